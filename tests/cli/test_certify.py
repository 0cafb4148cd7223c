# SPDX-License-Identifier: MIT
"""Thin parts: the warning without --certify, its report, -Werror, and what does not depend on threads."""
import json
import os
import unittest

import cli

SHEET = """cube(20, center = true);
translate([0, 0, 15.03])
  rotate([10, 20, 30]) cube([8, 8, 0.02], center = true);
"""
CRACK = """difference() {
  cube(20, center = true);
  rotate([12, 8, 5]) cube([0.01, 8, 8], center = true);
}
"""
# What the lattice misses inside formulas, polyhedra, twisted, extruded and combined solids: the scene, its line,
# "part" or "gap", and the range of its thickness.
PLANTED = {
    "wall of a formula": (
        "field(function (p) max(8 - norm(p), 0.03 - abs(p.x * 0.9 + p.y * 0.3 - 11.3), -1),\n"
        "  bounds = [[-9, -9, -9], [14, 9, 9]]);\n", 1, "part", (0.03, 0.07)),
    "crack of a polyhedron": (
        "difference() {\n"
        "  hull() { cube(20, center = true); translate([0, 0, 14]) sphere(3, $fn = 12); }\n"
        "  rotate([11, 7, 3]) polyhedron([[-0.01, -6, -6], [-0.01, 6, -6], [-0.01, 0, 7], [0.01, -6, -6], [0.01, 6, -6],\n"
        "    [0.01, 0, 7]], [[0, 1, 2], [3, 5, 4], [0, 3, 4, 1], [1, 4, 5, 2], [2, 5, 3, 0]]);\n"
        "}\n", 3, "gap", (0.01, 0.025)),
    "twisted needle": (
        "linear_extrude(3) square([12, 12]);\n"
        "translate([6, 6, 0]) linear_extrude(14, twist = 200) translate([1.3, 0.4]) square([0.03, 0.04]);\n",
        2, "part", (0.02, 0.04)),
    "gap below letters": (
        "linear_extrude(2) square([20, 12]);\n"
        "translate([2, 3, 2.02]) linear_extrude(2) text(\"Hi\", size = 11);\n", 1, "gap", (0.01, 0.03)),
    "hair of an outline": (
        "linear_extrude(4) union() { square([20, 8]); translate([5.03, 8]) square([0.05, 7]); }\n", 1, "part",
        (0.03, 0.06)),
    "disc of a combination": (
        "combine(function (a, b) max(max(a, b), a)) { sphere(8); translate([0, 0, 9.53]) cylinder(r = 5, h = 0.03); }\n", 1,
        "part", (0.02, 0.04)),
}
# Thick everywhere: nothing may be reported of them.
CLEAN = ["tour/" + name for name in (
    "01-first-solid", "02-operators", "03-blends", "04-six-blends", "05-expressions", "06-modules", "07-loops-and-lists",
    "08-transforms", "09-colour", "10-files", "14-smooth-steps", "15-your-own-blend")] + [
    "parts/cable_clip", "papers/nguyen_cross", "papers/nguyen_torus"]
CLEAN_PARTS = {
    "twisted bar": "linear_extrude(20, twist = 90) square([10, 6], center = true);\n",
    "bush": "rotate_extrude() translate([10, 0]) polygon([[0, 0], [6, 0], [6, 2], [2, 2], [2, 8], [0, 8]]);\n",
    "hull": "hull() { cube(10); translate([5, 5, 14]) sphere(3, $fn = 16); }\n",
    "pyramid": "polyhedron([[20, 0, 0], [30, 0, 0], [30, 10, 0], [20, 10, 0], [25, 5, 10]],\n"
               "  [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 3], [2, 1, 3]]);\n",
    "angle": "linear_extrude(30) polygon([[0, 0], [20, 0], [20, 4], [5, 5], [4, 20], [0, 20]]);\n",
}
DRILLED = "difference() { cube(20, center = true); rotate([20, 30, 0]) cylinder(r = 2, h = 60, center = true); }\n"


class Certify(cli.CliTest):
    def test_warning(self):
        self.write("sheet.txt", SHEET)
        result = self.run_in("sheet.txt", "-o", "out.ply", "-r", "64")
        self.assert_status(result, 0)
        self.assertEqual(result.stderr.count("W0406"), 1, result.stderr)
        self.assertIn("sheet.txt:3:24: warning W0406: a part about 0.0", result.stderr)
        self.assertIn("cube([8, 8, 0.02]", result.stderr)
        self.assertIn("hint: -r ", result.stderr)
        resolution = int(result.stderr.split("hint: -r ")[1].split()[0])
        self.assertLess(abs(resolution - 26 / (0.02 / 3 ** 0.5)), 800)
        self.write("crack.txt", CRACK)
        self.assertIn("a gap about 0.01", self.run_in("crack.txt", "-o", "out.ply", "-r", "64").stderr)

    def test_clean(self):
        self.write("drilled.txt", DRILLED)
        result = self.run_in("drilled.txt", "-r", "128", "-o", "out.ply", "--certify")
        self.assert_status(result, 0)
        self.assertNotIn("warning", result.stderr)
        self.assertIn("certify: every part of the surface is in the mesh\n", result.stderr)
        self.assertIn(" 0 refined, 0 unresolved, 0 missed\n", result.stderr)
        plain = self.run_in("drilled.txt", "-r", "128", "-o", "plain.ply")
        self.assertEqual(plain.stderr, "")
        self.assertEqual(self.read("out.ply"), self.read("plain.ply"))

    def assert_nothing_reported(self, path, resolution):
        result = self.run_in(path, "--certify", "-r", resolution, "--stats")
        self.assert_status(result, 0)
        certify = json.loads(result.stdout)["certify"]
        self.assertEqual((certify["missed"], certify["unresolved"]), (0, 0), certify["places"])
        self.assertGreater(certify["certified"] + certify["crease"], 500)

    @cli.optimised_only
    def test_clean_scenes(self):
        for name in CLEAN:
            with self.subTest(name):
                self.assert_nothing_reported(os.path.join(cli.SCENES, name + ".txt"), 64)
        for name, scene in CLEAN_PARTS.items():
            with self.subTest(name):
                self.write("part.txt", scene)
                self.assert_nothing_reported("part.txt", 48)

    def test_planted(self):
        for name, (scene, line, kind, (least, most)) in PLANTED.items():
            with self.subTest(name):
                self.write("planted.txt", scene)
                result = self.run_in("planted.txt", "--certify", "-r", "32", "--stats")
                self.assert_status(result, 0)
                places = json.loads(result.stdout)["certify"]["places"]
                self.assertTrue(places, result.stdout)
                place = max(places, key=lambda p: (p["kind"] == "missed", p["cells"]))
                if place["kind"] == "missed":
                    self.assertEqual(place["line"], line)
                    self.assertEqual(place["gap"], kind == "gap")
                    self.assertTrue(least <= place["thickness"] <= most, place)
                else:  # reported with its place at least
                    self.assertEqual(name, "gap below letters")
                    self.assertLess(abs(place["at"][2] - 2.01), 0.7)

    def test_varying_radius(self):
        """Nearly all cells have a cone, which the derivatives of one of the two solids must not spoil where it is far below."""
        self.write("rib.txt", "union(blend = function (p) 2 + p.x / 10) { cube([40, 20, 4]); translate([0, 8, 0]) cube([40, 4, 20]); }\n")
        result = self.run_in("rib.txt", "-r", "32", "--certify", "--stats")
        self.assert_status(result, 0)
        stats = json.loads(result.stdout)["certify"]
        self.assertEqual((stats["unresolved"], stats["missed"]), (0, 0))
        self.assertLess(stats["refined"], stats["crease"] / 20)

    def test_report(self):
        self.write("sheet.txt", SHEET)
        result = self.run_in("sheet.txt", "--certify", "-r", "64", "--stats")
        self.assert_status(result, 0)
        self.assertIn("sheet.txt:3:24: warning W0406", result.stderr)
        self.assertIn("missed", result.stderr)
        self.assertRegex(result.stderr, r"certify: every part of the surface thicker than 0\.0\d+ is in the mesh, but")
        certify = json.loads(result.stdout)["certify"]
        self.assertGreater(certify["missed"], 100)
        self.assertGreater(certify["certified"], 1000)
        place = certify["places"][0]
        self.assertEqual((place["kind"], place["line"], place["column"]), ("missed", 3, 24))
        self.assertLess(abs(place["at"][2] - 15), 3)
        self.assertLess(abs(place["thickness"] - 0.02), 0.005)

    def test_threads(self):
        self.write("sheet.txt", SHEET)
        reports = []
        for threads, isa in ((1, "scalar"), (1, ""), (3, "")):
            env = {"CSGMESH_ISA": isa} if isa else {}
            result = self.run_in("sheet.txt", "--certify", "-r", "48", "-j", threads, "-o", "out.ply", env=env)
            self.assert_status(result, 0)
            reports.append(result.stderr)
        self.assertEqual(len(set(reports)), 1, reports)

    def test_werror(self):
        self.write("sheet.txt", SHEET)
        self.assert_refused(self.run_in("sheet.txt", "-o", "out.ply", "-r", "64", "-Werror"), 1, "E0406")
        self.assert_files("sheet.txt")

    @cli.optimised_only
    def test_loose_bounds(self):
        """Of a field with steps and a constant far too large nothing is claimed, and nothing is kept silent."""
        self.write("loose.txt", "field(function (p) 1 - norm(p) + 0.000001 * floor(50 * p.x), "
                                "bounds = [[-2, -2, -2], [2, 2, 2]], lipschitz = 2000);\n")
        result = self.run_in("loose.txt", "--certify", "-r", "8", "--stats")
        self.assert_status(result, 0)
        certify = json.loads(result.stdout)["certify"]
        self.assertEqual(certify["certified"] + certify["crease"], 0)
        self.assertGreater(certify["unresolved"], 10)
        self.assertIn("W0407", result.stderr)

    def test_size(self):
        self.write("sheet.txt", SHEET)
        coarse = self.stats("sheet.txt", "--certify-size", "0.2", "-r", "48")["certify"]
        self.assertLess(abs(coarse["thickness"] - 3 ** 0.5 * 0.2), 1e-9)
        self.assert_refused(self.run_in("sheet.txt", "--certify-size", "0", "-o", "out.ply"), 2, "certify-size")


if __name__ == "__main__":
    cli.main()
