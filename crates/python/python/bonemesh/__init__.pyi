"""From a CT folder to a bone mesh, and from a selection on it to a region of its own."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Literal, SupportsIndex, TypeAlias, final, overload

import numpy as np
import numpy.typing as npt

__all__ = [
    "ArgumentError",
    "BonemeshError",
    "Cancel",
    "Cancelled",
    "DicomError",
    "Histogram",
    "LeftOut",
    "Mesh",
    "MeshError",
    "PhantomSurface",
    "Preview",
    "Scan",
    "Series",
    "SlicePlane",
    "Volume",
    "__version__",
    "alpha_surface",
    "canny",
    "check",
    "clean",
    "compare",
    "decimate",
    "face_outward",
    "faults",
    "fill_cavities",
    "fill_holes",
    "find_series",
    "histogram",
    "keep_islands",
    "label_components",
    "local_thickness",
    "main",
    "mean_neighbour_distance",
    "methods",
    "mirror",
    "normal_similarity",
    "phantom",
    "point_cloud",
    "read_mesh",
    "read_series",
    "render",
    "sample",
    "scan",
    "section",
    "select_roi",
    "signed_distances",
    "similarity_ranges",
    "smooth",
    "suggest_thresholds",
    "symmetry_plane",
    "tetrahedralize",
    "wall_thickness",
    "write_phantom",
]

__version__: str

_Path: TypeAlias = str | os.PathLike[str]
# Called with the name of the stage and the done part of it, 0 to 1.
_Progress: TypeAlias = Callable[[str, float], object]
# Columns, rows, slices, each (first, end).
_Crop: TypeAlias = str | Sequence[tuple[SupportsIndex, SupportsIndex]]
_Anatomical: TypeAlias = Literal["axial", "coronal", "sagittal"]
_Sampler: TypeAlias = Literal[
    "uniform", "targeted", "random", "thesis-uniform", "thesis-targeted"
]
# A threshold in place of a number of Hounsfield units; 350 where none is given.
_Threshold: TypeAlias = Literal[
    "auto",
    "edges",
    "multi-otsu",
    "otsu",
    "skull",
    "cortical",
    "thin-bone",
    "teeth",
]
# Which way a solid is cut: three numbers are a direction.
_Direction: TypeAlias = (
    Literal["normal", "through", "outward"] | Sequence[float] | npt.NDArray[np.floating]
)
# (nx, ny, nz, d) with n . p = d in mm, or three places.
_Plane: TypeAlias = (
    Literal["auto", "x", "y", "z"]
    | Sequence[float]
    | Sequence[Sequence[float]]
    | npt.NDArray[np.floating]
)
_Orientation: TypeAlias = Literal[
    "axial",
    "reversed",
    "sagittal",
    "coronal",
    "oblique",
    "tilted",
    "feet-first",
    "prone",
    "decubitus-left",
    "decubitus-right",
]

class BonemeshError(Exception): ...
class ArgumentError(BonemeshError, ValueError): ...
class DicomError(BonemeshError): ...
class MeshError(BonemeshError): ...
class Cancelled(BonemeshError): ...

@final
class Cancel:
    def __new__(cls) -> Cancel: ...
    def cancel(self) -> None: ...
    @property
    def is_cancelled(self) -> bool: ...

@final
class Series:
    @property
    def number(self) -> int: ...
    @property
    def uid(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def modality(self) -> str: ...
    @property
    def slices(self) -> int: ...
    @property
    def slices_found(self) -> int: ...
    @property
    def rows(self) -> int: ...
    @property
    def columns(self) -> int: ...
    @property
    def spacing_mm(self) -> tuple[float, float, float]: ...
    # (4, 4): (column, row, slice, 1) to patient millimetres.
    @property
    def patient_from_voxel(self) -> npt.NDArray[np.float64]: ...
    @property
    def orientation(self) -> str: ...
    @property
    def tilt_degrees(self) -> float: ...
    @property
    def slice_positions_mm(self) -> list[float]: ...
    # Position of the slice before the gap (mm), and how many are missing.
    @property
    def gaps(self) -> list[tuple[float, int]]: ...
    @property
    def is_resampled(self) -> bool: ...
    @property
    def duplicates(self) -> list[str]: ...
    @property
    def transfer_syntax(self) -> str: ...
    @property
    def estimated_memory_bytes(self) -> int: ...
    # None as long as no pixel was decoded.
    @property
    def hu_range(self) -> tuple[float, float] | None: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def files(self) -> list[Path]: ...
    # The report in words, and as `bonemesh info --json` prints it.
    @property
    def lines(self) -> list[str]: ...
    @property
    def report(self) -> dict[str, Any]: ...

@final
class LeftOut:
    @property
    def path(self) -> Path: ...
    @property
    def reason(self) -> str: ...

@final
class Scan:
    @property
    def recommended(self) -> int: ...
    @property
    def alternatives(self) -> list[int]: ...
    @property
    def series(self) -> list[Series]: ...
    @property
    def left_out(self) -> list[LeftOut]: ...

@final
class Volume:
    def __new__(
        cls, hu: npt.ArrayLike, patient_from_voxel: npt.ArrayLike
    ) -> Volume: ...
    # [slice, row, column], read-only.
    @property
    def hu(self) -> npt.NDArray[np.int16] | npt.NDArray[np.float32]: ...
    # (4, 4): (column, row, slice, 1) to patient millimetres.
    @property
    def patient_from_voxel(self) -> npt.NDArray[np.float64]: ...
    @property
    def spacing_mm(self) -> tuple[float, float, float]: ...
    def plane(self, name: _Anatomical) -> SlicePlane: ...
    # (rows, columns); the top row first.
    @overload
    def slice(
        self,
        name: _Anatomical,
        position_mm: float,
        *,
        window_hu: None = None,
        progress: _Progress | None = None,
        cancel: Cancel | None = None,
    ) -> npt.NDArray[np.float32]: ...
    @overload
    def slice(
        self,
        name: _Anatomical,
        position_mm: float,
        *,
        window_hu: tuple[float, float],
        progress: _Progress | None = None,
        cancel: Cancel | None = None,
    ) -> npt.NDArray[np.uint8]: ...
    @property
    def warnings(self) -> list[str]: ...

@final
class SlicePlane:
    @property
    def name(self) -> _Anatomical: ...
    # (4, 4): (right, up, position, 1) in mm to patient millimetres.
    @property
    def patient_from_plane(self) -> npt.NDArray[np.float64]: ...
    @property
    def pixel_mm(self) -> float: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def positions_mm(self) -> tuple[float, float]: ...
    @property
    def step_mm(self) -> float: ...

@final
class Histogram:
    # (N,) voxels; bin b ends with edges_hu[b + 1].
    @property
    def counts(self) -> npt.NDArray[np.uint64]: ...
    # (N + 1,)
    @property
    def edges_hu(self) -> npt.NDArray[np.float64]: ...
    @property
    def voxels(self) -> int: ...
    @property
    def padding(self) -> int: ...
    @property
    def beyond(self) -> int: ...
    def otsu(self, classes: SupportsIndex = 2) -> list[float]: ...

@final
class Mesh:
    def __new__(cls, vertices: npt.ArrayLike, triangles: npt.ArrayLike) -> Mesh: ...
    # (N, 3) mm, read-only.
    @property
    def vertices(self) -> npt.NDArray[np.float32]: ...
    # (M, 3), read-only.
    @property
    def triangles(self) -> npt.NDArray[np.uint32]: ...
    @property
    def report(self) -> dict[str, Any]: ...
    def save(
        self,
        path: _Path,
        *,
        frame: Literal["LPS", "RAS"] = "LPS",
        sidecar: bool = False,
        progress: _Progress | None = None,
        cancel: Cancel | None = None,
    ) -> None: ...

# Coarse surfaces of one scan at any threshold: made once, then quick. Thin bone stays and is shown up
# to half a coarse voxel thicker on each side.
@final
class Preview:
    def __new__(
        cls,
        volume: Volume,
        *,
        threads: SupportsIndex | None = None,
        progress: _Progress | None = None,
        cancel: Cancel | None = None,
    ) -> Preview: ...
    # Slices, rows, columns of the whole scan.
    @property
    def shape(self) -> tuple[int, int, int]: ...
    # (4, 4): (column, row, slice, 1) of the whole scan to patient millimetres.
    @property
    def patient_from_voxel(self) -> npt.NDArray[np.float64]: ...
    # Patient millimetres; `report` has threshold_hu, spacing_mm of the coarse voxels, vertices,
    # triangles, seconds.
    def surface(
        self,
        threshold_hu: float,
        *,
        crop: _Crop | None = None,
        threads: SupportsIndex | None = None,
        progress: _Progress | None = None,
        cancel: Cancel | None = None,
    ) -> Mesh: ...

@final
class PhantomSurface:
    def __new__(cls, name: str) -> PhantomSurface: ...
    @property
    def structures(self) -> list[str]: ...
    # distance_mm, point_mm, normal, crease, wall_mm, gap_mm, air_mm, outside_hu, structure.
    def nearest(
        self,
        points: npt.ArrayLike,
        *,
        crease_mm: float = 1.2,
        threads: SupportsIndex | None = None,
        progress: _Progress | None = None,
        cancel: Cancel | None = None,
    ) -> dict[str, npt.NDArray[Any]]: ...
    # (count, 3) mm.
    def samples(
        self,
        count: SupportsIndex,
        *,
        seed: SupportsIndex = 0,
        threads: SupportsIndex | None = None,
        progress: _Progress | None = None,
        cancel: Cancel | None = None,
    ) -> npt.NDArray[np.float64]: ...
    def volume_mm3(
        self,
        *,
        cell_mm: float = 0.25,
        threads: SupportsIndex | None = None,
        progress: _Progress | None = None,
        cancel: Cancel | None = None,
    ) -> float: ...

def scan(
    path: _Path,
    *,
    one_series: bool = False,
    pixels: bool = False,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Scan: ...
def find_series(
    path: _Path,
    *,
    one_series: bool = False,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> list[Series]: ...
def read_series(
    path: _Path,
    series: SupportsIndex | str | None = None,
    *,
    one_series: bool = False,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Volume: ...
def canny(
    image_or_stack: npt.ArrayLike,
    *,
    sigma: float = 1.0,
    low: float = 0.1,
    high: float = 0.2,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> npt.NDArray[np.bool_]: ...
def histogram(
    volume: Volume,
    *,
    bin_hu: SupportsIndex = 10,
    crop: _Crop | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Histogram: ...
def suggest_thresholds(
    volume: Volume,
    *,
    crop: _Crop | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> list[dict[str, Any]]: ...
def label_components(
    mask: npt.ArrayLike,
    *,
    connectivity: Literal[6, 26] = 26,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> npt.NDArray[np.uint32]: ...
def point_cloud(
    volume: Volume,
    *,
    threshold_hu: float | _Threshold = ...,
    sigma: float = 1.0,
    frame: Literal["patient", "image"] = "patient",
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> npt.NDArray[np.float64]: ...
def mean_neighbour_distance(
    points: npt.ArrayLike,
    *,
    k: SupportsIndex = 100,
    include_self: bool = True,
    spacing_mm: Sequence[float] | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> float: ...
def sample(
    points: npt.ArrayLike,
    *,
    percent: float | None = None,
    sampler: _Sampler = "uniform",
    seed: SupportsIndex = 0,
    spacing_mm: Sequence[float] | None = None,
    grid_px: SupportsIndex | None = None,
    cutoffs: Sequence[float] | None = None,
    percentages: Sequence[float] | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> npt.NDArray[np.uint32]: ...
def similarity_ranges(
    points: npt.ArrayLike,
    *,
    grid_px: SupportsIndex | None = None,
    cutoffs: Sequence[float] | None = None,
    spacing_mm: Sequence[float] | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> list[int]: ...
def normal_similarity(
    points: npt.ArrayLike,
    *,
    normals: Literal["plane", "space"] = "plane",
    neighbours: SupportsIndex | None = None,
    spacing_mm: Sequence[float] | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> float: ...
def compare(
    mesh: Mesh,
    reference: Mesh,
    *,
    samples: SupportsIndex = 100_000,
    residual: bool = True,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> dict[str, Any]: ...
def signed_distances(
    points: npt.ArrayLike,
    reference: Mesh,
    *,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> npt.NDArray[np.float64]: ...
def tetrahedralize(
    points: npt.ArrayLike,
    *,
    spacing_mm: Sequence[float] | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> npt.NDArray[np.uint32]: ...
def alpha_surface(
    points: npt.ArrayLike,
    alpha_mm: float,
    *,
    spacing_mm: Sequence[float] | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
def methods() -> list[str]: ...
def render(
    path_or_volume: _Path | Volume,
    *,
    threshold_hu: float | _Threshold = ...,
    local_leeway_hu: float | None = None,
    method: Literal[
        "alpha",
        "isosurface",
        "labelled",
        "ball-pivoting",
        "poisson",
        "tetrahedra",
        "planar",
    ]
    | None = None,
    sigma: float = 1.0,
    series: SupportsIndex | str | None = None,
    one_series: bool = False,
    crop: _Crop | None = None,
    sample_percent: float | None = None,
    sampler: _Sampler = "uniform",
    seed: SupportsIndex = 0,
    alpha_mm: float | Literal["auto"] | None = None,
    radii_mm: Sequence[float] | None = None,
    depth: int = 8,
    scale: float = 1.1,
    true_edges: bool = True,
    keep_table: bool = False,
    damp_metal: bool = False,
    holes: Literal["all"] | float | None = None,
    islands: Literal["largest"]
    | float
    | Sequence[tuple[float, float, float]]
    | None = None,
    cavities: Literal["all"] | float | None = None,
    smooth_mm: float | None = None,
    triangles: SupportsIndex | None = None,
    decimate_mm: float | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
def read_mesh(
    path: _Path,
    *,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
@overload
def select_roi(
    mesh: Mesh,
    selected_vertices: npt.ArrayLike,
    *,
    thickness_mm: float,
    method: Literal["solid", "thesis"] = "solid",
    direction: _Direction | None = None,
    clearance_mm: float | None = None,
    hidden: bool = False,
    mirror: _Plane | None = None,
    mirror_back: bool = False,
    separate: Literal[False] = False,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
@overload
def select_roi(
    mesh: Mesh,
    selected_vertices: npt.ArrayLike,
    *,
    thickness_mm: float,
    method: Literal["solid", "thesis"] = "solid",
    direction: _Direction | None = None,
    clearance_mm: float | None = None,
    hidden: bool = False,
    mirror: _Plane | None = None,
    mirror_back: bool = False,
    separate: Literal[True],
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> list[Mesh]: ...
def local_thickness(
    mesh: Mesh,
    selected_vertices: npt.ArrayLike,
    *,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> dict[str, float] | None: ...
def mirror(
    mesh: Mesh,
    plane: _Plane,
    *,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
def symmetry_plane(
    mesh: Mesh,
    *,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> tuple[float, float, float, float]: ...
def check(
    mesh: Mesh,
    *,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> dict[str, Any]: ...
def clean(
    mesh: Mesh,
    *,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
def face_outward(
    mesh: Mesh,
    *,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
def fill_holes(
    mesh: Mesh,
    *,
    holes: Literal["all"] | float = ...,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
def keep_islands(
    mesh: Mesh,
    *,
    islands: Literal["largest"] | float | Sequence[tuple[float, float, float]],
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
def fill_cavities(
    mesh: Mesh,
    *,
    cavities: Literal["all"] | float = ...,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
def smooth(
    mesh: Mesh,
    *,
    tolerance_mm: float,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
def decimate(
    mesh: Mesh,
    *,
    triangles: SupportsIndex | None = None,
    error_mm: float | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Mesh: ...
def faults(
    mesh: Mesh,
    *,
    thinner_than_mm: float | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> dict[str, npt.NDArray[np.uint32]]: ...

# Lines (N, 3); a closed one ends where it begins.
def section(
    mesh: Mesh,
    point: npt.ArrayLike,
    normal: npt.ArrayLike,
    *,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> list[npt.NDArray[np.float64]]: ...
def wall_thickness(
    mesh: Mesh,
    *,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> npt.NDArray[np.float64]: ...
def phantom(
    name: str,
    *,
    coarser: float = 1.0,
    pixel_mm: float | None = None,
    slice_mm: float | None = None,
    orientation: _Orientation | None = None,
    psf_px: float | None = None,
    noise_hu: float | None = None,
    seed: SupportsIndex | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> Volume: ...
def write_phantom(
    name: str,
    path: _Path,
    *,
    coarser: float = 1.0,
    pixel_mm: float | None = None,
    slice_mm: float | None = None,
    orientation: _Orientation | None = None,
    psf_px: float | None = None,
    noise_hu: float | None = None,
    seed: SupportsIndex | None = None,
    threads: SupportsIndex | None = None,
    progress: _Progress | None = None,
    cancel: Cancel | None = None,
) -> dict[str, Any]: ...

# The command `bonemesh` with the words of `sys.argv`; gives its exit code.
def main() -> int: ...
