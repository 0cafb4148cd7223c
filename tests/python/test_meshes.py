# SPDX-License-Identifier: MIT
"""Meshes: the bytes of the command line, arrays without a copy, files there and back."""
import gc
import pathlib

import numpy as np
import pytest

import csgmesh
from conftest import PARTS, SCENES, csgmesh_program

BALL = "sphere(10);"
MUG = SCENES / "parts" / "mug.txt"
COLOURED = 'part("a") color("red") cube(4); part("b") translate([9, 0, 0]) color("blue") sphere(3);'
WRITTEN = [row["name"] for row in csgmesh.formats() if row["is_written"]]


def address(array):
    return array.__array_interface__["data"][0]


@pytest.mark.parametrize("format_name", WRITTEN)
def test_write_has_the_bytes_of_the_command_line(folder, format_name):
    name = f"a.{format_name}"  # one for all: an OBJ file names its materials' file

    def written():
        return {path.name: path.read_bytes() for path in folder.glob("a.*")}

    (folder / "s.txt").write_text(COLOURED)
    csgmesh_program("s.txt", "-o", name, "-r", 24, cwd=folder)
    wanted = written()
    made = csgmesh.write(pathlib.Path("s.txt"), name, resolution=24)
    assert written() == wanted
    assert made.triangles > 100 and made.stats.cells != (0, 0, 0)
    # cells that follow the shape
    csgmesh_program("s.txt", "-o", name, "--quality", "draft", cwd=folder)
    wanted = written()
    csgmesh.write(pathlib.Path("s.txt"), name, quality="draft")
    assert written() == wanted
    # through a mesh in memory
    csgmesh_program("s.txt", "-o", name, "-r", 24, "--normals", "vertex", cwd=folder)
    wanted = written()
    csgmesh.mesh(COLOURED, resolution=24).write(name, metadata={"source": "s.txt"})
    assert written() == wanted


@pytest.mark.parametrize("path", PARTS, ids=lambda path: path.stem)
def test_the_ten_parts(folder, path):
    assert len(PARTS) == 10
    csgmesh_program(path, "-o", "a.ply", "--quality", "draft")
    csgmesh.mesh(path, quality="draft").write("b.ply")
    assert (folder / "b.ply").read_bytes() == (folder / "a.ply").read_bytes()


@pytest.mark.parametrize("options, arguments", [
    ({}, []),
    ({"tolerance": 0.3}, ["-e", 0.3]),
    ({"resolution": 40, "features": "smooth"}, ["-r", 40, "--features", "smooth"]),
    ({"cell_size": 1.5, "improve": True}, ["-s", 1.5, "--improve"]),
    ({"triangles": 500, "quality": "draft"}, ["--triangles", 500, "--quality", "draft"]),
    ({"resolution": 30, "simplify_share": 0.5, "prune": False}, ["-r", 30, "--simplify", "50%", "--no-prune"]),
    ({"resolution": 30, "bounds": [(-5, -20, -20), (20, 20, 20)], "colors": False},
     ["-r", 30, "--bounds", "-5,-20,-20,20,20,20", "--colors", "none"]),
    ({"define": {"h": 7.5}, "resolution": 30, "threads": 1}, ["-D", "h=7.5", "-r", 30]),
    ({"facets": "exact", "resolution": 20, "isa": "scalar"}, ["--facets", "exact", "-r", 20]),
])
def test_options_are_those_of_the_command_line(folder, options, arguments):
    (folder / "s.txt").write_text("h = 12; difference() { sphere(10, $fn = 30); cylinder(h = h, r = 4); }")
    csgmesh_program("s.txt", "-o", "a.ply", *arguments, cwd=folder)
    csgmesh.load("s.txt", **{k: v for k, v in options.items() if k in ("define", "facets")}).mesh(
        **{k: v for k, v in options.items() if k not in ("define", "facets")}).write("b.ply")
    assert (folder / "b.ply").read_bytes() == (folder / "a.ply").read_bytes()


def test_write_options(folder):
    (folder / "s.txt").write_text(BALL)
    csgmesh_program("s.txt", "-o", "a.stl", "--ascii", "-r", 16, cwd=folder)
    csgmesh.mesh(BALL, resolution=16).write("b.stl", ascii=True)
    assert (folder / "b.stl").read_bytes() == (folder / "a.stl").read_bytes()
    csgmesh_program("s.txt", "-o", "a.glb", "--up", "z", "--unit", "cm", "-r", 16, cwd=folder)
    csgmesh.write(BALL, "b.glb", y_up=False, unit="cm", resolution=16, metadata={"source": "s.txt"})
    assert (folder / "b.glb").read_bytes() == (folder / "a.glb").read_bytes()
    mesh = csgmesh.mesh(BALL, resolution=16)
    mesh.write("c.bin", format="ply", comment="made here")
    assert b"made here" in (folder / "c.bin").read_bytes()


def test_arrays():
    mesh = csgmesh.mesh(COLOURED, resolution=24, normals="vertex")
    count, triangles = len(mesh.vertices), len(mesh.triangles)
    for array, shape, dtype in ((mesh.vertices, (count, 3), np.float32), (mesh.triangles, (triangles, 3), np.uint32),
                                (mesh.normals, (count, 3), np.float32), (mesh.colors, (count, 4), np.uint8)):
        assert array.shape == shape and array.dtype == dtype
        assert not array.flags.writeable and not array.flags.owndata
        with pytest.raises(ValueError):
            array[0, 0] = 1
    for name in ("vertices", "triangles", "normals", "colors"):  # the same memory each time
        assert address(getattr(mesh, name)) == address(getattr(mesh, name))
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-6)
    assert set(map(tuple, mesh.colors)) == {(255, 0, 0, 255), (0, 0, 255, 255)}
    assert [part.name for part in mesh.parts] == ["a", "b"]
    assert mesh.parts[1].first_triangle == mesh.parts[0].triangle_count
    b = mesh.vertices[np.unique(mesh.triangles[mesh.parts[1].slice])]
    assert b[:, 0].min() > 5
    assert mesh.materials is None and mesh.origin == (0, 0, 0) and not mesh.is_split
    assert np.allclose(mesh.bounds, [mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)])


def test_a_mesh_holds_its_memory_once():
    mesh = csgmesh.mesh(BALL, resolution=100)
    arrays = sum(array.nbytes for array in (mesh.vertices, mesh.triangles, mesh.normals))
    assert arrays > 1e6
    assert arrays <= mesh._core.memory < arrays + 100000


def test_arrays_keep_the_mesh_alive():
    mesh = csgmesh.mesh(BALL, resolution=40)
    vertices, triangles = mesh.vertices, mesh.triangles
    want = vertices.copy()
    del mesh
    gc.collect()
    others = [csgmesh.mesh(BALL, resolution=40) for _ in range(3)]  # would take the memory, if it were free
    assert np.array_equal(vertices, want) and triangles.max() < len(vertices)
    del others


def test_no_normals_and_creases():
    assert csgmesh.mesh("cube(1);", normals="none").normals is None
    mesh = csgmesh.mesh("cube(1);", normals="crease", resolution=8)
    assert mesh.is_split and len(np.unique(mesh.vertices, axis=0)) < len(mesh.vertices)


def test_far_from_zero(folder):
    mesh = csgmesh.mesh("translate([5e6, 0, 0]) sphere(10);", resolution=30)
    assert any(mesh.origin) and mesh.vertices.dtype == np.float64
    assert np.allclose(np.linalg.norm(mesh.vertices - [5e6, 0, 0], axis=1), 10, atol=1e-4)
    assert np.array_equal(mesh.vertices, mesh.positions + np.array(mesh.origin))
    assert mesh.vertices is mesh.vertices
    again = csgmesh.Mesh(mesh.vertices, mesh.triangles)
    assert np.allclose(again.vertices, mesh.vertices, atol=1e-4, rtol=0)
    again.write("far.obj")
    assert np.allclose(csgmesh.read("far.obj").bounds, mesh.bounds, atol=1e-3, rtol=0)


def test_read_and_inspect(folder):
    mesh = csgmesh.mesh(COLOURED, resolution=24)
    for row in csgmesh.formats():
        if row["is_written"] and row["is_read"]:
            mesh.write(f"m.{row['name']}")
            read = csgmesh.read(f"m.{row['name']}")
            assert read.format == row["name"] and len(read.triangles) == len(mesh.triangles)
            assert (read.colors is not None) == row["keeps_colors"]
            if row["keeps_names"]:
                assert [part.name for part in read.parts] == ["a", "b"]
    check = mesh.inspect()
    assert check.components == 2 and check.boundary_edges == 0 and check.genus == 0
    assert check.volume == pytest.approx(64 + 4 / 3 * np.pi * 27, rel=0.02)
    (folder / "noname").write_bytes((folder / "m.ply").read_bytes())
    assert len(csgmesh.read("noname", format="ply").triangles) == len(mesh.triangles)


def test_meshes_of_arrays(folder):
    ball = csgmesh.mesh(BALL, resolution=20)
    own = ball.vertices.copy()
    mesh = csgmesh.Mesh(own, ball.triangles, normals=ball.normals, parts=[("top", 0, len(ball.triangles))])
    assert address(mesh.vertices) == address(own) and address(mesh.triangles) == address(ball.triangles)
    mesh.write("a.glb", sync=False)
    assert csgmesh.read("a.glb").parts[0].name == "top"
    painted = csgmesh.Mesh(own.tolist(), ball.triangles.astype(np.int64), colors=np.full((len(own), 4), 200))
    assert painted.colors.dtype == np.uint8 and (painted.colors == 200).all()
    del own
    assert np.array_equal(mesh.vertices, ball.vertices)


def test_to_trimesh():
    trimesh = pytest.importorskip("trimesh")
    mesh = csgmesh.mesh(COLOURED, resolution=40)
    made = mesh.to_trimesh()
    assert isinstance(made, trimesh.Trimesh) and made.is_watertight and len(made.faces) == len(mesh.triangles)
    assert made.volume == pytest.approx(mesh.inspect().volume)
    assert np.array_equal(made.visual.vertex_colors, mesh.colors)


def test_statistics():
    stats = csgmesh.mesh("cube(4); translate([0, 0, 5.1]) cube([4, 4, 0.01]);", resolution=16, certify=True).stats
    assert stats.certify.missed > 0 and stats.certify.places[0].line == 1
    assert csgmesh.mesh(BALL).stats.certify is None


def test_nothing_to_mesh(folder):
    with pytest.warns(csgmesh.SceneWarning, match="no surface"):
        mesh = csgmesh.mesh(BALL, bounds=[(50, 50, 50), (60, 60, 60)])
    assert mesh.vertices.shape == (0, 3) and mesh.triangles.shape == (0, 3)
    empty = "intersection() { cube(1); translate([5, 0, 0]) cube(1); }"
    assert len(csgmesh.mesh(empty).triangles) == 0
    with pytest.raises(csgmesh.SceneError, match="no surface"):
        csgmesh.write(empty, "x.ply")
    assert not list(folder.iterdir())
