# SPDX-License-Identifier: MIT
"""Whether engines show what we mean: GLB files drawn by three.js and Babylon.js in headless Chromium (show_with.mjs), held against csgmesh's picture of the scene itself, under one
camera: the same outline, the same colours, and brighter where it faces the lamp.

The engines are those of the folder CSGMESH_NODE_MODULES (`npm install three @babylonjs/core @babylonjs/loaders`), or of tests/io; the browser is that of tools/view (`npm ci` there) and
Chromium. Without them the tests are skipped, with a message.
"""
import json
import os
import shutil
import subprocess
import unittest

import cli
from test_render import read_ppm

HERE = os.path.dirname(os.path.abspath(__file__))
VIEW = os.path.join(HERE, "../../tools/view")
NODE_MODULES = os.environ.get("CSGMESH_NODE_MODULES", os.path.join(HERE, "..", "io", "node_modules"))
CHROMIUM = os.environ.get("CSGMESH_CHROMIUM", "/usr/bin/chromium")
SIZE = (400, 300)
PARTS = """part("lid") translate([0, 0, 20]) union(blend = 2) {
  color("red") sphere(5);
  color("blue") translate([6, 0, 0]) sphere(4);
}
part("base") color("seagreen") cube(8);
part("plain") color("goldenrod") material(0, 0.9) translate([30, 0, 0]) cylinder(h = 9, r = 4);
part("row") color("steelblue") for (i = [0 : 3]) translate([6 * i, -20, 0]) cube(4);
"""
EYE, TARGET, FOV = (50, -75, 50), (14, -6, 9), 30
FILES = {"plain": (), "meshopt": ("--compress", "meshopt"), "khr": ("--compress", "meshopt-khr"), "draco": ("--compress", "draco"), "levels": ("--lod", "2", "-e", "0.05")}


def why_missing(*modules):
    """None: all is there."""
    if not (os.path.isdir(os.path.join(VIEW, "node_modules/playwright-core")) and os.access(CHROMIUM, os.X_OK) and shutil.which("node")):
        return "no Chromium, or no npm ci --prefix tools/view"
    lacks = [name for name in modules if not os.path.isdir(os.path.join(NODE_MODULES, name))]
    return f"{' and '.join(lacks)} is not in {NODE_MODULES}" if lacks else None


def in_metres(place):
    return [0.001 * place[0], 0.001 * place[2], -0.001 * place[1]]


class Picture:
    """What is solid in a picture on white, and what it is like there."""

    def __init__(self, data):
        self.width, self.height, raw = read_ppm(data)
        self.pixels = [tuple(raw[i:i + 3]) for i in range(0, len(raw), 3)]
        self.solid = {i for i, pixel in enumerate(self.pixels) if min(pixel) < 235}

    def within(self):
        """Solid pixels with nothing but solid ones around them."""
        around = [dx + dy * self.width for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
        return {i for i in self.solid if all(i + step in self.solid for step in around)}

    def shares(self, i):
        """Red, green and blue, whatever the light; of light as it is, not as it is coded."""
        linear = [(value / 255) ** 2.2 + 1e-4 for value in self.pixels[i]]
        return [value / sum(linear) for value in linear]


def correlation(pairs):
    count = len(pairs)
    means = [sum(pair[k] for pair in pairs) / count for k in (0, 1)]
    products = [sum((pair[i] - means[i]) * (pair[k] - means[k]) for pair in pairs) for i, k in ((0, 1), (0, 0), (1, 1))]
    return products[0] / (products[1] * products[2]) ** 0.5


class Engines(cli.CliTest):
    def ours(self):
        camera = ",".join(map(str, (*EYE, *TARGET)))
        result = self.run_in("render", "parts.txt", "-o", "-", "-f", "ppm", "--size", "%dx%d" % SIZE, f"--camera={camera}", "--fov", FOV, "--no-ground", "--no-shadows", "--no-occlusion")
        self.assert_status(result, 0)
        return Picture(result.stdout)

    def theirs(self, library, names):
        paths = [self.path(name + ".glb") for name in names]
        for name, path in zip(names, paths):
            self.assert_status(self.run_in("parts.txt", "-o", path, *FILES[name]), 0)
        camera = {"eye": in_metres(EYE), "target": in_metres(TARGET), "up": [0, 1, 0], "fov": FOV}
        result = subprocess.run(["node", os.path.join(HERE, "show_with.mjs"), library, NODE_MODULES, "%dx%d" % SIZE, json.dumps(camera), *paths],
                                env={**os.environ, "CSGMESH_VIEW": VIEW}, capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        for name, path in zip(names, paths):
            with open(f"{path}.{library}.ppm", "rb") as file:
                yield name, Picture(file.read())

    def compare(self, ours, picture):
        self.assertGreater(len(ours.solid), 8000)
        shared = len(ours.solid & picture.solid) / len(ours.solid | picture.solid)
        inner = sorted(ours.within() & picture.within())
        off = sorted(max(abs(a - b) for a, b in zip(ours.shares(i), picture.shares(i))) for i in inner)
        bright = correlation([(sum(ours.pixels[i]), sum(picture.pixels[i])) for i in inner])
        print(f"  outlines share {shared:.4f}, shares of red, green and blue are off by {sum(off) / len(off):.4f}, brightness goes together by {bright:.3f}")
        self.assertGreater(shared, 0.985)
        self.assertLess(sum(off) / len(off), 0.06) # ours are paler where it is bright
        self.assertGreater(bright, 0.75)

    def show(self, library, names):
        self.write("parts.txt", PARTS)
        ours = self.ours()
        for name, picture in self.theirs(library, names):
            with self.subTest(file=name):
                print(library, name)
                self.compare(ours, picture)

    def test_pictures_differ(self):
        """What the test can see: another camera, a colour less, a part less."""
        self.write("parts.txt", PARTS)
        ours = self.ours()
        self.compare(ours, ours)
        for old, new in (('translate([0, 0, 20])', 'translate([0, 1, 20])'), ('color("steelblue")', 'color("seagreen")'), ('[0 : 3]', '[0 : 2]'), ("cube(8)", "cube(8.8)")):
            with self.subTest(change=new), self.assertRaises(AssertionError):
                self.write("parts.txt", PARTS.replace(old, new))
                self.compare(ours, self.ours())

    @unittest.skipIf(why_missing("three"), why_missing("three"))
    def test_three(self):
        self.show("three", list(FILES))

    @unittest.skipIf(why_missing("three", "@babylonjs/core", "@babylonjs/loaders"), why_missing("three", "@babylonjs/core", "@babylonjs/loaders"))
    def test_babylon(self):
        self.show("babylon", ["plain", "meshopt", "levels"])


if __name__ == "__main__":
    cli.main()
