# SPDX-License-Identifier: MIT
"""csgmesh diff --png and --html, and the whole of it as a CI job on a repository of scenes with goldens.

The page is opened in headless Chromium (tools/view has the driver); without it those tests are skipped.
With --thorough: every page, also on a phone, in the dark, and with a hostile name.
"""
import base64
import json
import os
import shutil
import subprocess
import sys
import unittest

import cli
import diff_support
from test_render import HAS_PNG, read_png, read_ppm

HERE = os.path.dirname(os.path.abspath(__file__))
VIEW = os.path.join(HERE, "../../tools/view")
CHROMIUM = os.environ.get("CSGMESH_CHROMIUM", "/usr/bin/chromium")
HAS_BROWSER = (os.path.isdir(os.path.join(VIEW, "node_modules/playwright-core"))
               and os.access(CHROMIUM, os.X_OK) and shutil.which("node") is not None)
THOROUGH = "--thorough" in sys.argv
needs_browser = unittest.skipUnless(HAS_BROWSER, "no Chromium, or no npm ci --prefix tools/view")

PLATE = """holes = 3;
difference() {
  cube([60, 30, 6]);
  for (i = [1 : holes]) translate([15 * i, 15, -1]) cylinder(h = 8, r = 4);
}
"""
WIDTH, PANEL, BAND, CAPTION, TALL = 1440, 480, 40, 30, 400


def look(path, *arguments):
    """What look_at_report.mjs sees."""
    result = subprocess.run(["node", os.path.join(HERE, "look_at_report.mjs"), path, *arguments],
                            env={**os.environ, "CSGMESH_VIEW": VIEW}, capture_output=True, text=True,
                            timeout=240, check=False)
    if result.returncode:
        raise AssertionError(result.stderr)
    return json.loads(result.stdout)


def data_of(page):
    """The comparisons in a page."""
    text = page.decode().split('id="data">')[1].split("</script>")[0]
    return json.loads(text)


class ReportTest(diff_support.DiffTest):
    RESOLUTION = 48

    def plates(self):
        self.mesh(PLATE, "a.ply")
        self.mesh(PLATE, "b.ply", "-D", "holes=2")


class Picture(ReportTest):
    def pixels(self, *arguments):
        self.diff(1, "a.ply", "b.ply", *arguments, "--png", "out.ppm")
        width, height, pixels = read_ppm(self.read("out.ppm"))
        self.assertEqual((width, height), (WIDTH, BAND + CAPTION + TALL + 44))
        return pixels

    @staticmethod
    def panel(pixels, index):
        rows = range(BAND + CAPTION, BAND + CAPTION + TALL)
        at = [3 * (y * WIDTH + index * PANEL) for y in rows]
        return b"".join(pixels[i + 3:i + 3 * PANEL] for i in at)

    def test_panels(self):
        self.plates()
        pixels = self.pixels()
        self.assertEqual(tuple(pixels[:3]), (176, 28, 36))
        before, after, heat = (self.panel(pixels, i) for i in range(3))
        colors = lambda panel: [tuple(panel[i:i + 3]) for i in range(0, len(panel), 3)]
        bluish = sum(b > r + 30 for r, _, b in colors(before))
        orange = sum(r > b + 30 for r, _, b in colors(after))
        red = lambda panel: sum(r > 80 and r > 2 * g and r > 2 * b for r, g, b in colors(panel))
        dark_red = red(heat)
        self.assertGreater(bluish, 10000)
        self.assertGreater(orange, 10000)
        self.assertGreater(dark_red, 40)
        self.assertLess(dark_red, 8000, "a hole alone has changed")
        self.assertEqual(red(before), 0)

    def test_same_bytes(self):
        self.plates()
        one, four = self.pixels("-j", 1), self.pixels("-j", 4)
        self.assertEqual(one, four)

    def test_view(self):
        """From the front the plate is 60 wide and 6 high, from the top 60 and 30."""
        self.plates()
        shapes = {}
        for view in ("front", "top", "0,90", "180,0"):
            before = self.panel(self.pixels("--view", view), 0)
            drawn = [i for i in range(0, len(before), 3) if abs(before[i] - 216) > 8]
            across, down = [i // 3 % (PANEL - 1) for i in drawn], [i // 3 // (PANEL - 1) for i in drawn]
            shapes[view] = (max(across) - min(across)) / (max(down) - min(down))
        self.assertAlmostEqual(shapes["front"], 10, delta=2)
        self.assertAlmostEqual(shapes["top"], 2, delta=0.2)
        self.assertEqual(shapes["0,90"], shapes["top"])
        self.assertTrue(self.pixels("--view", "30,30") != self.pixels("--view", "210,30"))
        self.diff(1, "a.ply", "b.ply", "--view", "top", "--html", "out.html")
        toward = data_of(self.read("out.html"))["pairs"][0]["models"]["toward"]
        self.assertAlmostEqual(toward[2], 1, places=9)
        self.assertLess(toward[1], 0)
        self.assert_refused(self.run_in("diff", "a.ply", "b.ply", "--view", "top"), 2, "--png or --html")
        self.assert_refused(self.run_in("diff", "a.ply", "b.ply", "--view", "upon", "--png", "x.ppm"), 2, "upon")

    def test_large_triangles(self):
        """A hole that is closed in a plate of few triangles has no vertex where the change is, and is seen all the same."""
        self.write("a.txt", PLATE)
        self.write("b.txt", PLATE.replace("holes = 3", "holes = 2"))
        for name in ("a", "b"):
            self.assert_status(self.run_in(name + ".txt", "-o", name + ".ply", "-q"), 0)
        heat = self.panel(self.pixels("--html", "out.html"), 2)
        red = sum(heat[i] > 120 and heat[i] > 2 * heat[i + 1] for i in range(0, len(heat), 3))
        self.assertGreater(red, 150)
        pair = data_of(self.read("out.html"))["pairs"][0]
        self.assertLess(pair["report"]["b"]["triangles"], 1000)
        self.assertLess(pair["models"]["b"]["triangles"], 22000)
        hottest = max(int.from_bytes(raw[i:i + 2], "little") for raw in [base64.b64decode(pair["models"]["b"]["heat"])]
                      for i in range(0, len(raw), 2))
        self.assertGreater(hottest, 0.8 * 65535)

    def test_best_view(self):
        """A change is looked at from where it is seen: from below only where that is the only way."""
        block = ("change = 0;\ndifference() {\n  cube([60, 30, 16]);\n  translate([30, 15, 8]) cylinder(h = 20, r = 6);\n"
                 "  if (change == 1) translate([40, 20, -1]) cube([10, 6, 6]);\n"  # from below
                 "  if (change == 2) translate([40, 27, 6]) cube([10, 6, 6]);\n"  # at the back
                 "  if (change == 3) translate([30, 15, 6]) cylinder(h = 4, r = 5.5);\n"  # in the deep of the hole
                 "  if (change == 4) translate([8, -1, -1]) cube([3, 40, 30]);\n}\n")  # everywhere
        self.mesh(block, "a.ply")
        toward = {}
        for change in (1, 2, 3, 4):
            self.mesh(block, "b.ply", "-D", f"change={change}")
            self.diff(1, "a.ply", "b.ply", "--html", "out.html")
            toward[change] = data_of(self.read("out.html"))["pairs"][0]["models"]["toward"]
        self.assertLess(toward[1][2], 0)
        self.assertTrue(toward[2][1] > 0 and toward[2][2] > 0, toward[2])
        self.assertGreater(toward[3][2], 0.8, "into the hole")
        self.assertGreater(toward[4][2], 0)

    def test_same_meshes_are_drawn_too(self):
        self.plates()
        self.diff(0, "a.ply", "a.ply", "--png", "out.ppm")
        pixels = read_ppm(self.read("out.ppm"))[2]
        self.assertEqual(tuple(pixels[:3]), (26, 116, 62))
        self.assertGreater(len(set(self.panel(pixels, 0))), 20)

    def test_empty_side(self):
        self.plates()
        self.diff(1, "/dev/null", "b.ply", "--png", "out.ppm", "--html", "out.html")
        pixels = read_ppm(self.read("out.ppm"))[2]
        self.assertEqual(len(set(self.panel(pixels, 0))), 3)  # the colour of the paper
        self.assertEqual(data_of(self.read("out.html"))["pairs"][0]["models"]["a"]["triangles"], 0)

    def test_turned(self):
        self.plates()
        self.write("turn.txt", 'rotate([-90, 0, 0]) import("a.ply");')
        self.assert_status(self.run_in("turn.txt", "-o", "t.ply", "-r", 48, "-q"), 0)
        self.run_in("diff", "a.ply", "t.ply", "--tol", 0.3, "--ignore", "up,normals", "--html", "out.html")
        pair = data_of(self.read("out.html"))["pairs"][0]
        self.assertTrue(pair["report"]["turned"])
        size = [high - low for low, high in zip(pair["models"]["box"][:3], pair["models"]["box"][3:])]
        self.assertLess(max(abs(a - b) for a, b in zip(size, (60, 30, 6))), 0.5)

    @unittest.skipUnless(HAS_PNG, "no libpng")
    def test_png(self):
        self.plates()
        self.diff(1, "a.ply", "b.ply", "--png", "out.png")
        self.assertEqual(read_png(self.read("out.png"))[0], WIDTH)

    def test_refused(self):
        self.plates()
        self.assert_refused(self.run_in("diff", "a.ply", "b.ply", "--png", "x.jpg"), 2, "x.jpg", ".png")
        self.assert_refused(self.run_in("diff", "a.ply", "b.ply", "--html", "x", "--json", "x"), 2,
                            "--json and --html both write to x")
        os.mkdir(self.path("f"))
        self.assert_refused(self.run_in("diff", "f", "f", "--png", "x.ppm"), 2, "--html")
        result = self.run_in("diff", "a.ply", "b.ply", "--html", "no/where.html")
        self.assert_status(result, 2)
        self.assertIn("no/where.html: error E0502: cannot write", result.stderr)
        self.assert_files("a.ply", "b.ply", "f")

    def test_a_full_disk_leaves_no_half_set(self):
        """A limit on file sizes stands for it: the page is too large, the small report before it fits."""
        self.mesh(PLATE, "a.ply")
        self.mesh(PLATE, "b.ply", "-D", "holes=2")
        before = sorted(os.listdir(self.folder))
        reports = "--junit r.xml --heatmap h.ply --html r.html"
        for command, left in ((f"ulimit -f 64; exec '{cli.PROGRAM}' diff a.ply b.ply {reports}", before),
                              (f"exec '{cli.PROGRAM}' diff a.ply b.ply {reports}",
                               sorted([*before, "h.ply", "r.html", "r.xml"]))):
            result = subprocess.run(["sh", "-c", command], cwd=self.folder, capture_output=True, check=False)
            self.assertEqual(result.returncode, 2 if left == before else 1, result.stderr)
            self.assertEqual(sorted(os.listdir(self.folder)), left)


class Page(ReportTest):
    def test_contents(self):
        self.plates()
        self.diff(1, "a.ply", self.path("b.ply"), "--html", "one.html", "-j", 1)
        self.diff(1, "a.ply", self.path("b.ply"), "--html", "two.html", "-j", 3)
        page = self.read("one.html")
        self.assertEqual(page, self.read("two.html"))
        self.assertNotIn(self.folder.encode(), page)
        for word in (b"http:", b"https:", b"{{", b" src="):
            self.assertNotIn(word, page)
        pair = data_of(page)["pairs"][0]
        self.assertEqual(pair["verdict"], "different")
        for side in "ab":
            self.assertGreaterEqual(pair["models"][side]["triangles"], pair["report"][side]["triangles"])
            self.assertEqual(pair["models"][side]["cell"], 0)
        result = self.diff(1, "a.ply", "b.ply", "--html", "-")
        self.assertTrue(result.stdout.startswith(b"<!doctype html>"))
        self.assertTrue(result.stdout.endswith(b"</html>\n"))

    def test_large_meshes_are_thinned(self):
        for name, radius in (("a.ply", 1), ("b.ply", 1.01)):
            self.write("ball.txt", f"sphere({radius});")
            self.assert_status(self.run_in("ball.txt", "-o", name, "-r", 220, "-q"), 0)
        self.diff(1, "a.ply", "b.ply", "--samples", 1000, "--html", "out.html")
        pair = data_of(self.read("out.html"))["pairs"][0]
        for side in "ab":
            model = pair["models"][side]
            self.assertGreater(pair["report"][side]["triangles"], 250000)
            self.assertLessEqual(model["triangles"], 250000)
            self.assertGreater(model["triangles"], 80000)
            self.assertGreater(model["cell"], 0)

    def test_names_are_escaped(self):
        name = 'x<img src=q onerror="document.title=1">&\u202e.ply'
        self.plates()
        os.rename(self.path("b.ply"), self.path(name))
        self.diff(1, "a.ply", name, "--html", "out.html")
        page = self.read("out.html")
        self.assertNotIn(b"<img", page)
        self.assertEqual(data_of(page)["pairs"][0]["file_b"], name)
        if HAS_BROWSER and THOROUGH:
            seen = look(self.path("out.html"))
            self.assertEqual(seen["errors"], [])
            self.assertIn(name, seen["text"])

    @needs_browser
    def test_in_a_browser(self):
        self.plates()
        self.diff(1, "a.ply", "b.ply", "--tol", 0.01, "--html", "out.html")
        seen = look(self.path("out.html"), self.path("page.png"))
        self.assertEqual((seen["errors"], seen["requests"]), ([], []))
        self.assertEqual(seen["title"], "different: b.ply")
        self.assertEqual(seen["panes"], [["a", 0], ["b", 0]])
        self.assertLess(seen["order"]["changes"], seen["order"]["view"], "what changed comes first")
        for word in ("DIFFERENT", "apart, more than 0.01", "What changed", "3 through holes became 2",
                     "Worst places", "Volume +"):
            self.assertIn(word, seen["text"])
        self.assertGreater(seen["canvas"]["colors"], 200)
        self.assertGreater(seen["canvas"]["drawn"], 0.05)
        self.assertFalse(seen["overflow"])
        self.assertEqual(read_png_size(self.read("page.png")), (1440, 950))
        self.check_hands(seen)

    def check_hands(self, seen):
        start, dragged, zoomed, keyed = (seen[name] for name in ("start", "dragged", "zoomed", "keyed"))
        self.assertNotEqual(start["azimuth"], dragged["azimuth"])
        self.assertLess(zoomed["distance"], dragged["distance"])
        self.assertNotEqual(keyed["azimuth"], zoomed["azimuth"])
        self.assertEqual(set(seen["modes"]), {"a", "b", "split", "heat", "side"})
        for mode, canvas in seen["modes"].items():
            self.assertGreater(canvas["drawn"], 0.05, mode)
            self.assertEqual(canvas["red"] > 30, mode in ("heat", "side"), mode)
        self.assertEqual(seen["split"], ["split", 0.8])
        self.assertAlmostEqual(seen["fitted"]["distance"], start["distance"], places=6)
        self.check_fingers(seen["touch"])
        self.assertGreater(seen["worst"], 0)
        self.assertLess(seen["flown"]["distance"], 0.8 * start["distance"])
        self.assertNotEqual(seen["flown"]["target"], start["target"])
        shown, x, width = seen["ring"]
        self.assertEqual(shown, "visible")
        self.assertAlmostEqual(x % (width / 2), width / 4, delta=2)  # in the middle of its pane

    def check_fingers(self, seen):
        before, turned, pinched, moved = (seen[name] for name in ("before", "turned", "pinched", "moved"))
        self.assertAlmostEqual(turned["azimuth"], before["azimuth"] - 0.64, places=6)
        self.assertAlmostEqual(turned["elevation"], before["elevation"] + 0.24, places=6)
        self.assertEqual(turned["distance"], before["distance"])
        self.assertAlmostEqual(pinched["distance"], turned["distance"] / 2, places=6)
        self.assertEqual((pinched["azimuth"], pinched["elevation"]), (turned["azimuth"], turned["elevation"]))
        self.assertNotEqual(moved["target"], pinched["target"])
        self.assertAlmostEqual(moved["distance"], pinched["distance"], delta=0.05 * pinched["distance"])

    @needs_browser
    @unittest.skipUnless(THOROUGH, "with --thorough")
    def test_on_a_phone_in_the_dark(self):
        self.plates()
        self.diff(0, "a.ply", "a.ply", "--html", "same.html")
        seen = look(self.path("same.html"), self.path("page.png"), "390x844", "dark")
        self.assertEqual(seen["errors"], [])
        self.assertFalse(seen["overflow"])
        self.assertIn("SAME", seen["text"])
        self.assertEqual(seen["worst"], 0)
        self.assertGreater(seen["canvas"]["drawn"], 0.05)
        self.diff(1, "a.ply", "b.ply", "--html", "other.html")
        seen = look(self.path("other.html"), self.path("page.png"), "390x844", "dark")
        self.assertEqual((seen["errors"], seen["overflow"]), ([], False))
        self.assertEqual([side for side, _ in seen["panes"]], ["a", "b"])
        self.assertGreater(seen["panes"][1][1], 100, "one above the other")
        self.assertLess(seen["order"]["changes"], seen["order"]["view"])


def read_png_size(data):
    return int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")


JOB = """#!/bin/sh
# What a CI server runs: mesh every scene, compare with the goldens, keep the report.
set -e
"$CSGMESH" batch scenes/*.txt -d out --name '{scene}.{ext}' -f ply -r 48 -q
"$CSGMESH" diff goldens out --tol 0.01 --html report.html --junit report.xml
"""


@unittest.skipUnless(shutil.which("git"), "no git")
class Job(ReportTest):
    """A small repository of scenes with goldens, as its owner and its reviewers use it."""

    def git(self, *arguments):
        env = {**os.environ, "GIT_CONFIG_GLOBAL": "/dev/null", "GIT_CONFIG_SYSTEM": "/dev/null"}
        return subprocess.run(["git", "-c", "user.name=t", "-c", "user.email=t@example.org", *arguments],
                              cwd=self.folder, env=env, capture_output=True, text=True, check=True).stdout

    def job(self, status):
        result = subprocess.run(["sh", "ci.sh"], cwd=self.folder, capture_output=True, text=True,
                                env={**os.environ, "CSGMESH": cli.PROGRAM}, check=False)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result.stdout

    def setUp(self):
        super().setUp()
        for folder in ("scenes", "goldens"):
            os.mkdir(self.path(folder))
        self.write("scenes/plate.txt", PLATE)
        self.write("scenes/ball.txt", "sphere(r = 10);\n")
        self.write("scenes/knob.txt", "union(blend = 2) { cylinder(h = 10, r = 8); sphere(r = 9); }\n")
        self.write("ci.sh", JOB)
        self.write(".gitignore", "/out/\n/report*\n")
        self.git("init", "-q", "-b", "main")
        self.job(1)  # no goldens yet
        self.diff(0, "goldens", "out", "--update")
        self.git("add", ".")
        self.git("commit", "-q", "-m", "scenes and goldens")

    def test_one_parameter(self):
        self.assertIn("3 of 3 same", self.job(0))
        self.write("scenes/plate.txt", PLATE.replace("holes = 3", "holes = 2"))
        self.git("commit", "-q", "-a", "-m", "two holes are enough")
        text = self.job(1)
        self.assertIn("2 of 3 same", text)
        self.assertRegex(text, "different: goldens/plate.ply out/plate.ply: .* apart, more than 0.01; "
                               "genus 3 became 2")
        self.assertIn(b'failures="1"', self.read("report.xml"))
        self.check_page()
        # the reviewer accepts
        self.diff(0, "goldens", "out", "--tol", 0.01, "--update")
        self.assertEqual(self.git("status", "--porcelain").strip(), "M goldens/plate.ply")
        self.git("commit", "-q", "-a", "-m", "accept")
        self.assertIn("3 of 3 same", self.job(0))

    def check_page(self):
        pairs = data_of(self.read("report.html"))["pairs"]
        self.assertEqual([pair["file_b"] for pair in pairs if pair.get("models")], ["out/plate.ply"])
        if not (HAS_BROWSER and THOROUGH):
            return
        seen = look(self.path("report.html"), self.path("report.png"))
        self.assertEqual((seen["errors"], seen["requests"]), ([], []))
        self.assertEqual(seen["word"], "DIFFERENT")
        self.assertEqual(seen["title"], "2 of 3 same")
        self.assertTrue(seen["pairs"][0].startswith("plate.ply"), "what differs comes first")
        self.assertEqual(seen["folded"], [2, False])
        self.assertIn("3 through holes became 2", seen["text"])
        self.assertGreater(seen["canvas"]["red"], 30)
        if os.environ.get("CSGMESH_KEEP"):
            shutil.copy(self.path("report.png"), os.environ["CSGMESH_KEEP"])


if __name__ == "__main__":
    if THOROUGH:
        sys.argv.remove("--thorough")
    cli.main()
