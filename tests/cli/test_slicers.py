# SPDX-License-Identifier: MIT
"""Layers against other programs: PrusaSlicer's of the mesh, and what librsvg draws of the SVG.

Without one of them its test is skipped, with a message. `test_slicers.py --table` prints the rows of docs/slice.md as they are measured.
"""
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
import zipfile

import cli
import png

PARTS = ("bracket", "mug", "spool")
LAYER, PIXEL, SCREEN = 0.2, 0.05, 120  # millimetres
DOTS = 10  # of librsvg, in a millimetre
EVERY = 40  # layers, of which one is looked at: reading pictures takes longest
SETTINGS = f"""printer_technology = SLA
layer_height = {LAYER}
initial_layer_height = {LAYER}
display_width = {SCREEN}
display_height = {SCREEN}
display_pixels_x = {round(SCREEN / PIXEL)}
display_pixels_y = {round(SCREEN / PIXEL)}
display_orientation = landscape
display_mirror_x = 0
display_mirror_y = 0
supports_enable = 0
pad_enable = 0
elefant_foot_compensation = 0
slice_closing_radius = 0
"""


def scene_of(part):
    return os.path.join(cli.SCENES, "parts", part + ".txt")


def run(*command, **options):
    result = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False,
                            timeout=250, **options)
    assert result.returncode == 0, result.stdout.decode("utf-8", "replace")[-500:]
    return result.stdout


def contours_of(path):
    """[(area, length of the contours, the group's id)] of the layers of an SVG file; and its box."""
    root, layers = xml.etree.ElementTree.parse(path).getroot(), []
    for group in root.iter("{http://www.w3.org/2000/svg}g"):
        area = length = 0
        for drawn in group.iter("{http://www.w3.org/2000/svg}path"):
            for loop in drawn.get("d").split("Z")[:-1]:
                numbers = [float(word) for word in re.findall(r"-?[0-9.]+", loop)]
                points = list(zip(numbers[::2], numbers[1::2]))
                for (a, b), (c, d) in zip(points, points[1:] + points[:1]):
                    area -= (a * d - b * c) / 2  # y points down there
                    length += ((a - c) ** 2 + (b - d) ** 2) ** 0.5
        layers.append((area, length, group.get("id")))
    return layers, [float(word) for word in root.get("viewBox").split()]


def middle_of_stl(path):
    """Of the box of a binary STL, in the plane."""
    with open(path, "rb") as file:
        body = file.read()[84:]
    points = [struct.unpack_from("<2f", body, corner) for at in range(0, len(body), 50) for corner in range(at + 12, at + 48, 12)]
    return [(min(p[k] for p in points) + max(p[k] for p in points)) / 2 for k in (0, 1)]


def white(rows):
    """How many pixels, greys by their share."""
    return sum(map(sum, rows)) / 255


def apart(rows, others, left, top):
    """The same of where two pictures differ; the first begins there in the second, and is black around."""
    width, inside = len(rows[0]), others[top:top + len(rows)]
    inner = [other[left:left + width] for other in inside]
    return white(others) - white(inner) + sum(abs(a - b) for row, other in zip(rows, inner) for a, b in zip(row, other)) / 255


class Slicers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def sliced(self, part, name, *options):
        run(cli.PROGRAM, "slice", scene_of(part), "--layer", LAYER, "-e", 0.01, "-o", self.path(name), *options)
        return self.path(name)

    def by_prusaslicer(self, part, box):
        """Pictures of all layers of the mesh within 0.01. PrusaSlicer puts the middle of the mesh's box at the given place, which is where
        the middle of the scene's box is in the middle of the screen."""
        with open(self.path("settings.ini"), "w", encoding="ascii") as file:
            file.write(SETTINGS)
        run(cli.PROGRAM, scene_of(part), "-e", 0.01, "-o", self.path("part.stl"))
        x, y = middle_of_stl(self.path("part.stl"))
        center = SCREEN / 2 + x - box[0] - box[2] / 2, SCREEN / 2 + y + box[1] + box[3] / 2
        run("prusa-slicer", "--export-sla", "--center", f"{center[0]:.6f},{center[1]:.6f}", "--load", self.path("settings.ini"),
            "-o", self.path("out.sl1"), "--datadir", self.path("data"), self.path("part.stl"))
        return zipfile.ZipFile(self.path("out.sl1"))

    def compared(self, part):
        """[(our area, theirs, area between, length of the contours)] of one layer in so many."""
        layers, box = contours_of(self.sliced(part, "part.svg"))
        found = []
        with zipfile.ZipFile(self.sliced(part, "part.zip", "--pixel", PIXEL)) as masks, self.by_prusaslicer(part, box) as other:
            names = sorted(name for name in other.namelist() if name.endswith(".png"))
            self.assertLessEqual(abs(len(names) - len(layers)), 1)
            for i in range(EVERY // 2, len(names), EVERY):
                width, height, _, rows = png.read(masks.read(f"{i:05}.png"))
                side, _, channels, others = png.read(other.read(names[i]))
                self.assertEqual((channels, width % 2, height % 2), (1, 0, 0))
                between = apart(rows, others, (side - width) // 2, (side - height) // 2)
                found.append((layers[i][0], white(others) * PIXEL ** 2, between * PIXEL ** 2, layers[i][1]))
        return found

    def test_prusaslicer(self):
        if not shutil.which("prusa-slicer"):
            self.skipTest("prusa-slicer is not installed")
        for part in PARTS:
            with self.subTest(part):
                found = self.compared(part)
                distances = sorted(between / length for _, _, between, length in found)
                self.assertLess(distances[len(distances) // 2], 0.006)
                self.assertLess(distances[-1], 0.05)  # where the surface is nearly level 0.01 in space is more in the layer
                ours, theirs = sum(row[0] for row in found), sum(row[1] for row in found)
                self.assertLess(abs(ours - theirs), 2e-3 * ours)

    def drawn(self, part):
        """[(our area, librsvg's, length of the contours)] of some layers, each drawn alone."""
        path, found = self.sliced(part, "part.svg"), []
        layers, _ = contours_of(path)
        for area, length, name in layers[EVERY // 2::4 * EVERY]:
            picture = run("rsvg-convert", "--unlimited", "--zoom", DOTS, "-i", name, path)
            _, _, channels, rows = png.read(picture)
            found.append((area, white([row[channels - 1::channels] for row in rows]) / DOTS ** 2, length))
        return found

    def test_librsvg(self):
        if not shutil.which("rsvg-convert"):
            self.skipTest("rsvg-convert is not installed (librsvg2-bin on Debian)")
        for part in PARTS:
            with self.subTest(part):
                for ours, theirs, length in self.drawn(part):
                    self.assertLess(abs(ours - theirs), 5e-4 * length)


    def table(self):
        for part in PARTS:
            found, seen = self.compared(part), self.drawn(part)
            ours, theirs, between, length = (sum(row[k] for row in found) for k in range(4))
            off = max(abs(ours - theirs) / length for ours, theirs, length in seen)
            print(f"| {part} | {len(found)} | {ours:.1f} | {theirs:.1f} | {1000 * between / length:.1f} | "
                  f"{max(1000 * row[2] / row[3] for row in found):.1f} | {1000 * off:.2f} |")


if __name__ == "__main__":
    if sys.argv[1:] == ["--table"]:
        table = Slicers("table")
        table.setUp()
        table.table()
        table.doCleanups()
    else:
        unittest.main()
