# SPDX-License-Identifier: MIT
"""A mesh as a page for browsers, and in Jupyter: the view of `csgmesh diff --html` (view.js, the same file) in a small frame,
with the mesh in it as arrays of integers in base64. Nothing is loaded from anywhere."""
from __future__ import annotations

import base64
import html
import json
import math
import os
import tempfile
from typing import TYPE_CHECKING, Any

import numpy as np

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


def _models(mesh: Mesh) -> dict[str, Any]:
    low, high = mesh.bounds - np.array(mesh.origin) if len(mesh.positions) else np.array([[0.0] * 3, [1.0] * 3])
    toward = [math.cos(ELEVATION) * math.sin(AZIMUTH), -math.cos(ELEVATION) * math.cos(AZIMUTH), math.sin(ELEVATION)]
    nothing = np.empty((0, 3))
    return {"a": _model(mesh.positions, mesh.triangles, mesh.colors, low, high - low),
            "b": _model(nothing, nothing, None, low, high - low),
            "box": [*low, *high], "toward": toward, "most": 0, "stops": [[0, 0, 0]] * 5}


def _words(mesh: Mesh) -> str:
    if not len(mesh.triangles):
        return "no triangles"
    size = mesh.bounds[1] - mesh.bounds[0]
    return f"{len(mesh.triangles)} triangles, " + " × ".join(f"{side:.5g}" for side in size)


def page(mesh: Mesh, title: str) -> str:
    texts = {}
    for name in ("page.html", "view.js"):
        with open(os.path.join(_HERE, name), encoding="utf-8") as file:
            texts[name] = file.read()
    data = json.dumps(_models(mesh)).replace("<", "\\u003c")
    filled = {"title": html.escape(title), "words": html.escape(_words(mesh)), "data": data, "js": texts["view.js"]}
    parts = texts["page.html"].split("{{")  # filled once: what is put in is not looked at again
    out = [parts[0]]
    for part in parts[1:]:
        name, rest = part.split("}}", 1)
        out += [filled[name], rest]
    return "".join(out)


def picture(mesh: Mesh) -> str:
    """A mesh that is too large to be kept in a notebook, as it looks."""
    from ._results import write_image
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mesh.png")
        write_image(mesh.render(width=720, height=HEIGHT), path)
        with open(path, "rb") as file:
            data = base64.b64encode(file.read()).decode()
    return (f'<figure style="margin: 0"><img width="720" height="{HEIGHT}" alt="the mesh" src="data:image/png;base64,{data}">'
            f"<figcaption>{html.escape(_words(mesh))}: too many to be turned here; mesh.to_html() makes a page of all, "
            'mesh(quality="draft") has fewer</figcaption></figure>')


def frame(mesh: Mesh) -> str:
    """For _repr_html_: the page in a frame of its own, so that it neither sees nor changes the notebook."""
    if len(mesh.triangles) > MOST:
        return picture(mesh)
    return (f'<iframe sandbox="allow-scripts" style="width: 100%; max-width: 720px; height: {HEIGHT}px; border: 0" '
            f'srcdoc="{html.escape(page(mesh, "csgmesh"))}"></iframe>')
