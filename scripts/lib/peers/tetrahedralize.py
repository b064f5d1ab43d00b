"""Delaunay tetrahedra of a file of points by an engine that Python can install, timed, as JSON.

usage: tetrahedralize.py gmsh|scipy|open3d POINTS THREADS

POINTS holds float64 x, y, z, little endian. Ends with status 3 where the engine is missing.
"""

import json
import sys
import time
from collections.abc import Callable

import numpy as np

NOT_INSTALLED = 3


Engine = tuple[str, Callable[[], int]]
"""Its name and version, and what is timed: the making and counting of the cells."""


def gmsh_engine(points: np.ndarray, threads: int) -> Engine:
    """Gmsh; its algorithm 10 is HXT, without which it takes an older and slower one."""
    import gmsh

    gmsh.initialize()
    gmsh.option.set_number("General.Terminal", 0)
    gmsh.option.set_number("General.NumThreads", threads)
    gmsh.option.set_number("Mesh.MaxNumThreads3D", threads)
    gmsh.option.set_number("Mesh.Algorithm3D", 10)
    make = gmsh.algorithm.tetrahedralize
    return f"gmsh {gmsh.__version__}", lambda: len(make(points.ravel())[0]) // 4


def scipy_engine(points: np.ndarray, _threads: int) -> Engine:
    """SciPy's Qhull."""
    import scipy

    make = scipy.spatial.Delaunay
    return f"SciPy {scipy.__version__}", lambda: len(make(points).simplices)


def open3d_engine(points: np.ndarray, _threads: int) -> Engine:
    """Open3D's tetrahedral mesh of a cloud."""
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    make = open3d.geometry.TetraMesh.create_from_point_cloud
    return f"Open3D {open3d.__version__}", lambda: len(make(cloud)[0].tetras)


ENGINES = {"gmsh": gmsh_engine, "scipy": scipy_engine, "open3d": open3d_engine}


def main(engine: str, path: str, threads: str) -> None:
    """Prints the engine, seconds and cells."""
    points = np.fromfile(path, "<f8").reshape(-1, 3)
    try:
        name, tetrahedralize = ENGINES[engine](points, int(threads))
    except (ImportError, OSError) as missing:  # OSError: a shared library is missing
        print(f"not installed: {engine} ({missing})", file=sys.stderr)
        sys.exit(NOT_INSTALLED)
    start = time.perf_counter()
    cells = tetrahedralize()
    seconds = time.perf_counter() - start
    print(json.dumps({"engine": name, "seconds": seconds, "cells": cells}))


if __name__ == "__main__":
    main(*sys.argv[1:])
