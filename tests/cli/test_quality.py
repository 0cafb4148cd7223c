# SPDX-License-Identifier: MIT
"""Cells that follow the shape: the default, --quality and --triangles. Flat solids end in as few triangles as they need, fine letters on a large
plate are there, bounds, parts, colours and formats are as on equal cells, and what excludes each other is said.
"""
import json
import unittest

import cli
import shading

LETTERS = 'cube([400, 300, 5]);\ntranslate([20, 20, 5]) linear_extrude(1) text("Io", size = 4);\n'
PAIR = 'part("a") color("red") cube(4);\npart("b") color("blue") translate([6, 0, 0]) sphere(3);\n'


class Quality(cli.CliTest):
    def stats(self, text, *options, status=0):
        self.write("scene.txt", text)
        result = cli.run("scene.txt", "-o", "out.ply", "--stats-full", *options, cwd=self.folder)
        self.assert_status(result, status)
        return json.loads(result.stdout)

    def bytes(self, text, *options, name="out.ply"):
        self.write("scene.txt", text)
        self.assert_status(cli.run("scene.txt", "-q", "-o", name, *options, cwd=self.folder), 0)
        return self.read(name)

    def test_cube(self):
        """A sharp cube has triangles of its own; a cylinder has a tolerance."""
        stats = self.stats("cube(10);", "--quality", "normal")
        self.assertEqual(stats["mesh"]["triangles"], 12)
        self.assertEqual(stats["lattice"], {"adaptive": False, "own_triangles": 12})
        stats = self.stats("cylinder(r = 5, h = 10);", "--quality", "normal")
        self.assertEqual(stats["quality"]["distance_allowed"], 2 ** -7)
        self.assertEqual(len(self.bytes("cube(10);", "--quality", "draft", name="out.stl")), 84 + 12 * 50)

    @cli.optimised_only
    def test_it_is_the_default(self):
        """Whatever else is asked for; -r 128 is what was the default, and what --certify looks at alone."""
        text = "difference() { cube(10); translate([10, 10, 10]) sphere(4); }"
        normal = self.bytes(text, "--quality", "normal")
        self.assertEqual(self.bytes(text), normal)
        self.assertTrue(self.stats(text)["lattice"]["adaptive"])
        self.assertTrue(json.loads(cli.run("info", "scene.txt", "--json", cwd=self.folder).stdout)["lattice"]["adaptive"])
        for options in (["--features", "smooth"], ["--improve"], ["--triangles", "99"], ["--simplify", "0.1"], ["--simplify", "50%"]):
            self.assertTrue(self.stats(text, *options)["lattice"]["adaptive"], options)
            self.assertEqual(self.read("out.ply"), self.bytes(text, "--quality", "normal", *options), options)
        lattice = self.stats(text, "-e", "0.1")["lattice"]
        self.assertEqual((lattice["adaptive"], lattice["tolerance"]), (True, 0.1))
        for options in (["-r", "128"], ["-s", "0.5"], ["-r", "64", "-e", "0.1"], ["--certify"], ["--certify-size", "0.05"]):
            self.assertFalse(self.stats(text, *options)["lattice"]["adaptive"], options)
        self.assertEqual(self.bytes(text, "--certify"), self.bytes(text, "-r", "128"))
        self.assertLess(len(normal), len(self.bytes(text, "-r", "128")) / 50)

    def test_simplify_without_cells(self):
        """Its error is the tolerance, whatever the quality would have been."""
        self.assertEqual(self.stats("sphere(10);", "--simplify", "0.25")["lattice"]["tolerance"], 0.25)
        self.assertFalse(self.stats("sphere(10);", "--simplify", "0.25", "-r", "32")["lattice"]["adaptive"])

    def test_any_unit(self):
        for size in (1e-6, 1e7):
            self.assertEqual(self.stats(f"cube({size});", "--quality", "draft")["mesh"]["triangles"], 12)

    def test_letters_on_a_plate(self):
        mesh = self.stats(LETTERS, "--quality", "normal")["mesh"]
        self.assertGreater(mesh["triangles"], 60)
        self.assertAlmostEqual(mesh["bounds"][1][2], 6, delta=0.25)
        self.assertEqual((mesh["components"], mesh["euler"]), (1, 0 + 2))

    def test_creases_side_by_side(self):
        """Ridges closer together than cells are wide: two creases go through a cell as two edges of its triangles, and corners that lie a little
        outside are good enough. Before, 395 places were left smooth, of 1320 triangles."""
        stats = self.stats("""star = [for (i = [0 : 47]) let (a = 7.5 * i) (5 - 0.3 * cos(6 * a)) * [cos(a), sin(a)]];
intersection(blend = 0.3) {
  linear_extrude(3, twist = 30) polygon(star);
  linear_extrude(3, twist = -30) polygon(star);
}""", "--quality", "draft")
        self.assertLess(stats["features"]["left_smooth"], 100)
        self.assertLess(stats["mesh"]["triangles"], 800)
        self.assertEqual(stats["mesh"]["euler"], 2)

    def test_edges_narrower_than_the_tolerance(self):
        """A chamfer of a sixth of it costs no more than a sharp edge; before, the cells along it were divided down to the tolerance."""
        before = [self.stats(f"intersection(blend = {blend}) {{ cylinder(h = 80, r = 40, center = true); plane([0.1, 0, 1], 10.3); }}")
                  for blend in ("0", "chamfer(0.01)")]
        self.assertEqual([stats["lattice"]["tolerance"] for stats in before], [0.0625, 0.0625])
        sharp, chamfered = (stats["mesh"]["triangles_before"] for stats in before)
        self.assertLess(chamfered, 1.5 * sharp)
        self.assertEqual(before[1]["features"]["left_smooth"], 0)

    def test_chamfer_of_two_thirds_of_the_tolerance(self):
        """Triangles that cut it off are within half a tolerance of its corner; when a fifth was asked for, 65 382 were to be thinned out."""
        stats = self.stats("rotate_extrude() polygon([[0, 0], [30, 0], [30, 19.98], [29.98, 20], [0, 20]]);")
        self.assertEqual(stats["lattice"]["tolerance"], 0.03125)
        self.assertLess(stats["mesh"]["triangles_before"], 20000)
        self.assertEqual(stats["features"]["left_smooth"], 0)

    def test_dent_in_a_turned_block(self):
        """1.2 T wide and deep; steps through the corners of its cube hardly leave one of its faces."""
        block = "union() { cube([8, 6, 2], center = true); translate([-2.914121, 0.696130, 1.087398]) sphere(0.0145663); }"
        dent = "translate([-1.654001, -0.559832, 1]) rotate([0, 0, 35.503]) cube([0.0093528, 0.0093528, 0.0187057], center = true);"
        counts = [self.stats(f"rotate([70.676, 125.851, -63.5]) difference() {{ {block} {cut} }}")["mesh"]["triangles"] for cut in ("", dent)]
        self.assertGreater(counts[1], counts[0] + 9)

    def test_bump_on_a_turned_block(self):
        """1.27 T wide and high: cells have a vertex 0.7 T above its foot, which thinning out takes away unless the places seen
        on its top stay near."""
        bump = "translate([1.756590, -2.260697, 1]) rotate([0, 0, 25.920]) translate([0, 0, 0.0049420]) cube([0.0099037, 0.0099037, 0.0099236], center = true);"
        scene = "rotate([9.596, -119.739, -89.344]) union() {{ cube([8, 6, 2], center = true); translate([3.422717, -2.110289, 1.118183]) sphere(0.0196972); {} }}"
        counts = [self.stats(scene.format(text))["mesh"]["triangles"] for text in ("", bump)]
        self.assertGreater(counts[1], counts[0])

    def test_rounded_edges_pass_through_large_cells(self):
        """By three vertices in a face where they bend; with one, 17 616 triangles were to be thinned out."""
        stats = self.stats("cube([30.3, 21.3, 10.7], round = 1.1);", "--quality", "normal")
        self.assertLess(stats["mesh"]["triangles_before"], 16500)
        self.assertEqual(stats["mesh"]["euler"], 2)

    def test_flat_faces_are_shaded_flat(self):
        """Where they end in a rounding, the surface's normals turn by up to 9 degrees within the tolerance: viewers would bend all of a face."""
        self.write("scene.txt", "cube([30, 20, 10], round = 1);")
        self.assert_status(cli.run("scene.txt", "-q", "-o", "out.obj", cwd=self.folder), 0)
        count, tilt = shading.tilt_of_large_faces(self.path("out.obj"), 15)
        self.assertGreater(count, 10)
        self.assertLess(tilt, 1)

    def test_finer_is_nearer(self):
        volumes = [self.stats("sphere(10);", "--quality", q)["mesh"]["volume"] for q in ("draft", "normal", "fine")]
        errors = [4188.790 - v for v in volumes]
        self.assertGreater(errors[0], 2 * errors[1])
        self.assertGreater(errors[1], 2 * errors[2])

    def test_triangles(self):
        for most in (100, 1000):
            mesh = self.stats("sphere(10);", "--triangles", most)["mesh"]
            self.assertLessEqual(mesh["triangles"], most + 1)
            self.assertGreater(mesh["triangles"], most // 2)
            self.assertEqual(mesh["euler"], 2)

    def test_share_of_the_triangles(self):
        """P% of what it has without: no place is then too far, since nothing was said of distances."""
        text = "sphere(10); translate([9, 0, 0]) cylinder(h = 12, r = 3);"
        whole = self.stats(text, "--quality", "draft")["mesh"]["triangles"]
        self.write("scene.txt", text)
        result = cli.run("scene.txt", "-o", "out.ply", "--stats", "--quality", "draft", "--simplify", "50%", cwd=self.folder)
        self.assert_status(result, 0)
        self.assertNotIn("warning", result.stderr)
        self.assertAlmostEqual(json.loads(result.stdout)["mesh"]["triangles"], whole / 2, delta=2)

    def test_hints(self):
        """What to do where it is too much says how these cells, too, get fewer."""
        # read in milliseconds, meshed in minutes: the limit is reached while it is meshed, however busy the machine is
        endless = "intersection() { cube(40); gyroid(cell = 2, thickness = 0.3); }"
        for text, options, words in (("sphere(1);", ["--max-memory", "3M"], "--quality draft, or with a lower -r"),
                                     (endless, ["--timeout", "1"], "--quality draft, or a lower -r"),
                                     ("sphere(1);", ["--bounds=-1e7,-1e7,-1e7,1e7,1e7,1e7"], "smaller --bounds, or -r")):
            self.write("scene.txt", text)
            result = cli.run("scene.txt", "-o", "out.ply", "--quality", "fine", *options, cwd=self.folder)
            self.assert_status(result, 2)
            self.assertIn(words, result.stderr)

    def test_bounds(self):
        self.write("scene.txt", "sphere(10);")
        result = cli.run("scene.txt", "-o", "out.ply", "--stats", "--quality", "draft", "--bounds=-20,-20,0,20,20,20", cwd=self.folder)
        self.assert_status(result, 0)
        self.assertIn("W0402", result.stderr)
        self.assertAlmostEqual(json.loads(result.stdout)["mesh"]["bounds"][0][2], 0, delta=0.1)

    def test_parts(self):
        mesh = self.stats(PAIR, "--quality", "draft")["mesh"]
        self.assertEqual(mesh["components"], 2)
        self.assertIn(b"uchar red", self.bytes(PAIR, "--quality", "draft")[:400])

    def test_lattice(self):
        lattice = self.stats("sphere(10);", "--quality", "normal")["lattice"]
        self.assertEqual((lattice["adaptive"], lattice["tolerance"]), (True, 2 ** -6))
        self.assertEqual(lattice["cell_finest"] * 2 ** (len(lattice["blocks"]) - 1), lattice["cell_coarsest"])
        self.assertGreater(lattice["blocks"][-1], 0)
        self.assertEqual(self.stats("sphere(10);", "-r", "32")["lattice"],
                         {"adaptive": False, "cell_coarsest": 20 / 32, "cell_finest": 20 / 32, "blocks": [80]})
        self.write("scene.txt", "sphere(10);")
        for options, words in ((["-r", "32"], "with cells of 0.625\n"), (["--quality", "normal"], "within 0.015625, of cells of ")):
            self.assertIn(words, cli.run("info", "scene.txt", *options, cwd=self.folder).stdout.decode())

    def test_polyhedra_go_out_as_they_are(self):
        """Balls with facets, and what comes back from a file; what crosses itself is meshed."""
        text = "sphere(10, $fn = 60);"
        stats = self.stats(text, "--facets=exact")
        self.assertEqual((stats["mesh"]["triangles"], stats["mesh"]["euler"]), (3596, 2))
        self.assertEqual(stats["lattice"], {"adaptive": False, "own_triangles": 3596})
        self.assertTrue(stats["files"][0]["manifold"])
        self.bytes(text, "--facets=exact", name="ball.stl")
        first = self.read("ball.stl")
        self.assertEqual(self.bytes('import("ball.stl");', name="again.stl"), first)
        self.assertEqual(self.stats(text, "--facets=exact", "--triangles", "3596")["mesh"]["triangles"], 3596)
        for options in (["--triangles", "500"], ["-r", "24"], ["--simplify", "0.5"], ["--quality", "draft", "--bounds=-9,-20,-20,20,20,20"]):
            self.assertNotIn("own_triangles", self.stats(text, "--facets=exact", *options)["lattice"])
        self.assertIn("3596 triangles of its mesh are those of polyhedra",
                      cli.run("info", "scene.txt", "--facets=exact", cwd=self.folder).stdout.decode())
        mixed = 'part("a") import("ball.stl"); part("b") translate([30, 0, 0]) cylinder(r = 2, h = 4);'
        stats = self.stats(mixed, "--quality", "draft")
        self.assertEqual(stats["lattice"]["own_triangles"], 3596)
        self.assertGreater(stats["mesh"]["triangles"], 3596 + 12)
        self.assertTrue(stats["lattice"]["adaptive"])

    @unittest.skipUnless(cli.has_library("Manifold"), "built without Manifold")
    def test_polyhedra_are_joined(self):
        """Sharp operators take polyhedra's own triangles; what is thinner than a tolerance stays, and volumes are exact."""
        self.bytes("sphere(10, $fn = 60);", "--facets=exact", name="ball.stl")
        whole = self.stats('import("ball.stl");')["mesh"]["volume"]
        halves = [self.stats('%s() { import("ball.stl"); translate([2.5, -20, -20]) cube(40); }' % kind)
                  for kind in ("intersection", "difference")]
        for stats in halves:
            self.assertEqual(stats["lattice"], {"adaptive": False, "own_triangles": stats["mesh"]["triangles"]})
            self.assertTrue(stats["mesh"]["manifold"])
            self.assertEqual(stats["mesh"]["euler"], 2)
        self.assertAlmostEqual(sum(stats["mesh"]["volume"] for stats in halves), whole, delta=1e-4 * whole)
        cut = self.stats("difference() { cube(20); translate([5, -1, 2]) cube([0.007, 30, 30]); }", "--quality", "draft")
        self.assertAlmostEqual(cut["mesh"]["volume"], 8000 - 0.007 * 20 * 18, delta=1e-3)
        bent = self.stats('difference() { import("ball.stl"); torus(r = 8, tube = 2); }', "--quality", "draft")
        self.assertTrue(bent["mesh"]["manifold"])

    @unittest.skipUnless(cli.has_library("Manifold"), "built without Manifold")
    def test_polyhedra_of_several_colors_are_joined(self):
        """Where the format has vertices for each side of a border, or no colours."""
        text = 'color("red") cube([20, 10, 5]); color("blue") translate([5, -5, -1]) cube([5, 20, 7]);'
        for name, taken in (("out.glb", True), ("out.obj", True), ("out.stl", True), ("out.ply", False), ("out.3mf", False)):
            self.write("scene.txt", text)
            result = cli.run("scene.txt", "-o", name, "--stats-full", cwd=self.folder)
            self.assert_status(result, 0)
            stats = json.loads(result.stdout)
            self.assertEqual("own_triangles" in stats["lattice"], taken, name)
            self.assertTrue(stats["files"][0]["manifold"], name)
            self.assertAlmostEqual(stats["mesh"]["volume"], 1000 + 700 - 250, delta=0.5)

    def test_colors_of_a_blend_that_ends_flush(self):
        """Where a number's blend ends at a plane the face has the solids' colours, which mix."""
        self.bytes('union(blend = 3) { color("#f00") cube([40, 20, 5]); color("#00f") cube([5, 20, 40]); }', name="out.obj")
        with open(self.path("out.obj"), encoding="ascii") as file:
            vertices = [list(map(float, line.split()[1:])) for line in file if line.startswith("v ")]
        self.assertTrue(all(green < 1e-6 and abs(red + blue - 1) < 0.01 for _, _, _, red, green, blue in vertices))
        self.assertTrue(any(0.2 < red < 0.8 and y == 0 for _, y, _, red, _, _ in vertices))

    def test_polyhedra_are_reshaped(self):
        """What thins out and improves begins with their triangles: no cells, however long and thin these are."""
        ball = "sphere(10, $fn = 60);"
        counts = {}
        for options in (["-e", "0.1"], ["--simplify", "0.1"], ["--simplify", "20%"], ["--triangles", "500"], ["--improve"]):
            stats = self.stats(ball, "--facets=exact", *options)
            self.assertEqual(stats["lattice"], {"adaptive": False, "own_triangles_before": 3596}, options)
            self.assertTrue(stats["files"][0]["manifold"], options)
            self.assertEqual(stats["mesh"]["euler"], 2)
            counts[options[-1]] = stats["mesh"]["triangles"]
        self.assertLessEqual(abs(counts["20%"] - 3596 / 5), 2)
        self.assertEqual(counts["500"], 500)
        self.assertLess(counts["0.1"], 3596 / 2)
        bar = self.bytes("cube([200, 1, 1]);", "-e", "0.01", name="bar.obj").decode()
        self.assertEqual((bar.count("\nf "), bar.count("\nvn ")), (12, 24), "a normal for each corner of each side")
        gap = self.stats("cube(5); translate([5.02, 0, 0]) cube(5);", "-e", "0.05")  # no field tells within E which side is whose
        self.assertEqual((gap["mesh"]["triangles"], gap["quality"]["open_places"]), (24, 0))
        plate = self.stats("union() { cube([20, 20, 0.01]); translate([30, 0, 0]) cube(5); }", "--simplify", "0.5")
        self.assertEqual(plate["mesh"]["triangles"], 24)

    @cli.optimised_only
    @unittest.skipUnless(cli.has_library("Manifold"), "built without Manifold")
    def test_joined_polyhedra_are_reshaped(self):
        """Of one look, or apart; what is no polyhedron takes cells, as do borders of looks."""
        cut = 'difference() { %ssphere(10, $fn = 60); translate([2.5, -20, -20]) cube(40); }'
        for color in ("", 'color("red") '):
            stats = self.stats(cut % color, "--facets=exact", "-e", "0.1")
            self.assertEqual("own_triangles_before" in stats["lattice"], not color)
            self.assertTrue(stats["files"][0]["manifold"])
            self.assertEqual(stats["quality"]["open_places"], 0)
        self.bytes(cut % "", "--facets=exact", "-e", "0.1", name="cut.ply")
        result = cli.run("diff", *cli.FEW_SAMPLES, "scene.txt", "cut.ply", "--facets=exact", "--tol", "0.1", "--ignore", "normals",
                         cwd=self.folder)
        self.assert_status(result, 0)
        apart = self.stats('color("red") cube(10); color("blue") translate([15, 0, 0]) cube(10);', "--simplify", "0.1")
        self.assertEqual((apart["lattice"]["own_triangles_before"], apart["mesh"]["triangles"]), (24, 24))
        self.assertIn(b"uchar red", self.read("out.ply")[:400])
        rest = self.stats('difference() { sphere(10, $fn = 60); torus(r = 8, tube = 2); }', "--simplify", "0.5")
        self.assertTrue(rest["lattice"]["adaptive"])

    def test_polyhedra_beyond_floats(self):
        """Coordinates that no float has are not taken as they are."""
        self.write("scene.txt", """module a() polyhedron(points = [[1, 1, 1], [2, 1, 1], [1, 2, 1], [1, 1, 2]], faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
module b() { a(); mirror([1, 0, 0]) a(); }
module c() { scale(1e14) b(); mirror([0, 1, 0]) scale(1e14) b(); }
module d() { scale(1e14) c(); mirror([0, 0, 1]) scale(1e14) c(); }
scale(1e14) d();
""")
        result = cli.run("scene.txt", "-o", "out.ply", cwd=self.folder)
        self.assert_status(result, 1)
        self.assertIn("W0403", result.stderr)
        self.assertNotIn("E0506", result.stderr)

    def test_thin_parts_are_named(self):
        """What is thinner than the tolerance, once, with the option that has it."""
        text = "difference() { cube([20, 20, 5], round = 1); translate([5.3, -1, 2]) cube([0.007, 30, 10]); }"
        self.write("scene.txt", text)
        result = cli.run("scene.txt", "-o", "out.ply", "--quality", "draft", cwd=self.folder)
        self.assert_status(result, 0)
        self.assertEqual(result.stderr.count("W0406"), 1, result.stderr)
        self.assertIn("scene.txt:1:%d: warning W0406: a gap about 0.00" % (text.index("cube([0.007") + 1), result.stderr)
        self.assertIn("hint: --simplify 0.00", result.stderr)

    def test_lattice_of_parts(self):
        """Small parts begin with smaller cells; blocks of one size are counted together."""
        alone = [self.stats(part + ";", "--quality", "draft", "--bounds=-51,-51,-1,51,51,101")["lattice"]
                 for part in ("cylinder(r = 50, h = 100)", "cylinder(r = 0.5, h = 1)")]
        both = self.stats('part("a") cylinder(r = 0.5, h = 1); part("b") cylinder(r = 50, h = 100);', "--quality", "draft", "--bounds=-51,-51,-1,51,51,101")["lattice"]
        self.assertGreater(alone[0]["cell_coarsest"], alone[1]["cell_coarsest"])
        self.assertEqual(both["cell_coarsest"], alone[0]["cell_coarsest"])
        self.assertEqual(sum(both["blocks"]), sum(map(sum, (lattice["blocks"] for lattice in alone))))

    def test_same_bytes(self):
        text = "difference() { rotate([20, 30, 40]) cube(10, center = true, round = 1); cylinder(h = 30, r = 3, center = true); }"
        one = self.bytes(text, "--quality", "draft", "-j", "1")
        for options in (["-j", "3"], ["--no-prune"]):
            self.assertEqual(one, self.bytes(text, "--quality", "draft", *options), options)

    def test_what_excludes_each_other(self):
        self.write("scene.txt", "cube(1);")
        for options in (["--quality", "fine", "-r", "9"], ["--quality", "normal", "-s", "1"], ["--quality", "draft", "-e", "1"], ["--quality", "none"],
                        ["--quality", "normal", "--certify"], ["--triangles", "9", "-s", "1"],
                        ["--triangles", "9", "--simplify", "1"], ["--quality", "fine", "--certify"]):
            self.assert_status(cli.run("scene.txt", "-o", "out.ply", *options, cwd=self.folder), 2)


if __name__ == "__main__":
    cli.main()
