# SPDX-License-Identifier: MIT
"""Meshes as input: csgmesh a.glb -o b.stl, csgmesh convert, and what OpenMesh makes of foreign meshes. What is kept is kept,
what is lost is said, what is changed is measured."""
import json
import math
import os
import struct
import unittest

import cli
import shading

PARTS = """part("body") color("red") cube([20, 20, 5]);
part("lid") color([0, 0.5, 1, 0.5]) translate([0, 0, 8]) sphere(r = 5);
"""


def stl(triangles):
    """A binary STL of triples of points."""
    facets = b"".join(struct.pack("<12fH", 0, 0, 0, *t[0], *t[1], *t[2], 0) for t in triangles)
    return b"\0" * 80 + struct.pack("<I", len(triangles)) + facets


def box_faces(low, high):
    """A box, turned outwards, as twelve triangles."""
    p = [(x, y, z) for z in (low[2], high[2]) for y in (low[1], high[1]) for x in (low[0], high[0])]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [(p[a], p[b], p[c]) for q in quads for a, b, c in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]


class ConvertTest(cli.CliTest):
    parts = None # parts.glb, made once for all tests

    def setUp(self):
        super().setUp()
        self.write("parts.txt", PARTS)
        if not ConvertTest.parts:
            self.mesh("parts.txt", "-o", "parts.glb", "-r", "24")
            ConvertTest.parts = self.read("parts.glb")
        self.write("parts.glb", ConvertTest.parts)

    def mesh(self, *arguments):
        result = cli.run(*arguments, cwd=self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def document(self, name):
        data = self.read(name)
        return json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])

    def glb(self, document, of):
        """The file with another document."""
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        rest = of[20 + struct.unpack("<I", of[12:16])[0]:]
        return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest

    def info(self, name):
        return json.loads(self.mesh("info", "--json", name).stdout)["mesh"]


class Converting(ConvertTest):
    def test_every_format(self):
        """Triangles always; names and colours where the format has a place for them, else a warning that says so."""
        names = {"obj", "gltf", "glb", "3mf", "amf"}
        colours = {"obj", "ply", "off", "gltf", "glb", "drc", "3mf", "amf"}
        before = self.info("parts.glb")
        for name in cli.formats_read():
            with self.subTest(name):
                target = "out." + name
                message = self.mesh("parts.glb", "-o", target).stderr
                after = self.info(target)
                self.assertEqual(after["triangles"], before["triangles"])
                self.assertEqual("the names of 2 parts (body, lid)" in message, name not in names, message)
                self.assertEqual("colours" in message and "transparent" not in message, name not in colours, message)
                self.assertNotIn("how transparent colours are", message)
                ignored = ["--ignore", "normals"] + ([] if name in names else ["--ignore", "names"]) + \
                    ([] if name in colours else ["--ignore", "colors"])
                tolerance = ["--tol", "0.01"] if name == "drc" else []
                self.mesh("diff", *cli.FEW_SAMPLES, "parts.glb", target, "-q", *ignored, *tolerance)

    def test_materials_of_obj(self):
        """Looks of parts stand in a file beside it, and come back; a part of several colours has them at its vertices."""
        self.write("a.txt", PARTS + """part("pin") color("gold") material(1, 0.25) translate([0, 0, 20]) cube(3);
part("knob") translate([40, 0, 0]) union(blend = 2) { color("lime") sphere(5); color("blue") translate([5, 0, 0]) sphere(4); }
""")
        self.mesh("a.txt", "-o", "a.glb", "-r", "24")
        self.assertEqual(self.mesh("a.glb", "-o", "a.obj").stderr, "")
        self.assertIn(b"mtllib a.mtl\n", self.read("a.obj"))
        names = [line.split()[1] for line in self.read("a.mtl").decode().splitlines() if line.startswith("newmtl")]
        self.assertEqual(names, ["red", "rgb0080FF-alpha50.2", "gold-metal100-rough25", "painted"])
        self.mesh("diff", *cli.FEW_SAMPLES, "a.glb", "a.obj", "-q", "--ignore", "normals")
        self.mesh("a.obj", "-o", "back.glb")
        self.assertEqual([m.get("pbrMetallicRoughness") for m in self.document("back.glb")["materials"]],
                         [m.get("pbrMetallicRoughness") for m in self.document("a.glb")["materials"]])

    def test_materials_of_obj_that_are_lost(self):
        self.write("a.txt", 'part("a") union(blend = 2) { color([1, 0, 0, 0.5]) cube(8); color("blue") sphere(3); }')
        self.mesh("a.txt", "-o", "a.glb", "-r", "24")
        self.assertIn("how transparent colours are", self.mesh("a.glb", "-o", "a.obj").stderr)
        self.assertFalse(os.path.exists(self.path("a.mtl"))) # it would say nothing

    def test_obj_of_others(self):
        """Their files of materials: missing, with pictures, broken, elsewhere."""
        obj = "mtllib {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl skin\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
        self.write("a b.mtl", "junk\nnewmtl skin\nKd 1 0.5 0\nPm 0.75\nTr 0.2\nmap_Kd wood.png\nKd spectral x\nnewmtl\n")
        os.mkdir(self.path("folder"))
        for name, left, colours in (("a b.mtl", "textures", True), ("missing.mtl", "materials (their file is not there)", False),
                                    ("../a b.mtl", "materials (their file is not there)", False),
                                    ("folder", "materials (their file is not there)", False)):
            self.write("a.obj", obj.format(name))
            message = self.mesh("a.obj", "-o", "a.glb").stderr
            self.assertEqual(message, f"csgmesh: warning: a.glb: lost, since it is not read: {left}\n")
            self.assertEqual(self.info("a.glb")["colors"], colours)
        self.write("a.obj", obj.format("a b.mtl"))
        self.mesh("a.obj", "-o", "a.glb")
        self.assertEqual(self.document("a.glb")["materials"][0]["pbrMetallicRoughness"],
                         {"baseColorFactor": [1, 0.215861, 0, 0.8], "metallicFactor": 0.75, "roughnessFactor": 0.6})

    def test_parts_that_share_vertices(self):
        """What repeats within one of them is not moved about under the other one."""
        places = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        lines = [f"v {x} {y} {z}" for x, y, z in places + [(x + 5, y, z) for x, y, z in reversed(places)]]
        faces = [(1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4)]
        moved = [tuple(9 - i for i in face) for face in faces]
        lines += ["o a"] + ["f %d %d %d" % face for face in faces + moved] + ["o b"] + ["f %d %d %d" % (9, *face[1:]) for face in moved if face[0] == 8]
        lines.insert(8, "v 5 -1 -1")
        self.write("shared.obj", "\n".join(lines) + "\n")
        self.mesh("shared.obj", "-o", "shared.glb")
        self.mesh("diff", *cli.FEW_SAMPLES, "shared.obj", "shared.glb", "-q", "--ignore", "normals")

    def test_units(self):
        """Ours keep their numbers and their unit; those of others become millimetres."""
        self.write("a.txt", "cube(2);")
        formats = [name for name in ("glb", "gltf", "3mf", "amf") if name in cli.formats_read()]
        for name in formats:
            self.mesh("a.txt", "-o", "a." + name, "--unit", "in")
            for other in formats:
                self.assertEqual(self.mesh("a." + name, "-o", "b." + other).stderr, "")
                self.mesh("b." + other, "-o", "c.glb")
                self.assertEqual(self.document("c.glb")["asset"]["extras"]["unit"], "in", (name, other))
                self.assertEqual(self.info("c.glb")["bounds"], [[0, 0, 0], [2, 2, 2]])
            self.assertIn("STL has no place for the unit (inch)", self.mesh("a." + name, "-o", "a.stl").stderr)
        self.write("b.amf", self.read("a.amf").replace(b"csgmesh", b"another"))
        self.assertAlmostEqual(self.info("b.amf")["bounds"][1][0], 50.8, places=5)
        self.mesh("b.amf", "-o", "c.glb")
        self.assertEqual(self.document("c.glb")["asset"]["extras"]["unit"], "mm")

    def test_what_is_not_read_is_said(self):
        document = self.document("parts.glb")
        document["asset"] = {"version": "2.0", "copyright": "somebody"}
        document.update(textures=[{}, {}], animations=[{}], skins=[{"joints": [0]}], cameras=[{}])
        self.write("foreign.glb", self.glb(document, self.read("parts.glb")))
        message = self.mesh("foreign.glb", "-o", "a.stl").stderr
        self.assertEqual(message, "csgmesh: warning: a.stl: STL has no place for the names of 2 parts (body, lid), colours"
                         "; not read: 2 textures, 1 animation, 1 skin, 1 camera, metadata\n")
        self.assertEqual(cli.run("foreign.glb", "-o", "b.glb", "-Werror", cwd=self.folder).returncode, 1)

    def test_werror_keeps_what_would_be_lost(self):
        result = cli.run("convert", "parts.glb", "-o", "a.stl", "-Werror", cwd=self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertFalse(os.path.exists(self.path("a.stl")))

    def test_colors_none(self):
        self.assertEqual(self.mesh("convert", "parts.glb", "-o", "a.3mf", "--colors", "none").stderr, "")
        self.assertFalse(self.info("a.3mf")["colors"])

    def test_to_a_folder(self):
        self.write("box.stl", stl(box_faces((0, 0, 0), (1, 2, 3))))
        self.mesh("convert", "parts.glb", "box.stl", "-d", "out", "-f", "ply")
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["box.ply", "parts.ply"])
        self.assertEqual(self.info("out/box.ply")["triangles"], 12)

    def test_one_that_fails_does_not_stop_the_others(self):
        self.write("broken.stl", b"solid nothing")
        self.write("box.stl", stl(box_faces((0, 0, 0), (1, 2, 3))))
        result = cli.run("convert", "broken.stl", "box.stl", "-d", "out", "-f", "off", cwd=self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(os.listdir(self.path("out")), ["box.off"])

    def test_usage(self):
        self.write("box.stl", stl(box_faces((0, 0, 0), (1, 2, 3))))
        os.mkdir(self.path("other"))
        self.write("other/box.stl", stl(box_faces((0, 0, 0), (1, 2, 3))))
        for arguments, message in (
                (["box.stl"], "no output file"),
                ([], "no mesh given"),
                (["box.stl", "parts.glb", "-o", "a.stl"], "several meshes need -d"),
                (["box.stl", "-d", "out"], "-d needs -f"),
                (["box.stl", "-d", "out", "-o", "a.ply"], "give one"),
                (["box.stl", "other/box.stl", "-d", "out", "-f", "ply"], "would both become out/box.ply"),
                (["other/box.stl", "-d", "other", "-f", "stl"], "would overwrite"),
                (["box.stl", "-o", "box.stl"], "would overwrite"),
                (["box.stl", "-o", "a.svg"], "no outlines"),
                (["box.stl", "-o", "a.ply", "--simplify", "1", "--triangles", "5"], "give one"),
                (["box.stl", "-o", "a.ply", "-r", "5"], "-r"),
                (["box.stl", "-o", "a.ply", "--smooth", "0"], "whole number")):
            with self.subTest(arguments):
                result = cli.run("convert", *arguments, cwd=self.folder)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(message, result.stderr)

    def test_options_of_scenes_have_no_effect(self):
        message = self.mesh("parts.glb", "-o", "a.3mf", "-r", "5", "--normals", "none").stderr
        self.assertIn("--resolution has no effect on a mesh", message)
        self.assertIn("--normals has no effect on a mesh", message)

    def test_smooth_is_for_meshes(self):
        result = cli.run("parts.txt", "-o", "a.stl", "--smooth", "2", cwd=self.folder)
        self.assertEqual(result.returncode, 2)
        self.assertIn("--smooth is for meshes", result.stderr)

    def test_a_mesh_where_a_scene_is_wanted(self):
        """Nothing says that it is no text file, whatever its name is."""
        self.write("renamed", self.read("parts.glb"))
        for command in (["check"], ["eval", "--at", "0,0,0"], ["deps"], ["dump", "--scene"], ["params"]):
            for name in ("parts.glb", "renamed"):
                with self.subTest(command=command, name=name):
                    result = cli.run(*command, name, cwd=self.folder)
                    self.assertEqual(result.returncode, 1)
                    self.assertIn(f"{name} is a mesh, not a scene", result.stderr)
                    self.assertIn("import(", result.stderr)
        self.mesh("renamed", "-o", "b.ply")
        self.assertEqual(self.info("b.ply")["triangles"], self.info("parts.glb")["triangles"])
        result = cli.run("-", "-o", "c.ply", cwd=self.folder, stdin=self.read("parts.glb"))
        self.assertEqual(result.returncode, 1)
        self.assertIn("standard input is a mesh", result.stderr)

    @unittest.skipUnless(cli.has_library("OpenMesh"), "this build has no OpenMesh")
    def test_limits(self):
        self.mesh("parts.txt", "-o", "fine.ply", "-r", "36")
        for option, message in ((["--timeout", "1e-9"], "more than 1e-09 s"), (["--max-memory", "300K"], "memory")):
            with self.subTest(option):
                result = cli.run("convert", "fine.ply", "-o", "b.stl", "--simplify", "10%", *option, cwd=self.folder)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(message, result.stderr)
                self.assertFalse(os.path.exists(self.path("b.stl")))


@unittest.skipUnless(cli.has_library("OpenMesh"), "this build has no OpenMesh")
class Reshaping(ConvertTest):
    def convert(self, source, target, *options):
        """What --stats says of it."""
        result = self.mesh("convert", source, "-o", target, "--stats=stats.json", *options)
        one, = json.loads(self.read("stats.json"))["conversions"]
        return one, result.stderr

    def closed(self, facts):
        return facts["boundary_edges"] == facts["nonmanifold_edges"] == facts["misoriented_edges"] == 0

    @cli.optimised_only
    def test_flat_faces_stay_flat(self):
        """Shaded by angles alone, faces between roundings tilt by 8 degrees at their corners."""
        self.write("scene.txt", "cube([30, 20, 10], round = 1);")
        self.assert_status(cli.run("scene.txt", "-q", "-r", "64", "-o", "in.glb", cwd=self.folder), 0)
        self.assert_status(cli.run("convert", "in.glb", "-q", "--simplify", "0.02", "-o", "out.obj", cwd=self.folder), 0)
        count, tilt = shading.tilt_of_large_faces(self.path("out.obj"), 15)
        self.assertGreater(count, 10)
        self.assertLess(tilt, 3)

    def test_simplify_within(self):
        self.mesh("parts.txt", "-o", "fine.glb", "-r", "36")
        one, message = self.convert("fine.glb", "b.glb", "--simplify", "0.05")
        self.assertLess(one["triangles"], one["triangles_read"] / 4)
        self.assertLessEqual(one["distance"][1], 0.05)
        self.assertIn("(proven)", message)
        self.assertTrue(self.closed(one), one)
        self.mesh("diff", *cli.FEW_SAMPLES, "fine.glb", "b.glb", "--tol", "0.05", "--ignore", "normals", "-q")

    @cli.optimised_only
    def test_share_and_count(self):
        self.mesh("parts.txt", "-o", "fine.ply", "-r", "60")  # of -r 60 diff once did not end
        have = self.info("fine.ply")["triangles"]
        for option, most in ((["--simplify", "10%"], have // 10), (["--triangles", "500"], 500)):
            with self.subTest(option):
                one, _ = self.convert("fine.ply", "b.ply", *option)
                self.assertLessEqual(one["triangles"], most)
                self.assertGreater(one["triangles"], 0.9 * most)
                self.assertTrue(self.closed(one), one)
                self.assertLess(one["distance"][1], 0.5)

    def test_names_and_colours_stay(self):
        one, _ = self.convert("parts.glb", "b.glb", "--simplify", "20%")
        self.assertTrue(self.closed(one), one)
        document = self.read("b.glb")
        self.assertIn(b'"body"', document)
        self.assertIn(b'"lid"', document)
        result = cli.run("diff", *cli.FEW_SAMPLES, "parts.glb", "b.glb", "--tol", "2", cwd=self.folder)
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_colours_that_jump_stay_where_they_jump(self):
        """A cube of many triangles, half red and half blue, whose colours share no vertex: the line between stays."""
        lines, faces, n = [], [], 8

        def vertex(p, colour):
            lines.append("%g %g %g %d %d %d 255" % (*p, *colour))
            return len(lines) - 1

        for axis in range(3):
            for side in (0, n):
                for i in range(n):
                    for j in range(n):
                        quad = []
                        for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                            p = [0, 0, 0]
                            p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, a, b
                            quad.append(p)
                        if not side:
                            quad.reverse()
                        middle = sum(p[0] for p in quad) / 4
                        colour = (255, 0, 0) if middle < n / 2 else (0, 0, 255)
                        v = [vertex(p, colour) for p in quad]
                        faces += [(v[0], v[1], v[2]), (v[0], v[2], v[3])]
        self.write("cube.off", "COFF\n%d %d 0\n%s\n%s\n" % (len(lines), len(faces), "\n".join(lines),
                                                            "\n".join("3 %d %d %d" % f for f in faces)))
        one, _ = self.convert("cube.off", "b.off", "--simplify", "0.01")
        self.assertLessEqual(one["triangles"], 40)
        rows = self.read("b.off").decode().split("\n")
        count = int(rows[1].split()[0])
        for row in rows[2:2 + count]:
            x, _, _, red, green, blue = (float(word) for word in row.split()[:6])
            scale = 1 if max(red, green, blue) <= 1 else 255
            self.assertEqual((red / scale, green / scale, blue / scale) in ((1, 0, 0), (0, 0, 1)), True, row)
            if x < n / 2:
                self.assertEqual(red / scale, 1, row)
            if x > n / 2:
                self.assertEqual(blue / scale, 1, row)

    def test_holes_are_filled(self):
        self.write("open.stl", stl(box_faces((0, 0, 0), (1, 2, 3))[:-1]))
        one, message = self.convert("open.stl", "b.off", "--simplify", "0.001")
        self.assertIn("1 hole filled", message)
        self.assertTrue(self.closed(one), one)
        self.assertAlmostEqual(one["volume"], 6)
        self.assertEqual(one["distance"][1], 0)

    def test_boxes_that_share_an_edge(self):
        """Four triangles at an edge, which no half-edge mesh holds as they are."""
        two = box_faces((0, 0, 0), (1, 1, 1)) + box_faces((1, 1, 0), (2, 2, 1))
        self.write("two.stl", stl(two))
        one, _ = self.convert("two.stl", "b.stl", "--simplify", "0.001", "--improve")
        self.assertAlmostEqual(one["volume"], 2, places=6)
        self.assertEqual(one["triangles"], 24)
        self.assertLessEqual(one["distance"][1], 0.001)

    def test_what_encloses_nothing_is_left(self):
        self.write("sheet.stl", stl([((0, 0, 0), (1, 0, 0), (0, 1, 0)), ((1, 0, 0), (1, 1, 0), (0, 1, 0))]))
        one, message = self.convert("sheet.stl", "b.stl", "--simplify", "50%")
        self.assertIn("enclose nothing and were left as they are", message)
        self.assertEqual(one["triangles"], 2)

    def test_improve(self):
        """Needles of a sliced torus go; it stays within a thousandth of its size, and no angle becomes smaller."""
        points = []
        steps, turns = 360, 24
        for i in range(steps):
            for k in range(turns):
                a, b = 2 * math.pi * i / steps, 2 * math.pi * k / turns
                radius = 10 + 4 * math.cos(b)
                points.append((radius * math.cos(a), radius * math.sin(a), 4 * math.sin(b)))
        faces = []
        for i in range(steps):
            for k in range(turns):
                p = [i * turns + k, (i + 1) % steps * turns + k, (i + 1) % steps * turns + (k + 1) % turns,
                     i * turns + (k + 1) % turns]
                faces += [(p[0], p[1], p[2]), (p[0], p[2], p[3])]
        self.write("torus.stl", stl([tuple(points[v] for v in f) for f in faces]))
        before = self.info("torus.stl")
        one, _ = self.convert("torus.stl", "b.stl", "--improve")
        self.assertGreater(one["min_angle_deg"], 1.5 * before["min_angle_deg"])
        self.assertLessEqual(one["distance"][1], 28 / 1000)
        self.assertTrue(self.closed(one), one)

    def test_smooth(self):
        """A ball whose vertices shake comes nearer to the ball, and keeps its volume."""
        self.write("ball.txt", "sphere(r = 10);\n")
        self.mesh("ball.txt", "-o", "ball.off", "-r", "20")
        rows = self.read("ball.off").decode().split("\n")
        count = int(rows[1].split()[0])

        def spread(lines):
            away = [abs(math.dist((0, 0, 0), tuple(map(float, row.split()[:3]))) - 10) for row in lines]
            return sum(away) / len(away)

        shaken = []
        for i, row in enumerate(rows[2:2 + count]):
            p = [float(word) for word in row.split()[:3]]
            scale = 1 + 0.02 * math.sin(12.9898 * i * i + 78.233)
            shaken.append(" ".join("%.6g" % (c * scale) for c in p))
        body = [row for row in rows[2 + count:] if row]
        self.write("shaken.off", "OFF\n%d %d 0\n%s\n" % (count, len(body), "\n".join(shaken + body)))
        one, _ = self.convert("shaken.off", "b.off", "--smooth", "8")
        smooth = self.read("b.off").decode().split("\n")
        after = [row for row in smooth[2:2 + one["vertices"]]]
        self.assertLess(spread(after), 0.5 * spread(shaken))
        self.assertAlmostEqual(one["volume"], 4 / 3 * math.pi * 1000, delta=60)
        self.assertGreater(one["distance"][1], 0)

    def test_same_bytes(self):
        self.convert("parts.glb", "a.glb", "--smooth", "1", "--simplify", "0.1", "--improve", "-j", "1")
        self.convert("parts.glb", "b.glb", "--smooth", "1", "--simplify", "0.1", "--improve", "-j", "4")
        self.assertEqual(self.read("a.glb"), self.read("b.glb"))

    def test_changed_again_it_stays(self):
        """What was thinned out within E has nothing left to be thinned out at E / 1000."""
        self.convert("parts.glb", "a.ply", "--simplify", "0.1", "--colors", "none")
        one, _ = self.convert("a.ply", "b.ply", "--simplify", "0.00001")
        self.assertGreater(one["triangles"], 0.9 * one["triangles_read"])


if __name__ == "__main__":
    unittest.main()
