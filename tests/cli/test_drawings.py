# SPDX-License-Identifier: MIT
"""Flat scenes as SVG, DXF and PDF: read back by csgmesh itself and, where they are installed, by
rsvg-convert (Debian's librsvg2-bin), ezdxf (python3-ezdxf or PyPI) and qpdf."""
import json
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree as xml

import cli

PLATE = "difference() { square([30, 20]); translate([10, 10]) circle(5); }\n"
LAYERS = """color("red") square(10);
part("lid <a>") translate([20, 0]) circle(5);
color("blue") mirror([1, 0]) translate([2, 2]) difference() { square(6); translate([1, 1]) square(2); }
part("lid <a>") translate([22, 0]) square(4);
"""
SVG = "{http://www.w3.org/2000/svg}"


def ezdxf():
    try:
        import ezdxf as module  # pylint: disable=import-outside-toplevel
        return module
    except ImportError:
        return None


def area_of_path(text):
    """Of closed loops of M and L commands, holes taken off."""
    total = 0
    for loop in text.replace("\n", "").split("Z"):
        points = [tuple(map(float, p.split())) for p in re.split("[ML]", loop) if p.strip()]
        total += sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1])) / 2
    return abs(total)


class Drawings(cli.CliTest):
    def draw(self, scene, *names, arguments=(), status=0):
        self.write("scene.scad", scene)
        outputs = [part for name in names for part in ("-o", name)]
        result = self.run_in("scene.scad", *outputs, *arguments)
        self.assert_status(result, status)
        return result

    def read(self, name):
        with open(f"{self.folder}/{name}", "rb") as file:
            return file.read()

    def volume(self, scene):
        self.write("back.scad", scene)
        result = self.run_in("back.scad", "-r", "96", "--stats")
        self.assert_status(result, 0)
        return json.loads(result.stdout)["mesh"]["volume"]

    def test_what_is_drawn_reads_back(self):
        self.draw(PLATE, "a.svg", "a.dxf", "a.pdf")
        wanted = self.volume("linear_extrude(2) " + PLATE)
        for name in ("a.svg", "a.dxf"):
            self.assertAlmostEqual(self.volume(f'linear_extrude(2) import("{name}", dpi = 25.4);'), wanted,
                                   delta=2e-4 * wanted)

    def test_svg_is_in_millimetres(self):
        self.assertEqual(self.draw(PLATE, "a.svg").stderr, "")
        root = xml.fromstring(self.read("a.svg"))
        self.assertEqual((root.get("width"), root.get("height"), root.get("viewBox")),
                         ("30mm", "20mm", "0 -20 30 20"))
        path = root.find(f".//{SVG}path").get("d")
        self.assertIn("M30 -20L0 -20L0 0L30 0Z", path)
        self.assertAlmostEqual(area_of_path(path), 600 - 25 * 3.14159265, delta=0.02)
        self.draw(PLATE, "a.svg", arguments=["--unit", "in"])
        self.assertEqual(xml.fromstring(self.read("a.svg")).get("width"), "762mm")

    def test_layers_have_names_and_colours(self):
        self.draw(LAYERS, "a.svg", "a.dxf", "a.pdf")
        groups = xml.fromstring(self.read("a.svg")).findall(f"{SVG}g")
        label = "{http://www.inkscape.org/namespaces/inkscape}label"
        self.assertEqual([(g.get(label), g.get("fill")) for g in groups],
                         [("#ff0000", "#ff0000"), ("lid <a>", "#d3d3d3"), ("#0000ff", "#0000ff")])
        areas = [area_of_path(g.find(f"{SVG}path").get("d")) for g in groups]
        self.assertAlmostEqual(areas[0], 100)
        self.assertAlmostEqual(areas[2], 32)
        self.assertEqual(re.findall(rb"\n0\nLAYER\n2\n(.*)\n", self.read("a.dxf")),
                         [b"_FF0000", b"LID__A_", b"_0000FF"])
        self.assertEqual(self.read("a.pdf").count(b"/Type /OCG /Name"), 3)

    def test_blends_are_drawn(self):
        self.draw("union(blend = 3) { square([40, 4], center = true); square([4, 40], center = true); }", "a.svg")
        area = area_of_path(xml.fromstring(self.read("a.svg")).find(f".//{SVG}path").get("d"))
        self.assertAlmostEqual(area, 304 + 4 * (1 - 3.14159265 / 4) * 9, delta=0.01)

    def test_projections_are_drawn(self):
        self.draw("projection() translate([0, 0, 3]) rotate([20, 30, 40]) cube(10);", "a.dxf")
        self.draw("projection(cut = true) sphere(5);", "a.svg")
        area = area_of_path(xml.fromstring(self.read("a.svg")).find(f".//{SVG}path").get("d"))
        self.assertAlmostEqual(area, 25 * 3.14159265, delta=0.05)

    def test_what_is_left_out_is_told(self):
        result = self.draw("cube(1); square(2);", "a.svg")
        self.assertIn("warning W0320: only flat figures are drawn: 1 solid is left out", result.stderr)
        self.assertIn("error E0337", self.draw("cube(1);", "b.svg", status=1).stderr)
        self.assertIn("nothing to draw", self.draw("", "b.svg", status=1).stderr)
        self.assertIn("no bounds", self.draw("difference() { projection(cut = true) plane(); circle(1); }",
                                             "b.svg", status=1).stderr)
        self.assert_files("a.svg", "scene.scad")

    def test_beside_a_mesh(self):
        result = self.draw(PLATE, "a.svg", "a.stl", arguments=["-M", "a.d"])
        self.assertEqual(result.stderr.count("W0322"), 1)
        self.assert_files("a.d", "a.stl", "a.svg", "scene.scad")
        self.assertIn("W0322", self.draw(PLATE, "b.stl").stderr)

    def test_names_of_layers(self):
        """Numbers of layers with one name cannot be another's name; what XML cannot hold is left out."""
        self.draw('part("a") square(1); part("A-2") square(2); part("A") square(3); part("x\\uFFFEy\\uFFFF") square(4);',
                  "a.dxf", "a.svg")
        lines = self.read("a.dxf").decode().split("\n")
        names = [lines[i + 2] for i in range(len(lines) - 2) if lines[i] == "LAYER" and lines[i + 1] == "2"]
        self.assertEqual(len(names), len(set(names)))
        self.assertIn("A$3", names)
        self.assertEqual(len(names), 4)
        self.assertIn(b'inkscape:label="x?y?"', self.read("a.svg"))

    def test_pipes_and_bytes(self):
        self.draw(PLATE, "a.svg", "a.dxf", "a.pdf")
        for name in ("svg", "dxf", "pdf"):
            result = self.run_in("scene.scad", "-f", name, "-o", "-", "-j", "1")
            self.assertEqual(result.stdout, self.read("a." + name))

    @unittest.skipUnless(shutil.which("rsvg-convert"), "rsvg-convert (librsvg2-bin) is not installed")
    def test_rsvg_reads_it(self):
        self.draw(LAYERS, "a.svg")
        done = subprocess.run(["rsvg-convert", "a.svg", "-o", "a.png"], cwd=self.folder, check=False,
                              capture_output=True, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (0, b""))

    @unittest.skipUnless(ezdxf(), "ezdxf (python3-ezdxf) is not installed")
    def test_ezdxf_reads_it(self):
        self.draw(LAYERS, "a.dxf")
        drawing = ezdxf().readfile(f"{self.folder}/a.dxf")
        self.assertFalse(drawing.audit().has_errors)
        self.assertEqual(drawing.header["$INSUNITS"], 4)
        self.assertEqual([(e.dxftype(), e.is_closed, e.dxf.layer) for e in drawing.modelspace()],
                         [("POLYLINE", True, layer) for layer in ("_FF0000", "LID__A_", "_0000FF", "_0000FF")])

    @unittest.skipUnless(shutil.which("qpdf"), "qpdf is not installed")
    def test_qpdf_finds_no_fault(self):
        scenes = [PLATE, LAYERS, "square(6000);", 'part("Größe \\U01F600") circle(0.01);',
                  "scale(1e-5) square([1, 3]);"]
        for scene in scenes:
            self.draw(scene, "a.pdf")
            done = subprocess.run(["qpdf", "--check", "a.pdf"], cwd=self.folder, check=False,
                                  capture_output=True, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (0, b""), done.stdout)


class Batches(cli.CliTest):
    """Drawings as outputs of jobs: the same bytes as one by one, up to date the next time."""

    def batch(self, *arguments):
        return self.run_in("batch", *arguments, "-d", "out", "-r", "12", "--json")

    def test_drawings_of_a_batch(self):
        self.write("flat.txt", "square(10); translate([20, 0]) circle(5);\n")
        self.write("solid.txt", "sphere(3);\n")
        self.assert_status(self.batch("flat.txt", "-f", "svg,dxf,pdf,stl"), 0)
        for name in ("flat.svg", "flat.dxf", "flat.pdf", "flat.stl"):
            self.assert_status(self.run_in("flat.txt", "-r", "12", "-o", name), 0)
            self.assertEqual(self.read(name), self.read("out/" + name), name)
        self.assertIn(b'"outcome": "up to date"', self.batch("flat.txt", "-f", "svg,dxf,pdf,stl").stdout)
        self.assert_status(self.batch("flat.txt", "-f", "svg", "--name", "alone.{ext}"), 0)
        self.assertEqual(self.read("flat.svg"), self.read("out/alone.svg"))
        result = self.batch("solid.txt", "-f", "svg")
        self.assert_status(result, 1)
        self.assertIn(b"E0337", result.stdout)
        result = self.batch("flat.txt", "-f", "svg", "--name", "{part}.{ext}")
        self.assert_status(result, 1)
        self.assertIn("a drawing has a layer for each part", result.stderr)
        self.write("jobs.json", '["flat.txt", {"scene": "flat.txt", "out": "named.dxf"}]')
        self.assert_status(self.batch("jobs.json"), 0)
        self.assertEqual(self.read("flat.dxf"), self.read("out/named.dxf"))


if __name__ == "__main__":
    cli.main()
