# SPDX-License-Identifier: MIT
"""Twisted, tapered, bent, repeated and unequally scaled solids: no holes at any resolution.

A Lipschitz constant that is too small shows as cells that the octree skips, so the mesh without pruning would be another one, or
pieces and volume would be wrong. Volumes are those of closed forms: these maps keep them, or change them in a known way.
"""
import json
import math
import sys

import cli

# scene, volume (None: not known in closed form), Euler characteristic of the surface
SCENES = {
    "twisted bar": ("linear_extrude(40, twist = 400) square([10, 4], center = true);", 1600, 2),
    "twisted figure aside": ("linear_extrude(30, twist = -180) translate([8, 0]) circle(3);", 30 * 9 * math.pi, 2),
    "twisted solid": ("twist(6) difference() { cube([12, 6, 40], center = true); rotate([0, 90, 0]) cylinder(h = 30, r = 1.5, "
                      "center = true); }", 12 * 6 * 40 - 12 * 1.5 ** 2 * math.pi, 0),
    "tapered": ("linear_extrude(20, scale = 0.25) square([12, 8], center = true);", 20 / 3 * 96 * (1 + 1 / 4 + 1 / 16), 2),
    "to a point": ("linear_extrude(15, scale = 0) circle(6);", 15 / 3 * 36 * math.pi, 2),
    "unequal scale": ("scale([3, 1, 0.4]) sphere(6);", 4 / 3 * math.pi * 6 ** 3 * 1.2, 2),
    "sheared": ("multmatrix([[1, 0, 0.8, 0], [0, 1, 0.3, 0], [0, 0, 1, 0]]) cylinder(h = 12, r = 5);", 12 * 25 * math.pi, 2),
    # bending keeps the volume of what is symmetric about the bent line
    "bent": ("bend(14) cube([60, 6, 5], center = true);", 60 * 6 * 5, 2),
    "bent far": ("bend(10) cube([58, 4, 4], center = true);", 58 * 4 * 4, 2),
    "bent holes": ("bend(20) difference() { cube([60, 8, 4], center = true); for (x = [-20, 0, 20]) translate([x, 0, 0]) "
                   "cylinder(h = 9, r = 2, center = true); }", None, -4),
    "sum with a cavity": ("minkowski() { difference() { cube(19, center = true); cube(11, center = true); } cube(1, center = true); }",
                          20 ** 3 - 10 ** 3, 4),
    "repeated": ("repeat([7, 7, 7], [3, 2, 2]) sphere(3);", 12 * 36 * math.pi, 24),
    "revolved part": ("rotate_extrude(angle = 250) translate([8, 0]) square([4, 6]);", 250 / 360 * math.pi * (144 - 64) * 6, 2),
}
QUICK = [16, 23, 40, 64]
SLOW = [90, 128, 181, 256, 362, 512]
THOROUGH = "--thorough" in sys.argv
if THOROUGH:
    sys.argv.remove("--thorough")


class Deformed(cli.CliTest):
    def facts(self, cells):
        result = cli.run("info", "--json", "-q", "-r", cells, "scene.txt", cwd=self.folder)
        self.assert_status(result, 0)
        return json.loads(result.stdout)["mesh"]

    def check(self, name, cells):
        _, volume, euler = SCENES[name]
        mesh, what = self.facts(cells), f"{name} at {cells} cells"
        self.assertEqual(mesh["boundary_edges"] + mesh["nonmanifold_edges"], 0, what)
        if cells >= 40:
            self.assertEqual(mesh["euler"], euler, what)
        if volume:
            self.assertLess(abs(mesh["volume"] / volume - 1), 30 / cells ** 1.5, f"{what}: volume {mesh['volume']}, not {volume}")

    def same_without_pruning(self, name, cells):
        meshes = []
        for extra in ([], ["--no-prune"]):
            self.assert_status(cli.run("scene.txt", "-q", "-r", cells, "-o", "out.ply", *extra, cwd=self.folder), 0)
            meshes.append(self.read("out.ply"))
        self.assertEqual(meshes[0], meshes[1], f"{name} at {cells} cells is another mesh without pruning")

    def test_no_holes(self):
        for name, (scene, _, _) in SCENES.items():
            self.write("scene.txt", scene)
            for cells in SLOW if THOROUGH else QUICK:
                self.check(name, cells)
            self.same_without_pruning(name, 96 if THOROUGH else 30)


if __name__ == "__main__":
    cli.main()
