# SPDX-License-Identifier: MIT
"""Fillets keep dimensions: what a rolling ball adds, the box of the sharp union, nothing where faces continue or solids are apart;
the same bytes in any order, pruned or not; certified where faces are plane.
"""
import itertools
import json
import math

import cli


def turned_block(size):
    """A box as a polyhedron whose faces are along no axis of any frame."""
    def turned(x, y, z):
        a, b = math.radians(33), math.radians(21)
        x, y = x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a)
        return [x, y * math.cos(b) - z * math.sin(b), y * math.sin(b) + z * math.cos(b)]
    points = [turned(*(size[axis] * (k >> axis & 1) for axis in range(3))) for k in range(8)]
    return f"polyhedron({points}, [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]);"


# scene without its blend, radius, volume that the fillet adds (None: not known in closed form)
ARC = 1 - math.pi / 4  # of a right angle, times r^2
SCENES = {
    "bracket": ("cube([40, 20, 5]); cube([5, 20, 40]);", 3, ARC * 9 * 20),
    "bracket of polyhedra": (turned_block([40, 20, 5]) + turned_block([5, 20, 40]), 3, ARC * 9 * 20),
    "bracket of outlines": ("linear_extrude(20) rotate(33) polygon([[0, 0], [40, 0], [40, 5], [0, 5]]);"
                            "linear_extrude(20) rotate(33) polygon([[0, 0], [5, 0], [5, 40], [0, 40]]);", 3, ARC * 9 * 20),
    "plates apart": ("cube([40, 40, 5]); translate([0, 0, 7]) cube([40, 40, 5]);", 8, 0),
    "box on box": ("cube([10, 8, 5]); translate([0, 0, 5]) cube([10, 8, 4]);", 2, 0),
    "one axis": ("cylinder(h = 9, r = 4); translate([0, 0, 9]) cylinder(h = 6, r = 4);", 2, 0),
    "trough": ("cube([40, 20, 4]); cube([4, 20, 24]); translate([36, 0, 0]) cube([4, 20, 24]);", 2, 2 * ARC * 4 * 20),
    "post": ("cube([30, 20, 4]); translate([15, 10, 2]) cylinder(h = 20, r = 5);", 2, None),
    "rib": ("cube([40, 20, 4]); cube([4, 20, 24]); translate([36, 0, 0]) cube([4, 20, 24]); translate([2, 8, 2]) cube([36, 4, 14]);",
            2, None),
    "crossing cylinders": ("cylinder(h = 40, r = 3, center = true); rotate([0, 60, 0]) cylinder(h = 40, r = 3, center = true);", 2,
                           None),
    "balls apart": ("sphere(5); translate([12, 0, 0]) sphere(5);", 3, 0),
    "pins close together": ("cube([30, 20, 3]); for (x = [9, 18.5]) translate([x, 10, 0]) cylinder(h = 20, r = 4.5);", 2, None),
    "sloping": ("cube([40, 20, 5]); rotate([0, -40, 0]) translate([4, 0, -3]) cube([6, 20, 30]);", 2, None),
}


def union(blend, body):
    return f"union(blend = {blend}) {{ {body} }}\n"


class Fillets(cli.CliTest):
    def mesh(self, text, cells=80):
        self.write("scene.txt", text)
        result = cli.run("info", "--json", "-q", "-r", cells, "scene.txt", cwd=self.folder)
        self.assert_status(result, 0)
        return json.loads(result.stdout)["mesh"]

    def bytes(self, text, *options, suffix="ply"):
        self.write("scene.txt", text)
        self.assert_status(cli.run("scene.txt", "-q", "-r", 48, "-o", "out." + suffix, *options, cwd=self.folder), 0)
        return self.read("out." + suffix)

    def test_dimensions(self):
        for name, (body, radius, added) in SCENES.items():
            made, sharp = self.mesh(union(f"fillet({radius})", body)), self.mesh(union(0, body))
            for side in (0, 1):
                for axis in range(3):
                    beyond = (made["bounds"][side][axis] - sharp["bounds"][side][axis]) * (1 if side else -1)
                    self.assertLessEqual(beyond, 1e-6 * radius, f"{name}: {made['bounds']}, not {sharp['bounds']}")
            self.assertEqual(made["boundary_edges"] + made["nonmanifold_edges"], 0, name)
            if added is not None:
                self.assertLess(abs(made["volume"] - sharp["volume"] - added), 1e-3 * sharp["volume"], name)
            self.assertGreaterEqual(made["volume"], sharp["volume"] * (1 - 1e-4), name)

    def test_same_bytes(self):
        body = ["cube([5, 20, 40]);", "cube([40, 20, 5]);", "rotate([0, 0, 20]) translate([20, 2, 0]) cube([6, 6, 30]);"]
        first = self.bytes(union("fillet(3)", " ".join(body)))
        for order in itertools.permutations(body):
            self.assertEqual(self.bytes(union("fillet(3)", " ".join(order))), first, order)
        nested = union("fillet(3)", union("fillet(3)", body[0] + body[1]) + body[2])
        self.assertEqual(self.bytes(nested), first, "nested")
        self.assertEqual(self.bytes(nested, "--no-prune"), first, "not pruned")

    def test_round_in_any_order(self):
        body = ["sphere(5);", "translate([4, 1, 2]) cube([6, 7, 8], center = true);", "translate([-3, 4, 1]) torus(r = 6, tube = 2);"]
        meshes = {self.bytes(union("round(r = 3)", " ".join(order))) for order in itertools.permutations(body)}
        self.assertEqual(len(meshes), 1)

    def test_rims(self):
        """A hole with a rim of radius 2 in a plate 10 thick: what is taken away more (Pappus), on both sides."""
        hole = "{ cube([40, 40, 10], center = true); cylinder(h = 30, r = 8, center = true); }\n"
        rounded, sharp = (self.mesh(f"difference(blend = {blend}) {hole}", 128) for blend in ("fillet(2)", 0))
        from_edge = 2 * (10 - 3 * math.pi) / (12 - 3 * math.pi)  # the centroid of what an arc leaves of a corner
        expected = 2 * ARC * 4 * 2 * math.pi * (8 + from_edge)
        self.assertLess(abs(sharp["volume"] - rounded["volume"] - expected), 0.02 * expected)

    def test_certify(self):
        self.write("scene.txt", union("fillet(3)", SCENES["bracket"][0]))
        result = cli.run("scene.txt", "-r", 32, "--certify", "-o", "out.stl", cwd=self.folder)
        self.assert_status(result, 0)
        self.assertIn(" 0 unresolved, 0 missed", result.stderr + result.stdout.decode())

    def test_no_formula(self):
        self.write("scene.txt", union("fillet(3)", SCENES["bracket"][0]))
        result = cli.run("dump", "--vm", "scene.txt", cwd=self.folder)
        self.assertEqual(result.returncode, 2)
        self.assertIn("E0345", result.stderr)


if __name__ == "__main__":
    cli.main()
