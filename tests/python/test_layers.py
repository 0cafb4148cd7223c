# SPDX-License-Identifier: MIT
"""Layers: the files of the command line, what is returned, and what is refused."""
import json
import pathlib

import pytest

import csgmesh
from conftest import SCENES, csgmesh_program

MUG = SCENES / "parts" / "mug.txt"


@pytest.mark.parametrize("options, arguments", [
    ({"layer": 2, "tolerance": 0.1}, ["--layer", 2, "-e", 0.1]),
    ({"layer": (0.5, 3), "cusp": 0.5, "tolerance": 0.1, "unit": "cm"},
     ["--layer", 0.5, "--most-layer", 3, "--cusp", 0.5, "-e", 0.1, "--unit", "cm"])])
@pytest.mark.parametrize("extension", ["svg", "cli", "3mf"])
def test_files_are_those_of_the_command_line(folder, extension, options, arguments):
    wanted = json.loads(csgmesh_program("slice", MUG, "-o", f"a.{extension}", "--json", *arguments, cwd=folder))
    found = csgmesh.slice(MUG, f"b.{extension}", **options)
    assert pathlib.Path(f"a.{extension}").read_bytes() == pathlib.Path(f"b.{extension}").read_bytes()
    for name in ("layers", "contours", "points", "tolerance", "volume", "unsettled", "smallest"):
        assert getattr(found, name) == wanted[name], name
    if "cusp" in options:
        assert (found.lowest, found.highest, found.sampled) == (wanted["lowest"], wanted["highest"], wanted["sampled"])


def test_sources_parts_and_formats(folder):
    solid = csgmesh.part("a", csgmesh.cube([2, 3, 4])) | csgmesh.part("b", csgmesh.sphere(1).translate([9, 0, 0]))
    for source in (solid, solid.scene(), str(solid)):
        found = csgmesh.slice(source, "layers", format="cli", layer=0.5, part="a")
        assert (found.layers, found.contours) == (8, 8) and found.volume == pytest.approx(24, rel=1e-4)
    assert csgmesh.slice(solid, "masks.zip", layer=1, pixel=0.5).layers == 5
    assert pathlib.Path("layers").read_text().startswith("$$HEADERSTART")


def test_what_is_refused(folder):
    cube = csgmesh.cube(1)
    for wrong, options, match in (
            (TypeError, {}, "wants the height of a layer"), (ValueError, {"layer": (0.1, 0.2)}, "cusp goes with"),
            (ValueError, {"layer": 0.1, "cusp": 0.1}, "cusp goes with"), (ValueError, {"layer": (1, 2, 3), "cusp": 1}, "layer must be"),
            (TypeError, {"layer": "thin"}, "layer must be a number"), (TypeError, {"layr": 1}, "did you mean 'layer'"),
            (ValueError, {"layer": 1, "part": "lid"}, "'lid'"), (csgmesh.ArgumentError, {"layer": -1}, "")):
        with pytest.raises(wrong, match=match):
            csgmesh.slice(cube, "x.svg", **options)
    with pytest.raises(ValueError, match="layers are written as svg, cli"):
        csgmesh.slice(cube, "x.stl", layer=1)
    with pytest.raises(ValueError, match="'gcode'"):
        csgmesh.slice(cube, "x.svg", format="gcode", layer=1)
    with pytest.raises(csgmesh.SceneError, match="infinity"):
        csgmesh.slice("plane([0, 0, 1]);", "x.svg", layer=1)
    with pytest.raises(csgmesh.LimitError):
        csgmesh.slice(MUG, "x.svg", layer=0.01, timeout=1e-6)
    assert list(folder.iterdir()) == []


def test_import_of_everything_keeps_slices():
    names = {}
    exec("from csgmesh import *", names)
    assert "slice" not in names and "Options:" in csgmesh.slice.__doc__ and "cusp" in csgmesh.slice.__doc__
