"""3D Slicer's default surface of a segment, by the libraries that it uses, and as a program of its own.

usage: slicer_surface.py DICOM_DIR HU OUT.stl        prints one JSON object

SimpleITK reads the largest series; VTK's discrete flying edges and windowed sinc make the surface of the
voxels above the threshold, with the parameters of 3D Slicer's conversion to a closed surface.
"""

import json
import sys
import time

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

# 3D Slicer's default smoothing factor of segments.
SMOOTHING = 0.5


def surface_of(label: vtk.vtkImageData) -> vtk.vtkPolyData:
    """The surface around what is 1."""
    march = vtk.vtkDiscreteFlyingEdges3D()
    march.SetInputData(label)
    march.SetValue(0, 1)
    march.ComputeNormalsOff()
    smooth = vtk.vtkWindowedSincPolyDataFilter()
    smooth.SetInputConnection(march.GetOutputPort())
    smooth.SetNumberOfIterations(int(20 + SMOOTHING * 40))
    smooth.SetPassBand(10.0 ** (-4.0 * SMOOTHING))
    smooth.SetEdgeAngle(15.0)
    smooth.SetFeatureAngle(60.0)
    smooth.BoundarySmoothingOff()
    smooth.FeatureEdgeSmoothingOff()
    smooth.NonManifoldSmoothingOn()
    smooth.NormalizeCoordinatesOn()
    smooth.Update()
    return smooth.GetOutput()


def main(folder: str, hu: str, target: str) -> None:
    """Folder to STL, each step timed."""
    # Only the program needs it: the surface is made for images from elsewhere, too.
    import SimpleITK as sitk

    times = [time.perf_counter()]
    reader = sitk.ImageSeriesReader()
    ids = reader.GetGDCMSeriesIDs(folder)
    reader.SetFileNames(
        max((reader.GetGDCMSeriesFileNames(folder, uid) for uid in ids), key=len)
    )
    read = reader.Execute()
    times.append(time.perf_counter())
    label = vtk.vtkImageData()
    label.SetDimensions(read.GetSize())
    label.SetSpacing(read.GetSpacing())
    bone = (sitk.GetArrayViewFromImage(read) > float(hu)).astype(np.uint8)
    label.GetPointData().SetScalars(numpy_to_vtk(bone.ravel()))
    surface = surface_of(label)
    times.append(time.perf_counter())
    writer = vtk.vtkSTLWriter()
    writer.SetFileTypeToBinary()
    writer.SetInputData(surface)
    writer.SetFileName(target)
    writer.Write()
    times.append(time.perf_counter())
    steps = dict(
        zip(["read", "surface", "write"], np.diff(times).tolist(), strict=True)
    )
    seconds = steps | {"total": times[-1] - times[0]}
    print(json.dumps({"seconds": seconds, "triangles": surface.GetNumberOfPolys()}))


if __name__ == "__main__":
    main(*sys.argv[1:])
