# SPDX-License-Identifier: MIT
"""Measures and clearances: the figures of the command line, closed forms, and what is refused."""
import json
import math
import pathlib

import pytest

import csgmesh
from conftest import SCENES, csgmesh_program

MUG = SCENES / "parts" / "mug.txt"
BOXES = 'part("a") cube([1, 2, 3]); part("b") translate([t, 0, 0]) color("red") sphere(1);'


def test_figures_are_those_of_the_command_line(folder):
    for options, arguments in (({"tolerance": 1e-2}, []), ({"tolerance": 1e-2, "density": 2.5}, ["--density", 2.5])):
        wanted = json.loads(csgmesh_program("measure", MUG, "--json", "--to", 1e-2, *arguments, cwd=folder))
        found = csgmesh.measure(MUG, **options)
        assert list(found.volume) == wanted["volume"] and list(found.mass) == wanted["mass"]
        assert [list(pair) for pair in found.inertia] == list(wanted["inertia"].values())
        assert [list(pair) for pair in found.bounds] == list(wanted["bounds"].values())
        assert [list(pair) for pair in found.moments] == [one["moment"] for one in wanted["principal"]]
        assert [list(axis) for axis in found.axes] == [one["axis"] for one in wanted["principal"]]
        assert found.is_reached and found.cubes == wanted["cubes"]


def test_solids_scenes_and_meshes(folder):
    solid = csgmesh.cube([2, 3, 4])
    for source in (solid, solid.scene(), "cube([2, 3, 4]);", solid.mesh()):
        found = csgmesh.measure(source)
        assert found.volume[0] <= 24 <= found.volume[1] and found.volume[1] - found.volume[0] < 0.01
        assert found.area[0] <= 52 <= found.area[1]
        assert found.area[1] - found.area[0] < 0.1 and found.axis_within[0] < 1
    low, high = csgmesh.measure(BOXES, define={"t": 9}, part="b", tolerance=1e-3).volume
    assert low <= 4 / 3 * math.pi <= high
    assert not csgmesh.measure("torus(8, 2);", tolerance=1e-9, most_cubes=1000).is_reached
    with pytest.raises(ValueError, match="'c'"):
        csgmesh.measure(BOXES, define={"t": 9}, part="c")
    with pytest.raises(csgmesh.SceneError, match="infinity"):
        csgmesh.measure("plane([0, 0, 1]);")
    with pytest.raises(TypeError, match="did you mean 'density'"):
        csgmesh.measure(solid, densty=1)
    with pytest.raises(csgmesh.LimitError):
        csgmesh.measure(MUG, timeout=1e-6)


def test_what_a_workshop_asks(folder):
    solid = csgmesh.cube([10, 20, 30]).rotate([20, 30, 40])
    for source in (solid, solid.mesh()):
        box = csgmesh.oriented_box(source, tolerance=1e-3)
        assert [round(high) for _, high in box.edges] == [30, 20, 10] and 5900 < box.volume[0] <= box.volume[1] < 6100
        assert all(math.hypot(*axis) == pytest.approx(1) for axis in box.axes) and len(box.ends) == 6
    shell = "difference() { cube([10, 20, 30]); translate([1, 1, 2]) cube([8, 18, 40]); }"
    found = csgmesh.walls(shell, tolerance=1e-2)
    assert found.wall.length[0] <= 1 <= found.wall.length[1] and found.gap.length[0] <= 8 <= found.gap.length[1]
    assert math.dist(*found.wall.at) == pytest.approx(found.wall.length[1]) and found.wall.overlooked == 0
    none = csgmesh.walls(csgmesh.cube(10), tolerance=1e-2).gap
    assert none.length == (math.inf, math.inf) and none.at is None
    faces = csgmesh.faces(csgmesh.cube([1, 2, 3]).mesh(), overhang_deg=30)
    assert faces.overhang[0] == pytest.approx(2) and faces.resting == faces.overhang and faces.steep[0] == pytest.approx(18)
    turned = csgmesh.faces(csgmesh.cube([1, 2, 3]).mesh(), up=[1, 0, 0])
    assert turned.overhang[0] == pytest.approx(6)
    for mistake in ({"angle_deg": 41}, {"part": "c"}):
        with pytest.raises(ValueError):
            csgmesh.walls("cube(1);", **mistake)
    with pytest.raises(TypeError, match="did you mean 'draft_deg'"):
        csgmesh.faces(csgmesh.cube(1).mesh(), draft_degs=1)


def test_clearances(folder):
    (folder / "boxes.txt").write_text("t = 0;\n" + BOXES)
    poses = [{"t": t} for t in (9, 2.5, 1.5, 4)]
    for source in (pathlib.Path("boxes.txt"), "t = 0;\n" + BOXES):
        (pair,) = csgmesh.clear(source, poses=poses[:2], tolerance=1e-3)
        assert (pair.parts, pair.state, pair.pose, pair.poses, pair.poses_bad) == (("a", "b"), "apart", 1, 2, 0)
        assert pair.gap[0] <= 0.5 <= pair.gap[1] and pair.gap[1] - pair.gap[0] <= 2e-3
        assert pair.inside is None and math.dist(*pair.nearest) == pytest.approx(pair.gap[1], abs=1e-6)
        (pair,) = csgmesh.clear(source, poses=poses)
        assert (pair.state, pair.pose, pair.poses_bad) == ("interfering", 2, 1)
        assert pair.volume[0] > 0 and pair.nearest is None and 0.5 < pair.inside[0] < 1
    assert (pair.steps, pair.steps_open, pair.first_open) == (3, 2, 2) and pair.gap_between == 0
    (pair,) = csgmesh.clear(BOXES, poses=[{"t": t} for t in (4, 3.75, 3.5)])
    assert (pair.steps_open, pair.first_open) == (0, None) and 0.7 < pair.gap_between <= 1.5
    (pair,) = csgmesh.clear(BOXES, define={"t": 2.5}, min_gap=0.6)
    assert (pair.poses_bad, pair.poses_open) == (1, 0)
    assert csgmesh.clear(csgmesh.code(BOXES.replace("t,", "9,")), parts="a")[0].state == "apart"
    with pytest.raises(ValueError, match="'a', 'b'"):
        csgmesh.clear(BOXES, define={"t": 9}, parts=["a", "d"])
    with pytest.raises(csgmesh.ArgumentError):
        csgmesh.clear(BOXES, define={"t": 9}, tolerance=-1)
    with pytest.raises(csgmesh.SceneSyntaxError):
        csgmesh.clear("cube(")
    with pytest.raises(csgmesh.SceneError):
        csgmesh.clear("cube(1);")
    with pytest.raises(csgmesh.SceneError, match="made in"):
        csgmesh.clear(csgmesh.cube(1).translate("nowhere"))
    with pytest.raises(ValueError, match="define"):
        csgmesh.clear(BOXES, poses=[{"no name": 1}])
    with pytest.raises(TypeError, match="Scene"):
        csgmesh.clear(csgmesh.parse(BOXES, define={"t": 9}))
