# SPDX-License-Identifier: MIT
"""csgmesh measure: closed forms, meshes, threads, and what is refused."""
import json
import math
import os
import random
import signal
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree

import cli

PI = math.pi
# scene: area
AREAS = {
    "cube([10, 20, 30]);": 2200,
    "rotate([20, 30, 40]) cube([10, 20, 30], center = true);": 2200,
    "sphere(10);": 400 * PI,
    "translate([1, 2, 3]) cylinder(h = 10, r = 5);": 150 * PI,
    "cylinder(h = 12, r1 = 5, r2 = 0);": 25 * PI + 65 * PI,
    "torus(8, 2);": 4 * PI ** 2 * 16,
    "difference() { cube(20, center = true); sphere(8); }": 2400 + 256 * PI,
    # flush faces are one, and what lies inside is no surface
    "union() { cube(10); translate([5, 0, 0]) cube(10); }": 800,
    "union() { cylinder(h = 10, r = 5); translate([0, 0, 5]) cylinder(h = 10, r = 5); }": 200 * PI,
    # a fillet of radius 2 between two half spaces at a right angle, in a block
    "intersection() { translate([-10, -10, 0]) cube([20, 20, 10]);"
    " union(blend = fillet(2)) { plane([0, 0, 1], 2); plane([1, 0, 0], 2 - 5); } }":
        2 * (96 + 4 - PI) + 20 * (56 + PI),
}
# scene: volume, centroid, (I_xx, I_zz) where there is a closed form, bounds
CLOSED = {
    "cube([10, 20, 30]);": (6000, (5, 10, 15), (6000 * (400 + 900) / 12, 6000 * 500 / 12), (0, 0, 0, 10, 20, 30)),
    "sphere(10);": (4 / 3 * PI * 1000, (0, 0, 0), (8 / 15 * PI * 1e5,) * 2, (-10, -10, -10, 10, 10, 10)),
    "translate([1, 2, 3]) cylinder(h = 10, r = 5);":
        (250 * PI, (1, 2, 8), (250 * PI * (3 * 25 + 100) / 12, 250 * PI * 25 / 2), (-4, -3, 3, 6, 7, 13)),
    "cylinder(h = 12, r1 = 5, r2 = 0);":
        (100 * PI, (0, 0, 3), (100 * PI * 3 / 80 * (4 * 25 + 144), 100 * PI * 0.3 * 25), (-5, -5, 0, 5, 5, 12)),
    "torus(8, 2);": (2 * PI ** 2 * 8 * 4, (0, 0, 0), None, (-10, -10, -2, 10, 10, 2)),
    "difference() { cube(20, center = true); sphere(8); }":
        (8000 - 4 / 3 * PI * 512, (0, 0, 0), (8000 * 800 / 12 - 8 / 15 * PI * 8 ** 5,) * 2, (-10, -10, -10, 10, 10, 10)),
    "rotate([20, 30, 40]) cube([10, 20, 30], center = true);": (6000, (0, 0, 0), None, None),
    "scale([1, 2, 3]) sphere(5);": (1000 * PI, (0, 0, 0), (1000 * PI / 5 * 325, 1000 * PI / 5 * 125), (-5, -10, -15, 5, 10, 15)),
}
# part: cubes that `--to 3e-4` takes, which are the same on any machine
CUBES = {
    "hook": 55643, "mug": 51439, "cable_clip": 65260, "gear_knob": 136359, "bracket": 96635,
    "phone_stand": 80865, "bottle": 6166, "spool": 61266, "pipe_manifold": 220540, "chess_pawn": 1287,
}
PARTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scenes", "parts")


def write(folder, name, text):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


class Measure(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def measure(self, scene, *options, status=0):
        path = write(self.folder, "scene.txt", scene)
        result = cli.run("measure", path, "--json", *options)
        self.assertEqual(result.returncode, status, result.stderr)
        return json.loads(result.stdout)

    def holds(self, interval, value):
        self.assertLessEqual(interval[0], value)
        self.assertGreaterEqual(interval[1], value)

    def test_closed_forms(self):
        to = 1e-3
        for scene, (volume, centroid, inertia, bounds) in CLOSED.items():
            with self.subTest(scene):
                found = self.measure(scene, "--to", to)
                self.holds(found["volume"], volume)
                self.assertLessEqual(found["volume"][1] - found["volume"][0], to * found["volume"][1])
                for axis, value in zip("xyz", centroid):
                    self.holds(found["centroid"][axis], value)
                for name, value in zip(("xx", "zz"), inertia or ()):
                    self.holds(found["inertia"][name], value)
                for interval, value in zip(found["bounds"].values(), bounds or ()):
                    self.holds(interval, value)
                    self.assertLessEqual(interval[1] - interval[0], 30 * to * 1.01)

    def test_areas(self):
        to = 1e-3
        for scene, area in AREAS.items():
            with self.subTest(scene):
                found = self.measure(scene, "--to", to)["area"]
                self.holds(found, area)
                self.assertLessEqual(found[1] - found[0], 10.1 * to * area)

    def test_area_of_a_blend_with_a_crease(self):
        scene = "intersection(blend = 1.5) { cube([10, 10, 10], round = 1.5); plane([1, 0, 1], 9); }"
        low, high = self.measure(scene, "--to", 0.02)["area"]
        self.assertGreater(low, 400)
        self.assertLess(high, 600)

    def test_area_that_nothing_bounds(self):
        # A fillet turns on the gradients of the cube, which are those of its roundings here.
        scene = "intersection(blend = fillet(1)) { cube([10, 10, 10], round = 1); plane([1, 0, 1], 9); }"
        low, high = self.measure(scene, "--to", 0.02)["area"]
        self.assertGreater(low, 400)
        self.assertIsNone(high)
        text = cli.run("measure", os.path.join(self.folder, "scene.txt"), "--to", 0.02).stdout.decode()
        self.assertRegex(text, r"area +at least 4\d\d\.")

    def check(self, scene, *conditions, status, options=()):
        path = write(self.folder, "scene.txt", scene)
        result = cli.run("measure", path, "--to", 1e-3, *options, *(w for c in conditions for w in ("--check", c)))
        self.assertEqual(result.returncode, status, result.stderr)
        return result

    def test_checks_hold_fail_and_stay_open(self):
        scene = "cube([10, 20, 30]);"
        self.check(scene, "volume < 6010 && volume > 5990", "size_x <= 10.1", "max_z - min_z > 29", status=0)
        self.check(scene, "!(volume > 7000) && (mass < 1 || volume / 2 + 1 > 2 * -3)", status=0)
        failed = self.check(scene, "size_x < 5 && size_y < 25", "volume < 1", status=1)
        self.assertIn("this fails: size_x < 5\n", failed.stderr)
        self.assertIn("this fails: volume < 1\n", failed.stderr)
        self.assertNotIn("size_y", failed.stderr)
        self.assertIn(b"holds        size_y < 25", failed.stdout)
        exact = 4 / 3 * PI * 1000  # the interval holds it, and is wider than rounding
        open_ = self.check("sphere(10);", f"volume < {exact!r}", status=2)
        self.assertIn("neither proven nor refuted", open_.stderr)
        self.assertIn("--to", open_.stderr)

    def test_checks_of_meshes(self):
        mesh = os.path.join(self.folder, "cube.stl")
        self.assertEqual(cli.run(write(self.folder, "cube.txt", "cube(2);"), "-o", mesh).returncode, 0)
        self.assertEqual(cli.run("measure", mesh, "--check", "volume > 7.99 && volume < 8.01").returncode, 0)
        self.assertEqual(cli.run("measure", mesh, "--check", "volume > 8.01").returncode, 1)

    def test_checks_in_reports(self):
        report = os.path.join(self.folder, "report.xml")
        found = self.check("cube(2);", "volume < 9 && volume > 8.5", status=1, options=("--json", "--junit", report))
        self.assertEqual(json.loads(found.stdout)["checks"],
                         [{"check": "volume < 9", "result": "holds"}, {"check": "volume > 8.5", "result": "fails"}])
        suite = xml.etree.ElementTree.parse(report).getroot()
        self.assertEqual((suite.get("tests"), suite.get("failures")), ("2", "1"))
        self.assertEqual([case.get("name") for case in suite], ["volume < 9", "volume > 8.5"])
        self.assertEqual([len(case) for case in suite], [0, 1])

    def test_wrong_checks(self):
        for condition, column, words in (
            ("volume <", 8, "ends too early"),
            ("volum < 3", 0, "volume"),
            ("volume < 3 4", 11, "should end here"),
            ("volume", 0, "comparison is needed"),
            ("(volume < 3) + 1 < 2", 0, "number is needed"),
            ("1 < volume < 3", 11, "join them by &&"),
            ("volume == 8", 7, "never proven to be equal"),
            ("volume < 3 && (mass", 19, "parenthesis"),
            ("volume < 3 && mass", 14, "comparison is needed"),
            ("(" * 200 + "1", 100, "too deep"),
            ("volume < 1e999", 9, "no number"),
            ("", 0, "ends too early"),
        ):
            with self.subTest(condition):
                result = self.check("cube(2);", condition, status=2)
                self.assertIn(words, result.stderr)
                caret = next(line for line in result.stderr.splitlines() if line.strip() == "^")
                self.assertEqual(len(caret) - 3, column)
        self.check("cube(2);", status=2, options=("--junit", os.path.join(self.folder, "r.xml")))

    TWISTED = "linear_extrude(height = 10, twist = 90) square(4, center = true);"  # 1e-4 takes more than two million cubes

    @cli.optimised_only  # with sanitizers measures of few cubes end at their number (tests/measure/test_measure.c)
    def test_as_close_as_seconds_allow(self):
        found = self.measure(self.TWISTED)
        self.assertFalse(found["reached"])
        self.holds(found["volume"], 160)
        self.assertLess(found["volume"][1] - found["volume"][0], 2e-3 * found["volume"][0])
        self.assertLess(found["cubes"], 2 ** 22)

    def test_timeout(self):
        self.measure(self.TWISTED, "--to", 1e-5, "--timeout", 0.1, status=2)

    def test_smooth_surfaces_are_known_by_their_bends(self):
        """With their areas, and edges."""
        fillet = "union(blend = fillet(3)) { translate([0, 0, -10]) cube([40, 40, 20], center = true); translate([0, 0, -5]) cylinder(h = 35, r = 6); }"
        foot = 2 * PI * (81 * (1 - PI / 4) - 4.5)  # of 2 pi (9 - u) (3 - sqrt(9 - u^2)), u from 0 to 3
        for scene, volume in (
            ("sphere(10);", 4000 * PI / 3),
            ("torus(8, 2);", 64 * PI ** 2),
            ("cylinder(h = 12, r1 = 5, r2 = 1);", 124 * PI),
            ("cube([10, 20, 30], round = 2);", 6 * 16 * 26 + 4 * (6 * 16 + 16 * 26 + 6 * 26) + 4 * PI * 48 + 32 * PI / 3),
            ("rotate([10, 20, 30]) scale(1.7) sphere(3);", 4 * PI / 3 * 5.1 ** 3),
            (fillet, 40 * 40 * 20 + PI * 36 * 30 + foot),
        ):
            with self.subTest(scene):
                found = self.measure(scene, "--to", 1e-4)
                self.assertTrue(found["reached"])
                self.holds(found["volume"], volume)

    def test_density(self):
        found = self.measure("cube(2);", "--to", 1e-3, "--density", 3)
        self.holds(found["mass"], 24)
        self.holds(found["inertia"]["xx"], 24 * 8 / 12)

    @cli.optimised_only
    def test_random_scenes_against_meshes(self):
        dice = random.Random(23)
        for _ in range(6):
            solids = "".join(
                f"translate([{dice.uniform(-5, 5):.3f}, {dice.uniform(-5, 5):.3f}, {dice.uniform(-5, 5):.3f}])"
                f" rotate([{dice.uniform(0, 90):.1f}, {dice.uniform(0, 90):.1f}, 0]) "
                f"{dice.choice(('cube(6);', 'sphere(4);', 'cylinder(h = 7, r = 3);', 'torus(4, 1);'))}\n"
                for _ in range(4))
            scene = f"{dice.choice(('union', 'difference'))}({dice.choice(('', 'blend = 1'))}) {{\n{solids}}}\n"
            with self.subTest(scene):
                found = self.measure(scene, "--to", 1e-2)
                mesh = os.path.join(self.folder, "mesh.ply")
                made = cli.run(os.path.join(self.folder, "scene.txt"), "-o", mesh, "-r", 96)
                self.assertEqual(made.returncode, 0, made.stderr)
                info = json.loads(cli.run("info", "--json", mesh).stdout)["mesh"]
                # a mesh of cells of h is off by a fraction of h^2 of curvature times its area
                room = 2e-3 * info["area"]
                self.assertLessEqual(found["volume"][0], info["volume"] + room)
                self.assertGreaterEqual(found["volume"][1], info["volume"] - room)
                # a mesh's area is not that of what touches or is cut thin, but here nothing is
                self.assertLessEqual(found["area"][0], info["area"] * 1.005)
                self.assertGreaterEqual(found["area"][1] or 1e9, info["area"] * 0.995)

    def test_same_text_with_any_threads(self):
        path = write(self.folder, "scene.txt", "union(blend = 1) { rotate([10, 20, 30]) cube(10); sphere(6); }\n")
        texts = {cli.run("measure", path, "--to", 1e-2, "-j", threads).stdout for threads in (1, 2, 3)}
        self.assertEqual(len(texts), 1)

    def test_parts(self):
        scene = 'part("box") cube(10);\npart("lid") translate([0, 0, 20]) cube([10, 10, 2]);\n'
        self.holds(self.measure(scene, "--to", 1e-3, "--part", "lid")["volume"], 200)
        path = write(self.folder, "scene.txt", scene)
        result = cli.run("measure", path, "--part", "lit")
        self.assertEqual(result.returncode, 1)
        self.assertIn('did you mean "lid"', result.stderr)

    @cli.optimised_only  # the same cubes
    def test_parts_take_no_more_cubes_than_they_did(self):
        """What makes a field rougher, or a model of it worse, is seen here long before it takes minutes."""
        for name, cubes in CUBES.items():
            with self.subTest(name):
                result = cli.run("measure", os.path.join(PARTS, name + ".txt"), "--to", 3e-4, "--json")
                found = json.loads(result.stdout)
                self.assertTrue(found["reached"])
                self.assertLess(found["cubes"], 1.2 * cubes)

    def test_each_part(self):
        scene = 'part("box") color("red") cube(10);\npart("lid") translate([0, 0, 20]) cube([10, 10, 2]);\n'
        found = self.measure(scene, "--to", 1e-3, "--each-part")
        self.holds(found["volume"], 1200)
        self.assertEqual([part["part"] for part in found["parts"]], ["box", "lid"])
        for part, volume in zip(found["parts"], (1000, 200)):
            self.holds(part["volume"], volume)
            alone = self.measure(scene, "--to", 1e-3, "--part", part["part"])
            self.assertEqual({name: alone[name] for name in part if name != "part"}, {name: part[name] for name in part if name != "part"})
        path = write(self.folder, "scene.txt", scene)
        text = cli.run("measure", path, "--to", 1e-3, "--each-part").stdout.decode()
        self.assertEqual([text.count(words) for words in ("a scene", 'part "box"', 'part "lid"', "  volume ")], [1, 1, 1, 3])
        mesh = os.path.join(self.folder, "mesh.glb")
        self.assertEqual(cli.run(path, "-o", mesh).returncode, 0)
        parts = json.loads(cli.run("measure", mesh, "--json", "--each-part").stdout)["parts"]
        self.assertEqual([round(part["area"][0]) for part in parts], [600, 280])
        self.assertNotIn("parts", self.measure("cube(1);", "--to", 1e-2, "--each-part"))
        both = cli.run("measure", path, "--each-part", "--part", "lid")
        self.assertEqual(both.returncode, 2)
        self.assertIn("give one", both.stderr)
        gone = self.run_text('part("box") cube(10);\npart("lid") intersection() { cube(1); translate([5, 0, 0]) cube(1); }\n', "--each-part")
        self.assertEqual(gone.returncode, 1)
        self.assertIn('part "lid" has no measures', gone.stderr)

    def run_text(self, scene, *options):
        return cli.run("measure", write(self.folder, "scene.txt", scene), *options)

    def test_principal_moments_and_axes(self):
        found = self.measure("rotate([0, 0, 30]) cube([10, 20, 30], center = true);", "--to", 1e-3)["principal"]
        for one, (moment, axis) in zip(found, ((500, (0, 0, 1)), (1000, (-0.5, 0.75 ** 0.5, 0)), (1300, (0.75 ** 0.5, 0.5, 0)))):
            self.holds(one["moment"], 6000 * moment / 12)
            self.assertLess(one["axis_within_deg"], 0.5)
            cosine = abs(sum(a * b for a, b in zip(one["axis"], axis)))
            self.assertGreaterEqual(cosine, math.cos(math.radians(one["axis_within_deg"])) - 1e-12)
        ball = self.measure("sphere(5);", "--to", 1e-3)["principal"]
        self.assertEqual([one["axis_within_deg"] for one in ball], [90] * 3)
        self.check("cube([10, 20, 30]);", "moment_1 < 260000 && moment_3 > 640000", status=0)
        self.check("cube([10, 20, 30]);", "area < 2210 && area > 2190", status=0)
        self.check("cube([10, 20, 30]);", "area < 2190", status=1)

    def test_meshes(self):
        path = write(self.folder, "scene.txt", "translate([1, 2, 3]) cube([10, 20, 30]);\n")
        mesh = os.path.join(self.folder, "mesh.stl")
        self.assertEqual(cli.run(path, "-o", mesh).returncode, 0)
        found = json.loads(cli.run("measure", mesh, "--json").stdout)
        self.holds(found["volume"], 6000)
        self.holds(found["inertia"]["xx"], 6000 * 1300 / 12)
        self.holds(found["area"], 2200)
        self.assertLess(found["area"][1] - found["area"][0], 1e-8)
        self.assertLess(found["volume"][1] - found["volume"][0], 1e-8 * 6000)
        open_one = write(self.folder, "open.off", "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n")
        result = cli.run("measure", open_one)
        self.assertEqual(result.returncode, 1)
        self.assertIn("not closed", result.stderr)

    @cli.optimised_only
    def test_oriented_box(self):
        scene = "rotate([20, 30, 40]) cube([10, 20, 30], center = true);\n"
        box = self.measure(scene, "--to", 1e-3, "--box")["oriented_box"]
        for edge, length in zip(box["edges"], (30, 20, 10)):
            self.assertLess(abs(edge["length"][1] - length), 0.1)
            self.assertGreaterEqual(edge["length"][1], length * (1 - 1e-6))
            self.assertLessEqual(edge["largest"][1] - edge["least"][0], edge["length"][1] + 1e-9)
        self.assertLess(abs(box["edges"][2]["axis"][2] + 0.5), 0.01)
        self.check(scene, "box_volume < 6100 && box_3 < 10.1", status=0)
        self.check(scene, "box_1 < 29", status=1)
        text = self.run_text(scene, "--to", 1e-3, "--box").stdout.decode()
        self.assertIn("box edge 1", text)
        self.assertNotIn("oriented_box", self.measure("cube(1);", "--to", 1e-2))
        parts = 'part("a") cube(1);\npart("b") rotate([0, 0, 30]) translate([5, 0, 0]) cube([1, 2, 3]);\n'
        found = self.measure(parts, "--to", 1e-3, "--box", "--each-part")["parts"]
        self.assertLess(abs(found[1]["oriented_box"]["volume"][1] - 6), 0.1)

    def test_overhang_and_draft_of_meshes(self):
        path = write(self.folder, "scene.txt", "cube([1, 2, 3]); translate([0, 0, 3]) cube([3, 2, 1]);\n")
        mesh = os.path.join(self.folder, "mesh.stl")
        self.assertEqual(cli.run(path, "-o", mesh).returncode, 0)
        faces = json.loads(cli.run("measure", mesh, "--overhang", 45, "--json").stdout)["faces"]
        self.holds(faces["overhang"], 2 * 2 + 2)
        self.holds(faces["resting"], 2)
        self.holds(faces["steep"], 2 * (3 + 2) * 3 - 4 * 3 + 2 * (3 + 2))
        turned = json.loads(cli.run("measure", mesh, "--draft", 2, "--upward", "0,0,-1", "--json").stdout)["faces"]
        self.holds(turned["resting"], 6)
        self.assertEqual(cli.run("measure", mesh, "--check", "overhang - resting < 3.9").returncode, 1)
        for options, said in ((("--overhang", 90), "below 90"), (("--upward", "0,0,0"), "no direction"),
                              (("--upward", "0,0,1", "--upward", "1,0,0"), "one direction")):
            wrong = cli.run("measure", mesh, *options)
            self.assertEqual(wrong.returncode, 2)
            self.assertIn(said, wrong.stderr)

    @cli.optimised_only
    def test_overhang_and_draft_of_scenes(self):
        scene = "cube([1, 2, 3]); translate([0, 0, 2.5]) cube([3, 2, 1.5]);\n"
        faces = self.measure(scene, "--to", 1e-3, "--overhang", 45)["faces"]
        for name, area in (("overhang", 4 + 2), ("resting", 2), ("steep", 15 + 15)):
            self.holds(faces[name], area)
            self.assertLess(faces[name][1] - faces[name][0], 0.3)
        turned = self.measure(scene, "--to", 1e-3, "--upward", "0,0,-1")["faces"]
        self.holds(turned["resting"], 6)
        self.assertGreater(turned["resting"][0], 5.9)
        ball = self.measure("translate([3, 4, 5]) sphere(10);", "--to", 1e-3, "--overhang", 60, "--draft", 5)["faces"]
        self.holds(ball["overhang"], 200 * PI * 0.5)
        self.holds(ball["steep"], 400 * PI * math.sin(math.radians(5)))
        self.holds(ball["resting"], 0)
        self.assertLess(ball["overhang"][1] - ball["overhang"][0], 30)
        cone = "cylinder(h = 10, r1 = 0, r2 = 10);"  # its side is at 45 degrees
        self.holds(self.measure(cone, "--to", 1e-3, "--overhang", 46)["faces"]["overhang"], 100 * PI * 2 ** 0.5)
        asked = 10 * 1e-3 * 100 * PI * (1 + 2 ** 0.5)  # of the whole area
        self.assertLess(self.measure(cone, "--to", 1e-3, "--overhang", 44)["faces"]["overhang"][1], asked)
        self.check(scene, "overhang - resting < 4.1", status=0)
        self.check(scene, "overhang - resting < 3.9", status=1)

    def test_walls_and_gaps(self):
        box = "difference() { cube([10, 20, 30]); translate([1, 1, 2]) cube([8, 18, 40]); }\n"
        found = self.measure(box, "--to", 1e-2, "--walls")
        for name, length in (("wall", 1), ("gap", 8)):
            span = found[name]
            self.holds(span["length"], length)
            self.assertLess(span["length"][1] - span["length"][0], 0.5)
            self.assertAlmostEqual(math.dist(*span["at"]), span["length"][1], 6)
            self.assertEqual((span["none"], span["overlooked"]), (False, 0))
        self.check(box, "wall > 0.6 && gap > 7", status=0)
        failed = self.check(box, "wall > 1.2 && gap > 7", status=1)
        self.assertIn("this fails: wall > 1.2\n", failed.stderr)
        self.check("cube(10);", "gap > 1e9", status=0)  # there is none
        text = self.run_text(box, "--to", 1e-2, "--walls").stdout.decode()
        self.assertRegex(text, r"(?m)^  wall +\S+ \.\. \S+ from \S+ to \S+$")
        self.assertIn("gap          none", self.run_text("cube(10);", "--to", 1e-2, "--walls").stdout.decode())
        self.assertNotIn("wall", self.measure(box, "--to", 1e-2))
        vague = self.run_text("cylinder(h = 12, r1 = 5, r2 = 0);\n", "--to", 0.1, "--finest", 1, "--check", "wall > 1")
        self.assertEqual(vague.returncode, 0, vague.stderr)
        self.assertIn("not looked for", vague.stderr)
        path = write(self.folder, "scene.txt", box)
        mesh = os.path.join(self.folder, "mesh.stl")
        self.assertEqual(cli.run(path, "-o", mesh).returncode, 0)
        for wrong, said in ((("measure", mesh, "--walls"), "of scenes, not of meshes"),
                            (("measure", path, "--wall-angle", 41), "at most 40")):
            result = cli.run(*wrong)
            self.assertEqual(result.returncode, 2)
            self.assertIn(said, result.stderr)

    def test_gaps_between_convex_parts_are_those_that_clear_finds(self):
        dice = random.Random(4)
        for _ in range(3):
            parts = []
            for name, from_x in (("a", 0), ("b", 9)):
                shape = dice.choice(("cube([%.2f, %.2f, %.2f]);" % tuple(dice.uniform(2, 4) for _ in range(3)),
                                     f"sphere({dice.uniform(1, 2):.2f});", f"cylinder(h = {dice.uniform(2, 4):.2f}, r = 1.5);"))
                turn = ", ".join(f"{dice.uniform(0, 90):.1f}" for _ in range(3))
                parts.append(f'part("{name}") translate([{from_x + dice.uniform(0, 1):.2f}, {dice.uniform(0, 3):.2f}, 0]) rotate([{turn}]) {shape}\n')
            scene = "".join(parts)
            with self.subTest(scene):
                gap = self.measure(scene, "--to", 1e-2, "--walls")["gap"]["length"]
                path = os.path.join(self.folder, "scene.txt")
                clear = json.loads(cli.run("clear", path, "--parts", "a,b", "--json").stdout)["pairs"][0]["gap"]
                low, high = clear if isinstance(clear, list) else (clear["low"], clear["high"])
                self.assertLessEqual(gap[0], high)
                self.assertGreaterEqual(gap[1], low - 1e-4)
                self.assertLess(gap[1] - gap[0], 0.3)

    def test_a_limit_leaves_what_is_proven_of_walls(self):
        path = write(self.folder, "scene.txt", "torus(8, 2);\n")
        short = cli.run("measure", path, "--to", 1e-2, "--walls", "--json", "--timeout", 0.3)
        self.assertIn(short.returncode, (0, 2), short.stderr)
        self.holds(json.loads(short.stdout)["volume"], CLOSED["torus(8, 2);"][0])

    def test_refused(self):
        for scene, said in (("plane([0, 0, 1]);", "infinity"), ("union() {}", "empty")):
            path = write(self.folder, "scene.txt", scene)
            result = cli.run("measure", path)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn(said, result.stderr)
        for options in (["--to", "0"], ["--to", "nan"], ["--density", "-1"]):
            self.assertEqual(cli.run("measure", path, *options).returncode, 2)

    def test_a_limit_prints_what_is_proven(self):
        path = write(self.folder, "scene.txt", "torus(8, 2);\n")
        result = cli.run("measure", path, "--to", "1e-12", "--timeout", "0.2", "--json")
        self.assertEqual(result.returncode, 2)
        found = json.loads(result.stdout)
        self.assertFalse(found["reached"])
        self.holds(found["volume"], CLOSED["torus(8, 2);"][0])

    def test_ctrl_c_prints_what_is_proven(self):
        path = write(self.folder, "scene.txt", "torus(8, 2);\n")
        process = subprocess.Popen([cli.PROGRAM, "measure", path, "--to", "1e-13", "--json", "--progress", "always"],
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        said = b""
        while b"measuring" not in said:  # the handler stands by then
            said += process.stderr.read1()
        process.send_signal(signal.SIGINT)
        printed, rest = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2, rest)
        self.assertIn(b"interrupted", said + rest)
        self.holds(json.loads(printed)["volume"], CLOSED["torus(8, 2);"][0])

    def test_a_limit_of_memory_prints_what_is_proven(self):
        path = write(self.folder, "scene.txt", "torus(8, 2);\n")
        for size in ("100K", "300K", "1M"):
            result = cli.run("measure", path, "--max-memory", size, "--density", 3, "--to", 0.01, "--json")
            self.assertIn(result.returncode, (0, 2), result.stderr)
            if result.stdout:
                self.holds(json.loads(result.stdout)["mass"], 3 * CLOSED["torus(8, 2);"][0])


if __name__ == "__main__":
    unittest.main()
