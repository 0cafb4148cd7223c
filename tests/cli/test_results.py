# SPDX-License-Identifier: MIT
"""What the program makes when all goes well: files, statistics, dependency rules, facts, dumps."""
import json
import math
import os
import re
import shutil
import subprocess
import unittest

import cli


class Outputs(cli.CliTest):
    def setUp(self):
        super().setUp()
        self.write("a.txt", cli.BLEND)

    def test_every_format(self):
        names = [f"out.{name}" for name in cli.formats_written()]
        self.assertGreaterEqual(len(names), 6)
        result = self.run_in("a.txt", "-r", "32", *sum((["-o", name] for name in names), []))
        self.assert_status(result, 0)
        self.assertEqual(result.stderr, "")
        self.assert_files("a.txt", *names)
        counts = {self.info(f"out.{name}")["mesh"]["triangles"] for name in cli.formats_read()}
        self.assertEqual(len(counts), 1, "the formats disagree")

    def test_ascii(self):
        self.assert_status(self.run_in("a.txt", "-r", "16", "--ascii", "-o", "a.ply", "-o",
                                       "a.stl"), 0)
        self.assertIn(b"format ascii 1.0", self.read("a.ply"))
        self.assertTrue(self.read("a.stl").startswith(b"solid"))

    def test_stdout_is_the_file(self):
        for name in ("ply", "stl", "obj", "glb"):
            piped = self.run_in("a.txt", "-r", "16", "-f", name, "-o", "-")
            self.assert_status(piped, 0)
            self.assert_status(self.run_in("a.txt", "-r", "16", "-o", f"a.{name}"), 0)
            self.assertEqual(piped.stdout, self.read(f"a.{name}"))

    def test_stdin(self):
        piped = self.run_in("-", "-r", "16", "-f", "ply", "-o", "-", stdin=cli.BLEND.encode())
        self.assert_status(piped, 0)
        direct = self.run_in("a.txt", "-r", "16", "-f", "ply", "-o", "-")
        self.assertEqual(piped.stdout, direct.stdout)
        wrong = self.run_in("-", "-f", "ply", "-o", "-", stdin=b"sphere(;")
        self.assert_refused(wrong, 1, "-:1:8")

    def test_format_wins_over_the_name_of_one_output(self):
        self.assert_status(self.run_in("a.txt", "-r", "16", "-f", "stl", "-o", "part.bin"), 0)
        self.assert_status(self.run_in("a.txt", "-r", "16", "-o", "part.stl"), 0)
        self.assertEqual(self.read("part.bin"), self.read("part.stl"))

    def test_written_with_the_usual_mode(self):
        self.assert_status(self.run_in("a.txt", "-r", "8", "-o", "a.ply", "--stats=a.json"), 0)
        mask = os.umask(0)
        os.umask(mask)
        for name in ("a.ply", "a.json"):
            self.assertEqual(os.stat(self.path(name)).st_mode & 0o777, 0o666 & ~mask)

    def test_link_is_followed(self):
        os.mkdir(self.path("store"))
        os.symlink("store/real.ply", self.path("a.ply"))
        self.write("store/real.ply", b"old")
        self.assert_status(self.run_in("a.txt", "-r", "8", "-o", "a.ply"), 0)
        self.assertTrue(os.path.islink(self.path("a.ply")))
        self.assertTrue(self.read("store/real.ply").startswith(b"ply"))

    def test_normals_and_colors(self):
        self.run_in("a.txt", "-r", "8", "-o", "full.ply")
        self.run_in("a.txt", "-r", "8", "--normals", "none", "--colors", "none", "-o", "bare.ply")
        full, bare = self.info("full.ply")["mesh"], self.info("bare.ply")["mesh"]
        self.assertEqual((full["normals"], full["colors"]), (True, True))
        self.assertEqual((bare["normals"], bare["colors"]), (False, False))
        self.assertEqual(full["triangles"], bare["triangles"])

    def test_up_and_unit(self):
        self.run_in("a.txt", "-r", "8", "-o", "y.gltf")
        self.run_in("a.txt", "-r", "8", "--up", "z", "-o", "z.gltf")
        self.run_in("a.txt", "-r", "8", "--unit", "mm", "-o", "mm.gltf")
        nodes = {name: json.loads(self.read(f"{name}.gltf"))["nodes"] for name in ("y", "z", "mm")}
        self.assertIn("rotation", json.dumps(nodes["y"]) + json.dumps(nodes["y"]).replace(
            "matrix", "rotation"))
        self.assertNotEqual(nodes["y"], nodes["z"])
        self.assertIn("0.001", json.dumps(nodes["mm"]))

    def test_defines_change_the_solid(self):
        self.write("b.txt", "size = 1;\nsphere(r = size);\n")
        small = self.stats("b.txt", "-r", "16")["mesh"]["volume"]
        large = self.stats("b.txt", "-r", "16", "-D", "size=2")["mesh"]["volume"]
        self.assertAlmostEqual(large / small, 8, places=4)

    def test_bounds_cut_and_close(self):
        self.write("b.txt", cli.BALL)
        stats = self.stats("b.txt", "-q", "-r", "32", "--bounds", "-2,-2,-2,2,2,0")
        self.assertEqual(stats["mesh"]["boundary_edges"], 0)
        self.assertAlmostEqual(stats["mesh"]["volume"], 2 / 3 * math.pi, delta=0.05)

    def test_cell_size(self):
        self.assertEqual(self.stats("a.txt", "-s", "0.25")["grid"]["cell_size"], 0.25)

    def test_echo_and_quiet(self):
        self.write("b.txt", 'echo("hello", 1);\na = 1;\na = 2;\nsphere(a);\n')
        loud, quiet = self.run_in("check", "b.txt"), self.run_in("check", "-q", "b.txt")
        self.assertIn('ECHO: "hello", 1\n', loud.stderr)
        self.assertIn("warning W", loud.stderr)
        self.assertEqual(quiet.stderr, "")

    def test_progress_and_color(self):
        shown = self.run_in("a.txt", "-r", "64", "--progress=always", "-o", "a.ply")
        self.assertIn(" %", shown.stderr)
        self.assertEqual(self.run_in("a.txt", "-r", "64", "-o", "a.ply").stderr, "")
        self.write("b.txt", cli.BLEND)
        for arguments, stage in ((["a.txt", "-r", "16", "--certify", "-o", "b.ply"], "proving"),
                                 (["b.txt", "-e", "0.05", "-o", "b.ply"], "thinning"),
                                 (["diff", "a.ply", "b.ply"], "comparing"),
                                 (["info", "a.txt"], "sampling")):
            said = self.run_in(*arguments, "--progress=always").stderr
            shares = [int(share) for share in re.findall(rf"{stage} +\[[=> ]+\] +(\d+) %", said)]
            self.assertTrue(shares, said)
            self.assertEqual(shares, sorted(shares), said)
            self.assertEqual(self.run_in(*arguments, "--progress=always", "-q").stderr, "")

    def test_one_bar_for_all_pairs_of_folders(self):
        for folder in ("old", "new"):
            os.mkdir(self.path(folder))
            for i in range(3):
                self.assert_status(self.run_in("a.txt", "-r", "10" if folder == "old" else "12", "-o",
                                               f"{folder}/{i}.ply"), 0)
        said = self.run_in("diff", "old", "new", "--progress=always").stderr
        shares = [int(share) for share in re.findall(r"\w+ +\[[=> ]+\] +(\d+) %", said)]
        self.assertEqual(shares, sorted(shares), said)
        self.assertTrue(any(33 <= share < 66 for share in shares), said)

    def test_colour_of_results(self):
        self.assert_status(self.run_in("a.txt", "-r", "10", "-o", "a.ply"), 0)
        self.assert_status(self.run_in("a.txt", "-r", "12", "-o", "b.ply"), 0)
        self.assertIn("\033[1;31mdifferent\033[0m: ", self.run_in("diff", *cli.FEW_SAMPLES, "--color=always", "a.ply", "b.ply").stdout.decode())
        self.assertIn("\033[1;32msame\033[0m: ", self.run_in("diff", *cli.FEW_SAMPLES, "--color=always", "a.ply", "a.ply").stdout.decode())
        self.assertNotIn("\033", self.run_in("diff", *cli.FEW_SAMPLES, "a.ply", "b.ply").stdout.decode())
        batch = self.run_in("batch", "a.txt", "-d", "out", "-r", "8", "--color=always").stdout.decode()
        self.assertIn("\033[1;32mmade ", batch)
        self.write("bad.txt", "sphere(;\n")
        colored = self.run_in("check", "--color=always", "bad.txt")
        self.assertIn("\033[1;31merror E", colored.stderr)
        self.assertNotIn("\033", self.run_in("check", "bad.txt").stderr)


class Statistics(cli.CliTest):
    def test_keys(self):
        self.write("a.txt", cli.BLEND)
        self.assert_status(self.run_in("a.txt", "-r", "32", "-j", "2", "--stats=s.json"), 0)
        stats = json.loads(self.read("s.json"))
        expected = {
            "csgmesh": None, "peak_rss_bytes": None, "threads": None, "simd": None,
            "scene": ["primitives", "operators", "lambda", "bounds"],
            "grid": ["cell_size", "cells"],
            "lattice": ["adaptive", "cell_coarsest", "cell_finest", "blocks"],
            "evaluations": ["interval", "points", "gradient", "primitive", "mean_tape_length"],
            "octree": ["visited", "pruned_outside", "pruned_inside", "leaf_blocks",
                       "unresolved_cells"],
            "features": ["vertices", "left_smooth", "fading"],
            "mesh": ["vertices", "triangles", "components", "euler", "genus", "boundary_edges",
                     "nonmanifold_edges", "misoriented_edges", "nonmanifold_vertices",
                     "degenerate_triangles", "zero_area_triangles", "manifold", "area", "volume", "bounds"],
            "files": None,
            "quality": ["max_abs_field", "vertices_measured", "min_angle_deg", "max_aspect",
                        "degenerate"],
            "time_s": ["parse", "evaluate", "compile", "octree", "mesh", "write", "total"],
        }
        self.assertEqual(set(stats), set(expected))
        for key, members in expected.items():
            if members:
                self.assertEqual(set(stats[key]), set(members), key)
        self.assertEqual(stats["scene"]["primitives"], 2)
        self.assertEqual(stats["scene"]["operators"], 1)
        self.assertEqual(stats["threads"], 2)
        self.assertIn(max(stats["grid"]["cells"]), range(32, 41))  # with a margin
        self.assertEqual((stats["mesh"]["euler"], stats["mesh"]["components"]), (2, 1))
        self.assertGreater(stats["evaluations"]["points"], 0)
        self.assertGreater(stats["octree"]["leaf_blocks"], 0)
        self.assertGreater(stats["time_s"]["total"], 0)

    def test_streamed(self):
        """Of a mesh that goes by there are the figures of the one in memory, with the same digits for any number of threads."""
        self.write("a.txt", "difference() { union(blend = 3) { sphere(10); translate([9, 3, 2]) sphere(6); } cylinder(h = 30, r = 2, center = true); }\n")
        for name in ("a.ply", "a.stl", "a.glb", "a.obj"):  # the last one through a mesh in memory
            options = ("a.txt", "-r", "90", "-o", name)
            full = self.stats(*options, "--stats-full")
            for more in (["-j", "1"], ["-j", "3"], ["-j", "2", "--max-memory", "32M" if name == "a.obj" else "8M"], ["--bounds=-20,-20,0,20,20,20"]):
                with self.subTest((name, more)):
                    if more[0] == "--bounds=-20,-20,0,20,20,20":
                        full = self.stats(*options, *more, "--stats-full")
                    stats = self.stats(*options, *more)
                    self.assertEqual(stats["mesh"], full["mesh"])
                    self.assertEqual(set(stats["quality"]), set(full["quality"]))
                    if "--bounds" not in more[0]:
                        self.assertLess(stats["quality"]["max_abs_field"], 1e-4)
                    self.assertNotIn("area", stats["files"][0])

    def test_full_implies_statistics(self):
        self.write("a.txt", "sphere(1);\n")
        full = self.stats("a.txt", "-r", "16", "-o", "a.ply", "--stats-full")
        self.assertEqual(full["files"][0]["area"], full["mesh"]["area"])
        alone = self.run_in("a.txt", "-r", "16", "-o", "a.ply", "--stats-full")
        self.assertEqual(json.loads(alone.stdout)["mesh"], full["mesh"])
        self.assert_status(self.run_in("a.txt", "-r", "16", "-o", "a.ply", "--stats=full"), 0)  # a file of that name
        self.assertNotIn("area", json.loads(self.read("full"))["files"][0])

    def test_agrees_with_info(self):
        self.write("a.txt", cli.BLEND)
        stats = self.stats("a.txt", "-r", "32", "-o", "a.ply")["mesh"]
        mesh = self.info("a.ply")["mesh"]
        for key in ("vertices", "triangles", "euler", "genus", "components"):
            self.assertEqual(mesh[key], stats[key])
        self.assertAlmostEqual(mesh["volume"], stats["volume"], places=5)

    @cli.optimised_only
    def test_without_room_for_the_mesh(self):
        """It goes to its file as it does without --stats, and its figures are those that go by; the file is looked at in runs."""
        self.write("a.txt", "sphere(10);\n")
        options = ("a.txt", "-r", "200", "-j", "2", "-o", "a.ply", "--max-memory")
        wide = self.stats(*options, "1G", "--stats-full")
        want = self.read("a.ply")
        result = self.run_in(*options, "8M", "--stats-full", "--stats=s.json")
        self.assert_status(result, 0)
        self.assertEqual(result.stderr, "")
        self.assertEqual(self.read("a.ply"), want)
        stats = json.loads(self.read("s.json"))
        for key in ("mesh", "quality", "files"):
            self.assertEqual(stats[key], wide[key])
        stats = self.stats(*options, "8M")
        self.assertEqual((stats["mesh"], stats["files"]), (wide["mesh"], [{"name": "a.ply", "format": "ply"}]))
        for name, limit in (("a.ply", "3M"), ("a.stl", "3M")):  # some 100 bytes for each of 270 000 triangles else
            self.assert_status(self.run_in("a.txt", "-r", "200", "-j", "2", "-o", name, "-q"), 0)
            self.assertEqual(self.run_in("info", "--json", name, "--max-memory", limit).stdout, self.run_in("info", "--json", name).stdout)
        self.assert_refused(self.run_in("info", "a.stl", "--max-memory", "1M"), 2, "E0901")
        self.assertGreater(stats["octree"]["leaf_blocks"], 0)

    def test_parts_that_touch(self):
        """Each is closed; a file that has nothing but places joins them, and a warning and --stats say so."""
        self.write("two.txt", 'part("a") cube(10);\npart("b") translate([10, 0, 0]) cube(10);\n')
        result = self.run_in("two.txt", "-o", "a.ply", "-o", "a.stl", "--stats-full")
        self.assert_status(result, 0)
        files = {file["format"]: file for file in json.loads(result.stdout)["files"]}
        self.assertTrue(files["ply"]["manifold"])
        self.assertFalse(files["stl"]["manifold"])
        self.assertIn(files["stl"]["nonmanifold_edges"], (4, 5))  # a diagonal of the face is one if both parts have the same
        self.assertEqual(result.stderr.count("W0514"), 1)
        self.assertIn("a.stl: warning W0514: parts touch in 4 vertices", result.stderr)
        if cli.has_library("tinygltf"):  # each node has vertices of its own, of each face
            self.assert_status(self.run_in("two.txt", "-o", "a.glb"), 0)
            self.assertIn("yes, an oriented 2-manifold", self.run_in("info", "a.glb").stdout.decode())
        self.write("two.txt", 'part("a") cube(10);\npart("b") translate([11, 0, 0]) cube(10);\n')
        self.assertNotIn("W0514", self.run_in("two.txt", "-o", "a.stl").stderr)

    def test_parts_that_touch_in_a_corner(self):
        """Copies of a corner are no places of their own, and stay with their parts."""
        self.write("two.txt", 'part("a") cube(10, center = true);\npart("b") translate([10, 10, 10]) cube(10, center = true);\n')
        result = self.run_in("two.txt", "-o", "a.ply", "-o", "a.obj", "-o", "a.stl", "--normals", "crease", "--stats-full")
        self.assert_status(result, 0)
        stats = json.loads(result.stdout)
        self.assertTrue(stats["mesh"]["manifold"])
        self.assertEqual([file["manifold"] for file in stats["files"]], [True, True, False])
        self.assertIn("a.stl: warning W0514: parts touch in 1 vertex,", result.stderr)
        # a copy that nothing uses belongs to no part: these do not touch, and nothing says so
        self.write("two.txt", 'part("x") difference() { sphere(6); cylinder(h = 4, r = 4); }\ntranslate([9, 0, 0]) cube(1);\n')
        self.assertNotIn("W0514", self.run_in("two.txt", "-r", "9", "-o", "a.obj", "-o", "a.stl", "--normals", "crease").stderr)

    def test_creases_without_a_gradient(self):
        """Where a fillet's gradient is nothing, the normal of a crease that was given up was none, and no file was written."""
        self.write("a.txt", 'scale(1e-3) union(blend = fillet(1.798357)) { roof() text("8", 8.503070);'
                            ' difference() { sphere(5.859); gyroid(6, 1.003487); } }\n'
                            'scale(1e-3) part("x") cube(5.920, round = 0.355975);\n')
        self.assert_status(self.run_in("a.txt", "-r", "18", "-o", "a.ply", "-o", "a.glb", "-q"), 0)

    def test_what_needs_less_memory(self):
        self.write("a.txt", "sphere(10);\n")
        for limit, options, word in (("2M", ("-o", "a.ply"), "equal cells do not: -r 256\n"),
                                     ("4M", ("-o", "a.obj", "--quality", "fine"), "-r 1024, with one output that is PLY, STL or GLB\n"),
                                     ("4M", ("-o", "a.obj", "-r", "200"), "one PLY, STL or GLB file alone is written while"),
                                     ("4M", ("-o", "a.ply", "-o", "a.stl", "-r", "200"), "one PLY, STL or GLB file alone"),
                                     ("1M", ("-o", "a.ply", "-r", "400"), "--features smooth has none")):
            with self.subTest(options):
                result = self.run_in("a.txt", "-j", "2", "--max-memory", limit, *options)
                self.assert_refused(result, 2, "E0901", "raise the limit with --max-memory", word)
        self.assert_files("a.txt")

    def test_files(self):
        """Each file as it is read back: what rounding and quantising have made of the mesh."""
        self.write("far.txt", "translate([5000, 5000, 5000]) union(blend = 3) { sphere(10); translate([9, 3, 2]) sphere(6); }\n")
        names = ["a.stl", "a.ply"] + ["a.drc"] * cli.has_library("Draco")
        files = self.stats("far.txt", "-r", "128", "--stats-full", *(word for name in names for word in ("-o", name)))["files"]
        self.assertEqual([file["name"] for file in files], names)
        for file in files:
            self.assertTrue(file["manifold"], file["name"])
            self.assertEqual((file["degenerate_triangles"], file["zero_area_triangles"]), (0, 0), file["name"])
            self.assertEqual(file["triangles"], files[1]["triangles"])
            self.assertEqual(self.info(file["name"])["mesh"]["area"], file["area"])
        self.assertNotEqual(files[0]["area"], files[1]["area"])  # floats are 0.0005 apart there
        self.assert_status(self.run_in("far.txt", "-r", "128", "-o", "b.stl"), 0)  # streamed or not: the same bytes
        self.assertEqual(self.read("a.stl"), self.read("b.stl"))

    def test_bounds_far_from_the_middle(self):
        self.write("ball.txt", "sphere(1000);\n")
        near = ("ball.txt", "-r", "32", "--bounds", "999,-0.5,-0.5,1000,0.5,0.5")
        self.assert_status(self.run_in(*near, "-o", "a.stl"), 0)
        self.assert_status(self.run_in(*near, "-o", "b.stl", "-o", "b.ply"), 0)
        self.assertEqual(self.read("a.stl"), self.read("b.stl"))  # streamed or not
        self.assertEqual(self.info("a.stl")["mesh"]["bounds"], self.info("b.ply")["mesh"]["bounds"])

    def test_too_far(self):
        self.write("far.txt", "translate([1e10, 0, 0]) sphere(1);\n")
        result = self.run_in("far.txt", "-o", "a.stl")
        self.assert_status(result, 2)
        self.assertIn("a.stl: error E0505: STL has floats in steps of 1.02e+03 near (1e+10, ", result.stderr)
        self.assert_files("far.txt")
        self.assert_status(self.run_in("far.txt", "-o", "a.ply"), 0)

    def test_far_and_exact(self):
        """Floats are half a unit apart there, and the corners of a cube are floats: nothing collapses."""
        self.write("far.txt", "translate([5e6, 0, 0]) cube(10);\n")
        for name in ("a.stl", "b.stl"):
            self.assert_status(self.run_in("far.txt", "-o", name, *(["--ascii"] if name == "b.stl" else [])), 0)
            found = self.info(name)["mesh"]
            self.assertEqual((found["triangles"], found["manifold"]), (12, True))
            for corner, wanted in zip(found["bounds"], ([5e6, 0, 0], [5e6 + 10, 10, 10])):
                for axis in range(3):
                    self.assertAlmostEqual(corner[axis], wanted[axis], places=5)
        self.write("far.txt", "translate([5e6, 0, 0]) cube(10.25);\n")
        self.assert_refused(self.run_in("far.txt", "-o", "c.stl"), 2, "E0505")


class Dependencies(cli.CliTest):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("lib dir"))
        self.write("lib dir/b#$.txt", "module ball() sphere(1);\n")
        self.write("a.txt", "include <lib dir/b#$.txt>\nball();\n")

    def test_deps(self):
        result = self.run_in("deps", "a.txt")
        self.assert_status(result, 0)
        self.assertEqual(result.stdout.decode().splitlines(), ["a.txt", "lib dir/b#$.txt"])

    def test_include_dir(self):
        self.write("c.txt", "use <b#$.txt>\nball();\n")
        self.assert_status(self.run_in("check", "c.txt"), 2)
        self.assert_status(self.run_in("check", "-I", "lib dir", "c.txt"), 0)

    def make(self, *arguments):
        return subprocess.run(["make", *arguments], cwd=self.folder, capture_output=True, text=True,
                              check=True).stdout

    @unittest.skipUnless(shutil.which("make"), "make is not installed")
    def test_make_understands_the_rule(self):
        self.write("Makefile", f"out.stl: a.txt\n\t'{cli.PROGRAM}' -r 8 $< -o $@ -M out.d\n"
                   "-include out.d\n")
        self.assertIn("csgmesh", self.make())
        self.assertIn("up to date", self.make())
        future = os.stat(self.path("out.stl")).st_mtime + 10
        os.utime(self.path("lib dir/b#$.txt"), (future, future))
        self.assertIn("csgmesh", self.make())

    @unittest.skipUnless(shutil.which("ninja"), "ninja is not installed")
    def test_ninja_understands_the_rule(self):
        self.write("build.ninja", f"rule mesh\n  command = '{cli.PROGRAM}' -r 8 $in -o $out -M out.d"
                   "\n  depfile = out.d\n  deps = gcc\nbuild out.stl: mesh a.txt\n")

        def ninja():
            return subprocess.run(["ninja"], cwd=self.folder, capture_output=True, text=True,
                                  check=True).stdout
        ninja()
        self.assertIn("no work to do", ninja())
        future = os.stat(self.path("out.stl")).st_mtime + 10
        os.utime(self.path("lib dir/b#$.txt"), (future, future))
        self.assertNotIn("no work to do", ninja())


class Looking(cli.CliTest):
    def test_long_numbers_in_json(self):
        self.write("n.json", '{"a": 3.' + 80 * "1" + ', "b": -0.' + 70 * "0" + '25, "c": 1' + 65 * "0" + "}")
        self.write("n.txt", 'n = import("n.json"); echo(n.a, n.b, n.c); cube(1);\n')
        self.assertIn("ECHO: 3.11111, -2.5e-71, 1e+65\n", self.run_in("check", "n.txt").stderr)

    def setUp(self):
        super().setUp()
        self.write("a.txt", cli.BLEND)

    def test_eval(self):
        self.write("ball.txt", cli.BALL)
        result = self.run_in("eval", "ball.txt", "--json", "--at", "3,0,4", "--at", "0,0,0")
        self.assert_status(result, 0)
        far, middle = map(json.loads, result.stdout.decode().splitlines())
        self.assertEqual(set(far), {"at", "f", "gradient", "lambda", "primitives"})
        self.assertAlmostEqual(far["f"], -4, places=12)
        self.assertAlmostEqual(far["gradient"][2], -0.8, places=12)
        self.assertEqual((middle["f"], middle["lambda"], middle["primitives"]), (1, 1, 1))
        text = self.run_in("eval", "ball.txt", "--at", "3,0,4").stdout.decode()
        self.assertIn("f = -4 (outside)", text)

    def test_info_of_a_scene(self):
        result = self.run_in("info", "-r", "32", "a.txt")
        self.assert_status(result, 0)
        for words in ("primitives   2", "operators    1", "closed       yes", "volume"):
            self.assertIn(words, result.stdout.decode())
        facts = json.loads(self.run_in("info", "--json", "-r", "32", "a.txt").stdout)
        self.assertEqual(facts["files"], ["a.txt"])
        self.assertEqual(facts["mesh"]["components"], 1)

    def test_info_of_an_unbounded_scene(self):
        self.write("plane.txt", "plane([0, 0, 1], 0);\n")
        result = self.run_in("info", "--json", "plane.txt")
        self.assert_status(result, 0)
        self.assertNotIn("mesh", json.loads(result.stdout))

    def test_info_of_an_open_mesh(self):
        self.write("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        result = self.run_in("info", "open.off")
        self.assert_status(result, 0)
        self.assertIn("closed       no: 3 boundary edges", result.stdout.decode())

    def test_dump_parses_back(self):
        flat = self.run_in("dump", "--scene", "a.txt")
        self.assert_status(flat, 0)
        self.write("flat.txt", flat.stdout)
        again = self.run_in("dump", "--scene", "flat.txt")
        self.assertEqual(again.stdout, flat.stdout)
        for name in ("a", "flat"):
            self.run_in(f"{name}.txt", "-r", "24", "-o", f"{name}.ply")
        self.assertEqual(self.read("a.ply"), self.read("flat.ply"))

    def test_dump_of_the_tape(self):
        result = self.run_in("dump", "--tape", "a.txt")
        self.assert_status(result, 0)
        self.assertGreaterEqual(len(result.stdout.splitlines()), 3)


if __name__ == "__main__":
    cli.main()
