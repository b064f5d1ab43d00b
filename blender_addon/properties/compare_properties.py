# SPDX-License-Identifier: GPL-3.0-or-later
"""`scene.bonemesh_compare`: how distances between two meshes are shown."""

from typing import Any

import bpy
from bpy.props import BoolProperty, FloatProperty, PointerProperty
from bpy.types import Context, PropertyGroup

from ..scene import scene_distances


def scale_changed(self: "BonemeshCompareProperties", _context: Context) -> None:
    """Paints what was compared anew."""
    scene_distances.paint_again(self.full_mm)


def are_shown(_properties: Any) -> bool:
    """Read from the 3D views, where it can be switched as well."""
    return scene_distances.are_shown(bpy.context)


def set_shown(_properties: Any, is_shown: bool) -> None:
    """Switches the 3D views."""
    scene_distances.set_shown(bpy.context, is_shown)


class BonemeshCompareProperties(PropertyGroup):
    """One property for each field of the panel's part Compare."""

    full_mm: FloatProperty(
        name="Full Colour at (mm)",
        description="Distance from which on a place is all red (outside of the other mesh) or all blue (inside of it)",
        default=1.0,
        min=0.001,
        soft_max=20.0,
        precision=2,
        update=scale_changed,
    )
    show: BoolProperty(
        name="Show Distances",
        description="Shows the colours in the 3D views, in solid shading, in place of those of bone and region",
        get=are_shown,
        set=set_shown,
        options={"SKIP_SAVE"},
    )


def register() -> None:
    """Adds `scene.bonemesh_compare`."""
    bpy.utils.register_class(BonemeshCompareProperties)
    bpy.types.Scene.bonemesh_compare = PointerProperty(type=BonemeshCompareProperties)


def unregister() -> None:
    """Takes it away."""
    del bpy.types.Scene.bonemesh_compare
    bpy.utils.unregister_class(BonemeshCompareProperties)
