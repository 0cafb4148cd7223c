# SPDX-License-Identifier: MIT
"""What a workshop asks of a solid: csgmesh/fabrication.h."""
from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Union

from . import _core
from ._call import Call, split
from ._results import SCENE_OPTIONS, Mesh, Source, _check_names, _measures, document, scene_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._types import FaceOptions, MeasureOptions, WallOptions


def oriented_box(source: Union[Source, Mesh], **options: Unpack[MeasureOptions]) -> SimpleNamespace:
    """The smallest box in any orientation that was found around a scene, a solid or a mesh: axes of unit length, the edges'
    lengths along these, the longest first, the volume, and the ends, the least along each axis, then the largest. That
    the solid lies in it is proven. As `csgmesh measure --box` (docs/measure.md)."""
    _check_names("oriented_box()", options, "measure", "scene")
    how, others = split(options, "measure")
    if isinstance(source, Mesh):
        call = Call("oriented_box()", options, "measure")
        return _measures(call, _core.oriented_box_of_mesh(call.run, source._core, call.of["measure"]))
    scene = scene_of(source, others)
    call = Call("oriented_box()", how, "measure")
    return _measures(call, _core.oriented_box_of_scene(call.run, scene._core, call.of["measure"]))


def walls(source: Source, **options: Unpack[WallOptions]) -> SimpleNamespace:
    """The thinnest wall and the narrowest gap of a scene or a solid: the length of each as (low, high), infinite where there
    is none, and at, two points that are high apart, or None. Below overlooked, places whose normals are not known were
    not looked at. As `csgmesh measure --walls` (docs/measure.md)."""
    _check_names("walls()", options, "wall", "scene")
    how, others = split(options, "wall")
    scene = scene_of(source, others)
    call = Call("walls()", how, "wall")
    return _measures(call, _core.walls_of_scene(call.run, scene._core, call.of["wall"]), "wall")


def faces(mesh: Mesh, **options: Unpack[FaceOptions]) -> SimpleNamespace:
    """The areas of a mesh's faces by direction: all of it, what overhangs, what of that it rests on, and steep walls without
    draft, each (low, high). As `csgmesh measure --overhang` (docs/measure.md)."""
    _check_names("faces()", options, "face")
    call = Call("faces()", options, "face")
    return _measures(call, _core.faces_of_mesh(call.run, mesh._core, call.of["face"]), "face")


document(oriented_box, [*_core.option_names["measure"], *SCENE_OPTIONS])
document(walls, [*_core.option_names["wall"], *SCENE_OPTIONS])
document(faces, _core.option_names["face"])
