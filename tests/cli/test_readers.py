# SPDX-License-Identifier: MIT
"""What independent readers find in our files: docs/formats.md has the table. Each reader that is not there is skipped, with a message.

Three parts of which one is painted, one has a colour that is half transparent and one a named one: sizes in the file's unit, names, materials.
"""
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import unittest

import cli

SCENE = """
part("lid") translate([0, 0, 20]) union(blend = 2) {
  color("red") sphere(5);
  color("blue") translate([6, 0, 0]) sphere(4);
}
part("base") color([0.2, 0.5, 0.1, 0.5]) cube(8);
part("plain") color("goldenrod") material(1, 0.3) translate([30, 0, 0]) cylinder(h = 9, r = 4);
"""
HIGHEST, NAMES = (34, 8, 25), ["base", "lid", "plain"]


def needs(module):
    return unittest.skipUnless(importlib.util.find_spec(module), f"the Python package {module} is not installed")


class Readers(cli.CliTest):
    def setUp(self):
        super().setUp()
        self.write("scene.txt", SCENE)

    def file(self, name, *options):
        result = cli.run("scene.txt", "-o", name, *options, cwd=self.folder)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return os.path.join(self.folder, name)

    def near(self, found, wanted, unit=1.0):
        for a, b in zip(found, wanted):
            self.assertAlmostEqual(a / unit, b, delta=0.05)

    @unittest.skipUnless(shutil.which("assimp"), "assimp is not installed")
    def test_assimp(self):
        for name in ("a.glb", "a.obj", "a.3mf"):
            text = subprocess.run(["assimp", "info", self.file(name)], capture_output=True, check=True).stdout.decode()
            self.assertRegex(text, r"Meshes: +3", name)
            if name == "a.glb": # metres, Y up
                point = text.split("Maximum point")[1].split("(")[1].split(")")[0]
                self.near([float(x) for x in point.split()], (34, 25, 5), 0.001)
                self.assertIn("goldenrod-metal100-rough30", text)

    @needs("trimesh")
    def test_trimesh(self):
        import trimesh  # pylint: disable=import-outside-toplevel,import-error
        scene = trimesh.load(self.file("a.glb"))
        self.near(scene.bounds[1], (34, 25, 5), 0.001)
        self.assertEqual(sorted(scene.geometry), NAMES)

    @needs("lib3mf")
    def test_lib3mf_in_strict_mode(self):
        if "3mf" not in cli.formats_written():
            self.skipTest("this build has no 3MF")
        import lib3mf  # pylint: disable=import-outside-toplevel,import-error
        model = lib3mf.get_wrapper().CreateModel()
        reader = model.QueryReader("3mf")
        reader.SetStrictModeActive(True)
        reader.ReadFromFile(self.file("a.3mf", "--meta", "title=Three parts"))
        self.assertEqual(reader.GetWarningCount(), 0)
        names, objects = [], model.GetMeshObjects()
        while objects.MoveNext():
            item = objects.GetCurrentMeshObject()
            names.append(item.GetName())
            self.assertTrue(item.IsManifoldAndOriented())
        self.assertEqual(sorted(names), NAMES)
        self.assertEqual(model.GetMetaDataGroup().GetMetaDataByKey("", "Title").GetValue(), "Three parts")

    @needs("bpy")
    def test_blender(self):
        program = ("import bpy, json; bpy.ops.wm.read_factory_settings(use_empty=True); bpy.ops.import_scene.gltf(filepath='a.glb'); "
                   "print('RESULT' + json.dumps(sorted([o.name, o.data.materials[0].name, max((o.matrix_world @ v.co).z for v in o.data.vertices)]"
                   " for o in bpy.data.objects if o.type == 'MESH')))")
        self.file("a.glb")
        text = subprocess.run([sys.executable, "-c", program], cwd=self.folder, capture_output=True, check=True).stdout.decode()
        found = json.loads(text.split("RESULT")[1].splitlines()[0])
        self.assertEqual([row[0] for row in found], NAMES)
        self.assertEqual(found[2][1], "goldenrod-metal100-rough30")
        self.near([row[2] for row in found], (8, 25, 9), 0.001)


if __name__ == "__main__":
    unittest.main()
