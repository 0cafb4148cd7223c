# SPDX-License-Identifier: MIT
"""csgmesh render: pictures as files, of scenes and of meshes, and what is refused."""
import base64
import json
import os
import struct

import cli
import png

HAS_PNG = cli.has_library("libpng")
SMALL = ("--size", "64x48")


def read_ppm(data):
    """(width, height, rows of bytes)."""
    magic, size, most, pixels = data.split(b"\n", 3)
    assert magic == b"P6" and most == b"255"
    width, height = map(int, size.split())
    assert len(pixels) == 3 * width * height
    return width, height, pixels


def read_png(data):
    """(width, height, channels, pixels)."""
    width, height, channels, rows = png.read(data)
    return width, height, channels, b"".join(rows)


class Render(cli.CliTest):
    def ppm(self, *arguments):
        result = self.run_in("render", *arguments, "-o", "-", "-f", "ppm")
        self.assert_status(result, 0)
        return read_ppm(result.stdout)

    def setUp(self):
        super().setUp()
        self.write("ball.txt", cli.BALL)
        self.write("blend.txt", cli.BLEND)

    def test_a_picture(self):
        result = self.run_in("render", "blend.txt", "-o", "blend.ppm", *SMALL)
        self.assert_status(result, 0)
        self.assertEqual(result.stderr, "")
        self.assert_files("ball.txt", "blend.txt", "blend.ppm")
        width, height, pixels = read_ppm(self.read("blend.ppm"))
        self.assertEqual((width, height), (64, 48))
        self.assertGreater(len(set(pixels)), 40)
        self.assertEqual(pixels[:3], b"\xff\xff\xff")

    def test_png(self):
        if not HAS_PNG:
            result = self.run_in("render", "ball.txt", "-o", "ball.png", *SMALL)
            self.assert_refused(result, 2, "PNG", "libpng", ".ppm")
            return
        self.assert_status(self.run_in("render", "blend.txt", "-o", "a.png", *SMALL), 0)
        width, height, channels, pixels = read_png(self.read("a.png"))
        self.assertEqual((width, height, channels), (64, 48, 3))
        self.assertEqual(pixels, self.ppm("blend.txt", *SMALL)[2])
        self.assert_status(self.run_in("render", "blend.txt", "-o", "b.png", *SMALL, "--background",
                                       "transparent"), 0)
        width, height, channels, pixels = read_png(self.read("b.png"))
        self.assertEqual(channels, 4)
        self.assertEqual(pixels[3], 0)
        self.assertEqual(pixels[4 * (24 * 64 + 32) + 3], 255)

    def test_same_bytes(self):
        mug = os.path.join(cli.SCENES, "parts", "mug.txt")
        pictures = set()
        for threads, isa in ((1, "scalar"), (2, "sse2"), (3, "avx2"), (4, "auto")):
            env = {} if isa == "auto" else {"CSGMESH_ISA": isa}
            result = self.run_in("render", mug, "-o", "-", "-f", "ppm", "--size", "160x120", "-j", threads,
                                 env=env)
            if result.returncode != 0 and isa != "scalar":
                continue  # not on this processor
            self.assert_status(result, 0)
            pictures.add(result.stdout)
        self.assertEqual(len(pictures), 1)

    def test_views_differ(self):
        seen = [self.ppm("blend.txt", *SMALL, *view) for view in (
            (), ("--view", "front"), ("--view", "left"), ("--view", "120,-30"),
            ("--camera", "4,-4,3,0,0,0"), ("--projection", "orthographic"), ("--fov", "90"),
            ("--zoom", "2"), ("--slice", "z=0"), ("--slice", "x=0.2", "--iso", "0.05"),
            ("--background", "#123"), ("--no-shadows",), ("--no-occlusion",), ("--samples", "1"),
            ("--bounds=-2,-2,-2,0.3,2,2",), ("-D", "$unused=1"),
            ("--projection", "orthographic", "--height", "9"), ("--frame=-5,-5,-5,5,5,5",))]
        pictures = [p for _, _, p in seen]
        self.assertEqual(pictures[15], pictures[0])
        del pictures[15]
        self.assertEqual(len(set(pictures)), len(pictures))

    def test_marks(self):
        """# and % are in pictures, and mean to meshes what they always did."""
        self.write("plain.txt", "difference() { cube(9); cylinder(h = 20, r = 3); }")
        self.write("marked.txt", "difference() { cube(9); #cylinder(h = 20, r = 3); } %sphere(15);")
        plain, marked = self.ppm("plain.txt", *SMALL), self.ppm("marked.txt", *SMALL)
        red = [sum(p[i] > p[i + 1] + 30 for i in range(0, len(p), 3)) for _, _, p in (plain, marked)]
        self.assertEqual(red[0], 0)
        self.assertGreater(red[1], 20)
        for arguments in (("--slice", "z=4"), ("--evaluator", "lazy", "--frame=0,0,0,9,9,9")):
            self.assertEqual(self.ppm("plain.txt", *SMALL, *arguments),
                             self.ppm("marked.txt", *SMALL, *arguments), arguments)
        for name in ("plain", "marked"):
            self.assert_status(self.run_in(f"{name}.txt", "-o", f"{name}.ply", "-r", 24), 0)
        self.assertEqual(self.read("plain.ply"), self.read("marked.ply"))
        self.assertEqual(self.ppm("marked.txt", *SMALL, "-j", 1), self.ppm("marked.txt", *SMALL, "-j", 3))

    def test_depfile(self):
        self.write("main.txt", "include <part.txt>\nthing();")
        self.write("part.txt", "module thing() sphere(2);")
        self.assert_status(self.run_in("render", "main.txt", "-o", "a.ppm", "-M", "a.d", *SMALL), 0)
        self.assertEqual(self.read("a.d").split(b"\n\n")[0].split(), [b"a.ppm:", b"\\", b"main.txt", b"\\", b"part.txt"])
        self.assert_status(self.run_in("render", "main.txt", "-o", "t.ppm", "--turntable", 2, "-M", "t.d", *SMALL), 0)
        self.assertTrue(self.read("t.d").startswith(b"t-000.ppm t-001.ppm: \\\n  main.txt"))
        self.assert_refused(self.run_in("render", "main.txt", "-o", "-", "-M", "a.d", *SMALL, "-f", "ppm"), 2, "-M needs")
        self.assert_status(self.run_in("main.txt", "-o", "a.ply", "-r", 16), 0)
        result = self.run_in("render", "a.ply", "-o", "b.ppm", "-M", "b.d", *SMALL)
        self.assert_status(result, 0)
        self.assertIn("--depfile has no effect on a mesh", result.stderr)
        self.assertNotIn("b.d", os.listdir(self.folder))

    def test_turntable(self):
        self.assert_status(self.run_in("render", "blend.txt", "-o", "t.ppm", "--turntable", 4, *SMALL,
                                       "--background", "black"), 0)
        self.assert_files("ball.txt", "blend.txt", "t-000.ppm", "t-001.ppm", "t-002.ppm", "t-003.ppm")
        self.assertEqual(len({self.read(f"t-00{i}.ppm") for i in range(4)}), 4)

    def test_a_mesh(self):
        self.assert_status(self.run_in("blend.txt", "-o", "blend.ply", "-r", 24), 0)
        plain = self.ppm("blend.ply", *SMALL)
        self.assertGreater(len(set(plain[2])), 30)
        self.assertNotEqual(self.ppm("blend.ply", *SMALL, "--wireframe"), plain)
        self.assertNotEqual(self.ppm("blend.ply", *SMALL, "--shading", "flat"), plain)
        for name in ("blend.ply", "blend.txt"):
            for option in ("--no-ground", "--edges"):
                self.assertNotEqual(self.ppm(name, *SMALL, option), self.ppm(name, *SMALL))
        result = self.run_in("render", "blend.ply", "-o", "x.ppm", *SMALL, "--slice", "z=0")
        self.assert_status(result, 0)
        self.assertIn("--slice has no effect on a mesh", result.stderr)
        for option, what in ((("--slice", "z=0"), "a section"), (("--evaluator", "lazy"), "a picture by the lazy evaluator")):
            result = self.run_in("render", "blend.txt", "-o", "x.ppm", *SMALL, "--edges", *option)
            self.assertIn("--edges has no effect on " + what, result.stderr)
        self.assertEqual(self.run_in("render", "blend.txt", "-o", "x.ppm", *SMALL, "--edges").stderr, "")

    def test_alpha_of_foreign_gltf(self):
        """Without alphaMode glTF's alpha says nothing; with BLEND one sees through."""
        points = struct.pack("<9f", -1, 0, -1, 1, 0, -1, 0, 0, 1)
        root = {"asset": {"version": "2.0", "generator": "another"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, 0, -1], "max": [1, 0, 1]}],
                "bufferViews": [{"buffer": 0, "byteLength": 36}],
                "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + base64.b64encode(points).decode()}],
                "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.25], "metallicFactor": 0}}]}
        darkest = {}
        for mode in (None, "BLEND"):
            if mode:
                root["materials"][0]["alphaMode"] = mode
            self.write("t.gltf", json.dumps(root))
            pixels = self.ppm("t.gltf", *SMALL, "--view", "top", "--no-ground")[2]
            darkest[mode] = min(pixels[i + 1] for i in range(0, len(pixels), 3))
        self.assertLess(darkest[None], 60)
        self.assertGreater(darkest["BLEND"], 150)

    def test_counts(self):
        fast = self.stats("render", "blend.txt", *SMALL)
        self.assertEqual((fast["width"], fast["height"], fast["evaluator"]), (64, 48, "fast"))
        self.assertGreater(fast["hits"], 300)
        self.assertGreater(fast["evaluations"]["primitive"], fast["evaluations"]["points"])
        lazy = ("render", "blend.txt", *SMALL, "--evaluator", "lazy")
        counts = [self.stats(*lazy, *more)["evaluations"] for more in (
            (), ("--no-lazy",), ("--no-lazy", "--no-bounds"), ("-j", 3))]
        self.assertEqual(counts[0], counts[3])
        self.assertLess(counts[0]["total"], counts[1]["total"])
        self.assertGreater(counts[2]["top_level"], 64 * 48)
        self.assertGreater(counts[2]["total"], counts[2]["top_level"])

    def test_refusals(self):
        for words, arguments in (
                ("no scene or mesh given", ()),
                ("no output file", ("ball.txt",)),
                ("tells no format", ("ball.txt", "-o", "x.jpg")),
                ("unknown format", ("ball.txt", "-o", "x.ppm", "-f", "glb")),
                ("--size wants", ("ball.txt", "-o", "x.ppm", "--size", "64")),
                ("--size wants", ("ball.txt", "-o", "x.ppm", "--size", "64x48x2")),
                ("--size wants", ("ball.txt", "-o", "x.ppm", "--size=-64x48")),
                ("1 to 16384 pixels", ("ball.txt", "-o", "x.ppm", "--size", "16385x1")),
                ("1 to 16384 pixels", ("ball.txt", "-o", "x.ppm", "--size", "4000000000x4000000000")),
                ("samples are from 1 to 8", ("ball.txt", "-o", "x.ppm", "--samples", "9")),
                ("angle of view", ("ball.txt", "-o", "x.ppm", "--fov", "170")),
                ("--view wants", ("ball.txt", "-o", "x.ppm", "--view", "above")),
                ("elevation", ("ball.txt", "-o", "x.ppm", "--view", "0,100")),
                ("azimuth is from", ("ball.txt", "-o", "x.ppm", "--view", "2e6,10")),
                ("--camera wants", ("ball.txt", "-o", "x.ppm", "--camera", "1,2,3")),
                ("same point", ("ball.txt", "-o", "x.ppm", "--camera", "1,2,3,1,2,3")),
                ("--background wants", ("ball.txt", "-o", "x.ppm", "--background", "#12")),
                ("--slice wants", ("ball.txt", "-o", "x.ppm", "--slice", "w=1")),
                ("--iso needs --slice", ("ball.txt", "-o", "x.ppm", "--iso", "1")),
                ("needs --evaluator lazy", ("ball.txt", "-o", "x.ppm", "--no-lazy")),
                ("at most 3600", ("ball.txt", "-o", "x.ppm", "--turntable", "3601")),
                ("not standard output", ("ball.txt", "-o", "-", "-f", "ppm", "--turntable", "3")),
                ("--view cannot", ("ball.txt", "-o", "x.ppm", "--camera", "1,2,3,0,0,0", "--view", "top")),
                ("memory", ("ball.txt", "-o", "x.ppm", "--size", "16000x16000", "--max-memory", "100M")),
                ("No such file", ("ball.txt", "-o", "nowhere/x.ppm", *SMALL))):
            with self.subTest(arguments):
                self.assert_refused(self.run_in("render", *arguments), 2, words)
                self.assert_files("ball.txt", "blend.txt")
        self.write("plane.txt", "plane([0, 0, 1]);\n")
        self.assert_refused(self.run_in("render", "plane.txt", "-o", "x.ppm"), 1, "infinity", "--bounds")
        self.write("bad.txt", "sphere(;\n")
        self.assert_refused(self.run_in("render", "bad.txt", "-o", "x.ppm"), 1, "bad.txt:1")
        self.write("bad.glb", b"glTF")
        self.assert_refused(self.run_in("render", "bad.glb", "-o", "x.ppm"), 1, "bad.glb")
        self.assert_files("ball.txt", "blend.txt", "plane.txt", "bad.txt", "bad.glb")

    def test_nothing_to_see(self):
        self.write("empty.txt", "sphere(0);\n")
        result = self.run_in("render", "empty.txt", "-o", "x.ppm", *SMALL)
        self.assert_status(result, 0)
        self.assertIn("nothing of the solid is in sight", result.stderr)
        self.assertEqual(set(read_ppm(self.read("x.ppm"))[2]), {255})
        self.assert_status(self.run_in("render", "-Werror", "empty.txt", "-o", "y.ppm", *SMALL), 1)


if __name__ == "__main__":
    cli.main()
