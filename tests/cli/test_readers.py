# SPDX-License-Identifier: MIT
"""What independent readers find in our files: each row of the table of docs/formats.md is measured anew, where its reader is installed.

Python packages are those of this interpreter (PYTHONPATH), three.js and draco3d those of the folder CSGMESH_NODE_MODULES, or what `npm ci` in tests/io puts there;
without one of them its test is skipped, with a message. `test_readers.py --table` prints the rows as they are measured.
"""
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree

import cli

HERE = os.path.dirname(os.path.abspath(__file__))
PAGE = os.path.join(HERE, "..", "..", "docs", "formats.md")
NODE_MODULES = os.environ.get("CSGMESH_NODE_MODULES", os.path.join(HERE, "..", "io", "node_modules"))
SCENE = """
part("lid") translate([0, 0, 20]) union(blend = 2) {
  color("red") sphere(5);
  color("blue") translate([6, 0, 0]) sphere(4);
}
part("base") color([0.2, 0.5, 0.1, 0.5]) cube(8);
part("plain") color("goldenrod") material(1, 0.3) translate([30, 0, 0]) cylinder(h = 9, r = 4);
part("row") color("gray") for (i = [0 : 3]) translate([6 * i, -20, 0]) cube(4);
"""
SIZE, NAMES, TITLE, GOLD = (39, 28, 25), {"lid", "base", "plain", "row"}, "Three parts", ("0.85490[0-9]", "0.64705[0-9]", "0.12549[0-9]")
COLUMNS = ("positions", "normals", "colours", "materials", "names", "unit", "instances", "levels", "metadata")
GLTF = set(COLUMNS) - {"levels"}
FORMATS = { # file, options, and what such a file has
    "STL": ("a.stl", (), {"positions"}),
    "PLY": ("a.ply", (), {"positions", "normals", "colours"}),
    "OFF": ("a.off", (), {"positions", "normals", "colours"}),
    "OFF, `--colors none --normals none`": ("plain.off", ("--colors", "none", "--normals", "none"), {"positions"}),
    "OBJ": ("a.obj", (), {"positions", "normals", "colours", "materials", "names"}),
    "OBJ, `--normals none`": ("plain.obj", ("--normals", "none"), {"positions", "colours", "materials", "names"}),
    "glTF": ("a.gltf", (), GLTF),
    "GLB": ("a.glb", (), GLTF),
    "GLB, `--compress meshopt`": ("meshopt.glb", ("--compress", "meshopt"), GLTF),
    "GLB, `--compress meshopt-khr`": ("khr.glb", ("--compress", "meshopt-khr"), GLTF),
    "GLB, `--compress draco`": ("draco.glb", ("--compress", "draco"), GLTF),
    "GLB, `--lod 2`": ("levels.glb", ("--lod", "2", "-e", "0.2"), set(COLUMNS)),
    "3MF": ("a.3mf", (), {"positions", "colours", "materials", "names", "unit", "metadata"}),
    "AMF": ("a.amf", (), {"positions", "colours", "names", "unit", "metadata"}),
    "Draco": ("a.drc", (), {"positions", "normals", "colours"}),
}
READERS = {"trimesh 5.2": "trimesh", "assimp 5.2": "assimp", "meshio 5.3": "meshio", "pymeshlab 2025.7": "pymeshlab",
           "Blender 5.0 (bpy)": "bpy", "lib3mf 2.5, strict": "lib3mf", "three.js": "three", "draco3d": "draco3d"}


def assimp_points(node, matrix, meshes):
    """Of all meshes where the nodes show them; what `assimp info` says is wrong below a node that scales."""
    numbers = [float(x) for x in node.find("Matrix4").text.split()]
    matrix = [[sum(matrix[i][k] * numbers[4 * k + j] for k in range(4)) for j in range(4)] for i in range(3)] + [[0, 0, 0, 1]]
    for index in (node.findtext("MeshRefs") or "").split():
        for point in meshes[int(index)]:
            yield [sum(row[k] * point[k] for k in range(3)) + row[3] for row in matrix[:3]]
    for inner in node.findall("NodeList/Node"):
        yield from assimp_points(inner, matrix, meshes)


def with_assimp(path):
    dump = path + ".assxml"
    result = subprocess.run(["assimp", "dump", path, dump], capture_output=True, check=False)
    if result.returncode != 0:
        return {"refused": result.stdout.decode() + result.stderr.decode()}
    with open(dump, encoding="utf-8", errors="replace") as file:
        text = file.read()
    root = xml.etree.ElementTree.fromstring(text)
    lists = [[float(x) for x in positions.text.split()] for positions in root.iter("Positions")]
    meshes = [list(zip(*[iter(numbers)] * 3)) for numbers in lists]
    identity = [[float(i == k) for k in range(4)] for i in range(4)]
    points = list(assimp_points(next(root.iter("Node")), identity, meshes))
    factors = {key: re.findall(r'"\$mat\.' + key + r'Factor"[^>]*>\s*([\d.]+)', text) for key in ("metallic", "roughness")}
    shown = sum(int(n) for n in re.findall(r'<MeshRefs num="(\d+)"', text))
    linear = ("0.70[0-9]*", "0.37[0-9]*", "0.01[0-9]*")
    return {"size": [max(p[k] for p in points) - min(p[k] for p in points) for k in range(3)], "names": re.findall(r'<Node name="([^"]*)"', text),
            "normals": "<Normals" in text, "colours": any(re.search(r"\s+".join(gold), text) for gold in (GOLD, linear)),
            "materials": any(float(a) == 1 and abs(float(b) - 0.3) < 1e-4 for a, b in zip(factors["metallic"], factors["roughness"])),
            "metadata": TITLE in text, "shapes": len(meshes), "shown": shown}


def why_missing(reader):
    """None: it is there."""
    if reader == "assimp":
        return None if shutil.which("assimp") else "assimp is not installed"
    if reader in ("three", "draco3d"):
        is_there = shutil.which("node") and os.path.isdir(os.path.join(NODE_MODULES, reader))
        return None if is_there else f"{reader} is not in {NODE_MODULES}, or there is no node"
    return None if importlib.util.find_spec(reader) else f"the Python package {reader} is not installed"


def read_all(reader, paths):
    if reader == "assimp":
        return [with_assimp(path) for path in paths]
    command = ["node", os.path.join(HERE, "read_with.mjs"), reader, os.path.abspath(NODE_MODULES)] if reader in ("three", "draco3d") else \
        [sys.executable, os.path.join(HERE, "read_with.py"), reader]
    result = subprocess.run(command + paths, capture_output=True, check=False)
    found = [json.loads(line[5:]) for line in result.stdout.decode(errors="replace").splitlines() if line.startswith("FOUND")]
    if len(found) != len(paths):
        raise AssertionError(f"{reader}: {result.stderr.decode(errors='replace')}")
    return found


def cells_of(found, has):
    """yes, lost, - where the file has no such thing, ? where the reader makes its own and nobody can tell."""
    if "refused" in found:
        return ["refused"] + [""] * (len(COLUMNS) - 1)
    def is_size(factor):
        return all(abs(a / factor - b) < 0.1 for a, b in zip(sorted(found["size"]), sorted(SIZE)))
    seen = dict(found, positions=is_size(0.001 if "instances" in has else 1), names=NAMES <= set(found.get("names", [])),
                unit=is_size(0.001) or found.get("unit") in ("millimeter", "1"), instances=found["shown"] > found["shapes"])
    words = {None: "?", True: "yes", False: "lost"}
    return [words[seen.get(column, False)] if column in has else "-" for column in COLUMNS]


def rows_of_page():
    with open(PAGE, encoding="utf-8") as file:
        rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in file if line.startswith("|")]
    return [row for row in rows if row[0] in FORMATS and len(row) == 2 + len(COLUMNS)]


class Readers(cli.CliTest):
    def file(self, name):
        path, options, _ = FORMATS[name]
        if not os.path.exists(self.path(path)):
            self.write("scene.txt", SCENE)
            result = cli.run("scene.txt", "-o", path, "-q", *options, *(["--meta", "title=" + TITLE] if "metadata" in FORMATS[name][2] else []),
                             cwd=self.folder)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
        return self.path(path)

    def known(self, formats):
        """Those that this build writes."""
        return [name for name in formats if FORMATS[name][0].rsplit(".", 1)[1] in cli.formats_written()]

    def measure(self, reader, formats):
        reason = why_missing(READERS[reader])
        if reason:
            self.skipTest(reason)
        formats = self.known(formats)
        found = read_all(READERS[reader], [self.file(name) for name in formats])
        for name, one in zip(formats, found):
            self.assertEqual(one.get("warnings", 0), 0, name)
            self.assertEqual(one.get("zero_area", 0), 0, name)
        return {name: cells_of(one, FORMATS[name][2]) for name, one in zip(formats, found)}

    def compare(self, reader):
        wanted = {row[0]: row[2:] for row in rows_of_page() if row[1] == reader}
        self.assertTrue(wanted)
        self.assertEqual(self.measure(reader, wanted), {name: cells for name, cells in wanted.items() if name in self.known(wanted)})


    def test_page_has_a_row_for_each(self):
        pairs = {(name, title) for name, readers in PAIRS.items() for title, reader in READERS.items() if reader in readers.split()}
        rows = [tuple(row[:2]) for row in rows_of_page()]
        self.assertEqual(set(rows), pairs)
        self.assertEqual(len(rows), len(pairs))


for title in READERS:
    setattr(Readers, "test_" + READERS[title], lambda self, title=title: self.compare(title))


PAIRS = {"STL": "trimesh assimp meshio pymeshlab bpy lib3mf three", "PLY": "trimesh assimp meshio pymeshlab bpy three",
         "OFF": "trimesh assimp meshio pymeshlab", "OFF, `--colors none --normals none`": "meshio", "OBJ": "trimesh assimp meshio pymeshlab bpy three",
         "OBJ, `--normals none`": "meshio", "glTF": "trimesh assimp bpy", "GLB": "trimesh assimp pymeshlab bpy three",
         "GLB, `--compress meshopt`": "trimesh assimp pymeshlab bpy three", "GLB, `--compress meshopt-khr`": "three",
         "GLB, `--compress draco`": "trimesh assimp pymeshlab bpy",
         "GLB, `--lod 2`": "trimesh assimp bpy three", "3MF": "trimesh assimp pymeshlab lib3mf", "AMF": "assimp", "Draco": "draco3d"}


class Table(Readers):
    def test_table(self):
        """For --table."""
        rows = {reader: self.measure(title, [name for name in FORMATS if reader in PAIRS[name].split()]) for title, reader in READERS.items()}
        for name, readers in PAIRS.items():
            for title, reader in READERS.items():
                if reader in readers.split():
                    print("| " + " | ".join([name, title] + rows[reader][name]) + " |")


def load_tests(loader, _tests, _pattern):
    return loader.loadTestsFromTestCase(Readers)


if __name__ == "__main__":
    if sys.argv[1:] == ["--table"]:
        unittest.main(argv=sys.argv[:1] + ["Table.test_table"])
    unittest.main()
