# SPDX-License-Identifier: MIT
"""Layers for printers, straight from a field."""
from __future__ import annotations

import os
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Optional

from . import _core
from ._call import Call, path_bytes, split
from ._results import SCENE_OPTIONS, Source, _check_names, _spaces, document, scene_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._types import Path, SliceOptions


def _format(path: Path, name: Optional[str]) -> bytes:
    known = _core.layer_formats()
    wanted = os.path.splitext(os.fsdecode(path))[1][1:].lower() if name is None else name
    if wanted not in known:
        raise ValueError(f"layers are written as {', '.join(known)}, not {wanted!r}: " + (
            f"{os.fsdecode(path)}: its extension names none; format= may" if name is None else "format names none of them"))
    return wanted.encode()


def slice(source: Source, path: Path, format: Optional[str] = None, **options: Unpack[SliceOptions]) -> SimpleNamespace:  # pylint: disable=redefined-builtin
    """The contours of a scene's, a file's or a solid's layers, straight from the field, into a file (.svg, .cli, .3mf with the
    slice extension, .zip of masks), each within tolerance of the surface. layer is the height of all layers, or the least and
    the largest one: then each is as high as cusp allows. Returns how many layers, contours and points there are, their volume,
    and what is not proven. As `csgmesh slice` (docs/slice.md)."""
    _check_names("slice()", options, "slice", "scene")
    name, as_format = path_bytes(path), _format(path, format)
    how, others = split(options, "slice")
    scene = scene_of(source, others)
    call = Call("slice()", how, "slice")
    _check_values(call.of["slice"])
    answer = _core.slice_scene(call.run, scene._core, name, as_format, call.of["slice"])
    part = call.of["slice"].get("part")
    if answer[0] == "ERR_ARGUMENT" and part is not None:
        raise ValueError(f"part: there is none of the name {part.decode()!r}, or another option is out of range")
    return _spaces(call.settle(answer)[0])


def _check_values(given: dict[str, Any]) -> None:
    """What can only be told of two options together, or is always wanted."""
    if given.get("layer") is None:
        raise TypeError("slice() wants the height of a layer: layer=0.2, or layer=(0.05, 0.3) with cusp=0.02")
    if isinstance(given["layer"], (tuple, list)) != (given.get("cusp") is not None):
        raise ValueError("cusp goes with a least and a largest height of layers: layer=(0.05, 0.3), cusp=0.02")


document(slice, [*_core.option_names["slice"], *SCENE_OPTIONS])
