# SPDX-License-Identifier: MIT
"""csgmesh slice: layers in files, threads, limits, and what is refused."""
import json
import math
import os
import re
import signal
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree
import zipfile

import cli
import png

SVG = "{http://www.w3.org/2000/svg}"
SLIC3R = "{http://slic3r.org/namespaces/slic3r}"
CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
SLICES = "{http://schemas.microsoft.com/3dmanufacturing/slice/2015/07}"


# What this build writes, as its own message lists them.
FORMATS = cli.run("slice", "x.txt", "--layer", 1, "-o", "x.none").stderr.partition("layers are written as")[2].split()
NEEDS_3MF = unittest.skipUnless(".3mf" in FORMATS, "this build has no 3MF")
NEEDS_MASKS = unittest.skipUnless(".zip" in FORMATS, "this build has no masks")


def write(folder, name, text):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def area(loop):
    return sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(loop, loop[1:] + loop[:1])) / 2


def svg_layers(path):
    """(z, loops of points with y upwards) of each layer of an SVG file."""
    layers = []
    for group in xml.etree.ElementTree.parse(path).getroot().iter(SVG + "g"):
        loops = []
        for drawn in group.iter(SVG + "path"):
            for loop in drawn.get("d").split("Z")[:-1]:
                numbers = [float(word) for word in re.findall(r"-?[0-9.]+", loop)]
                loops.append([(x, -y) for x, y in zip(numbers[::2], numbers[1::2])])
        layers.append((float(group.get(SLIC3R + "z")), loops))
    return layers


def svg_heights(path):
    """(bottom, top) of each layer."""
    groups = xml.etree.ElementTree.parse(path).getroot().iter(SVG + "g")
    said = [(float(group.get(SLIC3R + "z")), float(group.get(SLIC3R + "slice-height"))) for group in groups]
    return [(z - height / 2, z + height / 2) for z, height in said]


def cli_layers(path):
    """(top, loops) of each layer of a CLI file, in millimetres, and the lines of its head; turns and counts must agree."""
    with open(path, encoding="ascii") as file:
        lines = file.read().splitlines()
    start = lines.index("$$GEOMETRYSTART")
    head = dict(line.partition("/")[::2] for line in lines[:start])
    unit, layers = float(head["$$UNITS"]), []
    assert lines[0] == "$$HEADERSTART" and lines[1] == "$$ASCII" and lines[-1] == "$$GEOMETRYEND"
    for line in lines[start + 1:-1]:
        word, _, rest = line.partition("/")
        numbers = [int(number) for number in rest.split(",")]
        if word == "$$LAYER":
            layers.append((numbers[0] * unit, []))
            continue
        assert word == "$$POLYLINE" and numbers[0] == 1 and len(numbers) == 3 + 2 * numbers[2]
        points = [(x * unit, y * unit) for x, y in zip(numbers[3::2], numbers[4::2])]
        assert points[0] == points[-1]
        assert numbers[1] == (area(points[:-1]) > 0)
        layers[-1][1].append(points[:-1])
    return layers, head


def slices_3mf(path):
    """(bottom, top, loops) of each slice of a 3MF file; what the slice extension demands must hold."""
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
        model = xml.etree.ElementTree.fromstring(archive.read("3D/3dmodel.model"))
    assert (model.get("unit"), model.get("requiredextensions")) == ("millimeter", "s")
    stack, thing = model.find(f".//{SLICES}slicestack"), model.find(f".//{CORE}object")
    assert thing.get(SLICES + "slicestackid") == stack.get("id") and thing.get(SLICES + "meshresolution") == "lowres"
    assert [item.get("objectid") for item in model.iter(CORE + "item")] == [thing.get("id")]
    corners = [[float(vertex.get(axis)) for axis in "xyz"] for vertex in thing.iter(CORE + "vertex")]
    sides = [(int(t.get(a)), int(t.get(b))) for t in thing.iter(CORE + "triangle") for a, b in (("v1", "v2"), ("v2", "v3"), ("v3", "v1"))]
    assert len(corners) == 8 and len(set(sides)) == 36 and {(b, a) for a, b in sides} == set(sides)
    bottom, layers = float(stack.get("zbottom")), []
    for part in stack:
        top, loops = float(part.get("ztop")), []
        points = [(float(vertex.get("x")), float(vertex.get("y"))) for vertex in part.iter(SLICES + "vertex")]
        for polygon in part.iter(SLICES + "polygon"):
            ends = [int(segment.get("v2")) for segment in polygon]
            assert ends[-1] == int(polygon.get("startv")) and len(set(ends)) == len(ends) > 2
            loops.append([points[i] for i in ends[-1:] + ends[:-1]])
        assert part.tag == SLICES + "slice" and top > bottom and bool(points) == bool(loops) == bool(len(part))
        assert all(corners[0][k] <= p[k] <= corners[7][k] for p in points for k in (0, 1))
        layers.append((bottom, top, loops))
        bottom = top
    assert (corners[0][2], corners[7][2]) == (layers[0][0], layers[-1][1])
    return layers


def grey_png(data):
    """(width, height, rows) of a grey PNG."""
    width, height, channels, rows = png.read(data)
    assert channels == 1
    return width, height, rows


class Slice(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def slice(self, scene, *options, name="layers.svg", status=0):
        out = os.path.join(self.folder, name)
        result = cli.run("slice", write(self.folder, "scene.txt", scene), "-o", out, *options)
        self.assertEqual(result.returncode, status, result.stderr)
        return out, result

    def test_boxes_are_exact(self):
        out, _ = self.slice("translate([1, 2, 3]) cube([10, 20, 30]);\n", "--layer", 1.5)
        layers = svg_layers(out)
        self.assertEqual([z for z, _ in layers], [3.75 + 1.5 * i for i in range(20)])
        for _, loops in layers:
            self.assertEqual(len(loops), 1)
            self.assertEqual({(round(x, 4), round(y, 4)) for x, y in loops[0]}, {(1, 2), (11, 2), (11, 22), (1, 22)})
            self.assertAlmostEqual(area(loops[0]), 200, 3)

    def test_a_torus_has_holes_in_its_discs(self):
        out, result = self.slice("torus(8, 2);\n", "--layer", 0.25, "-e", 0.005, "--json")
        layers = svg_layers(out)
        self.assertEqual(len(layers), 16)
        for z, loops in layers:
            half = math.sqrt(4 - z * z)
            found = sorted(area(loop) for loop in loops)
            self.assertEqual(len(found), 2)
            self.assertAlmostEqual(found[0], -math.pi * (8 - half) ** 2, delta=0.02 * 2 * math.pi * 8 / half)
            self.assertAlmostEqual(found[1], math.pi * (8 + half) ** 2, delta=0.02 * 2 * math.pi * 10 / half)
        said = json.loads(result.stdout)
        self.assertEqual((said["layers"], said["contours"], said["tolerance"]), (16, 32, 0.005))
        self.assertAlmostEqual(said["volume"], sum(0.25 * area(loop) for _, loops in layers for loop in loops), 3)

    def test_cli_has_what_svg_has(self):
        scene = "torus(8, 2);\ntranslate([0, 0, -2]) cube([3, 2, 4]);\n"
        drawn = svg_layers(self.slice(scene, "--layer", 0.5, "-e", 0.01)[0])
        layers, head = cli_layers(self.slice(scene, "--layer", 0.5, "-e", 0.01, name="layers.cli")[0])
        self.assertEqual(head["$$LAYERS"], "8")
        self.assertEqual([float(word) for word in head["$$DIMENSION"].split(",")], [-10, -10, -2, 10, 10, 2])
        self.assertEqual(len(layers), len(drawn))
        for (top, loops), (middle, others) in zip(layers, drawn):
            self.assertAlmostEqual(top, middle + 0.25, 9)
            self.assertEqual([len(loop) for loop in loops], [len(loop) for loop in others])
            for loop, other in zip(loops, others):
                for (x, y), (u, v) in zip(loop, other):
                    self.assertLess(abs(x - u) + abs(y - v), 2.1e-5)

    @cli.optimised_only
    @NEEDS_3MF
    def test_3mf_has_what_svg_has(self):
        scene = "torus(8, 2);\ntranslate([0, 0, -2]) cube([3, 2, 4]);\ntranslate([9, 9, 4]) cube(1);\n"
        drawn = svg_layers(self.slice(scene, "--layer", 0.5, "-e", 0.01)[0])
        layers = slices_3mf(self.slice(scene, "--layer", 0.5, "-e", 0.01, name="layers.3mf")[0])
        self.assertEqual((layers[0][0], layers[-1][1], len(layers)), (-2, 5, 14))
        self.assertEqual([len(loops) for _, _, loops in layers], [len(loops) for _, loops in drawn])
        for (bottom, top, loops), (middle, others) in zip(layers, drawn):
            self.assertAlmostEqual((bottom + top) / 2, middle, 9)
            self.assertEqual(loops, others)
        files = set()
        for threads in (1, 2, 3):
            with open(self.slice(scene, "--layer", 0.01, "-j", threads, name="layers.3mf")[0], "rb") as file:
                files.add(file.read())
        self.assertEqual(len(files), 1)

    @NEEDS_3MF
    def test_lib3mf_reads_slices(self):
        try:
            import lib3mf  # pylint: disable=import-outside-toplevel
        except ImportError:
            self.skipTest("lib3mf for Python is not installed")
        out, result = self.slice("torus(8, 2);\ntranslate([9, 9, 4]) cube(1);\n", "--layer", 0.25, "--unit", "cm", "--json", name="layers.3mf")
        layers, said = slices_3mf(out), json.loads(result.stdout)
        model = lib3mf.get_wrapper().CreateModel()
        reader = model.QueryReader("3mf")
        reader.SetStrictModeActive(True)
        reader.ReadFromFile(out)
        self.assertEqual(reader.GetWarningCount(), 0)
        stacks, objects = model.GetSliceStacks(), model.GetMeshObjects()
        self.assertTrue(stacks.MoveNext() and objects.MoveNext())
        stack, thing = stacks.GetCurrentSliceStack(), objects.GetCurrentMeshObject()
        self.assertTrue(thing.HasSlices(False) and thing.IsManifoldAndOriented() and thing.IsValid())
        self.assertEqual((stack.GetSliceCount(), stack.GetBottomZ()), (said["layers"], -20))
        area_mm3 = 0
        for i, (bottom, top, loops) in enumerate(layers):
            part = stack.GetSlice(i)
            self.assertAlmostEqual(part.GetZTop(), top, 5)
            self.assertEqual(part.GetPolygonCount(), len(loops))
            points = [tuple(vertex.Coordinates) for vertex in part.GetVertices()] if loops else []
            read = [[points[index] for index in part.GetPolygonIndices(k)] for k in range(len(loops))]
            area_mm3 += sum(area(loop[:-1]) for loop in read) * (top - bottom)
        self.assertAlmostEqual(area_mm3 / 1000, said["volume"], delta=1e-4 * said["volume"])

    @NEEDS_MASKS
    def test_masks(self):
        scene = "difference() { cube([10, 6, 4]); translate([3, 3, -1]) cylinder(h = 6, r = 2); }\ntranslate([8, 4, 3.9]) cube([1, 1.5, 1]);\n"
        out, result = self.slice(scene, "--layer", 0.5, "--pixel", 0.1, "-e", 0.001, "--json", name="masks.zip")
        with zipfile.ZipFile(out) as archive:
            self.assertIsNone(archive.testzip())
            names = archive.namelist()
            self.assertEqual(names, [f"{i:05}.png" for i in range(10)] + ["layers.csv"])
            pictures = [grey_png(archive.read(name)) for name in names[:-1]]
            self.assertEqual(archive.read("layers.csv").decode().splitlines(), ["picture,from,to"] + [
                f"{i:05}.png,{i / 2:g},{i / 2 + 0.5:g}" for i in range(10)])
        self.assertEqual({(width, height) for width, height, _ in pictures}, {(100, 60)})
        rows = pictures[0][2]
        self.assertEqual((rows[59][0], rows[0][99], rows[29][29], rows[30][30]), (255, 255, 0, 0))
        self.assertAlmostEqual(sum(map(sum, rows)) / 255 * 0.01, 60 - 4 * math.pi, delta=0.02)
        rows = pictures[9][2]  # y runs down: the peg is in the upper right
        self.assertEqual((rows[10][85], rows[50][85], rows[10][15]), (255, 0, 0))
        volume = json.loads(result.stdout)["volume"]
        self.assertAlmostEqual(sum(sum(map(sum, rows)) for _, _, rows in pictures) / 255 * 0.01 * 0.5, volume, delta=0.002 * volume)

    @NEEDS_MASKS
    def test_masks_too_large(self):
        _, result = self.slice("cube(1);\n", "--layer", 0.5, "--pixel", 1e-5, name="masks.zip", status=2)
        self.assertIn("pixels in a row", result.stderr)
        _, result = self.slice("cube(1);\n", "--layer", 1e-5, "--pixel", 0.1, name="masks.zip", status=2)
        self.assertIn("too many for an archive", result.stderr)
        self.assertEqual(os.listdir(self.folder), ["scene.txt"])

    def test_a_gyroid_by_its_formula(self):
        """Its surface is |F| = level; chords are within the tolerance of it, but for the cube that it is cut by."""
        cell, thickness, within = 10, 1, 0.02
        out, _ = self.slice(f"intersection() {{ cube([12, 11, 1]); gyroid(cell = {cell}, thickness = {thickness}); }}\n",
                                 "--layer", 0.25, "-e", within)
        wave = 2 * math.pi / cell
        level, worst = thickness / 2 * 1.533 * wave, 0
        for z, loops in svg_layers(out):
            for loop in loops:
                for (a, b), (c, d) in zip(loop, loop[1:] + loop[:1]):
                    for share in (0, 0.25, 0.5, 0.75):
                        x, y = a + share * (c - a), b + share * (d - b)
                        if min(x, 12 - x, y, 11 - y) < within:
                            continue
                        u, v, w = wave * x, wave * y, wave * z
                        value = math.sin(u) * math.cos(v) + math.sin(v) * math.cos(w) + math.sin(w) * math.cos(u)
                        slope = (math.cos(u) * math.cos(v) - math.sin(w) * math.sin(u), math.cos(v) * math.cos(w) - math.sin(u) * math.sin(v),
                                 math.cos(w) * math.cos(u) - math.sin(v) * math.sin(w))
                        off = abs(abs(value) - level) / (wave * math.hypot(*slope))
                        self.assertLess(off, within if share else 1.02e-2 * within)
                        worst = max(worst, off)
        self.assertGreater(worst, 0.2 * within)

    @cli.optimised_only
    def test_heights_follow_the_surface(self):
        scene, how = "translate([0, 0, 20]) sphere(20);\n", ("--layer", 0.1, "--most-layer", 0.5, "--cusp", 0.1, "-e", 0.01)
        out, result = self.slice(scene, *how, "--json")
        said, heights = json.loads(result.stdout), svg_heights(out)
        self.assertEqual((said["layers"], said["sampled"], said["most_layer"], said["cusp"]), (len(heights), 0, 0.5, 0.1))
        for (low, high), (above, _) in zip(heights, heights[1:]):
            level = max(abs(low - 20), abs(high - 20)) / 20
            self.assertAlmostEqual(high, above, 4)
            self.assertLess((high - low) * level, 0.1001)
            self.assertTrue(0.0999 < high - low < 0.5001)
        self.assertLess(len(heights), 260)  # of 400
        self.assertAlmostEqual(said["lowest"], 0.1, 6)
        self.assertAlmostEqual(said["highest"], 0.5, 6)
        self.assertAlmostEqual(said["volume"], 4 / 3 * math.pi * 8000, delta=40)
        tops, _ = cli_layers(self.slice(scene, *how, name="layers.cli")[0])
        for (_, high), (top, _) in zip(heights, tops):
            self.assertLess(abs(high - top), 1e-4)
        if ".zip" in FORMATS:
            with zipfile.ZipFile(self.slice(scene, *how, "--pixel", 1, name="masks.zip")[0]) as archive:
                self.assertIsNone(archive.testzip())
                rows = [line.split(",") for line in archive.read("layers.csv").decode().splitlines()[1:]]
            for (low, high), (_, bottom, top) in zip(heights, rows):
                self.assertLess(max(abs(low - float(bottom)), abs(high - float(top))), 1e-4)
        if ".3mf" in FORMATS:
            stack = slices_3mf(self.slice(scene, *how, name="layers.3mf")[0])
            for (low, high), (bottom, top, _) in zip(heights, stack):
                self.assertLess(max(abs(low - bottom), abs(high - top)), 1e-4)
        files = set()
        for threads in (1, 3):
            with open(self.slice(scene, *how, "-j", threads)[0], "rb") as file:
                files.add(file.read())
        self.assertEqual(len(files), 1)
        _, result = self.slice(scene, *how)
        self.assertIn("from 0.1 to 0.5 high", result.stdout.decode())
        self.assertNotIn("sampled", result.stdout.decode())
        soft = os.path.join(cli.SCENES, "tour", "11-soft-solids.txt")  # whose gradients have no bounds
        result = cli.run("slice", soft, "--layer", 4, "--most-layer", 8, "--cusp", 2, "-e", 2, "-o", os.path.join(self.folder, "soft.svg"))
        self.assertRegex(result.stdout.decode(), r"sampled in [1-9][0-9]* cubes of [0-9.]+, where normals have no bounds")

    def test_one_part(self):
        scene = 'part("lid") translate([0, 0, 5]) cube([4, 5, 1]);\npart("box") cube([3, 2, 4]);\n'
        out, result = self.slice(scene, "--layer", 0.5, "--part", "lid", "--json")
        layers, said = svg_layers(out), json.loads(result.stdout)
        self.assertEqual(([z for z, _ in layers], said["part"]), ([5.25, 5.75], "lid"))
        self.assertAlmostEqual(said["volume"], 20, 3)
        self.assertNotIn("part", json.loads(self.slice(scene, "--layer", 0.5, "--json")[1].stdout))
        _, result = self.slice(scene, "--layer", 0.5, "--part", "lit", name="none.svg", status=1)
        self.assertIn('did you mean "lid"', result.stderr)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "none.svg")))
        _, result = self.slice("cube(1);\n", "--layer", 0.5, "--part", "lid", name="none.svg", status=1)
        self.assertIn("no named parts", result.stderr)

    def test_units_and_standard_output(self):
        scene = write(self.folder, "scene.txt", "cube(1);\n")
        result = cli.run("slice", scene, "--layer", 0.5, "--unit", "in", "-o", "-", "-f", "svg")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(b'width="25.4mm"', result.stdout)
        self.assertIn(b'slic3r:z="6.35"', result.stdout)
        self.assertNotIn(b"contours", result.stdout)

    def test_same_bytes_with_any_threads(self):
        scene = "union(blend = 1) { rotate([10, 20, 30]) cube(10); sphere(6); }\n"
        files = set()
        for threads in (1, 2, 3):
            out, _ = self.slice(scene, "--layer", 0.3, "-e", 0.01, "-j", threads)
            with open(out, "rb") as file:
                files.add(file.read())
        self.assertEqual(len(files), 1)

    def test_what_is_thin_is_told(self):
        _, result = self.slice("cube([10, 10, 5]);\ntranslate([12, 0, 0]) rotate([0, 0, 20]) cube([5, 0.004, 5]);\n",
                               "--layer", 1, "-e", 0.02, "--json")
        self.assertGreater(json.loads(result.stdout)["unsettled"], 0)
        _, result = self.slice("cube([10, 10, 5]);\n", "--layer", 1, "-e", 0.02, "--json")
        self.assertEqual(json.loads(result.stdout)["unsettled"], 0)

    def test_refused(self):
        scene = write(self.folder, "scene.txt", "cube(1);\n")
        for options, said in (
            (["-o", "x.svg"], "how high is a layer"),
            (["--layer", "0", "-o", "x.svg"], "--layer"),
            (["--layer", "-1", "-o", "x.svg"], "--layer"),
            (["--layer", "nan", "-o", "x.svg"], "--layer"),
            (["--layer", "1", "-e", "0", "-o", "x.svg"], "--tolerance"),
            (["--layer", "1", "--pixel", "0", "-o", "x.zip"], "--pixel"),
            (["--layer", "1", "--cusp", "0.1", "-o", "x.svg"], "go together"),
            (["--layer", "1", "--most-layer", "2", "-o", "x.svg"], "go together"),
            (["--layer", "1", "--most-layer", "1", "--cusp", "0.1", "-o", "x.svg"], "must be more than --layer"),
            (["--layer", "1", "--most-layer", "2", "--cusp", "0", "-o", "x.svg"], "--cusp"),
            (["--layer", "1"], "no output file"),
            (["--layer", "1", "-o", "x.gcode"], "tells no format of layers"),
            (["--layer", "1", "-o", "x", "-f", "stl"], "no format 'stl'"),
            (["--layer", "1", "-o", "-"], "standard output needs a format"),
            (["--layer", "1", "-o", "a.svg", "-o", "b.svg"], "one file"),
            (["--layer", "1", "-o", "/nowhere/x.svg"], "cannot write"),
        ):
            with self.subTest(options):
                result = cli.run("slice", scene, *options, cwd=self.folder)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(said, result.stderr)
                self.assertFalse(os.path.exists(os.path.join(self.folder, "x.svg")))
        for text, said in (("plane([0, 0, 1]);", "infinity"), ("union() {}", "empty")):
            _, result = self.slice(text, "--layer", 1, status=1)
            self.assertIn(said, result.stderr)
        _, result = self.slice("cube(1);", "--layer", "1e-9", status=2)
        self.assertIn("layers", result.stderr)

    def test_limits_leave_no_file(self):
        scene = "rotate([10, 20, 30]) cube(10);\n"
        out, result = self.slice(scene, "--layer", 0.001, "-e", 0.0005, "--timeout", 0.3, status=2)
        self.assertIn("time", result.stderr)
        self.assertFalse(os.path.exists(out))
        for size in ("100K", "300K", "1M", "3M"):
            out = os.path.join(self.folder, "small.svg")
            result = cli.run("slice", os.path.join(self.folder, "scene.txt"), "-o", out, "--layer", 0.1, "--max-memory", size)
            self.assertIn(result.returncode, (0, 2), result.stderr)
            self.assertEqual(os.path.exists(out), result.returncode == 0)
        self.assertEqual(sorted(os.listdir(self.folder)), sorted({"scene.txt"} | ({"small.svg"} if os.path.exists(out) else set())))

    def test_ctrl_c_leaves_no_file(self):
        path = write(self.folder, "scene.txt", "rotate([10, 20, 30]) cube(10);\n")
        out = os.path.join(self.folder, "layers.svg")
        process = subprocess.Popen([cli.PROGRAM, "slice", path, "--layer", "0.001", "-e", "0.0005", "-o", out, "--progress", "always"],
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        said = b""
        while b"writing" not in said:  # the handler stands by then
            more = process.stderr.read1()
            self.assertTrue(more, said)
            said += more
        process.send_signal(signal.SIGINT)
        _, rest = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2, rest)
        self.assertIn(b"interrupted", said + rest)
        self.assertEqual(os.listdir(self.folder), ["scene.txt"])


if __name__ == "__main__":
    unittest.main()
