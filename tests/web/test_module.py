# SPDX-License-Identifier: MIT
"""The compiler as WebAssembly writes the bytes that the native program writes (docs/web.md).

The module is that of tools/web/build.py in build-web, which this brings up to date; where nobody has built it, or Node
is missing, the tests are skipped.
"""
import gzip
import json
import os
import shutil
import subprocess
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "cli"))
sys.path.insert(0, os.path.join(ROOT, "tools", "web"))
import cli  # pylint: disable=wrong-import-position
import libraries  # pylint: disable=wrong-import-position
from make import make  # pylint: disable=wrong-import-position

PLACE = os.path.join(ROOT, "build-web")
NODE = shutil.which("node")
FORMATS = ["ply", "stl", "obj", "glb", "off", "3mf", "amf"]
DRAWINGS = ["svg", "dxf", "pdf"]
LARGEST = 1_200_000 # bytes of the module, gzipped
FONT = "LiberationSans-Regular.ttf" # beside the scene, as it is not in the folder that the module sees

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
    "hull": ("hull() { sphere(5); translate([20, 0, 0]) cube(8); }\nminkowski() { translate([0, 20, 0]) cube(4); sphere(1); }\n", ["-r", "48"]),
    "large": ("cube([1.5e14, 2e14, 123456789012345.678]);\n", ["-r", "8"]),
    "set": ("size = 3; // [1:10]\ncube(size);\n", ["-D", "size=5", "-r", "32"]),
}

# Outlines: their set operations and offsets, letters (kerned, with accents, from right to left), what is read from SVG.
FLAT = {
    "plate": ("difference() { square([30, 20]); translate([10, 10]) circle(4); offset(1) polygon([[20, 5], [25, 5], [22, 12]]); }\n", []),
    "letters": (f'text("AVATAR To fi Ωж\u202Exyz 12", font = "{FONT}");\n', []),
    "drawing": ('offset(r = 0.5) import("a.svg");\n', []),
}
SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="30mm" viewBox="0 0 40 30">
<path d="M 5 5 C 10 0, 20 0, 25 5 S 35 20, 20 25 Z"/><rect x="2" y="22" width="10" height="6" rx="2"/></svg>
"""


# What the native build must have for bytes to be compared.
LIBRARIES = ("Clipper", "Qhull", "FreeType", "FriBidi", "expat", "libzip")


@unittest.skipUnless(NODE, "no node")
@unittest.skipUnless(all(map(cli.has_library, LIBRARIES)), f"the native build lacks one of {', '.join(LIBRARIES)}")
@unittest.skipUnless(os.path.isdir(PLACE), "no build-web: tools/web/build.py makes it")
class Module(cli.CliTest):
    @classmethod
    def setUpClass(cls):
        cls.module = make("build.py")
        cls.font = libraries.Debian(os.path.join(PLACE, "sources")).font()[0]

    def run_module(self, *arguments):
        return subprocess.run([NODE, "--no-warnings", os.path.join(ROOT, "tools", "web", "run.mjs"), self.module, self.folder, *arguments],
                              capture_output=True, text=True, check=False, timeout=600)

    def write_files(self):
        shutil.copy(self.font, self.path(FONT))
        self.write("a.svg", SVG)

    def test_size(self):
        """What a page has to load: the bound of docs/web.md."""
        self.assertLess(len(gzip.compress(self.read(self.module), 9, mtime=0)), LARGEST)

    def test_the_same_meshes(self):
        self.compare({**SCENES, **{name: (f"linear_extrude(3) {text}", options) for name, (text, options) in FLAT.items()}}, FORMATS)

    def test_the_same_drawings(self):
        """Also of large sizes, whose decimals tools/web/wasm/decimals.cpp makes."""
        self.compare({**FLAT, "large": ("translate([0.0625, 5e14]) square([123456789.015625, 98765432109876.5]);\n", [])}, DRAWINGS)

    def test_the_font_of_every_name(self):
        """A page has one font; another one that is asked for is a finding, as it is natively where it is not installed."""
        self.write_files()
        os.makedirs(self.path("fonts"))
        os.rename(self.path(FONT), self.path("fonts/" + FONT))
        self.write("by file.txt", f'text("Abc", font = "fonts/{FONT}");\n')
        self.run_module("by file.txt", "-o", "by file.svg")
        for name, warnings in (("", 0), ("Liberation Sans", 0), ("liberation sans:style=Regular", 0), ("Papyrus", 1), ("Liberation Sans:style=Bold", 1)):
            with self.subTest(name):
                self.write("a.txt", f'text("Abc", font = "{name}");\n')
                done = self.run_module("a.txt", "-o", "a.svg")
                self.assertEqual((done.returncode, done.stdout.count('"warning"')), (0, warnings), done.stdout)
                self.assertEqual(self.read("a.svg"), self.read("by file.svg"))

    def test_a_mesh_is_read(self):
        """Exceptions and long jumps of the libraries: a broken archive is a finding."""
        self.write("a.txt", "cube(10);\n")
        self.run_module("a.txt", "-o", "a.3mf")
        self.write("b.txt", 'import("a.3mf");\n')
        self.assertEqual(self.run_module("b.txt", "-o", "b.stl").returncode, 0)
        self.write("a.3mf", "no archive")
        done = self.run_module("b.txt", "-o", "c.stl")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("a.3mf", done.stdout)

    def compare(self, scenes, formats):
        self.write_files()
        for name, (text, options) in scenes.items():
            self.write("a.txt", text)
            for form in formats:
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
