# SPDX-License-Identifier: GPL-3.0-or-later
"""`scene.bonemesh`: what the panel asks for."""

import os
from collections.abc import Iterator
from functools import lru_cache

import bonemesh
import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)
from bpy.types import Context, PropertyGroup

METHODS = [
    (
        "alpha",
        "Alpha",
        "3D Delaunay tetrahedra of the edge points, those no larger than alpha kept; alpha comes from the points' mean distance",
    ),
]
SAMPLERS = [
    ("uniform", "Uniform", "Points at even steps along each contour"),
    ("random", "Random", "Points drawn by lot"),
    (
        "thesis-uniform",
        "Thesis, Uniform",
        "Ten neighbours at a time, in steps of ten percent (Rier's pseudo-uniform sampling)",
    ),
]


@lru_cache(maxsize=4)
def _series_found(directory: str, _modified: float) -> tuple[tuple[str, str], ...]:
    return tuple(
        (
            str(s.number),
            f"{s.description or 'no description'}, {s.slices} slices {s.columns} x {s.rows}",
        )
        for s in bonemesh.find_series(directory)
    )


def suggest_series(
    self: "BonemeshProperties", _context: Context, _text: str
) -> Iterator[tuple[str, str]]:
    """The series of the chosen folder, offered when the user opens the field."""
    directory = bpy.path.abspath(self.ct_directory)
    try:
        yield from _series_found(directory, os.stat(directory).st_mtime)
    except (OSError, bonemesh.BonemeshError):
        # Nothing to suggest yet: what is wrong with the folder is said when it is rendered.
        return


class BonemeshProperties(PropertyGroup):
    """One property for each field of the panel."""

    ct_directory: StringProperty(
        name="CT Images",
        description="Folder of CT images (DICOM files; folders inside it are searched too)",
        subtype="DIR_PATH",
    )
    mesh_directory: StringProperty(
        name="Mesh Folder",
        description="Folder in which the meshes are saved as STL",
        subtype="DIR_PATH",
    )
    hu_threshold: IntProperty(
        name="HU Threshold",
        description="Bone is above this many Hounsfield units: 350 for skulls, 600 for cortical bone of the limbs",
        default=350,
        min=-1024,
        max=3071,
    )
    cut_thickness: FloatProperty(
        name="Thickness of Cut (mm)",
        description="How deep the region reaches below the selected surface",
        default=5.0,
        min=0.0,
        soft_max=50.0,
        precision=2,
    )
    mesh_name: StringProperty(
        name="Mesh Filename",
        description="Name of the surface mesh and of its STL file",
    )
    roi_name: StringProperty(
        name="Segmented Mesh Filename",
        description="Name of the region of interest and of its STL file",
    )
    sigma: FloatProperty(
        name="Edge Smoothing",
        description="Sigma of the Gaussian in the edge detection, in pixels; 0 smooths nothing",
        default=1.0,
        min=0.0,
        max=10.0,
        soft_max=4.0,
    )
    sample_percent: FloatProperty(
        name="Points Kept",
        description="Part of the edge points that is meshed; 100 keeps them all",
        default=100.0,
        min=0.1,
        max=100.0,
        precision=1,
        subtype="PERCENTAGE",
    )
    sampler: EnumProperty(
        name="Sampling",
        description="How the points are chosen when not all are kept",
        items=SAMPLERS,
    )
    method: EnumProperty(
        name="Method",
        description="How the surface is made",
        items=METHODS,
    )
    series: StringProperty(
        name="Series",
        description="Number or UID of the series, where the folder holds several; empty takes the only one",
        search=suggest_series,
        search_options={"SUGGESTION"},
    )
    crop: StringProperty(
        name="Crop",
        description="Part of the images to use, as columns, rows, slices counted from 0, ends excluded: 0:255,0:345,2:90; empty uses all",
    )
    center_in_world: BoolProperty(
        name="Center in World",
        description="Puts the mesh at the world's centre instead of its place in the patient",
    )


def register() -> None:
    """Adds `scene.bonemesh`."""
    bpy.utils.register_class(BonemeshProperties)
    bpy.types.Scene.bonemesh = PointerProperty(type=BonemeshProperties)


def unregister() -> None:
    """Takes `scene.bonemesh` away."""
    _series_found.cache_clear()
    del bpy.types.Scene.bonemesh
    bpy.utils.unregister_class(BonemeshProperties)
