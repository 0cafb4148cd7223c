# SPDX-License-Identifier: MIT
"""Scenes, meshes, pictures and comparisons: what libcsgmesh makes, with the names that people use."""
from __future__ import annotations

import math
import os
import re
import textwrap
from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union

import numpy as np

from . import _core, _errors, _page
from ._call import Call, defines, existing, format_bytes, path_bytes, split
from ._errors import Diagnostic
from ._solid import SolidBase

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray
    from typing_extensions import Unpack

    from ._types import ClearOptions, DiffOptions, MeasureOptions, MeshOptions, Path, RenderOptions, RunOptions, SceneMeshOptions, SceneOptions
    from ._types import SceneWriteOptions, WriteOptions

Source = Union[str, "os.PathLike[str]", SolidBase, "Scene"]


def _spaces(value: Any) -> Any:
    """Dicts as objects whose members are read by name."""
    if isinstance(value, dict):
        return SimpleNamespace(**{key: _spaces(item) for key, item in value.items()})
    return [_spaces(item) for item in value] if isinstance(value, list) else value


class Part(NamedTuple):
    """A run of a mesh's triangles with a name: mesh.triangles[part.slice]."""

    name: Optional[str]
    first_triangle: int
    triangle_count: int

    @property
    def slice(self) -> slice:
        return slice(self.first_triangle, self.first_triangle + self.triangle_count)


# ---- meshes

def _rows(array: ArrayLike, dtype: Any, columns: int, what: str) -> NDArray[Any]:
    """As an array of rows, without a copy where it is one already."""
    rows = np.asarray(array)
    if rows.ndim != 2 or rows.shape[1] != columns:
        raise ValueError(f"{what} must have the shape (n, {columns}), not {rows.shape}")
    if rows.dtype.kind not in "fiu" or (np.dtype(dtype).kind == "u" and rows.dtype.kind == "f"):
        raise TypeError(f"{what} must be {'whole ' if np.dtype(dtype).kind == 'u' else ''}numbers, not {rows.dtype}")
    most = np.iinfo(dtype).max if np.dtype(dtype).kind == "u" else None
    if most and rows.size and (rows.min() < 0 or rows.max() > most):
        raise ValueError(f"{what} must be from 0 to {most}")
    return np.ascontiguousarray(rows, dtype)


class Mesh:
    """A triangle mesh. Its arrays show libcsgmesh's memory, without a copy: they cannot be written to, and each keeps the
    mesh alive. `Mesh(vertices, triangles)` makes one of arrays of your own, which are shared where they are of single
    precision and of 32 bits."""

    __slots__ = ("_core", "_vertices", "diagnostics", "stats", "format", "__weakref__")
    _core: Any
    _vertices: Optional[NDArray[Any]]
    diagnostics: list[Diagnostic]  #: what was found while it was made
    stats: Any  #: what making it cost and found: csgm_mesh_stats; None: it was not made of a scene
    format: Optional[str]  #: of the file that it was read from

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, *, normals: Optional[ArrayLike] = None,
                 colors: Optional[ArrayLike] = None, parts: Sequence[tuple[Optional[str], int, int]] = ()):
        points = np.asarray(vertices)
        origin = (0.0, 0.0, 0.0)
        if points.dtype == np.float64 and points.ndim == 2 and points.shape[1:] == (3,) and len(points):
            origin = _origin_of(points)
            points = points - origin if any(origin) else points
        positions = _rows(points, np.float32, 3, "vertices")
        indices = _rows(triangles, np.uint32, 3, "triangles")
        if indices.size and indices.max() >= len(positions):
            raise ValueError(f"triangles: there is no vertex {indices.max()}, only {len(positions)}")
        own = [None if array is None else _rows(array, dtype, columns, what) for array, dtype, columns, what in
               ((normals, np.float32, 3, "normals"), (colors, np.uint8, 4, "colors"))]
        for array, what in zip(own, ("normals", "colors")):
            if array is not None and len(array) != len(positions):
                raise ValueError(f"{what} must have one row for each of the {len(positions)} vertices, not {len(array)}")
        self._take(_core.mesh_of_arrays(
            origin, positions, indices, own[0], own[1], _checked_parts(parts, len(indices))), [], None)

    def _take(self, core: Any, diagnostics: list[Diagnostic], format_name: Optional[str]) -> None:
        self._core, self._vertices = core, None
        self.diagnostics, self.stats, self.format = diagnostics, _spaces(core.stats), format_name

    @classmethod
    def _of(cls, core: Any, diagnostics: list[Diagnostic], format_name: Optional[str] = None) -> Mesh:
        self = cls.__new__(cls)
        self._take(core, diagnostics, format_name)
        return self

    # ---- arrays

    @property
    def vertices(self) -> NDArray[Any]:
        """(n, 3), in scene units: single precision, without a copy. Of a solid that lies so far from zero that this would be
        too coarse: double precision, made once (positions + origin)."""
        if not any(self.origin):
            return self.positions
        if self._vertices is None:
            self._vertices = self.positions + np.array(self.origin)
            self._vertices.flags.writeable = False
        return self._vertices

    @property
    def origin(self) -> tuple[float, float, float]:
        """What positions are relative to; zeros but for solids far from zero."""
        return self._core.origin

    @property
    def positions(self) -> NDArray[np.float32]:
        """(n, 3), relative to origin, without a copy."""
        return self._core.positions

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """(m, 3): three vertices each, counter-clockwise seen from outside; without a copy."""
        return self._core.triangles

    @property
    def normals(self) -> Optional[NDArray[np.float32]]:
        """(n, 3), of length 1, outwards, without a copy; None: it has none."""
        return self._core.normals

    @property
    def colors(self) -> Optional[NDArray[np.uint8]]:
        """(n, 4): sRGB and alpha, without a copy; None: the scene has no colours."""
        return self._core.colors

    @property
    def materials(self) -> Optional[NDArray[np.uint16]]:
        """(n, 2): metallic and roughness times 10000, without a copy; None: the scene has none."""
        return self._core.materials

    @property
    def parts(self) -> list[Part]:
        """All triangles in order; a mesh of a scene without parts is one without a name."""
        parts = [Part(*part) for part in self._core.parts]
        return parts or [Part(None, 0, len(self.triangles))]

    @property
    def is_split(self) -> bool:
        """It has a vertex for each sheet at creases (normals="crease")."""
        return self._core.split

    @property
    def bounds(self) -> NDArray[np.float64]:
        """[[x, y, z], [x, y, z]] of its vertices."""
        if not len(self.positions):
            return np.array([[math.inf] * 3, [-math.inf] * 3])
        low, high = self.positions.min(axis=0), self.positions.max(axis=0)
        return np.array([low, high], np.float64) + np.array(self.origin)

    # ---- what can be done with it

    def inspect(self, **options: Unpack[RunOptions]) -> SimpleNamespace:
        """What csgmesh info counts and measures: open edges, components, genus, area, volume, the worst triangles ..."""
        call = Call("Mesh.inspect()", options)
        return _spaces(call.settle(_core.inspect(call.run, self._core))[0])

    def write(self, path: Path, format: Optional[str] = None, **options: Unpack[WriteOptions]) -> None:
        """Writes a file, complete or not at all, in the format that its extension (or `format`) names."""
        call = Call("Mesh.write()", options, "write")
        call.settle(_core.write(call.run, self._core, path_bytes(path), _format_for(path, format), call.of["write"]))

    def as_file(self, format: str, **options: Unpack[WriteOptions]) -> Mesh:
        """The mesh as a file of this format gives it back: rounded, welded or split, without what it does not keep."""
        call = Call("Mesh.as_file()", options, "write")
        core, found = call.settle(_core.as_file(call.run, self._core, format_bytes(format), call.of["write"]))
        return Mesh._of(core, found, format)

    def render(self, **options: Unpack[RenderOptions]) -> NDArray[np.uint8]:
        """A picture: (height, width, 4), sRGB and alpha. csgmesh.render."""
        return render(self, **options)

    def to_trimesh(self) -> Any:
        """A trimesh.Trimesh, which copies the arrays (it computes in double precision)."""
        import trimesh
        given: dict[str, Any] = {"vertex_normals": self.normals, "vertex_colors": self.colors}
        kept = {name: array for name, array in given.items() if array is not None}
        return trimesh.Trimesh(self.vertices, self.triangles, process=False, metadata={"parts": self.parts}, **kept)

    def to_html(self, title: str = "csgmesh", triangles: int = 1_000_000) -> str:
        """A page that shows it, to be turned: whole in itself, without any network. It holds at most so many triangles."""
        return _page.page(self, title, triangles)

    def _repr_html_(self) -> str:
        return _page.frame(self)

    def __repr__(self) -> str:
        has = [name for name in ("normals", "colors", "materials") if getattr(self, name) is not None]
        named = [part.name for part in self.parts if part.name]
        more = (", " + ", ".join(has) if has else "") + (", parts " + ", ".join(named) if named else "")
        return f"<csgmesh.Mesh: {len(self.positions)} vertices, {len(self.triangles)} triangles{more}>"


def _origin_of(points: NDArray[np.float64]) -> tuple[float, float, float]:
    """Where double precision is asked for and single would be too coarse: the middle of the box."""
    low, high = points.min(axis=0), points.max(axis=0)
    size, far = float((high - low).max()), float(np.abs([low, high]).max())
    if not np.isfinite(far) or far <= 64 * size:
        return (0.0, 0.0, 0.0)
    middle = np.round((low + high) / 2)
    return (float(middle[0]), float(middle[1]), float(middle[2]))


def _checked_parts(parts: Sequence[tuple[Optional[str], int, int]], triangles: int) -> list[tuple[Optional[str], int, int]]:
    at, out = 0, []
    for name, first, count in parts:
        if first != at or count < 0:
            raise ValueError(f"parts must take all triangles in order: part {name!r} begins at {first}, not at {at}")
        at += count
        out.append((name, int(first), int(count)))
    if out and at != triangles:
        raise ValueError(f"parts must take all triangles: they have {at} of {triangles}")
    return out


def _format_for(path: Path, format: Optional[str]) -> bytes:
    """The format of a file to be written; one that nobody knows is said with what there is."""
    if format is None and not _core.format_of(path_bytes(path)):
        known = ", ".join("." + row["name"] for row in _core.formats() if row["is_written"])
        raise ValueError(f"{os.fsdecode(path)}: its extension names no format of meshes ({known}); format= may")
    return format_bytes(format)


# ---- scenes

class Scene:
    """A scene that is read: the exact field, and what meshes and pictures are made of."""

    __slots__ = ("_core", "_info", "_source", "diagnostics", "__weakref__")
    _core: Any
    _info: Any
    _source: Optional[str]  # the name of its file, without folders
    diagnostics: list[Diagnostic]  #: what was found while it was read

    def __init__(self) -> None:
        raise TypeError("scenes are made by csgmesh.load(path), csgmesh.parse(text) or solid.scene()")

    @classmethod
    def _of(cls, core: Any, diagnostics: list[Diagnostic]) -> Scene:
        self = cls.__new__(cls)
        self._core, self._info, self._source, self.diagnostics = core, core.info(), None, diagnostics
        return self

    @property
    def bounds(self) -> NDArray[np.float64]:
        """[[x, y, z], [x, y, z]]: a box that contains the solid; sides may be infinite."""
        return np.array(self._info["bounds"])

    @property
    def lipschitz(self) -> float:
        """How much the field changes at most along one unit of length."""
        return self._info["lipschitz"]

    @property
    def primitive_count(self) -> int:
        return self._info["primitive_count"]

    @property
    def operator_count(self) -> int:
        return self._info["operator_count"]

    @property
    def has_colors(self) -> bool:
        return self._info["has_colors"]

    @property
    def files(self) -> list[str]:
        """The files that were read for it: its own first, then what it includes and imports."""
        return [os.fsdecode(name) for name in self._core.files()]

    def field(self, points: ArrayLike, *, gradients: bool = True, **options: Unpack[RunOptions]) -> Any:
        """The exact field at points of the shape (..., 3): values (...) and gradients (..., 3), positive inside. By all
        threads, without the GIL. With gradients=False the values alone."""
        given = np.asarray(points)
        if given.ndim < 1 or given.shape[-1] != 3:
            raise ValueError(f"points must have the shape (..., 3), not {given.shape}")
        if given.dtype.kind not in "fiu":
            raise TypeError(f"points must be numbers, not {given.dtype}")
        rows = np.ascontiguousarray(given.reshape(-1, 3), np.float64)
        few = {"threads": 1} if len(rows) < 256 else {}  # threads would cost more than they give
        call = Call("Scene.field()", {**few, **options})
        values: NDArray[np.float64] = np.empty(len(rows))
        slopes = np.empty((len(rows), 3)) if gradients else None
        call.settle(_core.eval_points(call.run, self._core, rows, values, slopes))
        shaped = values.reshape(given.shape[:-1])
        return (shaped, slopes.reshape(given.shape)) if slopes is not None else shaped

    def mesh(self, **options: Unpack[MeshOptions]) -> Mesh:
        """Its mesh: csgmesh.mesh."""
        call = Call("Scene.mesh()", options, "mesh")
        return Mesh._of(*call.settle(_core.build(call.run, self._core, call.of["mesh"])))

    def write(self, path: Path, format: Optional[str] = None, **options: Any) -> SimpleNamespace:
        """Straight into a file: csgmesh.write."""
        return write(self, path, format, **options)

    def render(self, **options: Unpack[RenderOptions]) -> NDArray[np.uint8]:
        """A picture: (height, width, 4), sRGB and alpha. csgmesh.render."""
        return render(self, **options)

    def dump(self, what: str = "scene", **options: Unpack[RunOptions]) -> str:
        """It as text: "scene" parses back to the same tree, "openscad" is for OpenSCAD (read it with facets="exact" and
        flat="kept"), "vm" for fidget and libfive, "tape" is what the kernels run."""
        kinds = ("scene", "tape", "vm", "openscad")
        if what not in kinds:
            raise ValueError(f"what must be one of {', '.join(kinds)}, not {what!r}")
        call = Call("Scene.dump()", options)
        return call.settle(_core.dump(call.run, self._core, kinds.index(what)))[0]

    def draw(self, path: Path, **options: Unpack[WriteOptions]) -> None:
        """Writes the outlines of a flat scene, which was read with flat="drawing": .svg, .dxf or .pdf."""
        name = path_bytes(path)
        if _core.drawing_format(name) not in ("svg", "dxf", "pdf"):
            raise ValueError(f"{os.fsdecode(name)}: drawings are .svg, .dxf or .pdf")
        if not self._core.layer_count:
            raise ValueError('the scene has no outlines: read a flat one with flat="drawing"')
        call = Call("Scene.draw()", options, "write")
        call.settle(_core.draw(call.run, self._core, name, call.of["write"]))

    def __str__(self) -> str:
        return self.dump()

    def __repr__(self) -> str:
        name = f" of {self.files[0]}" if self.files else ""
        return f"<csgmesh.Scene{name}: {self.primitive_count} primitives, {self.operator_count} operators>"

    def _repr_html_(self) -> str:
        return self.mesh(quality="draft")._repr_html_()


def load(path: Path, **options: Unpack[SceneOptions]) -> Scene:
    """Reads a scene from a file."""
    call = Call("load()", options, "scene")
    scene = Scene._of(*call.settle(_core.load(call.run, existing(path), call.of["scene"])))
    scene._source = os.path.basename(os.fsdecode(path))
    return scene


def parse(text: str, name: str = "text", **options: Unpack[SceneOptions]) -> Scene:
    """Reads a scene from its text. name: what findings call it; where it has a folder, includes are looked for there."""
    if not isinstance(text, str):
        raise TypeError(f"text must be a str, not {type(text).__name__}")
    call = Call("parse()", options, "scene")
    return Scene._of(*call.settle(
        _core.parse(call.run, text.encode("utf-8", "surrogatepass"), path_bytes(name, "name"), call.of["scene"])))


def scene_of(source: Source, options: Any) -> Scene:
    """A text, the path of a file (as pathlib has it), a solid, or a scene."""
    if isinstance(source, Scene):
        for name in options:
            if name in _core.option_names["scene"]:
                raise TypeError(f"{name} says how a text is read: the scene has been")
        return source
    if isinstance(source, SolidBase):
        call = Call("a solid", options, "scene")
        return Scene._of(*call.settle(
            _core.parse(call.run, str(source).encode("utf-8", "surrogatepass"), b"solid", call.of["scene"]), source._origin))
    if isinstance(source, str):
        if re.fullmatch(r"[^;(){}\n]+\.(txt|scad|csg)", source):
            raise ValueError(f"{source!r} is the name of a file, where a scene's text is wanted: "
                             f"csgmesh.load({source!r}) or pathlib.Path({source!r})")
        return parse(source, **options)
    if isinstance(source, os.PathLike):
        return load(source, **options)
    raise TypeError(f"a scene's text, a path, a solid or a scene is wanted, not {type(source).__name__}")


def check(source: Source, **options: Unpack[SceneOptions]) -> list[Diagnostic]:
    """What is wrong with a scene's text, a file (a pathlib.Path) or a solid, as csgmesh check says it: all findings, and none
    of them raises or warns. Quicker than reading it, as nothing is made that nobody asks about."""
    call = Call("check()", options, "scene")
    _read_in(call, source, {**call.of["scene"], "only_check": True})
    return _errors.diagnostics_of(call.run.findings, _origin_in(source))


def _read_in(call: Call, source: Any, how: dict[str, Any]) -> tuple[str, Any]:
    """A scene in the call's own run, as _core returns it: nothing raises or warns."""
    if isinstance(source, os.PathLike):
        return _core.load(call.run, existing(source), how)
    if not isinstance(source, (str, SolidBase)):
        raise TypeError(f"a scene's text, a path or a solid is wanted, not {type(source).__name__}")
    name = b"solid" if isinstance(source, SolidBase) else b"text"
    return _core.parse(call.run, str(source).encode("utf-8", "surrogatepass"), name, how)


def _origin_in(source: Any) -> Optional[_errors.Origin]:
    """Where in Python a solid was made; None of others."""
    return source._origin if isinstance(source, SolidBase) else None


def mesh(source: Source, **options: Unpack[SceneMeshOptions]) -> Mesh:
    """The mesh of a scene's text, of a file (a pathlib.Path), of a solid or of a scene."""
    _check_names("mesh()", options, "scene", "mesh")
    how: Any
    how, others = split(options, "mesh")
    return scene_of(source, others).mesh(**how)


def write(source: Union[Source, Mesh], path: Path, format: Optional[str] = None, **options: Unpack[SceneWriteOptions]) -> Any:
    """Meshes a scene straight into a file, with the bytes of `csgmesh SCENE -o FILE`: PLY, STL and GLB of equal cells are
    filled by all threads while the mesh is made, in memory that does not grow with it. Normals are those of sheets
    ("crease") where the format keeps them."""
    name, format_name = path_bytes(path), _format_for(path, format)
    if isinstance(source, Mesh):
        given: Any = options
        return source.write(path, format, **given)
    _check_names("write()", options, "scene", "mesh", "write")
    how, others = split(options, "mesh", "write")
    scene = scene_of(source, others)
    if scene._source and isinstance(how.get("metadata", {}), Mapping):  # as the command line has it
        how["metadata"] = {"source": scene._source, **how.get("metadata", {})}
    call = Call("write()", {"normals": "crease", **how}, "mesh", "write")
    (vertices, triangles, stats), _ = call.settle(
        _core.build_file(call.run, scene._core, name, format_name, call.of["mesh"], call.of["write"]))
    return SimpleNamespace(vertices=vertices, triangles=triangles, stats=_spaces(stats))


def _check_names(doing: str, options: Any, *kinds: str) -> None:
    """Before anything is done: names that no option has."""
    Call(doing, {k: v for k, v in options.items() if k not in ("progress", "echo")}, *kinds)


def read(path: Path, format: Optional[str] = None, **options: Unpack[RunOptions]) -> Mesh:
    """Reads a mesh from a file."""
    name = existing(path)
    known = _core.format_of(name)
    if format is None and not known:
        formats = ", ".join("." + row["name"] for row in _core.formats() if row["is_read"])
        raise ValueError(f"{os.fsdecode(name)}: its extension names no format of meshes ({formats}); csgmesh.load reads scenes")
    call = Call("read()", options)
    return Mesh._of(*call.settle(_core.read(call.run, name, format_bytes(format))), format or known)


# ---- pictures

def render(source: Union[Source, Mesh], **options: Unpack[RenderOptions]) -> NDArray[np.uint8]:
    """A picture of a scene, a solid or a mesh as an array (height, width, 4): sRGB and alpha, without a copy. A scene's is
    drawn from its field, without a mesh."""
    if isinstance(source, Mesh):
        call = Call("render()", options, "render")
        return call.settle(_core.render_mesh(call.run, source._core, call.of["render"]))[0].pixels
    _check_names("render()", options, "render", "scene")
    how, others = split(options, "render")
    scene = scene_of(source, others)
    call = Call("render()", how, "render")
    return call.settle(_core.render_scene(call.run, scene._core, call.of["render"]))[0].pixels


def write_image(pixels: ArrayLike, path: Path, **options: Unpack[RunOptions]) -> None:
    """Writes a picture, .png or .ppm, from an array (height, width, 4) of bytes."""
    rows = np.asarray(pixels)
    if rows.ndim != 3 or rows.shape[2] != 4 or not rows.size:
        raise ValueError(f"pixels must have the shape (height, width, 4), not {rows.shape}")
    if rows.dtype != np.uint8:
        raise TypeError(f"pixels must be of type uint8, not {rows.dtype}")
    name = path_bytes(path)
    if os.path.splitext(name)[1].lower() not in (b".png", b".ppm"):
        raise ValueError(f"{os.fsdecode(name)}: pictures are .png or .ppm")
    call = Call("write_image()", options)
    call.settle(_core.write_image(call.run, np.ascontiguousarray(rows), name))


# ---- comparisons

class Diff:
    """A comparison of two meshes. Its members are those of `csgmesh diff --json` (docs/diff.md): level, different, reasons,
    hausdorff, a_to_b, b_to_a, volume, a, b ..."""

    def __init__(self, core: Any, diagnostics: list[Diagnostic]):
        self._core = core
        self.diagnostics = diagnostics
        self.__dict__.update(vars(_spaces(core.report())))

    different: bool
    level: str
    reasons: list[str]
    tolerance: float
    hausdorff: tuple[float, float]

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"a comparison has no {name!r}")

    def __bool__(self) -> bool:
        """Whether they are different."""
        return self.different

    @property
    def distances_a(self) -> Optional[NDArray[np.float32]]:
        """The distance of each vertex of A from B, without a copy; None: they were not measured."""
        return self._core.distances(0)

    @property
    def distances_b(self) -> Optional[NDArray[np.float32]]:
        """The distance of each vertex of B from A, without a copy; None: they were not measured."""
        return self._core.distances(1)

    def write_heatmap(self, path: Path, side: str = "b", **options: Unpack[WriteOptions]) -> None:
        """Writes one side with its distances as colours: PLY, OBJ, OFF, glTF, 3MF or AMF."""
        if side not in ("a", "b"):
            raise ValueError(f"side must be 'a' or 'b', not {side!r}")
        if self._core.distances("ab".index(side)) is None:
            raise ValueError("the distances of the vertices were not measured")
        _format_for(path, None)
        call = Call("Diff.write_heatmap()", options, "write")
        call.settle(_core.write_heatmap(call.run, self._core, "ab".index(side), path_bytes(path), call.of["write"]))

    def __repr__(self) -> str:
        why = f" ({', '.join(self.reasons)})" if self.reasons else ""
        low, high = self.hausdorff
        return f"<csgmesh.Diff: {self.level}{why}, {low:.6g} to {high:.6g} apart>"


_QUALITIES = ("normal", "draft", "fine")


def _tolerance(scene: Scene, how: dict[str, Any], quality: str) -> float:
    """Of cells that follow the shape; 0: something else says how fine they are."""
    if any(how.get(name) for name in ("resolution", "cell_size", "tolerance", "simplify_error", "simplify_share", "bounds")):
        return 0.0
    return _core.quality_tolerance(_QUALITIES.index(quality), scene._core)


def _shared_tolerance(scenes: list[Scene], how: dict[str, Any], options: Any) -> float:
    """Two scenes are meshed within one tolerance, as csgmesh diff does it: the smaller of theirs, and a quarter of what may
    differ at most, but not less than that of quality "fine"."""
    own = [_tolerance(scene, how, how.get("quality", "normal")) for scene in scenes]
    if not all(own):
        return 0.0
    within, finest = min(own), min(_tolerance(scene, how, "fine") for scene in scenes)
    diagonal = float(np.linalg.norm(scenes[0].bounds[1] - scenes[0].bounds[0]))
    most = max(options.get("tolerance") or 0, (options.get("tolerance_relative") or 0) * diagonal)
    if 0 < most < math.inf:
        within = min(within, max(2.0 ** math.floor(math.log2(most / 4)), finest))
    return within


def _side(source: Union[Source, Mesh], common: dict[str, Any]) -> Union[Scene, Mesh]:
    if isinstance(source, (Mesh, Scene)):
        return source
    if isinstance(source, SolidBase):
        return scene_of(source, common)
    name = path_bytes(source)
    return read(source, **common) if _core.format_of(name) else load(source, **common)


def _mesh_side(scene: Scene, other: Union[Scene, Mesh], how: dict[str, Any], normals: Optional[str]) -> Mesh:
    """A scene's mesh, as the file of the other side would hold it."""
    as_format = other.format if isinstance(other, Mesh) else None
    row = next((row for row in _core.formats() if row["name"] == as_format and row["is_written"]), None)
    kind = normals or ("crease" if row and row["keeps_creases"] else "vertex")
    looks = not row or row["keeps_colors"] or row["keeps_materials"]
    made = scene.mesh(**{"normals": kind, "colors": looks, **how})
    return made.as_file(row["name"]) if row and len(made.triangles) else made


def diff(a: Union[Source, Mesh], b: Union[Source, Mesh], **options: Unpack[DiffOptions]) -> Diff:
    """How far two meshes are apart, with proven bounds: A is what was, B what is. Each is a Mesh, a Scene, a solid, or the
    path of a mesh or scene; scenes are meshed (mesh={...} says how)."""
    how = dict(options.get("mesh") or {})
    use_field = bool(options.get("field"))
    rest = {name: value for name, value in options.items() if name not in ("mesh", "field")}
    common, _ = split(rest)
    call = Call("diff()", rest, "diff")
    given = [_side(side, common) for side in (a, b)]
    scenes = [side for side in given if isinstance(side, Scene)]
    if len(scenes) == 2:
        within = _shared_tolerance(scenes, how, rest)
        how = {**how, "simplify_error": within} if within else how
        how.pop("quality", None) if within else None
    ignored = set(call.of["diff"].get("ignore") or ())
    for side in given:
        ignored |= _lost(side.format) if isinstance(side, Mesh) else set()
    call.of["diff"]["ignore"] = sorted(ignored)
    made = _compare(call, given, {**common, **how}, use_field, None)
    if made.reasons == ["normals"] and "normals" not in how and len(scenes) == 1:
        call = Call("diff()", {**rest, "ignore": sorted(ignored)}, "diff")
        made = _compare(call, given, {**common, **how}, use_field, "vertex")
    return made


def _lost(format_name: Optional[str]) -> set[str]:
    """What a file cannot hold is no difference."""
    row = next((row for row in _core.formats() if row["name"] == format_name), None)
    return {what for what in ("normals", "colors", "names") if row and not row[f"keeps_{what}"]}


def _compare(call: Call, given: list[Union[Scene, Mesh]], how: dict[str, Any], use_field: bool, normals: Optional[str]) -> Diff:
    sides = [side if isinstance(side, Mesh) else _mesh_side(side, other, how, normals)
             for side, other in zip(given, reversed(given))]
    fields = [side._core if use_field and isinstance(side, Scene) else None for side in given]
    return Diff(*call.settle(_core.diff(call.run, sides[0]._core, sides[1]._core, fields[0], fields[1], call.of["diff"])))


# ---- numbers with proof

def measure(source: Union[Source, Mesh], **options: Unpack[MeasureOptions]) -> SimpleNamespace:
    """Volume, mass, centroid, inertia, principal moments and axes, and the smallest box of a scene, a solid or a closed mesh.
    Each number is (low, high), and the true one lies between them; bounds are the least x, y, z, then the largest; inertia is
    xx, yy, zz, xy, xz, yz around the centroid. axes are of unit length, the true ones within axis_within degrees; area is of
    meshes only. is_reached: as closely as tolerance asks. As `csgmesh measure` (docs/measure.md)."""
    _check_names("measure()", options, "measure", "scene")
    how, others = split(options, "measure")
    if isinstance(source, Mesh):
        call = Call("measure()", options, "measure")
        return _measures(call, _core.measure_mesh(call.run, source._core, call.of["measure"]))
    scene = scene_of(source, others)
    call = Call("measure()", how, "measure")
    return _measures(call, _core.measure_scene(call.run, scene._core, call.of["measure"]))


def _measures(call: Call, answer: tuple[str, Any], kind: str = "measure") -> SimpleNamespace:
    part = call.of[kind].get("part")
    if answer[0] == "ERR_ARGUMENT" and part is not None:
        raise ValueError(f"part: there is none of the name {part.decode()!r}, or another option is out of range")
    return _spaces(call.settle(answer)[0])


class Clearance(NamedTuple):
    """What is proven of two parts over all poses: that of the worst. A step, from one pose to the next, is covered if the two
    are proven to stay clear on the way, each being the same part, and the one moving in relation to the other by a screw."""

    parts: tuple[Optional[str], Optional[str]]
    state: str  #: "apart", "touching", "undecided" or "interfering", at the worst pose
    pose: int  #: the worst
    gap: tuple[float, float]  #: nowhere less than the first
    nearest: Optional[tuple[tuple[float, float, float], tuple[float, float, float]]]  #: a point of each, gap[1] apart
    inside: Optional[tuple[float, float, float]]  #: a point inside both, where they interfere
    volume: Optional[tuple[float, float]]  #: what both have, where they interfere
    size: Optional[float]  #: undecided: the edge of the largest cube that is left
    poses: int  #: at which both are there
    poses_bad: int  #: those where they interfere, or are less than min_gap apart
    poses_open: int  #: those where that could not be told
    steps: int  #: from one pose to the next, where both are there at both
    steps_open: int  #: those that are not covered: nothing is claimed of them
    first_open: Optional[int]  #: the pose that the first of these leads to
    gap_between: float  #: at no pose, and in no step that is covered, is the gap less


def clear(source: Union[str, "os.PathLike[str]", SolidBase], poses: Sequence[Mapping[str, Any]] = ({},),
          **options: Unpack[ClearOptions]) -> list[Clearance]:
    """Whether the named parts of a scene's text, a file (a pathlib.Path) or a solid stay clear of each other: a Clearance for
    each pair. poses: values for assignments at the top of the text, as of define, one dict for each pose. As `csgmesh clear`
    (docs/clear.md)."""
    call = Call("clear()", options, "scene", "clear")
    origin = _origin_in(source)

    def needed(answer: tuple[str, Any]) -> Any:
        """Findings of what has not failed are settled at the end."""
        return answer[1] if answer[0] == "OK" else call.settle(answer, origin)[0]

    given = call.of["scene"].get("define") or {}
    core = needed(_core.begin_clear(call.run, call.of["clear"]))
    for pose in poses:
        scene = needed(_read_in(call, source, {**call.of["scene"], "define": {**given, **defines(pose)}}))
        answer = _core.add_pose(call.run, core, scene)
        if answer[0] == "ERR_ARGUMENT":
            there = ", ".join(repr(name) for name in core.parts())
            raise ValueError(f"parts: a part that is asked for is not there, only {there}")
        needed(answer)
    call.settle(("OK", None), origin)
    return [Clearance(**pair) for pair in core.pairs()]


SCENE_OPTIONS = [name for name in _core.option_names["scene"] if name != "only_check"]


def document(function: Any, options: Sequence[str]) -> None:
    """Docstrings end with the options that a function takes."""
    names = textwrap.fill(", ".join([*options, "progress", "echo", *_core.option_names["run"]]), 106)
    function.__doc__ = f"{function.__doc__}\n\n    Options:\n{textwrap.indent(names, '    ')}"


def _document_all() -> None:
    of, scene = _core.option_names, SCENE_OPTIONS
    documented: list[tuple[Any, list[str]]] = [
        (load, scene), (parse, scene), (check, scene), (mesh, [*of["mesh"], *scene]), (Scene.mesh, of["mesh"]),
        (write, [*of["mesh"], *of["write"], *scene]), (Mesh.write, of["write"]), (render, [*of["render"], *scene]),
        (diff, [*of["diff"], "field", "mesh"]), (read, []), (measure, [*of["measure"], *scene]), (clear, [*of["clear"], *scene]), (Scene.field, [])]
    for function, options in documented:
        document(function, options)


_document_all()
