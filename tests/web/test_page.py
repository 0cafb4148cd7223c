# SPDX-License-Identifier: MIT
"""The page of tools/web in headless Chromium, opened from its file without a network (docs/web.md).

It is that of tools/web/page.py in build-web, which this brings up to date; where nobody has built it, or Chromium, Node or
the driver of tools/view are missing, the tests are skipped.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "cli"))
import cli  # pylint: disable=wrong-import-position
from make import make  # pylint: disable=wrong-import-position

PLACE = os.path.join(ROOT, "build-web")
VIEW = os.path.join(ROOT, "tools", "view")
CHROMIUM = os.environ.get("CSGMESH_CHROMIUM", "/usr/bin/chromium")
HAS_BROWSER = (os.path.isdir(os.path.join(VIEW, "node_modules", "playwright-core")) and os.access(CHROMIUM, os.X_OK)
               and shutil.which("node") is not None)

PLATE = """width = 30; // [10:60]
label = "lid";
difference() { cube([width, 20, 10]); translate([15, 10, -1]) cylinder(h = 12, r = 5); }
"""
FLAT = """width = 30;
difference() { square([width, 20]); translate([10, 10]) circle(4); }
"""


@unittest.skipUnless(HAS_BROWSER, "no Chromium, or no npm ci --prefix tools/view")
@unittest.skipUnless(os.path.isdir(os.path.join(PLACE, "page")), "no build-web/page: tools/web/page.py makes it")
class Page(cli.CliTest):
    @classmethod
    def setUpClass(cls):
        cls.url = pathlib.Path(make("page.py")).as_uri()

    def visit(self, size, *steps, fragment="", errors=(), **options):
        """What was seen, its looks and focus; an error of the page fails the test unless it is awaited."""
        environment = {**os.environ, "CSGMESH_VIEW": VIEW, "CSGMESH_LOOK": json.dumps({"offline": True, **options})}
        result = subprocess.run(["node", os.path.join(ROOT, "tests", "cli", "look_at_view.mjs"), self.url + fragment, size, *steps],
                                env=environment, capture_output=True, text=True, timeout=120, check=False)
        if result.returncode:
            raise AssertionError(result.stderr)
        seen = json.loads(result.stdout)
        self.assertEqual([error for error in seen["errors"] if not any(part in error for part in errors)], [])
        return seen

    def open_plate(self, size, *steps, **options):
        """In the page: the new scene with PLATE as its text."""
        return self.visit(size, "wait=done", f"put={PLATE}", "wait=done", "end", *steps, fragment="#scene=scene.txt", **options)

    def test_first_picture(self):
        first, = self.visit("1280x800", "wait=done", "look")["looks"]
        self.assertGreater(first["drawn"], 0.05)
        self.assertGreater(first["triangles"], 1000)
        self.assertIn("triangles, within", first["figures"])
        self.assertEqual((first["status"], first["absent"], first["stale"], first["dim"]), ("", "", False, []))
        self.assertIn("GLB", first["formats"])
        self.assertEqual(first["title"], "mug.txt - csgmesh")

    def test_menu_and_includes(self):
        tour, paper = self.visit("1280x800", "wait=done", "choose=10 files", "wait=done", "look", "choose=Hsu die", "wait=done", "look")["looks"]
        for look, name in ((tour, "10-files.txt"), (paper, "hsu_die.txt")):
            self.assertEqual((look["title"], look["findings"], look["stale"]), (f"{name} - csgmesh", "", False))
            self.assertGreater(look["drawn"], 0.02)
        self.assertEqual(paper["hash"], "#scene=scenes/papers/hsu_die.txt")
        self.assertIn("//", tour["text"])
        self.assertNotIn("//! expect", tour["text"])

    def test_a_mistake_while_one_types(self):
        good, wrong, mended = self.open_plate("1280x800", "look", f"put={PLATE}cub(3);", "wait=failed", "look", "press=Control+z", "wait=done",
                                              "look")["looks"]
        self.assertIn("30 x 20 x 10", good["figures"])
        self.assertEqual((wrong["wrong"], wrong["stale"]), (["cub"], True))
        self.assertIn("did you mean 'cube'?", wrong["findings"])
        self.assertIn("scene.txt:4:1", wrong["findings"])
        self.assertGreater(wrong["drawn"], 0.05, "the model before it stays")
        self.assertEqual((mended["wrong"], mended["findings"], mended["stale"]), ([], "", False))

    def test_parameters_and_link(self):
        slid, again, back = self.open_plate("1280x800", "slide=width=55", "wait=done", "look", "click=#link", "said=link", "reload", "wait=done", "look",
                                            "click=#reset", "wait=done", "look")["looks"]
        self.assertIn("55 x 20 x 10", slid["figures"])
        self.assertIn("label", slid["parameters"])
        self.assertRegex(again["hash"], r"^#text=[\w-]+$")
        self.assertIn("55 x 20 x 10", again["figures"])
        self.assertIn("width = 30; // [10:60]", again["text"])
        self.assertIn("30 x 20 x 10", back["figures"])

    @unittest.skipUnless(cli.has_library("Clipper") and cli.has_library("libzip"), "the native build lacks Clipper or libzip")
    def test_downloads(self):
        """Every format of meshes that the page offers, with the bytes of the command line."""
        formats = [name.lower() for name in self.visit("1280x800", "wait=done", "look")["looks"][0]["formats"]]
        self.assertLessEqual({"stl", "ply", "obj", "glb", "gltf", "off", "amf", "svg", "dxf", "pdf"}, set(formats))
        drawings = [name for name in formats if name in ("svg", "dxf", "pdf")]
        meshes = [name for name in formats if name not in drawings]
        self.assertIn("3mf", meshes)
        self.open_plate("1280x800", "slide=width=55", "wait=done", *(f"download={name}={self.path('got.' + name)}" for name in meshes))
        self.write("scene.txt", PLATE)
        for name in meshes:
            with self.subTest(name):
                self.assertEqual(self.read(f"got.{name}"), self.native("width=55", name))
        self.visit("1280x800", "wait=done", "put=" + FLAT, "wait=done", *(f"download={name}={self.path('got.' + name)}" for name in drawings),
                   fragment="#scene=scene.txt")
        self.write("scene.txt", FLAT)
        for name in drawings:
            with self.subTest(name):
                self.assertEqual(self.read(f"got.{name}"), self.native("width=30", name))

    def native(self, define, form):
        with open(self.path("native"), "wb") as out:
            done = subprocess.run([cli.PROGRAM, "scene.txt", "-D", define, "-o", "-", "-f", form], cwd=self.folder, stdout=out, check=False)
        self.assertEqual(done.returncode, 0)
        return self.read("native")

    def test_phone(self):
        for scheme in ("light", "dark"):
            first, wrong = self.visit("390x844", "wait=done", "look", "end", "type=cub(3);", "wait=failed", "look", colorScheme=scheme)["looks"]
            with self.subTest(scheme):
                self.assertEqual((first["wide"], wrong["wide"]), (390, 390), "nothing is wider than the phone")
                self.assertGreater(first["drawn"], 0.05)
                self.assertEqual((first["dim"], wrong["dim"]), ([], []))

    def test_keyboard_alone(self):
        """Every control is reached by Tab, in a frame; the editor does not keep the key; arrows turn the model."""
        seen = self.visit("1280x800", "wait=done", "look", "press=Tab*28", "key=ArrowLeft", "look")
        names = [name for name, _ in seen["focus"]]
        for name in ("scene", "open", "save", "link", "about-button", "canvas", "fit", "from-where", "wire", "measure", "section", "quality",
                     "format"):
            self.assertIn(name, names)
        self.assertTrue(any("cm-content" in name for name in names))
        self.assertEqual([name for name, outline in seen["focus"] if outline == "none" and name != "BODY"], [])
        before, after = (look["camera"] for look in seen["looks"])
        self.assertNotEqual(before["azimuth"], after["azimuth"])

    def test_what_is_outdated_ends(self):
        """Keys while a mesh is made: the last text is the one that is shown."""
        last, = self.visit("1280x800", "end", *(f"type=translate([{8 * i}, 0, 0]) sphere(3);" for i in range(9, 14)), "wait=done", "look",
                           fragment="#scene=scenes/tour/11-soft-solids.txt")["looks"]
        self.assertIn("translate([104, 0, 0]) sphere(3);", last["text"])
        self.assertEqual(last["findings"], "")

    def test_what_is_missing(self):
        lacking, = self.visit("390x844", "unfit", "look", lacks="WebAssembly")["looks"]
        self.assertIn("this browser has no WebAssembly", lacking["absent"])
        broken, = self.visit("1280x800", "wait=done", "look", fragment="#text=abcdef")["looks"]
        self.assertEqual(broken["status"], "No scene: the scene in the address is cut off or broken.")


if __name__ == "__main__":
    cli.main()
