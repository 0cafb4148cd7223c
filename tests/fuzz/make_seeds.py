#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Small valid files for the fuzzers to begin with: by csgmesh, and by whatever other writers are there.

Usage: make_seeds.py CSGMESH OUT

Writes OUT/TARGET/WRITER-WHAT.EXTENSION, one folder for each target of a reader. What is committed in
tests/data/fuzz/corpus was made so, with Assimp 5.2, OpenSCAD 2021.01 (Debian 12) and, from PyPI, trimesh, meshio,
lib3mf, DracoPy, pygltflib and fontTools; a writer that is missing is named and passed over. Files above LARGEST bytes are not kept, since
a fuzzer that changes a byte seldom finds what matters in them.
"""
import os
import subprocess
import sys
import tempfile
import zipfile

LARGEST = 3000
TARGET_OF = {"xml": "3mf", "glb": "gltf", "gltf": "gltf", "ttf": "font", "otf": "font"}

BOX = "cube([3, 2, 1]);\n"
TETRA = "polyhedron([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]], [[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 2, 3]]);\n"
PAINTED = 'color("red") part("a") ' + TETRA + 'color([0, 0.5, 1, 0.5]) part("b \\" <&") translate([5, 0, 0]) ' + TETRA
METAL = "material(metallic = 1, roughness = 0.3) " + TETRA
FAR = "translate([1e5, 2e5, -3e5]) " + TETRA
PLATE = "difference() { square([30, 20]); translate([9, 9]) circle(5, $fn = 6); }\n"
# Written by hand: what people's drawing programs do and ours do not.
BY_HAND = {
    "style.svg": """<svg xmlns="http://www.w3.org/2000/svg" width="2in" height="3pc"><style>/* a */ .a, rect { fill: none; stroke: #f00 }
#b{stroke-width:3mm!important}</style><g class="a b" style="display:inline"><rect id="b" x="1" y="2" width="30" height="4" rx="50%"/></g>
<g display="none"><circle r="4"/></g><text x="1">no</text></svg>""",
    "path.svg": """<svg viewBox="0 0 9 9"><path d="m1 1l.5-.5-1e0,2e-1zM3,3h1v1H3Zm4-2c1 0 1 1 0 1s-1-1 0-1q.5.5 0 1t1 1a1 2 30 0110 1zM0 0"/>
<path fill-rule="nonzero" transform="rotate(45) scale(2 -1)" d="M0 0L1 0 1 1 0 1ZM.2.2.8.2.8.8.2.8Z"/></svg>""",
    "inkscape.svg": """<?xml version="1.0" encoding="UTF-8"?><svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" width="40mm" viewBox="0 0 40 40"><defs><clipPath id="c"><rect width="9" height="9"/></clipPath>
</defs><g inkscape:groupmode="layer" inkscape:label="Layer 1" transform="translate(-1,-2)"><use xlink:href="#p" x="3"/><path id="p" clip-path="url(#c)"
d="M 0,0 C 1,2 3,4 5,6 Z"/><polygon points="0,0 9,0 9,9"/></g></svg>""",
    "lines.dxf": "0\nSECTION\n2\nENTITIES\n" + "".join(
        f"0\nLINE\n8\n0\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n" for a, b, c, d in ((0, 0, 4, 0), (4, 0, 4, 3), (4, 3, 0, 0))) +
        "0\nENDSEC\n0\nEOF\n",
    "curves.dxf": "0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n90\n3\n70\n1\n10\n0\n20\n0\n42\n0.5\n10\n4\n20\n0\n10\n4\n20\n3\n0\nARC\n10\n1\n20\n1\n40\n2\n"
        "50\n30\n51\n200\n0\nELLIPSE\n10\n0\n20\n0\n11\n2\n21\n1\n40\n0.5\n41\n0\n42\n6.283\n0\nSPLINE\n71\n2\n72\n6\n73\n3\n40\n0\n40\n0\n40\n0\n40\n1\n"
        "40\n1\n40\n1\n10\n0\n20\n0\n10\n1\n20\n2\n10\n2\n20\n0\n0\nENDSEC\n0\nEOF\n",
    "placed.amf": """<amf unit="inch"><object id="0"><mesh><vertices><vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex><vertex>
<coordinates><x>1</x><y>0</y><z>0</z></coordinates></vertex><vertex><coordinates><x>0</x><y>1</y><z>0</z></coordinates></vertex><vertex><coordinates>
<x>0</x><y>0</y><z>1</z></coordinates></vertex></vertices><volume><triangle><v1>0</v1><v2>2</v2><v3>1</v3></triangle><triangle><v1>0</v1><v2>1</v2><v3>3</v3>
</triangle><triangle><v1>1</v1><v2>2</v2><v3>3</v3></triangle><triangle><v1>0</v1><v2>3</v2><v3>2</v3></triangle></volume></mesh></object>
<constellation id="1"><instance objectid="0"><deltax>1</deltax><rx>90</rx></instance><instance objectid="0"><rz>45</rz></instance></constellation></amf>""",
    "strange.obj": "# a\nmtllib none.mtl\nv 0 0 0 1\nv 1 0 0 1 0 0\r\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\ng a b\nusemtl m\ns off\nf 1/1/1 3/1/1 2/1/1\n"
        "f -4//1 -3//1 -1//1\nf 2 \\\n3 4\nl 1 2\nf 1 4 3\n",
    "strange.off": "STCNOFF BINARY?\n",
    "comments.off": "# c\nCNOFF # d\n4 4 0\n0 0 0 0 0 1 1 0 0 1\n1 0 0 0 0 1 0 1 0 1\n0 1 0 0 0 1 0 0 1 1\n0 0 1 0 0 1 255 255 255 255\n3 0 2 1 9\n3 0 1 3 0.1 0.2 0.3\n"
        "3 1 2 3\n3 0 3 2\n",
    "lists.ply": "ply\nformat ascii 1.0\ncomment c\nobj_info i\nelement face 1\nproperty list uchar int vertex_index\nproperty uchar red\nelement vertex 4\nproperty double y\n"
        "property float x\nproperty float z\nproperty short nx\nelement edge 1\nproperty int v\nend_header\n4 0 1 2 3 7\n0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0 4\n5\n",
}
# name: scene, output's extension, options
OURS = {
    "box": (BOX, "obj off stl ply amf 3mf glb gltf drc", []),
    "painted": (PAINTED, "obj off ply amf 3mf glb gltf drc", ["--normals=none"]),
    "far": (FAR, "obj off ply glb", ["--normals=none"]),
    "metal": (METAL, "obj 3mf glb gltf", []),
    "ascii": (TETRA, "ply stl", ["--ascii"]),
    "creased": (TETRA, "obj glb", ["--normals=crease"]),
    "draco": (TETRA, "glb gltf", ["--compress=draco"]),
    "meshopt": (TETRA, "glb gltf", ["--compress=meshopt"]),
    "khr": (PAINTED, "glb", ["--compress=meshopt-khr", "--normals=none"]),
    "inches": (TETRA, "3mf amf glb", ["--unit=inch", "--meta=title=Tetra <&>"]),
    "coarse-bits": (TETRA, "drc", ["--draco-bits=5"]),
    "bare": (TETRA, "drc obj off", ["--normals=none"]),
}
DRAWINGS = {"plate": (PLATE, "svg dxf")}


def run(*command):
    return subprocess.run(command, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


class Seeds:
    def __init__(self, out, work):
        self.out, self.work, self.kept = out, work, {}

    def path(self, name):
        return os.path.join(self.work, name)

    def keep(self, name):
        """A file of the work folder, when it is there and small."""
        path, extension = self.path(name), name.rsplit(".", 1)[1]
        if not os.path.exists(path) or not 0 < os.path.getsize(path) <= LARGEST:
            return
        with open(path, "rb") as file:
            data = file.read()
        target = TARGET_OF.get(extension, extension)
        if data in self.kept.setdefault(target, []):
            return
        self.kept[target].append(data)
        os.makedirs(os.path.join(self.out, target), exist_ok=True)
        with open(os.path.join(self.out, target, name), "wb") as file:
            file.write(data)
        if extension == "3mf":
            self.keep_model(name)

    def keep_model(self, name):
        """The model by itself, which the target packs anew: no change of it breaks the archive."""
        with zipfile.ZipFile(self.path(name)) as archive:
            for part in archive.namelist():
                if part.endswith(".model"):
                    model = self.path(name[:-4] + "-model.xml")
                    with open(model, "wb") as file:
                        file.write(archive.read(part))
                    self.keep(os.path.basename(model))

    def scene(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)


def make_ours(seeds, program):
    for table, options in ((OURS, None), (DRAWINGS, [])):
        for what, row in table.items():
            scene = seeds.scene("a.txt", row[0])
            for extension in row[1].split():
                name = f"csgmesh-{what}.{extension}"
                if run(program, scene, "-q", "-o", seeds.path(name), *(row[2] if options is None else options)):
                    seeds.keep(name)


def make_by_hand(seeds, _):
    for name, text in BY_HAND.items():
        seeds.scene(name, text)
        seeds.keep(name)
    with zipfile.ZipFile(seeds.path("zipped.amf"), "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(zipfile.ZipInfo("placed.amf"), BY_HAND["placed.amf"])
    seeds.keep("zipped.amf")


def make_openscad(seeds, _):
    scene = seeds.scene("solid.scad", "cube([3, 2, 1]);\n")
    flat = seeds.scene("flat.scad", "difference() { square([3, 2]); translate([1, 1]) circle(0.5, $fn = 6); }\n")
    made = [run("openscad", "-o", seeds.path(f"openscad-box.{extension}"), scene) for extension in
            ("stl", "off", "amf", "3mf")]
    made += [run("openscad", "-o", seeds.path(f"openscad-plate.{extension}"), flat) for extension in ("svg", "dxf")]
    for extension in ("stl", "off", "amf", "3mf"):
        seeds.keep(f"openscad-box.{extension}")
    for extension in ("svg", "dxf"):
        seeds.keep(f"openscad-plate.{extension}")
    return any(made)


def make_assimp(seeds, program):
    scene = seeds.scene("b.txt", PAINTED)
    run(program, scene, "-q", "-o", seeds.path("in.glb"), "--normals=none")
    for kind, extension in (("obj", "obj"), ("objnomtl", "obj"), ("stl", "stl"), ("stlb", "stl"), ("ply", "ply"), ("plyb", "ply"),
                            ("gltf2", "gltf"), ("glb2", "glb"), ("3mf", "3mf")):
        name = f"assimp-{kind}.{extension}"
        run("assimp", "export", seeds.path("in.glb"), seeds.path(name), "-f" + kind)
        seeds.keep(name)


def make_trimesh(seeds, _):
    import trimesh  # pylint: disable=import-outside-toplevel
    mesh = trimesh.Trimesh([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], process=False)
    mesh.visual.vertex_colors = [[255, 0, 0, 255], [0, 255, 0, 128], [0, 0, 255, 255], [9, 9, 9, 255]]
    for extension in ("obj", "off", "stl", "ply", "glb", "3mf"):
        name = f"trimesh-tetra.{extension}"
        try:
            mesh.export(seeds.path(name))
        except ImportError as missing:
            print(f"trimesh: no {extension}: {missing}")
        seeds.keep(name)
    mesh.export(seeds.path("trimesh-text.ply"), encoding="ascii")
    seeds.keep("trimesh-text.ply")


def make_meshio(seeds, _):
    import meshio  # pylint: disable=import-outside-toplevel
    import numpy  # pylint: disable=import-outside-toplevel
    points = numpy.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 2]], dtype=float)
    mixed = [("triangle", numpy.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])), ("quad", numpy.array([[3, 2, 1, 0]]))]
    for extension, cells in (("obj", mixed), ("ply", mixed), ("off", mixed[:1]), ("stl", mixed[:1])):
        name = f"meshio-pyramid.{extension}"
        meshio.Mesh(points, cells).write(seeds.path(name))
        seeds.keep(name)


def make_draco(seeds, _):
    import DracoPy  # pylint: disable=import-outside-toplevel
    import numpy  # pylint: disable=import-outside-toplevel
    points = numpy.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]], dtype=numpy.float32)
    faces = numpy.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], dtype=numpy.uint32)
    colors = numpy.array([[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9]], dtype=numpy.uint8)
    for name, options in (("fast", {"compression_level": 0}), ("best", {"compression_level": 10, "quantization_bits": 11}),
                          ("colors", {"colors": colors}), ("ordered", {"preserve_order": True}), ("cloud", {"faces": None})):
        data = DracoPy.encode(points, **{"faces": faces, **options})
        with open(seeds.path(f"dracopy-{name}.drc"), "wb") as file:
            file.write(data)
        seeds.keep(f"dracopy-{name}.drc")


def make_lib3mf(seeds, _):
    import lib3mf  # pylint: disable=import-outside-toplevel
    from lib3mf import get_wrapper  # pylint: disable=import-outside-toplevel
    wrapper = get_wrapper()
    model = wrapper.CreateModel()
    mesh = model.AddMeshObject()
    points = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]]
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    mesh.SetGeometry([lib3mf.Position(Coordinates=tuple(map(float, p))) for p in points],
                     [lib3mf.Triangle(Indices=tuple(f)) for f in faces])
    model.AddBuildItem(mesh, wrapper.GetIdentityTransform())
    model.QueryWriter("3mf").WriteToFile(seeds.path("lib3mf-tetra.3mf"))
    seeds.keep("lib3mf-tetra.3mf")


def make_fonts(seeds, _):
    from fontTools import fontBuilder  # pylint: disable=import-outside-toplevel
    from fontTools.feaLib.builder import addOpenTypeFeaturesFromString  # pylint: disable=import-outside-toplevel
    from fontTools.pens.t2CharStringPen import T2CharStringPen  # pylint: disable=import-outside-toplevel
    from fontTools.pens.ttGlyphPen import TTGlyphPen  # pylint: disable=import-outside-toplevel

    def draw(pen, sides):
        pen.moveTo((100, 0))
        pen.lineTo((100, 700))
        if sides > 3 and isinstance(pen, T2CharStringPen):
            pen.curveTo((200, 800), (400, 800), (500, 700))
        elif sides > 3:
            pen.qCurveTo((300, 900), (500, 700))
        pen.lineTo((500, 0))
        pen.closePath()
        return pen

    names = [".notdef", "A", "V", "f", "i", "f_i"]
    for what, is_ttf, features in (
            ("kern", True, "feature kern { pos A V -80; } kern;"),
            ("ligature", True, "feature liga { sub f i by f_i; } liga;"),
            ("mark", True, "markClass [i] <anchor 250 0> @TOP; feature mark { pos base A <anchor 300 700> mark @TOP; } mark;"),
            ("context", False, "feature calt { sub A' V by V; } calt;"), ("cff", False, "")):
        builder = fontBuilder.FontBuilder(1000, isTTF=is_ttf)
        builder.setupGlyphOrder(names)
        builder.setupCharacterMap({65: "A", 86: "V", 102: "f", 105: "i", 0x3b1: "A", 0x10330: "V"})
        if is_ttf:
            builder.setupGlyf({name: draw(TTGlyphPen(None), 3 + i % 2).glyph() for i, name in enumerate(names)})
        else:
            shapes = {name: draw(T2CharStringPen(600, None), 3 + i % 2).getCharString() for i, name in enumerate(names)}
            builder.setupCFF("Seed", {"FullName": "Seed"}, shapes, {})
        builder.setupHorizontalMetrics({name: (600, 100) for name in names})
        builder.setupHorizontalHeader(ascent=900, descent=-200)
        builder.setupNameTable({"familyName": "Seed", "styleName": "Regular"})
        builder.setupOS2()
        builder.setupPost(keepGlyphNames=False)
        if features:
            addOpenTypeFeaturesFromString(builder.font, features)
        for table in ("head", "maxp"):
            if hasattr(builder.font[table], "modified"):
                builder.font[table].created = builder.font[table].modified = 0
        builder.font.recalcTimestamp = False
        name = f"fonttools-{what}.{'ttf' if is_ttf else 'otf'}"
        builder.save(seeds.path(name))
        seeds.keep(name)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, out = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    with tempfile.TemporaryDirectory() as work:
        seeds = Seeds(out, work)
        for make in (make_ours, make_by_hand, make_openscad, make_assimp, make_trimesh, make_meshio, make_draco, make_lib3mf, make_fonts):
            try:
                make(seeds, program)
            except (ImportError, FileNotFoundError) as missing:
                print(f"{make.__name__[5:]}: passed over: {missing}")
        for target, kept in sorted(seeds.kept.items()):
            print(f"{target}: {len(kept)} seeds, {sum(map(len, kept))} bytes")


if __name__ == "__main__":
    main()
