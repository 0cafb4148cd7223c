#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The pictures of docs/features.md: solids as plain marching cubes makes them (left) and with sharp
features (right), with their triangles. Usage: features.py CSGMESH. Needs Pillow."""
import os
import subprocess
import sys
import tempfile

from PIL import Image

SCENES = [
    ("cube", 24, "rotate([31, 47, 13]) cube(10, center = true);"),
    ("tetrahedron", 24, "rotate([11, 27, 43]) intersection() { plane([1, 1, 1], 5); plane([-1, -1, 1], 5); "
                        "plane([-1, 1, -1], 5); plane([1, -1, -1], 5); }"),
    ("cylinder", 24, "rotate([31, 47, 13]) cylinder(h = 10, r = 5, center = true);"),
    ("cone", 24, "rotate([61, 17, 13]) cylinder(h = 10, r1 = 5, r2 = 0, center = true);"),
    ("crossed", 32, "rotate([31, 47, 13]) union() { cylinder(h = 20, r = 3, center = true); "
                    "rotate([90, 0, 0]) cylinder(h = 20, r = 4, center = true); }"),
    ("plate", 36, "rotate([21, 37, 13]) difference() { cube([20, 20, 4], center = true); "
                  "for (x = [-5, 5], y = [-5, 5]) translate([x, y, 0]) cylinder(h = 10, r = 2, center = true); }"),
    ("gear", 48, "rotate([31, 27, 13]) linear_extrude(4) difference() { union() { circle(8); for (i = [0 : 11]) "
                 "rotate(i * 30) polygon([[7, -1.6], [10.5, -0.9], [10.5, 0.9], [7, 1.6]]); } circle(3); }"),
    ("wedge", 32, "rotate([10, 20, 30]) intersection() { cube([20, 20, 6], center = true); plane([0.2, 1, 0], 3); "
                  "plane([0.2, -1, 0], 3); }"),
    ("blend", 32, "rotate([31, 27, 13]) difference() { union(blend = 3) { cube([16, 16, 6], center = true); "
                  "cylinder(h = 20, r = 4, center = true); } cylinder(h = 30, r = 2.5, center = true); }"),
    ("letters", 64, 'rotate([40, 0, 20]) linear_extrude(3) text("Aa", size = 10, font = "DejaVu Sans:style=Bold");'),
]
OUT = os.path.join(os.path.dirname(__file__), "..", "..", "docs", "pictures", "features")
SIZE = (420, 340)


def main():
    program = sys.argv[1]
    os.makedirs(OUT, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for name, resolution, text in SCENES:
            scene = os.path.join(folder, "s.txt")
            with open(scene, "w", encoding="utf-8") as file:
                file.write(text)
            sheet = Image.new("RGB", (2 * SIZE[0], SIZE[1]), "white")
            for column, features in enumerate(("smooth", "sharp")):
                mesh, picture = os.path.join(folder, "m.ply"), os.path.join(folder, "p.png")
                subprocess.run([program, scene, "-q", "-r", str(resolution), "--features", features, "-o", mesh],
                               check=True)
                subprocess.run([program, "render", mesh, "-q", "--wireframe", "--shading", "flat", "--size",
                                "%dx%d" % SIZE, "-o", picture], check=True)
                sheet.paste(Image.open(picture).convert("RGB"), (column * SIZE[0], 0))
            sheet.convert("P", palette=Image.ADAPTIVE, colors=64).save(os.path.join(OUT, name + ".png"), optimize=True)


if __name__ == "__main__":
    main()
