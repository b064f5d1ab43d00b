# SPDX-License-Identifier: GPL-3.0-or-later
"""The part CT Slices of the panel: is the surface where the bone is? Judged by eye on the images."""

from typing import Any

import bpy
from bpy.types import Context, Panel, UILayout

from ..operators.hide_slices import BONEMESH_OT_hide_slices
from ..operators.show_slices import BONEMESH_OT_show_slices
from ..slices import scene_slices, slice_store, slice_updates
from ..slices.slice_store import PLANES, Shown
from .part import Part
from .text import draw_text

LETTERS = {"axial": "z", "coronal": "y", "sagittal": "x"}


class BONEMESH_PT_slices(Part, Panel):
    """The CT images as slices in the scene, with the surface's contour on them."""

    bl_label = "CT Slices"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws the button, then a row for each slice."""
        layout.use_property_split = False
        layout.operator(BONEMESH_OT_show_slices.bl_idname, icon="IMAGE_PLANE")
        shown = slice_store.current()
        if shown is None:
            if scene_slices.found("stack") is not None:
                text = "The CT images of these slices are not in memory; press Show CT Slices"
                draw_text(layout, context, text, icon="ERROR")
            return
        properties = context.scene.bonemesh_slices
        for name in PLANES:
            draw_slice(layout.column(align=True), properties, shown, name)
        draw_surface(layout, shown)
        column = layout.column(align=True)
        column.prop(properties, "centre_hu")
        column.prop(properties, "width_hu")
        draw_text(layout, context, shown.memory_text(), icon="MEMORY")
        layout.operator(BONEMESH_OT_hide_slices.bl_idname, icon="X")


def draw_slice(column: Any, properties: Any, shown: Shown, name: str) -> None:
    """Draws the eye and the slider, and where the slice is."""
    position = scene_slices.position_mm(name)
    if position is None:
        column.label(text=f"The {name} slice was removed; press Show CT Slices")
        return
    row = column.row(align=True)
    eye = "HIDE_OFF" if scene_slices.is_shown(name) else "HIDE_ON"
    row.prop(properties, f"show_{name}", text="", icon=eye)
    row.prop(properties, name, slider=True)
    number, slices = shown.slice_number(name, position), shown.slices(name)
    column.label(
        text=f"{LETTERS[name]} = {position:.1f} mm, slice {number} of {slices}"
    )


def draw_surface(layout: Any, shown: Shown) -> None:
    """Draws whose contour it is, with an eye, since the surface hides what is in it."""
    placed = slice_updates.surface()
    if shown.surface is None or placed is None:
        layout.label(text="No surface, no contour", icon="INFO")
        return
    row = layout.row(align=True)
    row.label(text=f"Contour of {placed.name}", icon="OUTLINER_OB_CURVE")
    row.prop(placed, "hide_viewport", text="", emboss=False)


def register() -> None:
    """Adds the part."""
    bpy.utils.register_class(BONEMESH_PT_slices)


def unregister() -> None:
    """Takes it away."""
    bpy.utils.unregister_class(BONEMESH_PT_slices)
