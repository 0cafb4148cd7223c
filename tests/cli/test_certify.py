# SPDX-License-Identifier: MIT
"""Thin parts: the warning without --certify, its report, -Werror, and what does not depend on threads."""
import json
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
        result = self.run_in("drilled.txt", "-o", "out.ply", "--certify")
        self.assert_status(result, 0)
        self.assertNotIn("warning", result.stderr)
        self.assertRegex(result.stderr, r"certify: every part of the surface thicker than 0\.00\d+ is in the mesh\n")
        self.assertIn(" 0 unresolved, 0 missed\n", result.stderr)
        plain = self.run_in("drilled.txt", "-o", "plain.ply")
        self.assertEqual(plain.stderr, "")
        self.assertEqual(self.read("out.ply"), self.read("plain.ply"))

    def test_report(self):
        self.write("sheet.txt", SHEET)
        result = self.run_in("sheet.txt", "--certify", "-r", "64", "--stats")
        self.assert_status(result, 0)
        self.assertIn("sheet.txt:3:24: warning W0406", result.stderr)
        self.assertIn("missed", result.stderr)
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

    def test_loose_bounds(self):
        """Of a field whose constant is far too large nothing is claimed, and nothing is kept silent."""
        self.write("loose.txt", "field(function (p) 1 - norm(p), bounds = [[-2, -2, -2], [2, 2, 2]], "
                                "lipschitz = 60);\n")
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
