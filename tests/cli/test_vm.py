# SPDX-License-Identifier: MIT
"""dump --vm and import() of .vm tapes: a scene's formula, written and read again, has its values."""
import json
import os
import random

import cli


class Tapes(cli.CliTest):
    def values(self, path, points):
        at = [word for p in points for word in ("--at", "%r,%r,%r" % p)]
        result = cli.run("eval", "-q", "--json", path, *at)
        self.assert_status(result, 0)
        lines = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual(len(lines), len(points))
        return [line["f"] for line in lines]

    def check_scene(self, path):
        tape = cli.run("dump", "--vm", "-q", path)
        if tape.returncode == 2 and "E0345" in tape.stderr:
            return False  # soft solids: no tape can hold them, and it is said so
        self.assert_status(tape, 0)
        self.write("scene.vm", tape.stdout)
        self.write("again.txt", 'import("scene.vm", lipschitz = 1000);\n')
        draw = random.Random(path)
        points = [tuple(draw.uniform(-reach, reach) for _ in range(3)) for reach in (5, 30, 90) * 12]
        wanted = self.values(path, points)
        for got, value, p in zip(self.values(self.path("again.txt"), points), wanted, points):
            self.assertLessEqual(abs(got - value), 1e-6 * (1 + abs(value)), f"{path} at {p}")
        self.assertLess(len(set(map(str, wanted))), len(points) + 1)
        self.assertGreater(len(set(map(str, wanted))), 10)
        return True

    def test_the_tour_comes_back(self):
        folder = os.path.join(cli.SCENES, "tour")
        names = [name for name in sorted(os.listdir(folder)) if name.endswith(".txt")]
        self.assertGreater(len(names), 8)
        held = 0
        for name in names:
            with self.subTest(name):
                held += self.check_scene(os.path.join(folder, name))
        self.assertGreater(held, 8)

    def test_shapes_and_deformations_come_back(self):
        self.write("a.txt", "linear_extrude(7, twist = 20) difference() { square(9); circle(2); }\n"
                            "translate([20, 0, 0]) bend(9) union(blend = 1) { cube([12, 2, 2], center = true); sphere(3); }\n"
                            "translate([0, 30, 0]) linear_extrude(3) polygon([[0, 0], [20, 0], [10, 5], [20, 10], [0, 10]]);\n"
                            "translate([0, -30, 0]) combine(function (a, b) a + b - sqrt(a * a + b * b + 1), lipschitz = 3) { sphere(5); cube(7); }\n"
                            "translate([0, -60, 0]) minkowski() { cube(7); cylinder(h = 2, r1 = 3, r2 = 0, $fn = 5); }\n"
                            "intersection() { gyroid(20, 3); translate([-40, 0, 0]) sphere(15); }\n")
        self.check_scene(self.path("a.txt"))

    def test_a_tape_is_meshed(self):
        self.write("ball.vm", "# a ball\nx var-x\ny var-y\nz var-z\na square x\nb square y\nc square z\n"
                              "d add a b\ne add d c\nf sqrt e\nr const 3\nout sub f r\n")
        self.write("cut.txt", 'import("ball.vm", bounds = [[-4, -4, -4], [4, 4, 1]]);\n')
        self.assert_clean(self.run_in(self.path("cut.txt"), "-q", "-r", "32", "-o", "cut.obj"))
        heights = [float(line.split()[3]) for line in self.read("cut.obj").decode().splitlines()
                   if line.startswith("v ")]
        self.assertAlmostEqual(max(heights), 1, delta=0.01)
        self.assertAlmostEqual(min(heights), -3, delta=0.05)

    def test_what_is_wrong_is_told(self):
        self.write("bad.vm", "x var-x\n\nout cube x\n")
        self.write("steep.vm", "x var-x\nout square x\n")
        for scene, says in (('import("bad.vm");', "line 3: there is no operation 'cube'"),
                            ('import("steep.vm");', "how steep the formula gets cannot be told"),
                            ('import("gone.vm");', "there is no file 'gone.vm'"),
                            ('import("steep.vm", bounds = 3);', "bounds must be [[x, y, z], [x, y, z]]")):
            self.write("scene.txt", scene)
            result = cli.run("dump", "--scene", self.path("scene.txt"))
            self.assert_status(result, 1)
            self.assertIn(says, result.stderr)
        self.write("dent.txt", "polyhedron([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4], [1, 1, 1]], [[0, 1, 2], "
                               "[0, 3, 1], [0, 2, 3], [1, 4, 2], [1, 3, 4], [3, 2, 4]]);")
        result = cli.run("dump", "--vm", self.path("dent.txt"))
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("no tape can hold a solid of 6 triangles that is not convex", result.stderr)
        self.assertEqual(result.stdout, b"")


if __name__ == "__main__":
    cli.main()
