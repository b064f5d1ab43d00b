# SPDX-License-Identifier: GPL-3.0-or-later
"""`scene.bonemesh_output`: how meshes leave Blender, and what is too thin to be printed."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    PointerProperty,
    StringProperty,
)
from bpy.types import PropertyGroup

FORMATS = [
    ("stl", "STL", "For 3D printing and nearly every program; says no unit"),
    ("3mf", "3MF", "For 3D printing; small, and says that its unit is the millimetre"),
    ("ply", "PLY", "For measuring and viewing; small, vertices are shared"),
    ("obj", "OBJ", "For modelling and viewing; text"),
]
FRAMES = [
    (
        "LPS",
        "LPS (DICOM)",
        "Coordinates run to the patient's left, back and head, as in DICOM files and here",
    ),
    (
        "RAS",
        "RAS (NIfTI)",
        "Coordinates run to the patient's right, front and head, as in NIfTI files and many viewers; turned, not mirrored",
    ),
]


class BonemeshOutputProperties(PropertyGroup):
    """One property for each field of the panel's part Export, and the thinnest wall that prints."""

    file_name: StringProperty(
        name="Filename",
        description="Name of the file in the mesh folder, without its ending; empty takes the object's name",
    )
    format: EnumProperty(
        name="Format", description="Kind of file; all are in millimetres", items=FORMATS
    )
    frame: EnumProperty(
        name="Frame",
        description="Which way the axes of the file point in the patient; the file says so itself",
        items=FRAMES,
    )
    as_placed: BoolProperty(
        name="As Placed in Scene",
        description="Writes the mesh where the object was moved and turned to; else at its place in the patient, where it fits the images",
        default=False,
    )
    thin_mm: FloatProperty(
        name="Thin Below (mm)",
        description="Walls thinner than this are selected as thin; 1 mm is about what printers of plastic can make",
        default=1.0,
        min=0.01,
        soft_max=5.0,
        precision=2,
    )


def register() -> None:
    """Adds `scene.bonemesh_output`."""
    bpy.utils.register_class(BonemeshOutputProperties)
    bpy.types.Scene.bonemesh_output = PointerProperty(type=BonemeshOutputProperties)


def unregister() -> None:
    """Takes it away."""
    del bpy.types.Scene.bonemesh_output
    bpy.utils.unregister_class(BonemeshOutputProperties)
