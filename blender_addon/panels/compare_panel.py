# SPDX-License-Identifier: GPL-3.0-or-later
"""The part Compare of the panel: how far the active mesh lies from another one."""

from typing import Any

import bpy
from bpy.types import Context, Panel, UILayout

from ..operators.compare_meshes import BONEMESH_OT_compare_meshes, other_meshes
from ..reports import distances
from ..scene import meshes, scene_distances
from .part import Part
from .text import draw_text


class BONEMESH_PT_compare(Part, Panel):
    """The active mesh against another selected one, as colours and in words."""

    bl_label = "Compare"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws which meshes are meant, the button, and what was found."""
        layout.use_property_split = False
        active, others = context.active_object, other_meshes(context)
        if active is not None and len(others) == 1:
            text = f"{active.name} against {others[0].name}"
            draw_text(layout, context, text, icon="MESH_DATA")
        layout.operator(BONEMESH_OT_compare_meshes.bl_idname)
        found = None
        if active is not None:
            found = meshes.kept_report(active, scene_distances.COMPARED)
        if found is not None:
            draw_found(layout, context, active, found)


def draw_found(layout: Any, context: Any, active: Any, found: dict[str, Any]) -> None:
    """Draws the distances in words, what the colours mean, and their scale."""
    column = layout.box().column(align=True)
    reference = bpy.data.objects.get(found["reference"])
    is_old = reference is None or reference.type != "MESH"
    if is_old or scene_distances.place(active, reference) != found.get(
        scene_distances.PLACE
    ):
        text = "Moved or changed since it was compared; press Compare Meshes again"
        draw_text(column, context, text, icon="ERROR")
        return
    for line in distances.lines(found, active.name):
        draw_text(column, context, line, icon="DOT")
    other = found["reference"]
    text = f"Red lies outside of {other}, blue inside"
    draw_text(column, context, text, icon="COLOR")
    properties = context.scene.bonemesh_compare
    layout.prop(properties, "full_mm")
    layout.prop(properties, "show")


def register() -> None:
    """Adds the part."""
    bpy.utils.register_class(BONEMESH_PT_compare)


def unregister() -> None:
    """Takes it away."""
    bpy.utils.unregister_class(BONEMESH_PT_compare)
