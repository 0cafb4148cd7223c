# SPDX-License-Identifier: MIT
"""csgmesh clear: gaps and collisions of parts, poses, reports, what is refused."""
import json
import math
import os
import signal
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree

import cli
from test_render import read_ppm

TWO = """t = 0;
part("a") cube(10);
part("b") translate([12 - t, 2, 3]) cube([2, 6, 2]);
"""
FOUR = TWO + """part("far") translate([1000, 0, 0]) sphere(1);
part("on top") translate([2, 2, 10]) cylinder(h = 3, r = 1);
"""


class Clear(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def run_on(self, scene, *options, status=0):
        path = os.path.join(self.folder, "scene.txt")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scene)
        result = cli.run("clear", path, *options)
        self.assertEqual(result.returncode, status, result.stderr + result.stdout.decode())
        return result

    def pairs(self, scene, *options, status=0):
        found = json.loads(self.run_on(scene, "--json", *options, status=status).stdout)
        return {tuple(pair["parts"]): pair for pair in found["pairs"]}

    def test_states(self):
        pairs = self.pairs(FOUR, "--to", 0.001)
        self.assertEqual(len(pairs), 6)
        gap = pairs["a", "b"]["gap"]
        self.assertTrue(gap[0] <= 2 <= gap[1] < 2.001, gap)
        near = pairs["a", "b"]["nearest"]
        self.assertAlmostEqual(math.dist(*near), gap[1])
        self.assertEqual(pairs["a", "on top"]["state"], "touching")
        self.assertEqual(pairs["a", "on top"]["result"], "clear")
        far = pairs["a", "far"]
        self.assertTrue(far["by_boxes"])
        self.assertEqual(far["cubes"], 0)
        self.assertTrue(980 < far["gap"][0] <= 989 and far["gap"][1] is None)

    def test_interfering(self):
        pairs = self.pairs(FOUR, "-D", "t=3", status=1)
        pair = pairs["a", "b"]
        self.assertEqual((pair["state"], pair["result"]), ("interfering", "not clear"))
        self.assertTrue(0 < pair["volume"][0] <= 12 <= pair["volume"][1], pair["volume"])
        x, y, z = pair["inside"]
        self.assertTrue(9 <= x <= 10 and 2 <= y <= 8 and 3 <= z <= 5)
        text = self.run_on(FOUR, "-D", "t=3", status=1)
        self.assertIn('"a" and "b": interfering', text.stdout.decode())
        self.assertIn('"a" and "b" interfere', text.stderr)

    def test_min_gap(self):
        self.run_on(TWO, "--min-gap", 1.99)
        failed = self.run_on(TWO, "--min-gap", 2.01, status=1)
        self.assertIn("closer than 2.01", failed.stderr)
        self.run_on(TWO, "-D", "t=2")  # they touch, which is clear
        self.run_on(TWO, "-D", "t=2", "--min-gap", 0.1, status=1)
        undecided = self.run_on(TWO, "--min-gap", 2, status=2)  # it is as large: nothing shows that it is not less
        self.assertIn("could not be told", undecided.stderr)

    def test_over(self):
        pairs = self.pairs(FOUR, "--over", "t=-1:0.25:1.5")
        pair = pairs["a", "b"]
        self.assertEqual(pair["worst"], {"pose": 10, "t": 1.5})
        self.assertEqual(pair["poses"], 11)
        self.assertTrue(pair["gap"][0] <= 0.5 <= pair["gap"][1])
        self.assertEqual(pairs["a", "on top"]["poses"], 11)
        found = self.run_on(FOUR, "--over", "t=0:4", status=1)
        self.assertIn('"a" and "b" interfere at t = 4', found.stderr)
        self.assertIn("between poses 3 of 4 steps not covered, first 1 .. 2", found.stdout.decode())
        self.assertIn("2 of 5 interfere", found.stdout.decode())
        whole = json.loads(self.run_on(FOUR, "--over", "t=0:4", "--json", status=1).stdout)
        self.assertEqual(whole["over"], {"parameter": "t", "first": 0, "step": 1, "last": 4})
        self.assertEqual(whole["between_poses"], "of steps that are covered, for parts that move by screws")
        downwards = self.pairs(TWO, "--over", "t=1:-0.1:0")["a", "b"]
        self.assertEqual((downwards["poses"], downwards["worst"]["pose"]), (11, 0))

    def test_between(self):
        pairs = self.pairs(FOUR, "--over", "t=-1:0.25:1.5", "--between")
        slides, far, still = pairs["a", "b"], pairs["b", "far"], pairs["a", "on top"]
        for pair in (slides, far, still):
            self.assertEqual((pair["steps"], pair["steps_not_covered"]), (10, 0))
            self.assertNotIn("first_not_covered", pair)
        self.assertTrue(0.24 < slides["gap_between"] <= 0.5, slides)
        self.assertTrue(980 < far["gap_between"] < 990)
        self.assertEqual(still["gap_between"], 0)  # they touch, and do not move
        self.assertIn("they do not move in relation to each other", self.run_on(FOUR, "--over", "t=0:1").stdout.decode())
        # it is on the other side of the bar from one pose to the next
        jumps = 'part("bar") cube([1, 9, 9]); t = 0; part("ball") translate([3 * t - 5, 4, 4]) sphere(1);'
        pair = self.pairs(jumps, "--over", "t=0:4:8")["bar", "ball"]
        self.assertEqual((pair["result"], pair["steps"], pair["steps_not_covered"]), ("clear", 2, 1))
        self.assertEqual(pair["first_not_covered"], [0, 4])
        report = os.path.join(self.folder, "report.xml")
        failed = self.run_on(jumps, "--over", "t=0:4:8", "--between", "--junit", report, status=2)
        self.assertIn('"bar" and "ball" between poses: 1 of 2 steps not covered, first 0 .. 4', failed.stderr)
        suite = xml.etree.ElementTree.parse(report).getroot()
        self.assertEqual((suite.get("failures"), suite.get("errors")), ("0", "1"))
        self.assertIn("1 of 2 steps not covered", suite[0].find("system-out").text)
        # a ball that grows is not the same ball
        grows = self.pairs('t = 0; part("a") sphere(1); part("b") translate([9, 0, 0]) sphere(1 + t);', "--over", "t=0:2")
        self.assertEqual(grows["a", "b"]["steps_not_covered"], 2)
        self.run_on(TWO, "--over", "t=0:0.25:1", "--between", "--min-gap", 0.9)
        row = 't = 0; for (i = [0 : 7]) part(str("p", i)) translate([100 * i, i * t, 0]) sphere(%s);'
        for radius, words in (("1", "between poses a gap of at least 9"), ("1 + t", "between poses steps of 28 of them are not covered")):
            found = self.run_on(row % radius, "--over", "t=0:2").stdout.decode()
            self.assertIn("28 other pairs: apart", found)
            self.assertIn(words, found)
        self.run_on(TWO, "--over", "t=0:1", "--between", "--min-gap", 1.001, status=1)

    def test_refine(self):
        swings = 't = 0; part("post") translate([10, 0, 0]) sphere(1); part("ball") rotate(t) translate([7.9, 0, 0]) sphere(1);'
        whole = ("--over", "t=-80:160:80", "--between")
        self.assertEqual(self.pairs(swings, *whole, status=2)["post", "ball"]["steps_not_covered"], 1)
        halved = self.pairs(swings, *whole, "--refine", 5)["post", "ball"]
        self.assertTrue(2 < halved["steps"] == halved["poses"] - 1 <= 32, halved)
        self.assertEqual((halved["steps_not_covered"], halved["worst"]["t"]), (0, 0))
        self.assertTrue(0 < halved["gap_between"] <= 0.1 <= halved["gap"][1] < 0.11, halved)
        # what interferes on the way is found, and what cannot be covered is halved so often and no more
        hits = self.pairs(swings.replace("7.9", "8.1"), *whole, "--refine", 5, status=1)["post", "ball"]
        self.assertEqual((hits["state"], hits["worst"]["t"]), ("interfering", 0))
        slides = self.pairs('t = 0; part("a") cube(1); part("b") translate([1, t, 0]) cube(1);', "--over", "t=0:1", "--refine", 3)
        self.assertEqual((slides["a", "b"]["steps"], slides["a", "b"]["steps_not_covered"]), (8, 8))
        late = self.run_on(swings, "--over", "t=-80:0.01:80", "--refine", 16, "--to", 1e-7, "--timeout", 0.25, status=2)
        self.assertIn("longer than the limit of 0.25 s", late.stderr)

    def test_parts(self):
        self.assertEqual(set(self.pairs(FOUR, "--parts", "b,on top")), {("b", "on top")})
        pairs = self.pairs(FOUR, "--parts", "far")
        self.assertEqual(len(pairs), 3)
        self.assertFalse(pairs["a", "far"]["by_boxes"])  # named, so it is wanted exactly
        self.assertIsNotNone(pairs["a", "far"]["gap"][1])

    def test_same_for_any_threads(self):
        self.assertEqual(*(self.run_on(FOUR, "--json", "--over", "t=0:0.5:3", "-j", threads, status=1).stdout
                           for threads in (1, 3)))

    def test_junit(self):
        report = os.path.join(self.folder, "report.xml")
        self.run_on(FOUR, "-D", "t=3", "--junit", report, status=1)
        suite = xml.etree.ElementTree.parse(report).getroot()
        self.assertEqual((suite.get("name"), suite.get("tests"), suite.get("failures"), suite.get("errors")),
                         ("csgmesh clear", "6", "1", "0"))
        cases = {case.get("name"): case for case in suite}
        self.assertIn("interfere", cases['"a" and "b"'].find("failure").get("message"))
        self.assertIsNone(cases['"a" and "on top"'].find("failure"))
        self.run_on(TWO, "--min-gap", 2, "--junit", report, status=2)
        self.assertEqual(xml.etree.ElementTree.parse(report).getroot().get("errors"), "1")

    def picture(self, scene, *options, status=0):
        """(width, height, at): of the pair that is drawn; at(x, y) is a pixel."""
        path = os.path.join(self.folder, "worst.ppm")
        self.run_on(scene, "--picture", path, *options, status=status)
        with open(path, "rb") as file:
            width, height, pixels = read_ppm(file.read())
        return width, height, lambda x, y: tuple(pixels[3 * (y * width + x):3 * (y * width + x) + 3])

    def reds(self, picture, first, last):
        """Pixels that are red in columns first .. last - 1, without the band at the top."""
        _, height, at = picture
        pixels = [at(x, y) for y in range(40, height - 70) for x in range(first, last)]
        return sum(2 * g < r and 2 * b < r for r, g, b in pixels)

    def test_picture(self):
        clear = self.picture(FOUR)  # "a" and "on top" touch: of all pairs the nearest
        self.assertEqual(clear[:2], (1280, 670))
        self.assertEqual(clear[2](2, 2), (26, 116, 62))
        self.assertGreater(self.reds(clear, 641, 1280), 100)  # the balls
        bad = self.picture(FOUR, "--over", "t=0:1:4", status=1)
        self.assertEqual(bad[2](2, 2), (176, 28, 36))
        whole, near = self.reds(bad, 0, 640), self.reds(bad, 641, 1280)
        self.assertTrue(near > 5000 and near > 5 * whole > 0, (whole, near))
        ring = [(x, y) for x in range(640) for y in range(40, 600) if bad[2](x, y) == (0, 0, 0)]
        red = [(x, y) for x in range(640) for y in range(40, 600) if bad[2](x, y)[0] > 2 * max(bad[2](x, y)[1:])]
        for axis in (0, 1):  # the ring's middle is on what is red
            middle, reached = sum(p[axis] for p in ring) / len(ring), [p[axis] for p in red]
            self.assertTrue(min(reached) < middle < max(reached), (middle, min(reached), max(reached)))
        far = self.picture('part("a") sphere(1); part("b") translate([9, 0, 0]) sphere(1);')
        self.assertEqual(far[0], 640)  # by their boxes: no place is known
        top, front = (self.picture(TWO, "--view", view)[2] for view in ("top", "0,0"))
        self.assertNotEqual([top(x, 320) for x in range(640)], [front(x, 320) for x in range(640)])

    def test_picture_that_is_refused(self):
        path = os.path.join(self.folder, "worst.ppm")
        for scene, options, words in (
                (TWO, ("--picture", "worst.jpg"), ("worst.jpg", ".png or .ppm")),
                (TWO, ("--view", "top"), ("--view needs --picture",)),
                (TWO, ("--view", "upon", "--picture", path), ("upon",)),
                ('part("a") sphere(1); part("b") intersection() { sphere(1); translate([9, 0, 0]) sphere(1); }',
                 ("--picture", path), ("is not drawn", "empty")),
                (TWO, ("--picture", os.path.join(self.folder, "none", "worst.ppm")), ("worst.ppm",))):
            with self.subTest(options):
                result = self.run_on(scene, *options, status=2)
                for word in words:
                    self.assertIn(word, result.stderr)
        self.assertFalse(os.path.exists(path))

    def test_what_is_refused(self):
        for scene, options, words in (
                (TWO, ("--parts", "a,bb"), ('no part "bb"', 'did you mean "b"')),
                (TWO, ("--parts", "a,,b"), ("name that is empty",)),
                ("sphere(1);", (), ("fewer than two parts", "part(")),
                ('part("a") sphere(1);', (), ("fewer than two parts",)),
                ('part("a") sphere(1); part("b") plane([0, 0, 1], 0);', (), ('part "b" reaches to infinity',)),
                (TWO, ("--over", "t"), ("NAME=A:STEP:B",)),
                (TWO, ("--over", "t=0:x:1"), ("wants numbers",)),
                (TWO, ("--over", "t=0:0:1"), ("never comes",)),
                (TWO, ("--over", "t=0:-1:1"), ("never comes",)),
                (TWO, ("--over", "t=0:1e-9:1"), ("more than 1000000 poses",)),
                (TWO, ("--over", "tt=0:1"), ("'t'",)),
                (TWO, ("--min-gap", "-1"), ("--min-gap",)),
                (TWO, ("--between",), ("--between needs --over",)),
                (TWO, ("--refine", "2"), ("--refine needs --over",)),
                (TWO, ("--over", "t=0:1", "--refine", "17"), ("16 times at most",)),
                (TWO + "cub(1);", (), ("cube",))):
            with self.subTest(options or scene):
                result = self.run_on(scene, *options, status=2)
                for word in words:
                    self.assertIn(word, result.stderr)
                self.assertEqual(result.stdout, b"")
        self.assertEqual(cli.run("clear").returncode, 2)
        self.assertIn("many times", cli.run("clear", "-", "--over", "t=0:1", stdin=TWO.encode()).stderr)
        self.assertEqual(cli.run("clear", "-", stdin=TWO.encode()).returncode, 0)

    def test_limits(self):
        slow = 'part("a") difference() { cube(30, center = true); sphere(10); }\npart("b") sphere(9.9999);\n'
        late = self.run_on(slow, "--timeout", 0.05, "--to", 1e-7, status=2)
        self.assertIn("could not be told", late.stderr)
        self.assertIn("undecided", late.stdout.decode())
        short = self.run_on(slow, "--max-memory", "6M", "--to", 1e-7, status=2)
        self.assertIn("more memory is needed", short.stderr)

    def test_interrupted(self):
        path = os.path.join(self.folder, "scene.txt")
        with open(path, "w", encoding="utf-8") as file:
            file.write(FOUR)
        process = subprocess.Popen([cli.PROGRAM, "clear", path, "--over", "t=0:0.00001:1.9", "--progress", "never"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            process.wait(1)
        except subprocess.TimeoutExpired:
            pass
        process.send_signal(signal.SIGINT)
        out, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2, errors)
        self.assertIn(b"this is proven so far", errors)
        self.assertIn(b'"a" and "b": apart', out)


if __name__ == "__main__":
    unittest.main()
