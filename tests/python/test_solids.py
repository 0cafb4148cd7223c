# SPDX-License-Identifier: MIT
"""Solids as Python values: they print as scenes, which make the same meshes; all names of the language are there."""
import inspect
import math
import re
import sys

import numpy as np
import pytest

import csgmesh
from csgmesh import _modules, cube, cylinder, functions, sphere
from conftest import ROOT, csgmesh_program

sys.path.insert(0, str(ROOT / "tools" / "manual"))
import tables  # noqa: E402


def test_print():
    solid = (sphere(10) | cube(8)).fillet(2) - cylinder(h=40, r=3)
    assert str(solid) == repr(solid) == """\
difference() {
  union(blend = fillet(2)) {
    sphere(10);
    cube(8);
  }
  cylinder(h = 40, r = 3);
}"""
    assert str(sphere(1).translate([1, 2.5, -3]).color("red")) == 'color("red") translate([1, 2.5, -3]) sphere(1);'
    assert str(sphere(d=3)) == "sphere(d = 3);" and str(cube(2, center=True)) == "cube(size = 2, center = true);"


def test_the_mesh_is_that_of_the_printed_scene(folder):
    solid = (sphere(10) | cube(8)).fillet(2) - cylinder(h=40, r=3)
    (folder / "s.txt").write_text(str(solid))
    csgmesh_program("s.txt", "-o", "a.glb", "-r", 30, cwd=folder)
    solid.write("b.glb", resolution=30, metadata={"source": "s.txt"})
    assert (folder / "a.glb").read_bytes() == (folder / "b.glb").read_bytes()
    assert np.array_equal(solid.mesh(resolution=30).vertices, csgmesh.mesh(str(solid), resolution=30).vertices)
    assert solid.render(width=20, height=16).shape == (16, 20, 4)
    assert solid.scene().field([0, 0, 9.5], gradients=False) < 0


def test_operators_join_what_they_continue():
    a, b, c = sphere(1), cube(2), cylinder(h=3)
    assert str(a | b | c) == "union() {\n  sphere(1);\n  cube(2);\n  cylinder(3);\n}"
    assert len((a - b - c)._children) == 3 and len((a & b & c)._children) == 3
    assert len((a | (b | c))._children) == 2
    assert str((a | b).chamfer(1) | c).startswith("union() {\n  union(blend = chamfer(1)) {")
    assert (a | b).fillet(1) == (sphere(1) | cube(2)).fillet(1) != (a | b).fillet(2)
    assert len({a, sphere(1), b}) == 2
    assert str(csgmesh.union(a, b, blend=2)) == str(a.union(b, blend=2)) == "union(blend = 2) {\n  sphere(1);\n  cube(2);\n}"
    assert str((a | b).fillet(1).fillet(3)) == str((a | b).fillet(3))
    for wrong in (lambda: a | 3, lambda: a - None, lambda: a.fillet(2), lambda: 3 | a, lambda: csgmesh.translate([1, 2, 3]),
                  lambda: csgmesh.union(a, 3), lambda: csgmesh.sphere(a), lambda: csgmesh.Solid()):
        with pytest.raises(TypeError):
            wrong()


def test_functions_take_solids_behind_their_arguments():
    a, b = sphere(1), cube(2)
    for made, want in ((csgmesh.translate([1, 0, 0], a), a.translate([1, 0, 0])), (csgmesh.hull(a, b), a.hull(b)),
                       (csgmesh.rotate(30, a, b), a.rotate(30, None, b)), (csgmesh.projection(a), a.projection()),
                       (csgmesh.minkowski(a, b), a.minkowski(b))):
        assert made == want and len(made._children) in (1, 2)
    assert str(csgmesh.rotate(30, a, b)) == "rotate(30) {\n  sphere(1);\n  cube(2);\n}"
    assert str(csgmesh.linear_extrude(file="a.svg", height=3)) == 'linear_extrude(height = 3, file = "a.svg");'


@pytest.mark.parametrize("value, text", [
    (True, "true"), (3, "3"), (2.5, "2.5"), (1e-7, "1e-07"), (np.float32(0.5), "0.5"), (np.arange(3), "[0, 1, 2]"), ([1, (2, 3.0)], "[1, [2, 3.0]]"),
    ('say "hi"\n', r'"say \"hi\"\n"'), (range(0, 10, 3), "[0 : 3 : 9]"), (math.inf, "(1 / 0)"), (csgmesh.Expression("x + 1"), "x + 1"),
    ({"a": 1, "b": [2]}, "object(a = 1, b = [2])"), (functions.sin(30) * 2 + 1, "((sin(30) * 2) + 1)"), (-functions.sin(30), "(-sin(30))"),
    (lambda p: 1 - functions.norm(p), "function (p) (1 - norm(p))"), (lambda p: p.x * p[1] / 2, "function (p) ((p.x * p[1]) / 2)"),
])
def test_values(value, text):
    assert str(csgmesh.field(value)) == f"field({text});"


def test_values_mean_the_same_there():
    lines = []
    for value in (0.1, 1e300, -2.5e-300, 'a "quoted" \\ line\n', [1, [2, 3]], True):
        csgmesh.parse("echo(x); x = 0; sphere(1);", define={"x": value}, echo=lines.append)
    assert "".join(lines) == ('ECHO: 0.1\nECHO: 1e+300\nECHO: -2.5e-300\nECHO: "a "quoted" \\ line\n"\n'
                              "ECHO: [1, [2, 3]]\nECHO: true\n")
    ball = csgmesh.field(lambda p: 2 - functions.norm(p), bounds=[[-3, -3, -3], [3, 3, 3]])
    assert ball.scene().field([1, 1, 1], gradients=False) == pytest.approx(2 - math.sqrt(3))


@pytest.mark.parametrize("wrong", [object(), sphere(1), {1, 2}])
def test_what_is_no_value(wrong):
    with pytest.raises(TypeError):
        csgmesh.Expression("f")(wrong)


def test_every_module_of_the_language():
    """Names, parameters and their order are those of the table."""
    parameters = {}
    for macro, fields in tables.calls("src/lang/modules/modules.def"):
        if macro == "CSG_PARAMETER":
            parameters.setdefault(fields[0], []).append(fields[1:3])
    names = [fields for macro, fields in tables.calls("src/lang/modules/modules.def") if macro == "CSG_MODULE"]
    assert len(names) > 40
    for name, _, children, _ in names:
        function = getattr(_modules, name + "_" if name == "import" else name)
        own = [p for p in inspect.signature(function).parameters.values() if p.name not in ("fn", "fa", "fs", "solids")]
        assert [p.name for p in own] == [p for p, _ in parameters.get(name, [])]
        assert [p.kind is p.KEYWORD_ONLY for p in own] == [how == "NAMED" for _, how in parameters.get(name, [])]
        assert hasattr(csgmesh.Solid, name) == (children != "0") or name == "render"
        assert (getattr(csgmesh, function.__name__) is function) == (name != "render")


def test_every_function_of_the_language():
    rows = [fields for _, fields in tables.calls("src/lang/functions/functions.def")]
    for name, handler, fewest, most, _, _ in rows:
        function = getattr(functions, name + "_" if name == "import" else name)
        few = [1] * int(fewest)
        assert str(function(*few)) == f"{name}({', '.join('1' for _ in few)})"
        if int(most) < 1000000:
            with pytest.raises(TypeError, match="argument"):
                function(*[1] * (int(most) + 1))
        if handler in ("blend", "rule", "arc", "profile"):
            joined = getattr(sphere(1) | cube(1), name)(*few)
            assert str(joined).startswith(f"union(blend = {function(*few)})")


def test_options_are_those_of_the_header():
    """Each member of an options struct is an option of the function, and a name for type checkers."""
    header = "".join((ROOT / "include" / "csgmesh" / name).read_text() for name in ("csgmesh.h", "slicing.h", "fabrication.h"))
    header = re.sub(r"/\*.*?\*/", "", header, flags=re.S)
    renamed = {"scene": {"defines": "define", "define_count": None, "include_dirs": "include", "include_dir_count": None},
               "render": {"camera": None, "slice_axis": "slice", "slice_at": None}, "diff": {"ignored": "ignore", "scene_a": None, "scene_b": None},
               "mesh": {}, "write": {"metadata_count": None, "level_count": None}, "slice": {"height": "layer", "most_height": None}, "wall": {}, "face": {}}
    more = {"render": {"view", "eye", "target", "up", "projection", "fov", "view_height", "zoom"}}
    typed = {"scene": "SceneOptions", "mesh": "BuildOptions", "write": "FileOptions", "render": "PictureOptions", "diff": "DiffOptions", "slice": "SliceOptions",
             "wall": "WallOptions", "face": "FaceOptions"}
    from csgmesh import _core, _types
    for kind, renaming in renamed.items():
        body = re.search(rf"typedef struct csgm_{kind}_options \{{(.*?)\}} csgm_{kind}_options;", header, re.S).group(1)
        members = [re.sub(r"\[.*\]", "", m.strip(" *")) for line in body.split(";") if line.strip()
                   for m in re.sub(r"^\s*(const )?[a-z0-9_]+ (\*const \*|\*)?", "", line.strip()).split(",")]
        wanted = {renaming.get(m, m) for m in members if m not in ("struct_size", "monitor")} - {None} | more.get(kind, set())
        assert set(_core.option_names[kind]) == wanted, kind
        wanted -= {"only_check"}  # check() sets it
        own = set(getattr(_types, typed[kind]).__annotations__) - set(_types.RunOptions.__annotations__)
        own -= set(_types.SceneOptions.__annotations__) if kind in ("slice", "wall") else set()  # they take a scene's options, too
        assert own - {"field", "mesh"} == wanted, kind
    assert set(_core.option_names["run"]) | {"progress", "echo"} == set(_types.RunOptions.__annotations__)


def test_a_mistake_is_found_where_it_was_made():
    good = sphere(3)
    bad = csgmesh.tube([[0, 0, 0]], degree=7).translate([1, 0, 0]); line = inspect.currentframe().f_lineno  # noqa: E702
    with pytest.raises(csgmesh.SceneError) as caught:
        (good | bad).mesh()
    assert caught.value.made_at == f"{__file__}:{line}" and f"made in {__file__}:{line}" in str(caught.value)
    assert caught.value.file == "solid" and "degree = 7" in caught.value.source_line


def test_code(folder):
    (folder / "lib.scad").write_text("module knob(r) sphere(r);")
    solid = csgmesh.code("for (i = [0 : 2])\n  translate([5 * i, 0, 0]) knob(1 + i / 10);", use="lib.scad") | cube(1)
    assert str(solid).startswith("use <lib.scad>\nunion() {\n  group() {\n")
    assert solid.scene().primitive_count == 4
    assert str(csgmesh.code("cube(1);").rotate(30)) == "rotate(30) group() {\n  cube(1);\n}"
    with pytest.raises(csgmesh.SceneError) as caught:
        csgmesh.code("\nspere(1);\n").mesh()
    assert caught.value.made_at.startswith(__file__)


def test_deep_trees():
    solid = sphere(1)
    for _ in range(3000):
        solid = solid.translate([0.001, 0, 0])
    assert solid.scene().bounds[1][0] == pytest.approx(4)
    many = csgmesh.union(*(sphere(1).translate([3 * i, 0, 0]) for i in range(500)))
    assert many.scene().primitive_count == 500


def test_marks_and_specials():
    assert str(sphere(1).mark("highlight")) == "#sphere(1);"
    assert str((sphere(1) | cube(1)).mark("background")) == "%union() {\n  sphere(1);\n  cube(1);\n}"
    assert str(cylinder(h=2, r=1, fn=6)) == "cylinder(h = 2, r = 1, $fn = 6);"
    with pytest.raises(ValueError):
        sphere(1).mark("loud")
