# SPDX-License-Identifier: MIT
"""The compiler as WebAssembly writes the bytes that the native program writes (docs/web.md).

The module is that of tools/web/build.py in build-web, which this brings up to date; where nobody has built it, or Node
is missing, the tests are skipped.
"""
import json
import os
import shutil
import subprocess
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "cli"))
import cli  # pylint: disable=wrong-import-position

PLACE = os.path.join(ROOT, "build-web")
NODE = shutil.which("node")
FORMATS = ["ply", "stl", "obj", "glb", "off"]

# With cells that follow the shape, the default, and with equal ones.
SCENES = {
    "blend": (cli.BLEND, []),
    "ball": ("sphere(10);\n", []),
    "tight": ("sphere(10);\n", ["-e", "0.005"]),
    "cut": ("difference(blend = 0.05) { cube(2, center = true); rotate([90, 0, 0]) cylinder(h = 3, r = 0.6, center = true); }\n",
            ["-s", "0.05"]),
    "many": ("for (i = [0 : 40]) translate([cos(i * 40), sin(i * 40), i / 15]) sphere(r = 0.2 + 0.004 * i);\n", ["-r", "64"]),
    "field": ("intersection() { sphere(r = 1); field(function (p) 0.3 - abs(sin(400 * p.x) * cos(400 * p.y) + sin(400 * p.y) * cos(400 * p.z))); }\n",
              ["-r", "48"]),
    "set": ("size = 3; // [1:10]\ncube(size);\n", ["-D", "size=5", "-r", "32"]),
}


@unittest.skipUnless(NODE, "no node")
@unittest.skipUnless(os.path.isdir(PLACE), "no build-web: tools/web/build.py makes it")
class Module(cli.CliTest):
    @classmethod
    def setUpClass(cls):
        done = subprocess.run([sys.executable, os.path.join(ROOT, "tools", "web", "build.py")], capture_output=True, text=True, check=False)
        if done.returncode == 77:
            raise unittest.SkipTest(done.stderr.strip())
        if done.returncode:
            raise AssertionError(done.stdout + done.stderr)
        cls.module = done.stdout.strip()

    def run_module(self, *arguments):
        return subprocess.run([NODE, "--no-warnings", os.path.join(ROOT, "tools", "web", "run.mjs"), self.module, self.folder, *arguments],
                              capture_output=True, text=True, check=False, timeout=600)

    def test_the_same_bytes(self):
        for name, (text, options) in SCENES.items():
            self.write("a.txt", text)
            for form in FORMATS:
                with self.subTest(f"{name} {form}"):
                    self.assert_status(self.run_in("a.txt", *options, "-o", "native." + form), 0)
                    done = self.run_module("a.txt", *options, "-o", "module." + form)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    self.assertEqual(self.read("module." + form), self.read("native." + form))

    def test_a_mistake(self):
        """It is told with its place, as the native program tells it, and nothing is written."""
        self.write("a.txt", "sphere(1);\ncub(3);\n")
        native = self.run_in("a.txt", "-o", "x.stl", "--diagnostics=json")
        done = self.run_module("a.txt", "-o", "x.stl")
        self.assertEqual((done.returncode, native.returncode), (1, 1))
        told = [[json.loads(line) for line in text.splitlines()] for text in (done.stdout, native.stderr)]
        self.assertEqual(told[0], told[1])
        self.assert_files("a.txt")

    def test_wrong_options(self):
        self.write("a.txt", cli.BALL)
        done = self.run_module("a.txt", "--no-such-option")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertIn("--no-such-option", done.stdout)


if __name__ == "__main__":
    cli.main()
