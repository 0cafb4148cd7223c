# SPDX-License-Identifier: MIT
"""part() and material(): what becomes of them in every format that knows such things."""
import json
import re
import struct
import unittest
import xml.etree.ElementTree as xml
import zipfile

import cli

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
MATERIAL = "{http://schemas.microsoft.com/3dmanufacturing/material/2015/02}"

SCENE = """
sphere(3);
part("lid & <cap>") color("red") translate([0, 0, 12]) cylinder(h = 2, r = 10);
part("box") material(metallic = 1, roughness = 0.25) difference() {
  cylinder(h = 10, r = 10);
  translate([0, 0, 1]) cylinder(h = 10, r = 8);
}
"""
BLENDED = """union(blend = 2) {
  material(metallic = 1, roughness = 0.1) sphere(3);
  color("blue", alpha = 0.5) translate([4, 0, 0]) sphere(3);
}
"""


def glb_document(data):
    length = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[20:20 + length]), data[20 + length + 8:]


def vertices_of(element):
    return [tuple(float(v.get(axis)) for axis in "xyz") for v in element.iter(CORE + "vertex")]


class PartsTest(cli.CliTest):
    def mesh(self, text, name, *options):
        self.write("scene.txt", text)
        result = cli.run("scene.txt", "-o", name, "-r", 40, *options, cwd=self.folder)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return self.read(name)

    def check_closed(self, name):
        if name.endswith(".glb") and not cli.has_library("tinygltf"):
            self.skipTest("this build cannot read glTF")
        text = cli.run("info", name, cwd=self.folder).stdout.decode()
        self.assertIn("closed       yes", text)
        return text

    def test_gltf_has_a_node_and_mesh_for_each(self):
        document, _ = glb_document(self.mesh(SCENE, "a.glb"))
        nodes = document["nodes"]
        self.assertEqual(nodes[0]["children"], [1, 2, 3])
        self.assertEqual([n.get("name") for n in nodes], [None, None, "lid & <cap>", "box"])
        self.assertEqual([m.get("name") for m in document["meshes"]],
                         [None, "lid & <cap>", "box"])
        factors = [m["pbrMetallicRoughness"] for m in document["materials"]]
        self.assertEqual([(f["metallicFactor"], f["roughnessFactor"]) for f in factors],
                         [(0, 0.6), (0, 0.6), (1, 0.25)])
        self.assertEqual([m["name"] for m in document["materials"]],
                         ["#C7C7CC", "red", "#C7C7CC-metal100-rough25"])
        self.assertEqual(factors[1]["baseColorFactor"], [1, 0, 0, 1])
        self.assertEqual(document["asset"]["extras"]["unit"], "mm")
        self.assertFalse([m for m in document["meshes"] if "COLOR_0" in m["primitives"][0]["attributes"]])
        used = [m["primitives"][0]["material"] for m in document["meshes"]]
        self.assertEqual(used, [0, 1, 2])
        self.assertIn("components   3", self.check_closed("a.glb"))

    def test_every_part_is_closed_by_itself(self):
        self.mesh(SCENE, "a.obj")
        vertices, parts = [], {}
        for line in self.read("a.obj").decode().splitlines():
            word, *rest = line.split(" ")
            if word == "v":
                vertices.append(rest)
            elif word == "o":
                name = line[2:]
            elif word == "f":
                parts.setdefault(name if "name" in locals() else None, []).append(
                    [int(corner.split("/")[0]) for corner in rest])
        self.assertEqual(list(parts), [None, "lid & <cap>", "box"])
        seen = set()
        for faces in parts.values():
            edges = {(f[i], f[(i + 1) % 3]) for f in faces for i in range(3)}
            self.assertEqual(len(edges), 3 * len(faces))
            self.assertTrue(all((b, a) in edges for a, b in edges))
            corners = {c for f in faces for c in f}
            self.assertFalse(corners & seen)
            seen |= corners

    def test_3mf_is_a_sound_package(self):
        if "3mf" not in cli.formats_written():
            self.skipTest("this build has no 3MF")
        self.mesh(SCENE, "a.3mf", "--unit", "cm")
        with zipfile.ZipFile(self.path("a.3mf")) as package:
            self.assertIsNone(package.testzip())
            self.assertEqual(package.namelist(),
                             ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"])
            for entry in package.infolist():
                self.assertEqual(entry.date_time, (1980, 1, 1, 0, 0, 0))
            for name in package.namelist():
                xml.fromstring(package.read(name))
            model = xml.fromstring(package.read("3D/3dmodel.model"))
        self.assertEqual((model.tag, model.get("unit")), (CORE + "model", "centimeter"))
        ids = [e.get("id") for e in model.find(CORE + "resources")]
        self.assertEqual(len(ids), len(set(ids)))
        objects = model.findall(f"{CORE}resources/{CORE}object")
        self.assertEqual([o.get("name") for o in objects], [None, "lid & <cap>", "box"])
        items = [i.get("objectid") for i in model.findall(f"{CORE}build/{CORE}item")]
        self.assertEqual(items, [o.get("id") for o in objects])
        # parts of one colour name a base material once; metallic and roughness stand in its name
        bases = model.find(f"{CORE}resources/{CORE}basematerials")
        group = model.find(f"{CORE}resources/{MATERIAL}colorgroup")
        looks = [(b.get("name"), b.get("displaycolor")) for b in bases]
        for item in objects:
            count = len(vertices_of(item))
            painted = group is not None and item.get("pid") == group.get("id")
            self.assertTrue(painted or item.get("pid") == bases.get("id"))
            for triangle in item.iter(CORE + "triangle"):
                corners = [int(triangle.get(v)) for v in ("v1", "v2", "v3")]
                self.assertEqual(len(set(corners)), 3)
                self.assertLess(max(corners), count)
                self.assertEqual(painted, triangle.get("p1") is not None)
                self.assertTrue(all(int(triangle.get(p, 0)) < len(group or ()) + 1 for p in ("p1", "p2", "p3")))
        self.assertEqual(looks[int(objects[1].get("pindex"))], ("red", "#FF0000FF"))
        self.assertIn("metal100-rough25", looks[int(objects[2].get("pindex"))][0])
        self.check_closed("a.3mf")

    def test_3mf_units(self):
        if "3mf" not in cli.formats_written():
            self.skipTest("this build has no 3MF")
        for unit, name in (("none", "millimeter"), ("mm", "millimeter"), ("m", "meter"),
                           ("in", "inch")):
            self.mesh("sphere(1);", "a.3mf", "--unit", unit)
            with zipfile.ZipFile(self.path("a.3mf")) as package:
                text = package.read("3D/3dmodel.model").decode()
            self.assertIn(f'<model unit="{name}"', text)

    def test_amf_objects(self):
        """An object with its name for each part, and lengths in a unit that AMF has."""
        for unit, name, factor in (("none", "millimeter", 1), ("cm", "millimeter", 10), ("in", "inch", 1)):
            self.mesh(SCENE, "a.amf", "--unit", unit)
            self.mesh(SCENE, "a.ply")
            root = xml.fromstring(self.read("a.amf"))
            self.assertEqual((root.tag, root.get("unit")), ("amf", name))
            names = [o.findtext("metadata[@type='name']") for o in root.findall("object")]
            self.assertEqual(names, [None, "lid & <cap>", "box"])
            for item in root.findall("object"):
                count = len(item.findall("mesh/vertices/vertex"))
                for triangle in item.findall("mesh/volume/triangle"):
                    self.assertLess(max(int(c.text) for c in triangle), count)
            if "amf" in cli.formats_read():
                sizes = [self.info(f"a.{end}")["mesh"]["bounds"] for end in ("amf", "ply")]
                for a, b in zip(sum(sizes[0], []), sum(sizes[1], [])):
                    self.assertAlmostEqual(a, b * factor, delta=1e-5)

    def test_amf_of_others(self):
        """Instances in their places, a vertex's colour before its object's, archives."""
        if "amf" not in cli.formats_read():
            self.skipTest("this build reads no AMF")
        corners = ["<x>0</x><y>0</y><z>0</z>", "<x>1</x><y>0</y><z>0</z>", "<x>0</x><y>2</y><z>0</z>",
                   "<x>0</x><y>0</y><z>3</z>"]
        vertices = "".join(f"<vertex><coordinates>{c}</coordinates></vertex>" for c in corners)
        faces = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
        volume = "".join(f"<triangle><v1>{a}</v1><v2>{b}</v2><v3>{c}</v3></triangle>" for a, b, c in faces)
        wedge = (f"<object id='7'><color><r>0</r><g>1</g><b>0</b></color><mesh><vertices>{vertices}</vertices>"
                 f"<volume materialid='3'>{volume}</volume></mesh></object>")
        self.write("plain.amf", f"<amf>{wedge}</amf>")
        mesh = self.info("plain.amf")["mesh"]
        self.assertEqual((mesh["volume"], mesh["bounds"]), (1, [[0, 0, 0], [1, 2, 3]]))
        placed = (f"<amf><material id='3'><color><r>1</r></color></material>{wedge}<constellation id='1'>"
                  "<instance objectid='7'><deltax>10</deltax><rz>90</rz></instance>"
                  "<instance objectid='7'><rx>180</rx><deltaz>-5</deltaz></instance></constellation></amf>")
        with zipfile.ZipFile(self.path("zipped.amf"), "w", zipfile.ZIP_DEFLATED) as package:
            package.writestr("model.amf", placed)
        mesh = self.info("zipped.amf")["mesh"]
        self.assertEqual((round(mesh["volume"], 6), mesh["components"], mesh["manifold"]), (2, 2, True))
        for bound, wanted in zip(sum(mesh["bounds"], []), (0, -2, -8, 10, 1, 3)):
            self.assertAlmostEqual(bound, wanted, places=6)
        self.mesh('import("plain.amf");', "again.ply", "-r", "32")
        self.assertAlmostEqual(self.info("again.ply")["mesh"]["volume"], 1, places=2)

    def test_levels_say_how_near_they_are(self):
        """Of all parts together; error is a bound where it is proven."""
        self.mesh('part("a") sphere(5); part("b") translate([20, 0, 0]) cylinder(h = 9, r = 3);', "a.glb", "--lod", "3", "-e", "0.1")
        document, _ = glb_document(self.read("a.glb"))
        ids = next(node for node in document["nodes"] if "MSFT_lod" in node.get("extensions", {}))["extensions"]["MSFT_lod"]["ids"]
        for i, tolerance in zip(ids, (0.4, 1.6), strict=True):
            extras = document["nodes"][i]["extras"]
            self.assertTrue(extras["proven"])
            self.assertGreater(extras["measured"], 0)
            self.assertLess(extras["measured"], extras["error"] * (1 + 1e-9))
            self.assertLess(extras["error"], tolerance * (1 + 1e-9))

    def test_what_repeats_is_one_mesh(self):
        """Also where cells lie otherwise in each, so that faces are cut otherwise into triangles; not where something else differs."""
        cubes = "for (i = [0 : 19]) translate([10 * i, 0, 0]) cube(5);"
        for text, meshes, nodes, wanted in ((cubes, 1, 20, 2500), ("for (i = [0 : 9]) translate([i, 3 * i, 0]) cube(2);", 1, 10, 80),
                                            ("for (i = [0 : 3]) translate([10 * i, 0, 0]) color([i / 3, 0, 0]) cube(5);", 1, 1, 500),
                                            ("for (i = [0 : 3]) translate([10 * i, 0, 0]) rotate(90 * i) cube([5, 4, 3], center = true);", 2, 4, 240)):
            self.write("scene.txt", text)
            self.assertEqual(cli.run("scene.txt", "-o", "a.glb", "-o", "a.ply", cwd=self.folder).returncode, 0)
            document, _ = glb_document(self.read("a.glb"))
            self.assertEqual(len(document["meshes"]), meshes, text)
            self.assertEqual(sum("mesh" in node for node in document["nodes"]), nodes, text)
            if not cli.has_library("tinygltf"):
                continue
            a, b = (json.loads(cli.run("info", "--json", name, cwd=self.folder).stdout)["mesh"] for name in ("a.glb", "a.ply"))
            for key in ("triangles", "bounds", "components", "manifold"):
                self.assertEqual(a[key], b[key], (text, key))
            self.assertAlmostEqual(a["volume"], wanted, delta=1e-3)
            self.assertAlmostEqual(b["volume"], wanted, delta=1e-3)

    def test_other_formats_hold_all_parts(self):
        for name in ("a.stl", "a.ply", "a.off"):
            self.mesh(SCENE, name)
            self.assertIn("components   3", self.check_closed(name))

    def test_one_part_alone_is_the_scene(self):
        solid = 'translate([1, 2, 3]) difference() { cube(4); sphere(3); }\n'
        for name in ("a.ply", "a.stl"):
            plain = self.mesh(solid, name)
            self.assertEqual(self.mesh('part("x") ' + solid, name), plain)
        plain, _ = glb_document(self.mesh(solid, "a.glb"))
        named, _ = glb_document(self.mesh('part("x") ' + solid, "a.glb"))
        self.assertEqual(named["nodes"][0].pop("name"), "x")
        self.assertEqual(named["meshes"][0].pop("name"), "x")
        # of equal cells, only a part is known as a whole and says that it is a manifold
        self.assertEqual(named["meshes"][0].pop("extensions").keys(), {"EXT_mesh_manifold"})
        for key in ("nodes", "meshes", "materials"):
            self.assertEqual(named[key], plain[key])
        self.assertEqual(named["accessors"][:len(plain["accessors"])], plain["accessors"])

    def test_parts_of_one_name_are_one(self):
        document, _ = glb_document(self.mesh(
            'for (i = [0 : 3]) translate([3 * i, 0, 0]) part("bolt") sphere(1);', "a.glb"))
        self.assertEqual([n.get("name") for n in document["nodes"]], ["bolt"])
        self.assertIn("components   4", self.check_closed("a.glb"))

    def test_parts_may_touch_and_overlap(self):
        text = 'part("a") cube(2); part("b") translate([2, 0, 0]) cube(2); part("c") cube(1);'
        self.write("scene.txt", text)
        result = cli.run("scene.txt", "-o", "a.glb", "-r", 30, "--stats", cwd=self.folder)
        self.assertEqual(result.returncode, 0)
        stats = json.loads(result.stdout)
        self.assertEqual(stats["mesh"]["components"], 3)
        self.assertAlmostEqual(stats["mesh"]["volume"], 17, delta=0.2)
        self.assertLess(stats["quality"]["max_abs_field"], 1e-4)

    def test_operands_are_no_parts(self):
        for text in ('difference() { sphere(2); part("hole") sphere(1); }',
                     'union(blend = 1) { sphere(2); part("knob") translate([2, 0, 0]) sphere(1); }',
                     'part("outer") { sphere(2); part("inner") translate([4, 0, 0]) sphere(1); }'):
            self.write("scene.txt", text)
            result = cli.run("scene.txt", "-o", "a.glb", cwd=self.folder)
            self.assertEqual(result.returncode, 0)
            self.assertEqual(result.stderr.count("W0334"), 1, result.stderr)
            document, _ = glb_document(self.read("a.glb"))
            self.assertEqual(len(document["meshes"]), 1)
            refused = cli.run("scene.txt", "-o", "b.glb", "-Werror", cwd=self.folder)
            self.assertEqual(refused.returncode, 1)

    def test_materials_and_alpha_blend(self):
        document, data = glb_document(self.mesh(BLENDED, "a.glb"))
        material, = document["materials"]
        self.assertEqual(material["alphaMode"], "BLEND")
        self.assertEqual(material["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"], 0)
        primitive = document["meshes"][0]["primitives"][0]
        accessor = document["accessors"][primitive["attributes"]["TEXCOORD_0"]]
        view = document["bufferViews"][accessor["bufferView"]]
        raw = data[view["byteOffset"]:view["byteOffset"] + 4 * accessor["count"]]
        pairs = [((u / 65535 - 0.25) * 2, (v / 65535 - 0.25) * 2)
                 for u, v in struct.iter_unpack("<HH", raw)]
        self.assertAlmostEqual(max(u for u, _ in pairs), 1, delta=1e-4)
        self.assertAlmostEqual(min(u for u, _ in pairs), 0, delta=1e-4)
        self.assertTrue(any(0.2 < u < 0.8 for u, _ in pairs))
        for u, v in pairs:  # mixed in one proportion
            self.assertAlmostEqual(v, 0.6 - 0.5 * u, delta=1e-3)
        image = document["bufferViews"][document["images"][0]["bufferView"]]
        start = image["byteOffset"]
        self.assertEqual(data[start:start + 4], b"\x89PNG")

    def test_no_colors_no_materials(self):
        document, _ = glb_document(self.mesh(BLENDED, "a.glb", "--colors", "none"))
        self.assertEqual(set(document["meshes"][0]["primitives"][0]["attributes"]),
                         {"POSITION", "NORMAL"})
        self.assertNotIn("textures", document)

    def test_same_bytes_for_any_threads(self):
        names = [n for n in ("a.glb", "a.3mf", "a.obj") if n[2:] in cli.formats_written()]
        for name in names:
            bytes_of = {self.mesh(SCENE, name, "-j", threads) for threads in (1, 2, 5)}
            self.assertEqual(len(bytes_of), 1, name)
            unpruned = self.mesh(SCENE, name, "--no-prune")
            self.assertEqual({unpruned}, bytes_of)

    def test_bad_arguments(self):
        for text, message in (("part() sphere(1);", "needs a name"),
                              ("part(3) sphere(1);", "needs a name"),
                              ('part("") sphere(1);', "needs a name"),
                              ("material(metallic = 2) sphere(1);", "metallic"),
                              ("material(roughness = -1) sphere(1);", "roughness")):
            self.write("scene.txt", text)
            result = cli.run("scene.txt", "-o", "a.glb", cwd=self.folder)
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, re.escape(message))

    def test_print_parses_back(self):
        self.write("scene.txt", 'part("a\\"b\\\\\\n") color("red") material(0.3, 0.7) sphere(1);'
                                'part("b") cube(1);')
        first = cli.run("dump", "--scene", "scene.txt", cwd=self.folder).stdout
        self.write("again.txt", first)
        second = cli.run("dump", "--scene", "again.txt", cwd=self.folder)
        self.assertEqual((second.stdout, second.stderr), (first, ""))
        self.assertIn(b"material(metallic = 0.3, roughness = 0.7)", first)

    def test_an_empty_part_is_told(self):
        self.write("scene.txt", 'part("dust") sphere(0.0001); part("b") cube(10);')
        result = cli.run("scene.txt", "-o", "a.glb", "-r", 20, cwd=self.folder)
        self.assertEqual(result.returncode, 0)
        self.assertIn('no surface of the part "dust" was found', result.stderr)
        document, _ = glb_document(self.read("a.glb"))
        self.assertEqual([m["name"] for m in document["meshes"]], ["b"])


if __name__ == "__main__":
    unittest.main()
