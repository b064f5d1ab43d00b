"""What makes a mesh of a volume: every method of Bonemesh, and the engines of VTK and 3D Slicer.

The seconds are those from the volume in memory to the mesh, without reading and writing.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import bonemesh
import numpy as np
import vtk
from slicer_surface import surface_of
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

# Ways of a method that are measured as methods of their own, by their options.
WAYS: dict[str, dict[str, dict[str, Any]]] = {
    "isosurface": {"isosurface, at the threshold": {"true_edges": False}},
}

Made = tuple[bonemesh.Mesh, float]


@dataclass(frozen=True)
class Engine:
    """One way to make a mesh of the bone above a threshold."""

    name: str
    is_ours: bool
    make: Callable[[bonemesh.Volume, float], Made]


def image_of(volume: bonemesh.Volume, values: Any) -> vtk.vtkImageData:
    """Values on the volume's grid, which must lie along the axes of the patient."""
    matrix = volume.patient_from_voxel
    image = vtk.vtkImageData()
    image.SetDimensions(values.shape[::-1])
    image.SetSpacing(np.diag(matrix)[:3])
    image.SetOrigin(matrix[:3, 3])
    flat = np.ascontiguousarray(values).ravel()
    image.GetPointData().SetScalars(numpy_to_vtk(flat, deep=True))
    return image


def grey(volume: bonemesh.Volume, _hu: float) -> vtk.vtkImageData:
    """The Hounsfield units."""
    return image_of(volume, volume.hu)


def label(volume: bonemesh.Volume, hu: float) -> vtk.vtkImageData:
    """1 in bone, 0 elsewhere."""
    return image_of(volume, (volume.hu > hu).astype(np.uint8))


def mesh_of(surface: vtk.vtkPolyData) -> bonemesh.Mesh:
    """VTK's triangles as a mesh."""
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputData(surface)
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    triangles.Update()
    made = triangles.GetOutput()
    points = vtk_to_numpy(made.GetPoints().GetData())
    faces = vtk_to_numpy(made.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    return bonemesh.Mesh(points, faces)


def flying_edges(image: vtk.vtkImageData, hu: float) -> vtk.vtkPolyData:
    """The surface of equal grey."""
    march = vtk.vtkFlyingEdges3D()
    march.SetInputData(image)
    march.SetValue(0, hu)
    march.ComputeNormalsOff()
    march.Update()
    return march.GetOutput()


def surface_nets(image: vtk.vtkImageData, _hu: float) -> vtk.vtkPolyData:
    """Nets around the label, with VTK's own smoothing."""
    nets = vtk.vtkSurfaceNets3D()
    nets.SetInputData(image)
    nets.SetValue(0, 1)
    nets.Update()
    return nets.GetOutput()


def slicer(image: vtk.vtkImageData, _hu: float) -> vtk.vtkPolyData:
    """3D Slicer's conversion of a segment to a closed surface with its default parameters."""
    return surface_of(image)


def peer(
    name: str,
    image: Callable[[bonemesh.Volume, float], vtk.vtkImageData],
    surface: Callable[[vtk.vtkImageData, float], vtk.vtkPolyData],
) -> Engine:
    """An engine that makes a surface of an image."""

    def make(volume: bonemesh.Volume, hu: float) -> Made:
        start = time.perf_counter()
        made = surface(image(volume, hu), hu)
        seconds = time.perf_counter() - start
        return mesh_of(made), seconds

    return Engine(name, False, make)


def ours(name: str, method: str, options: dict[str, Any]) -> Engine:
    """One of our methods."""

    def make(volume: bonemesh.Volume, hu: float) -> Made:
        start = time.perf_counter()
        mesh = bonemesh.render(volume, threshold_hu=hu, method=method, **options)
        return mesh, time.perf_counter() - start

    return Engine(name, True, make)


PEERS = [
    peer("VTK flying edges", grey, flying_edges),
    peer("VTK surface nets", label, surface_nets),
    peer("3D Slicer's default", label, slicer),
]


def engines(only: Sequence[str], peers: bool) -> list[Engine]:
    """Ours, as the product lists them, then the peers; of ours `only` these, if any are named."""
    unknown = set(only) - set(bonemesh.methods())
    if unknown:
        known = ", ".join(bonemesh.methods())
        raise SystemExit(
            f"error: there is no method {', '.join(sorted(unknown))}; choose from: {known}"
        )
    found = []
    for method in bonemesh.methods():
        if only and method not in only:
            continue
        found.append(ours(method, method, {}))
        for name, options in WAYS.get(method, {}).items():
            found.append(ours(name, method, options))
    return found + (PEERS if peers else [])
