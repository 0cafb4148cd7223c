# SPDX-License-Identifier: MIT
"""csgmesh: text scenes of solids and blends, and solids as Python values, to watertight triangle meshes.

    mesh = csgmesh.mesh("sphere(10);", tolerance=0.05)
    mesh.vertices, mesh.triangles, mesh.normals          # arrays of numpy, without a copy
    mesh.write("ball.glb")

    from csgmesh import sphere, cube, cylinder
    solid = (sphere(10) | cube(8)).fillet(2) - cylinder(h=40, r=3)
    print(solid)                                         # the scene's text

docs/python.md tells of all of it. Lengths are scene units, z is up.
"""
from . import _core, _modules, functions
from ._errors import (ArgumentError, Diagnostic, Error, FileError, FormatError, InternalError, LimitError, MissingFileError,
                      OutOfMemoryError, SceneError, SceneSyntaxError, SceneWarning, UnsupportedError)
from ._layers import slice as slice  # pylint: disable=redefined-builtin
from ._modules import Solid
from ._fabrication import faces, oriented_box, walls
from ._results import (Clearance, Diff, Mesh, Part, Scene, check, clear, diff, load, measure, mesh, parse, read, render, write,
                       write_image)
from ._solid import Expression, code
from ._modules import *  # noqa: F403 the modules of the scene language
from .functions import *  # noqa: F403 its blends

__version__: str = _core.version
#: which libraries this build has, a line each
features: str = _core.features


def formats() -> "list[dict[str, object]]":
    """The formats of mesh files, and what each of them keeps."""
    return _core.formats()


# not slice(), which would hide Python's own from who imports *
__all__ = [
    "ArgumentError", "Clearance", "Diagnostic", "Diff", "Error", "Expression", "FileError", "FormatError", "InternalError", "LimitError",
    "Mesh", "MissingFileError", "OutOfMemoryError", "Part", "Scene", "SceneError", "SceneSyntaxError", "SceneWarning", "Solid",
    "UnsupportedError", "check", "clear", "code", "diff", "faces", "features", "formats", "functions", "load", "measure", "mesh", "oriented_box",
    "parse", "read", "render", "walls", "write", "write_image",
]
__all__ += [*_modules.__all__, *functions.__all__]
