# SPDX-License-Identifier: GPL-3.0-or-later
"""`scene.bonemesh_region`: how a region is cut; what is right as it stands for most regions."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    PointerProperty,
    StringProperty,
)
from bpy.types import PropertyGroup

METHODS = [
    (
        "solid",
        "Solid",
        "The bone under the selection, cut out: closed, printable, its front the mesh's own triangles",
    ),
    (
        "thesis",
        "Thesis",
        "Slice by slice along one normal, meshed as a point cloud (Rier); needs a mesh of method Alpha",
    ),
]
DIRECTIONS = [
    (
        "normal",
        "Into the Bone",
        "Along the surface's own normals, to the far side of the bone where that comes first",
    ),
    (
        "view",
        "Along the View",
        "Straight along the direction you look in, to the far side of the bone",
    ),
    (
        "through",
        "Straight Through",
        "Straight through hollows and whatever lies behind, down to the thickness",
    ),
    (
        "outward",
        "Plate on the Bone",
        "Away from the bone: the plate that lies on it there, for implants and drill guides",
    ),
    (
        "given",
        "Along a Direction",
        "Straight along a direction of the patient, such as that of an earlier region, to the far side of the bone",
    ),
]
PLANES = [
    ("auto", "Found", "The mesh's own plane of symmetry, found"),
    ("x", "Left and Right", "Between left and right, through the middle of the mesh"),
    ("y", "Front and Back", "Between front and back, through the middle of the mesh"),
    ("z", "Top and Bottom", "Between top and bottom, through the middle of the mesh"),
    ("given", "Three Points", "Through three vertices, taken from the selection"),
]


class BonemeshRegionProperties(PropertyGroup):
    """One property for each field of the panel's part Region."""

    method: EnumProperty(
        name="Method", description="How the region is found", items=METHODS
    )
    direction: EnumProperty(
        name="Direction", description="Which way the region is cut", items=DIRECTIONS
    )
    direction_numbers: FloatVectorProperty(
        name="Along",
        description="The direction in the patient: to the left, to the back, to the head",
        size=3,
        default=(0.0, 1.0, 0.0),
        precision=4,
    )
    clearance: FloatProperty(
        name="Clearance (mm)",
        description="The gap between the bone and a plate on it",
        default=0.2,
        min=0.0,
        max=20.0,
        precision=2,
    )
    hidden: BoolProperty(
        name="Take Hidden Pieces",
        description="Selected pieces that lie behind others count, too, such as those that a lasso with X-ray picked up on the far side",
        default=False,
    )
    separate: BoolProperty(
        name="One for Each Piece",
        description="A region of its own for each piece of the selection that does not touch the others; else they are one",
        default=False,
    )
    plane: EnumProperty(
        name="Mirror Plane",
        description="The plane between the two sides",
        items=PLANES,
    )
    plane_numbers: FloatVectorProperty(
        name="Plane",
        description="Normal and offset (mm) of the plane through three points, in the patient",
        size=4,
        default=(1.0, 0.0, 0.0, 0.0),
        precision=4,
    )
    mirror_back: BoolProperty(
        name="Put at the Selection",
        description="Mirrors what was taken from the healthy side to where the selection is, as the template for an implant; else it stays where it was taken",
        default=True,
    )
    measured: StringProperty(
        name="Thickness Here",
        description="The thickness of the bone under the selection when it was last measured",
        options={"SKIP_SAVE"},
    )


def register() -> None:
    """Adds `scene.bonemesh_region`."""
    bpy.utils.register_class(BonemeshRegionProperties)
    bpy.types.Scene.bonemesh_region = PointerProperty(type=BonemeshRegionProperties)


def unregister() -> None:
    """Takes it away."""
    del bpy.types.Scene.bonemesh_region
    bpy.utils.unregister_class(BonemeshRegionProperties)
