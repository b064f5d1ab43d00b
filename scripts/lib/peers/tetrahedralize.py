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


def gmsh_engine(points: np.ndarray, threads: int) -> Callable[[], int]:
    """Gmsh; its algorithm 10 is HXT, without which it takes an older and slower one."""
    import gmsh

    gmsh.initialize()
    gmsh.option.set_number("General.Terminal", 0)
    gmsh.option.set_number("General.NumThreads", threads)
    gmsh.option.set_number("Mesh.MaxNumThreads3D", threads)
    gmsh.option.set_number("Mesh.Algorithm3D", 10)
    return lambda: len(gmsh.algorithm.tetrahedralize(points.ravel())[0]) // 4


def scipy_engine(points: np.ndarray, _threads: int) -> Callable[[], int]:
    """SciPy's Qhull."""
    from scipy.spatial import Delaunay

    return lambda: len(Delaunay(points).simplices)


def open3d_engine(points: np.ndarray, _threads: int) -> Callable[[], int]:
    """Open3D's tetrahedral mesh of a cloud."""
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    create = open3d.geometry.TetraMesh.create_from_point_cloud
    return lambda: len(create(cloud)[0].tetras)


ENGINES = {"gmsh": gmsh_engine, "scipy": scipy_engine, "open3d": open3d_engine}


def main(engine: str, path: str, threads: str) -> None:
    """Prints seconds and cells."""
    points = np.fromfile(path, "<f8").reshape(-1, 3)
    try:
        tetrahedralize = ENGINES[engine](points, int(threads))
    except (ImportError, OSError) as missing:  # OSError: a shared library is missing
        print(f"not installed: {engine} ({missing})", file=sys.stderr)
        sys.exit(NOT_INSTALLED)
    start = time.perf_counter()
    cells = tetrahedralize()
    print(json.dumps({"seconds": time.perf_counter() - start, "cells": cells}))


if __name__ == "__main__":
    main(*sys.argv[1:])
