# SPDX-License-Identifier: MIT
"""Names of types, and the options of each function: they are libcsgmesh's, whose header says what each means."""
from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, Optional, TypedDict, Union

if TYPE_CHECKING:
    from ._solid import Expression

Path = Union[str, "os.PathLike[str]"]
Point = Sequence[float]
Box = Sequence[Point]

#: What an argument of a solid may be: what the scene language has values for. A function becomes a formula.
Value = Union[None, bool, int, float, str, "Expression", Sequence[Any], Mapping[str, Any], "os.PathLike[str]", Callable[..., Any]]

#: progress(stage, fraction), or a bar of tqdm
Progress = Union[Callable[[str, float], Any], Any, None]


class RunOptions(TypedDict, total=False):
    """How the work is done; for all functions."""

    threads: int  # 0, the default: one per core
    isa: Literal["auto", "scalar", "sse2", "avx2", "avx512", "neon"]
    max_depth: int
    max_nodes: int
    max_steps: int
    max_memory: int  # bytes
    timeout: float  # seconds
    warnings_as_errors: bool
    library_warnings: bool
    progress: Progress
    echo: Optional[Callable[[str], Any]]  # gets what the scene echoes; without it: standard output


class SceneOptions(RunOptions, total=False):
    """How a scene's text is read."""

    define: Mapping[str, Value]  # replaces assignments at the top of the text
    include: Union[Path, Sequence[Path]]  # folders for include, use and import
    parameter_file: Path
    parameter_set: str
    facets: Literal["round", "exact"]
    leniency: Literal["strict", "by_file", "lenient"]
    openscad_version: Union[str, int]  # "2021.01"
    flat: Literal["plate", "drawing", "both", "kept"]


class BuildOptions(TypedDict, total=False):
    """How a field is meshed: csgm_mesh_options."""

    bounds: Box
    cell_size: float
    resolution: int
    normals: Literal["none", "vertex", "crease"]
    features: Literal["sharp", "smooth"]
    colors: bool
    prune: bool
    tolerance: float
    simplify_error: float
    simplify_share: float
    improve: bool
    certify: bool
    certify_size: float
    quality: Literal["normal", "draft", "fine"]
    triangles: int


class MeshOptions(RunOptions, BuildOptions, total=False):
    """For a scene that is read already."""


class SceneMeshOptions(SceneOptions, BuildOptions, total=False):
    """For a text or a solid."""


class FileOptions(TypedDict, total=False):
    """How a file is written: csgm_write_options."""

    ascii: bool
    draco: bool
    draco_position_bits: int
    draco_normal_bits: int
    draco_color_bits: int
    draco_level: int
    y_up: bool
    sync: bool
    only_if_changed: bool
    unit: Literal["none", "mm", "cm", "m", "in"]
    comment: str
    meshopt: bool
    meshopt_khr: bool
    uv: Literal["none", "box", "cylinder"]
    # Coarser meshes of the same solid, and how far each is from it; or also what was measured, and whether the error is proven.
    levels: Sequence[tuple[Any, float] | tuple[Any, float, float, bool]]
    metadata: Mapping[str, str]  # what the file says about itself: title, author, license, source, version


class WriteOptions(RunOptions, FileOptions, total=False):
    """For a mesh."""


class SceneWriteOptions(SceneOptions, BuildOptions, FileOptions, total=False):
    """For a scene, a text or a solid that goes straight into a file."""


class PictureOptions(TypedDict, total=False):
    """How a picture is drawn: csgm_render_options and its csgm_camera."""

    width: int
    height: int
    samples: int
    view: Sequence[float]  # azimuth and elevation, degrees
    eye: Point
    target: Point
    up: Point
    projection: Literal["perspective", "orthographic"]
    fov: float
    view_height: float
    zoom: float
    frame: Box
    turns: bool
    background: Union[str, Sequence[int]]  # "#rrggbb", "#rrggbbaa", "white", "black", "transparent"; or four numbers
    occlusion: bool
    shadows: bool
    ground: bool
    edges: bool
    bounds: Box
    slice: tuple[Literal["x", "y", "z"], float]
    iso_step: float
    wireframe: bool
    flat: bool
    evaluator: Literal["fast", "lazy"]
    lazy: bool
    bounds_used: bool


class RenderOptions(RunOptions, PictureOptions, total=False):
    """For a scene, a solid or a mesh."""


class DiffOptions(RunOptions, total=False):
    """What a comparison looks at: csgm_diff_options."""

    tolerance: float
    tolerance_relative: float
    tolerance_volume: float
    material: Literal["any", "added", "removed"]
    ignore: Union[str, Sequence[str]]  # "order", "normals", "colors", "names", "up", "topology"
    samples: int
    verdict_only: bool
    field: bool  # measure against the exact field of a scene, too
    mesh: BuildOptions  # how scenes are meshed


class MeasureOptions(SceneOptions, total=False):
    """How closely a solid is measured: csgm_measure_options."""

    tolerance: float  # how wide the volume's interval may be, as a share of it (1e-4)
    density: float  # mass per cubic scene unit (1)
    part: str  # of this name alone
    most_cubes: int


class SliceOptions(SceneOptions, total=False):
    """How a solid is cut into layers: csgm_slice_options."""

    layer: Union[float, Sequence[float]]  # the height of a layer; or the least and the largest one, with cusp
    cusp: float  # how far the steps of layers may stand off the surface
    tolerance: float  # how far contours may be from the surface (a 10000th of the longest side)
    unit: Literal["none", "mm", "cm", "m", "in"]
    pixel: float  # the edge of a mask's pixel in millimetres (0.05)
    sync: bool
    part: str  # of this name alone


class WallOptions(SceneOptions, total=False):
    """Which walls and gaps are looked for, and how closely: csgm_wall_options."""

    tolerance: float  # how closely lengths are to be known, as a share of the longest side
    finest: float  # shorter ones are not looked for where normals are not known closely
    angle_deg: float  # how far the two sides may be from parallel (30)
    part: str  # of this name alone
    most_pairs: int


class FaceOptions(RunOptions, total=False):
    """What overhangs, and what has no draft: csgm_face_options."""

    up: Sequence[float]  # against gravity, or how a mould opens ((0, 0, 1))
    overhang_deg: float  # faces that look down, so near to level (45)
    draft_deg: float  # walls that are so near to upright (1)
    part: str  # of this name alone


class ClearOptions(SceneOptions, total=False):
    """What is to be known of parts: csgm_clear_options."""

    tolerance: float  # how closely gaps are to be known
    min_gap: float  # whether gaps are as large
    parts: Union[str, Sequence[str]]  # pairs among these alone; of one, its pairs with all others
    most_pairs: int
