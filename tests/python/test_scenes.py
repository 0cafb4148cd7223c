# SPDX-License-Identifier: MIT
"""Scenes: their field at arrays of points, pictures, comparisons, texts; each as the command line has it."""
import json
import pathlib

import numpy as np
import pytest

import csgmesh
from conftest import PARTS, csgmesh_program

TEXT = "r = 5; union(blend = 2) { sphere(r); translate([6, 0, 0]) cube(4, center = true); }"


def test_field_is_that_of_the_command_line(folder):
    (folder / "s.txt").write_text(TEXT)
    points = [(0, 0, 0), (4.5, 0.25, 1), (9, 3, -2), (100, 0, 0)]
    scene = csgmesh.load("s.txt", define={"r": 5.5})
    values, gradients = scene.field(points)
    at = [part for point in points for part in ("--at", ",".join(map(str, point)))]
    lines = csgmesh_program("eval", "s.txt", "-D", "r=5.5", "--json", *at, cwd=folder).splitlines()
    want = [json.loads(line) for line in lines]
    assert len(want) == 4 and values.tolist() == [row["f"] for row in want]
    assert gradients.tolist() == [row["gradient"] for row in want]


def test_field_of_many_points():
    scene = csgmesh.parse(TEXT)
    points = np.random.default_rng(1).uniform(-9, 9, (40, 50, 3))
    values, gradients = scene.field(points)
    assert values.shape == (40, 50) and gradients.shape == (40, 50, 3)
    one, slope = scene.field(points[7, 9])
    assert one == values[7, 9] and np.array_equal(slope, gradients[7, 9])
    assert np.array_equal(scene.field(points, gradients=False, threads=1), values)
    assert np.array_equal(scene.field(points.astype(np.float32), gradients=False), scene.field(points.astype(np.float32).astype(float))[0])
    assert np.array_equal(scene.field(points[::2, :, ::-1])[0], scene.field(points[::2, :, ::-1].copy())[0])
    step = 1e-6
    slopes = (scene.field(points + [step, 0, 0], gradients=False) - values) / step
    assert np.median(np.abs(slopes - gradients[..., 0])) < 1e-4
    assert scene.field(np.empty((0, 3)))[0].shape == (0,)
    mesh = scene.mesh(resolution=32)
    assert np.abs(scene.field(mesh.vertices, gradients=False)).max() < 1e-4


@pytest.mark.parametrize("shape", [(3, 2), (4,), (), (2, 3, 4)])
def test_points_of_another_shape(shape):
    with pytest.raises(ValueError, match=r"points must have the shape \(\.\.\., 3\), not"):
        csgmesh.parse(TEXT).field(np.zeros(shape))


def test_what_is_known_of_a_scene(folder):
    (folder / "part.txt").write_text("module m() sphere(3);")
    (folder / "s.txt").write_text("include <part.txt>\nm(); color(\"red\") cube(4);")
    scene = csgmesh.load(pathlib.Path("s.txt"))
    assert [pathlib.Path(path).name for path in scene.files] == ["s.txt", "part.txt"]
    assert scene.primitive_count == 2 and scene.operator_count == 1 and scene.has_colors and scene.lipschitz == 1
    assert scene.bounds.tolist() == [[-3, -3, -3], [4, 4, 4]]
    for what, option in (("scene", "--scene"), ("tape", "--tape"), ("vm", "--vm")):
        assert scene.dump(what).encode() == csgmesh_program("dump", "s.txt", option, cwd=folder)
    assert str(csgmesh.parse(str(scene))) == str(scene)


def test_drawings(folder):
    (folder / "s.txt").write_text("square([30, 20]); translate([40, 0]) circle(5);")
    csgmesh_program("s.txt", "-o", "a.svg", cwd=folder)
    csgmesh.load("s.txt", flat="drawing").draw("b.svg")
    assert (folder / "b.svg").read_bytes() == (folder / "a.svg").read_bytes()
    with pytest.raises(ValueError, match="drawing"):
        csgmesh.parse("cube(1);").draw("c.svg")
    with pytest.raises(ValueError, match="svg"):
        csgmesh.load("s.txt", flat="drawing").draw("c.png")


def read_ppm(data):
    width, height = map(int, data.split(maxsplit=3)[1:3])
    return np.frombuffer(data[-3 * width * height:], np.uint8).reshape(height, width, 3)


def test_pictures_are_those_of_the_command_line(folder):
    (folder / "s.txt").write_text(TEXT)
    csgmesh_program("render", "s.txt", "-o", "a.ppm", "--size", "80x60", "--view", "20,40", cwd=folder)
    picture = csgmesh.render(pathlib.Path("s.txt"), width=80, height=60, view=(20, 40))
    assert picture.shape == (60, 80, 4) and picture.dtype == np.uint8 and not picture.flags.owndata
    assert np.array_equal(picture[..., :3], read_ppm((folder / "a.ppm").read_bytes()))
    csgmesh.write_image(picture, "b.ppm")
    assert (folder / "b.ppm").read_bytes() == (folder / "a.ppm").read_bytes()
    csgmesh_program("render", "s.txt", "-o", "a.ppm", "--size", "60x60", "--slice", "z=1", "--iso", "1.5", cwd=folder)
    picture = csgmesh.render(TEXT, width=60, height=60, slice=("z", 1), iso_step=1.5)
    assert np.array_equal(picture[..., :3], read_ppm((folder / "a.ppm").read_bytes()))
    csgmesh_program("s.txt", "-o", "m.ply", "-r", 20, cwd=folder)
    csgmesh_program("render", "m.ply", "-o", "a.ppm", "--size", "60x60", "--wireframe", "--background", "#204060", cwd=folder)
    picture = csgmesh.read("m.ply").render(width=60, height=60, wireframe=True, background="#204060")
    assert np.array_equal(picture[..., :3], read_ppm((folder / "a.ppm").read_bytes()))
    assert (csgmesh.render("sphere(1);", width=20, height=20, background="transparent")[0, 0] == 0).all()
    for pixels, error in ((picture[..., :3], ValueError), (picture.astype(float), TypeError), (picture[0], ValueError)):
        with pytest.raises(error):
            csgmesh.write_image(pixels, "c.ppm")


def plain(value):
    """A comparison as JSON has it."""
    if hasattr(value, "__dict__"):
        value = vars(value)
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items() if item is not None and not key.startswith("_")}
    return [plain(item) for item in value] if isinstance(value, (list, tuple)) else value


def assert_report(diff, want):
    """The figures of csgmesh diff --json are the members of the comparison."""
    got = plain(diff)
    for key in ("level", "reasons", "tolerance", "precision", "turned", "hausdorff", "a_to_b", "b_to_a", "volume", "normals", "colors", "names", "a_to_field_of_b",
                "b_to_field_of_a"):
        assert got.get(key) == want.get(key), key
    for side in ("a", "b"):
        for key in ("vertices", "triangles", "area", "volume", "genus", "components", "bounds", "closed"):
            assert got[side][key] == want[side][key], key
    assert diff.different == (want["verdict"] == "different") == bool(diff)


def test_diff_of_files(folder):
    (folder / "s.txt").write_text(TEXT)
    csgmesh_program("s.txt", "-o", "a.ply", "-r", 20, cwd=folder)
    csgmesh_program("s.txt", "-o", "b.glb", "-r", 20, "-D", "r=5.2", cwd=folder)
    csgmesh_program("s.txt", "-o", "c.stl", "-r", 20, cwd=folder)
    for left, right, options, arguments in (
            ("a.ply", "b.glb", {}, []), ("a.ply", "c.stl", {}, []),
            ("a.ply", "b.glb", {"tolerance": 0.5, "ignore": "normals"}, ["--tol", 0.5, "--ignore", "normals"]),
            ("a.ply", "b.glb", {"material": "added", "samples": 1000}, ["--one-sided", "added", "--samples", 1000])):
        diff = csgmesh.diff(left, right, **options)
        csgmesh_program("diff", left, right, "--json", "d.json", *arguments, status=int(diff.different), cwd=folder)
        assert_report(diff, json.loads((folder / "d.json").read_text()))
    diff = csgmesh.diff("a.ply", csgmesh.read("b.glb"))
    assert diff.distances_a.shape == (diff.a.vertices,) and diff.distances_b.shape == (diff.b.vertices,)
    assert not diff.distances_a.flags.owndata and diff.distances_b.max() <= diff.hausdorff[1] * 1.0001
    csgmesh_program("diff", "a.ply", "b.glb", "--heatmap", "h.ply", status=1, cwd=folder)
    diff.write_heatmap("i.ply")
    assert (folder / "i.ply").read_bytes() == (folder / "h.ply").read_bytes()


def test_diff_of_scenes(folder):
    (folder / "a.txt").write_text(TEXT)
    (folder / "b.txt").write_text(TEXT.replace("cube(4", "cube(4.2"))
    (folder / "c.txt").write_text("sphere(5);")
    (folder / "d.txt").write_text("sphere(5.5);")
    few = {"samples": 1000}, ["--samples", 1000]
    for left, right, options, arguments in (
            ("a.txt", "b.txt", {"mesh": {"quality": "draft"}}, ["--quality", "draft"]),
            ("a.txt", "b.txt", {"tolerance": 0.5}, ["--tol", 0.5]),
            ("c.txt", "d.txt", {"mesh": {"resolution": 6}, "field": True}, ["-r", 6, "--field"]),
            ("m.obj", "a.txt", {"mesh": {"resolution": 20}}, ["-r", 20])):
        options, arguments = {**options, **few[0]}, [*arguments, *few[1]]
        if left == "m.obj":
            csgmesh_program("a.txt", "-o", "m.obj", "-r", 20, cwd=folder)
        diff = csgmesh.diff(left, right, **options)
        csgmesh_program("diff", left, right, "--json", "d.json", *arguments, status=int(diff.different), cwd=folder)
        assert_report(diff, json.loads((folder / "d.json").read_text()))
    assert not csgmesh.diff(csgmesh.sphere(3), csgmesh.parse("sphere(3);"), samples=1000)
    assert csgmesh.diff(csgmesh.sphere(3), csgmesh.sphere(3.1), samples=1000).reasons == ["distance"]


def test_parts_by_name():
    assert len(PARTS) == 10
    mesh = csgmesh.mesh(csgmesh.part("lid", csgmesh.cube(3)) | csgmesh.part("pot", csgmesh.sphere(9).translate([0, 0, -20])), quality="draft")
    assert [part.name for part in mesh.parts] == ["lid", "pot"]
