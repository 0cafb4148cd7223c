# SPDX-License-Identifier: MIT
"""-e, --simplify and --improve as users meet them: every format, parts, colours, figures, errors."""
import json
import math
import os
import struct
import unittest

import cli

PLATE = """difference() {
  union(blend = 0.2) { color("red") cube([4, 3, 0.6], center = true); cylinder(r = 0.8, h = 2, center = true); }
  cylinder(r = 0.4, h = 5, center = true);
}
"""
PARTS = """part("left") cube(1);
part("right") translate([3, 0, 0]) sphere(r = 1);
"""


class Tolerance(cli.CliTest):
    def stats(self, *arguments):
        result = self.run_in(*arguments, "--stats")
        self.assert_status(result, 0)
        stats = json.loads(result.stdout)
        flat = {}
        for value in stats.values():
            flat.update(value if isinstance(value, dict) else {})
        return {**stats, **flat, **stats["mesh"]}

    def test_box(self):
        self.write("box.txt", "rotate([10, 20, 30]) cube([3, 2, 1]);\n")
        stats = self.stats("box.txt", "-e", "0.01", "-o", "box.ply")
        self.assertLessEqual(stats["triangles"], 100)
        self.assertLessEqual(stats["max_distance_measured"], 0.01)
        self.assertEqual(stats["max_distance_bound"], 0.01)

    def test_walls_thinner_than_the_tolerance(self):
        """Two facetted balls, one in the other and 0.02 apart: all triangles are proven to be within 0.05 of these."""
        self.write("skin.txt", "difference() { sphere(r = 10, $fn = 40); sphere(r = 9.98, $fn = 40); }\n")
        stats = self.stats("skin.txt", "--facets=exact", "-e", "0.05", "-o", "skin.stl")
        self.assertEqual((stats["open_places"], stats["max_distance_bound"], stats["euler"]), (0, 0.05, 4))
        self.assertLess(stats["triangles"], 0.9 * stats["own_triangles_before"])
        self.assert_status(self.run_in("skin.txt", "--facets=exact", "-o", "own.stl"), 0)
        report = self.run_in("diff", "skin.stl", "own.stl", "--tol", "0.05", "--ignore-topology")
        self.assert_status(report, 0)

    @cli.optimised_only
    def test_cells_missed_a_place(self):
        """The first mesh is 0.065 from a place of the knurl: cells are divided there, no others, and all is shown to be within."""
        stats = self.stats(os.path.join(cli.SCENES, "models", "bottle_cap.txt"), "-e", "0.05", "-o", "out.ply")
        self.assertEqual((stats["open_places"], stats["max_distance_bound"]), (0, 0.05))
        self.assertLessEqual(stats["max_distance_measured"], 0.05)
        self.assertLess(stats["triangles"], 12000)

    def radii(self, *arguments):
        """The least and the largest distance of a ball's vertices from its middle, and their triangles."""
        stats = self.stats("ball.txt", *arguments, "-o", "out.ply")
        body = self.read("out.ply").split(b"end_header\n", 1)[1]
        count = stats["vertices"]
        step = (len(body) - 13 * stats["triangles"]) // count
        places = [struct.unpack_from("<3f", body, step * i) for i in range(count)]
        lengths = [math.hypot(*place) for place in places]
        return min(lengths), max(lengths), stats["triangles"]

    def test_vertices_on_both_sides(self):
        """Of a ball of radius 10 vertices on it, and triangles within 0.05, take twice as many of them."""
        self.write("ball.txt", "sphere(r = 10);\n")
        low, high, few = self.radii("-e", "0.05")
        self.assertGreater(high, 10.02)
        self.assertLess(high, 10.05)
        self.assertGreater(low, 9.95)
        on_low, on_high, many = self.radii("--simplify", "0.05")
        self.assertGreater(on_low, 9.9999)
        self.assertLess(on_high, 10.0001)
        self.assertLess(few, 0.8 * many)

    def test_small_files(self):
        """The mug within 0.05: asked are 30 kB with meshoptimizer."""
        for option in ("meshopt", "meshopt-khr") if cli.has_library("meshoptimizer") else ():
            with self.subTest(compress=option):
                self.assert_status(self.run_in(os.path.join(cli.SCENES, "parts", "mug.txt"), "-e", "0.05", "-o", "mug.glb", "--compress", option), 0)
                self.assertLess(len(self.read("mug.glb")), 30000)

    def test_formats(self):
        self.write("plate.txt", PLATE)
        counts = {}
        for ending in ("stl", "obj", "ply", "glb"):
            if ending in cli.formats_written():
                stats = self.stats("plate.txt", "-e", "0.05", "-o", "out." + ending)
                counts[ending] = stats["triangles"]
                self.assertGreater(len(self.read("out." + ending)), 100)
        without_colors = counts.pop("stl")
        self.assertEqual(len(set(counts.values())), 1, counts)
        self.assertLess(without_colors, counts["obj"])

    def test_colors_stay(self):
        self.write("plate.txt", PLATE)
        self.assert_status(self.run_in("plate.txt", "-e", "0.05", "-o", "out.ply"), 0)
        self.assertIn(b"property uchar red", self.read("out.ply"))

    def test_parts_stay(self):
        self.write("parts.txt", PARTS)
        self.assert_status(self.run_in("parts.txt", "-e", "0.05", "-o", "out.obj"), 0)
        text = self.read("out.obj").decode()
        self.assertIn("left", text)
        self.assertIn("right", text)

    def test_simplify(self):
        self.write("ball.txt", cli.BALL)
        before = self.stats("ball.txt", "-r", "48", "-o", "out.ply")["triangles"]
        share = self.stats("ball.txt", "-r", "48", "--simplify", "20%", "-o", "out.ply")
        self.assertLessEqual(abs(share["triangles"] - before / 5), 2)
        error = self.stats("ball.txt", "-r", "48", "--simplify", "0.02", "-o", "out.ply")
        self.assertLess(error["triangles"], before / 5)
        self.assertLessEqual(error["max_distance_measured"], 0.02)

    def test_improve(self):
        self.write("ball.txt", cli.BALL)
        before = self.stats("ball.txt", "-r", "24", "-o", "out.ply")
        after = self.stats("ball.txt", "-r", "24", "--improve", "-o", "out.ply")
        self.assertLessEqual(after["triangles"], before["triangles"])
        self.assertLess(before["min_angle_deg"], 10)
        self.assertGreater(after["min_angle_deg"], 20)

    def test_errors(self):
        self.write("ball.txt", cli.BALL)
        for bad in (("-e", "0.1", "--simplify", "0.1"), ("-e", "0"), ("-e", "-1"), ("-e", "x"),
                    ("--simplify", "0%"), ("--simplify", "x%")):
            with self.subTest(bad=bad):
                result = self.run_in("ball.txt", "-o", "out.ply", *bad)
                self.assertNotEqual(result.returncode, 0)
                self.assertIn("error", result.stderr)
                self.assert_files("ball.txt")

    @cli.optimised_only
    def test_in_little_memory(self):
        """A mesh whose triangles, before they are thinned out, have no room is made in tiles: the limit alone says so, not the threads."""
        self.write("lattice.txt", "intersection() { cube([10, 10, 10]); gyroid(cell = 8, thickness = 1); }")
        arguments = ("lattice.txt", "-e", "0.05")
        whole = self.stats(*arguments, "-o", "whole.ply", "-j", 2)
        tiles = self.stats(*arguments, "-o", "a.ply", "-j", 2, "--max-memory", "16M")
        self.assertFalse(self.read("whole.ply") == self.read("a.ply"))
        self.assertTrue(tiles["manifold"])
        self.assertEqual(tiles["euler"], whole["euler"])
        self.assertLessEqual(tiles["triangles_before"], whole["triangles_before"])  # with cells divided where places were missed
        self.assertGreater(tiles["triangles_before"], 0.98 * whole["triangles_before"])
        thinned = [self.stats("lattice.txt", "--simplify", "0.05", "-o", "c.ply", "-j", 2, *limit)["triangles_before"]
                   for limit in ((), ("--max-memory", "16M"))]
        self.assertEqual(*thinned)  # nothing is proven: of the same cells
        self.assertEqual(tiles["max_distance_bound"], 0.05)
        self.assertLess(tiles["triangles"], 1.1 * whole["triangles"])
        self.assert_status(self.run_in(*arguments, "-o", "b.ply", "-q", "--max-memory", "16M", "-j", 1), 0)
        self.assertTrue(self.read("a.ply") == self.read("b.ply"))

    @cli.optimised_only
    def test_too_little_memory_is_told(self):
        """Tiles that cannot be held all together: how much is needed at least, before the limit is met."""
        self.write("lattice.txt", "intersection() { cube([10, 10, 10]); gyroid(cell = 5, thickness = 0.6); }")
        result = self.run_in("lattice.txt", "-e", "0.05", "-j", "1", "--max-memory", "8M", "-o", "a.ply")
        self.assert_refused(result, 2, "E0901", "at least 9 MiB of memory are needed", "--quality draft", "-r")
        self.assert_files("lattice.txt")

    def test_too_little_memory(self):
        self.write("plate.txt", PLATE)
        result = self.run_in("plate.txt", "-e", "0.001", "--max-memory", "4M", "-o", "out.ply")
        self.assertNotEqual(result.returncode, 0)
        self.assert_files("plate.txt")


if __name__ == "__main__":
    cli.main()
