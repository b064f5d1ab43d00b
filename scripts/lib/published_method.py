"""The published method with the packages it used, each step timed: what Bonemesh is measured against.

usage: published_method.py DICOM_DIR HU OUT.stl        prints one JSON object

pydicom reads, scikit-image finds Canny edges slice by slice, SciPy's k-d tree gives alpha, VTK's
Delaunay3D (through PyVista) the tetrahedra, and the surface of what alpha leaves is written as STL.
"""

import json
import sys
import time
from pathlib import Path

import numpy as np
import pydicom
import pyvista
from scipy.spatial import KDTree
from skimage.feature import canny

ALPHA_NEIGHBOURS = 100


class Stopwatch:
    """Seconds of each named step."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        now = time.perf_counter()
        self.seconds[name] = now - self._last
        self._last = now


def read_slices(folder: Path) -> list[pydicom.Dataset]:
    """Every image of the folder that says where its slice lies, by InstanceNumber."""
    datasets = [
        pydicom.dcmread(f, force=True) for f in sorted(folder.iterdir()) if f.is_file()
    ]
    slices = [d for d in datasets if "PixelData" in d and "SliceLocation" in d]
    return sorted(slices, key=lambda d: int(d.InstanceNumber))


def edge_points(
    slices: list[pydicom.Dataset], hu: float, watch: Stopwatch
) -> np.ndarray:
    """The cloud of edge pixels in mm, in the image frame."""
    first = slices[0]
    stored = np.stack([d.pixel_array for d in slices]).astype(float)
    volume = stored * float(first.RescaleSlope) + float(first.RescaleIntercept)
    watch.lap("read")
    edges = np.stack([canny(image > hu) for image in volume])
    watch.lap("edges")
    dy, dx = (float(v) for v in first.PixelSpacing)
    z = np.array([float(d.SliceLocation) for d in slices])
    k, row, column = np.nonzero(edges)
    cloud = np.column_stack([column * dx - dx / 2, row * dy - dy / 2, z[k]])
    watch.lap("cloud")
    return cloud


def main(folder: str, hu: str, out: str) -> None:
    watch = Stopwatch()
    cloud = edge_points(read_slices(Path(folder)), float(hu), watch)
    distances, _ = KDTree(cloud).query(cloud, ALPHA_NEIGHBOURS)
    alpha = float(distances.mean(axis=1).mean())
    watch.lap("neighbours")
    kept = pyvista.PolyData(cloud).delaunay_3d(alpha=alpha)
    watch.lap("tetrahedra")
    surface = kept.extract_surface(algorithm="dataset_surface").triangulate().clean()
    watch.lap("surface")
    surface.save(out)
    watch.lap("write")
    tetrahedra = kept.extract_cells(
        np.flatnonzero(kept.celltypes == pyvista.CellType.TETRA)
    )
    report = {
        "points": len(cloud),
        "alpha_mm": alpha,
        "tetrahedra": int(tetrahedra.n_cells),
        "triangles": int(surface.n_cells),
        "open_edges": int(surface.n_open_edges),
        "watertight": surface.n_open_edges == 0,
        "volume_mm3": float(tetrahedra.volume),
        "seconds": watch.seconds | {"total": sum(watch.seconds.values())},
    }
    print(json.dumps(report))


if __name__ == "__main__":
    main(*sys.argv[1:])
