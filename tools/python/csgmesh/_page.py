# SPDX-License-Identifier: MIT
"""A mesh as a page for browsers, and in Jupyter: the view of `csgmesh diff --html` (view.js, the same file) in a small frame,
with the mesh in it as arrays of integers in base64. Nothing is loaded from anywhere."""
from __future__ import annotations

import base64
import html
import json
import math
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._call import Call

if TYPE_CHECKING:
    from ._results import Mesh

_HERE = os.path.dirname(os.path.abspath(__file__))
STEPS = 65535
MOST = 250000  # triangles in a notebook: as many as csgmesh diff --html draws of a mesh
HEIGHT = 420  # of the frame in a notebook, in CSS pixels
AZIMUTH, ELEVATION = math.radians(35), math.radians(25)  # as csgmesh render looks


def _base64(array: Any) -> str:
    return base64.b64encode(array.tobytes()).decode()


def _model(positions: Any, triangles: Any, colors: Any, low: Any, size: Any) -> dict[str, Any]:
    share = np.divide(positions - low, size, out=np.zeros(positions.shape), where=size > 0)
    model = {"vertices": len(positions), "triangles": len(triangles), "cell": 0,
             "positions": _base64(np.round(STEPS * share).astype("<u2")), "indices": _base64(triangles.astype("<u4"))}
    if colors is not None and len(colors):
        model["colors"] = _base64(colors[:, :3])
    return model


def _thinned(mesh: Mesh, most: int) -> tuple[Any, Any, Any]:
    """Positions, triangles and colours; where there are more triangles than `most`, each cluster of vertices as one."""
    positions, triangles, colors = mesh.positions, mesh.triangles, mesh.colors
    if len(triangles) <= most:
        return positions, triangles, colors
    cluster_of = np.empty(len(positions), np.uint32)
    call = Call("a page", {})
    low, high = (tuple(map(float, corner)) for corner in mesh.bounds)
    (count, _), _ = call.settle(_core.cluster(call.run, mesh._core, low, high, most, cluster_of))
    sizes = np.bincount(cluster_of, minlength=count)

    def means(columns: Any) -> Any:
        return np.stack([np.bincount(cluster_of, column, count) / sizes for column in columns.T], axis=1)
    joined = cluster_of[triangles]
    kept = (joined != np.roll(joined, 1, axis=1)).all(axis=1)
    return means(positions), joined[kept], None if colors is None else np.round(means(colors)).astype(np.uint8)


def _models(mesh: Mesh, most: int) -> dict[str, Any]:
    low, high = mesh.bounds - np.array(mesh.origin) if len(mesh.positions) else np.array([[0.0] * 3, [1.0] * 3])
    toward = [math.cos(ELEVATION) * math.sin(AZIMUTH), -math.cos(ELEVATION) * math.cos(AZIMUTH), math.sin(ELEVATION)]
    nothing = np.empty((0, 3))
    return {"a": _model(*_thinned(mesh, most), low, high - low), "b": _model(nothing, nothing, None, low, high - low),
            "box": [*low, *high], "toward": toward, "most": 0, "stops": [[0, 0, 0]] * 5}


def _words(mesh: Mesh, drawn: int) -> str:
    if not len(mesh.triangles):
        return "no triangles"
    size, fewer = mesh.bounds[1] - mesh.bounds[0], f" (drawn with {drawn})" if drawn < len(mesh.triangles) else ""
    return f"{len(mesh.triangles)} triangles{fewer}, " + " × ".join(f"{side:.5g}" for side in size)


def page(mesh: Mesh, title: str, most: int) -> str:
    texts = {}
    for name in ("page.html", "view.js"):
        with open(os.path.join(_HERE, name), encoding="utf-8") as file:
            texts[name] = file.read()
    models = _models(mesh, most)
    data, words = json.dumps(models).replace("<", "\\u003c"), _words(mesh, models["a"]["triangles"])
    filled = {"title": html.escape(title), "words": html.escape(words), "data": data, "js": texts["view.js"]}
    parts = texts["page.html"].split("{{")  # filled once: what is put in is not looked at again
    out = [parts[0]]
    for part in parts[1:]:
        name, rest = part.split("}}", 1)
        out += [filled[name], rest]
    return "".join(out)


def frame(mesh: Mesh) -> str:
    """For _repr_html_: the page in a frame of its own, so that it neither sees nor changes the notebook."""
    return (f'<iframe sandbox="allow-scripts" style="width: 100%; max-width: 720px; height: {HEIGHT}px; border: 0" '
            f'srcdoc="{html.escape(page(mesh, "csgmesh", MOST))}"></iframe>')
