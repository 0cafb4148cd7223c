# SPDX-License-Identifier: MIT
"""dump --scene: every scene of the repository prints as text that is the same tree, bit for bit."""
import os

import cli

FOLDERS = ["tour", "models", "parts", "stress", "hard", "papers"]


def scenes():
    for folder in FOLDERS:
        for place, _, names in os.walk(os.path.join(cli.SCENES, folder)):
            for name in sorted(names):
                if name.endswith((".txt", ".scad", ".csg")):
                    yield os.path.join(place, name)


class Dump(cli.CliTest):
    def dump(self, path):
        result = cli.run("dump", "--scene", "-q", path)
        self.assert_status(result, 0)
        return result.stdout

    def mesh(self, path, out):
        result = self.run_in(path, "-q", "-r", "24", "-o", out)
        self.assert_clean(result)
        return self.read(out) if result.returncode == 0 else result.returncode

    def check_scene(self, path):
        text = self.dump(path)
        self.write("flat.txt", text)
        self.assertEqual(self.dump(self.path("flat.txt")), text, f"{path}: another tree")
        again = self.mesh("flat.txt", "flat.ply")
        self.assertEqual(self.mesh(path, "source.ply"), again, f"{path}: another mesh")

    def test_every_scene_of_the_repository(self):
        count = 0
        for path in scenes():
            if os.path.basename(os.path.dirname(path)) in ("library", "libraries"):  # needs others
                continue
            count += 1
            with self.subTest(os.path.relpath(path, cli.SCENES)):
                self.check_scene(path)
        self.assertGreater(count, 20)

    def test_numbers_that_are_no_short_decimals(self):
        self.write("a.txt", "translate([1/3, PI, 1e-17]) rotate([10, 20, 30]) scale([1/7, 2, exp(1)])\n"
                            "  color([1/3, 0.1, 2/3, 0.5]) union(blend = sqrt(2)) { sphere(r = 1/3);\n"
                            "  cylinder(h = 1/9, r1 = 1/11, r2 = 1/13, round = 1/101); }\n")
        self.check_scene(self.path("a.txt"))


if __name__ == "__main__":
    cli.main()
