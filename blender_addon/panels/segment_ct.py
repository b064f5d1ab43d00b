# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab "Segment CT" in the sidebar of the 3D view."""

from typing import Any

import bpy
from bpy.types import Context, Panel, UILayout

from ..jobs import job
from ..operators.cancel import BONEMESH_OT_cancel
from ..operators.check_mesh import BONEMESH_OT_check_mesh
from ..operators.choose_ct_directory import BONEMESH_OT_choose_ct_directory
from ..operators.choose_mesh_directory import BONEMESH_OT_choose_mesh_directory
from ..operators.render_again import BONEMESH_OT_read_sidecar, BONEMESH_OT_render_again
from ..operators.render_surface_mesh import BONEMESH_OT_render_surface_mesh
from ..operators.select_roi import BONEMESH_OT_select_roi
from ..request import suggestions
from . import (
    contents_box,
    files_box,
    memory_box,
    mesh_box,
    next_step_box,
    threshold_box,
)


class BONEMESH_PT_segment_ct(Panel):
    """From CT images to a surface mesh, and from that to a region of interest."""

    bl_label = "Segment CT"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Segment CT"

    def draw(self, context: Context) -> None:
        """Draws the fields in the order in which they are used."""
        properties = context.scene.bonemesh
        layout = self.layout

        # At the top, where it is seen without scrolling.
        running = job.running()
        if running is None:
            next_step_box.draw(layout, context)
        else:
            draw_progress(layout, running)
        column = layout.column()
        column.operator(BONEMESH_OT_choose_ct_directory.bl_idname)
        column.prop(properties, "ct_directory", text="")
        contents_box.draw(column, context)
        threshold_box.draw(column, context)
        filled = suggestions.filled(context)
        draw_surface(layout.column(), context, filled)
        draw_region(layout.column(), context, filled)
        draw_check(layout.column(), context)


def draw_surface(column: UILayout, context: Context, filled: Any) -> None:
    """Draws what the whole mesh is called, where it is saved, and the button that makes it."""
    properties = context.scene.bonemesh
    column.label(text="Mesh Filename")
    column.prop(properties, "mesh_name", text="", placeholder=filled.mesh_name)
    column.operator(BONEMESH_OT_choose_mesh_directory.bl_idname)
    column.prop(
        properties, "mesh_directory", text="", placeholder=filled.mesh_directory
    )
    files_box.draw(column, context, filled.mesh_directory, filled.mesh_name)
    memory_box.draw(column, context)
    if properties.crop.strip():
        # Seen where it matters: the part Crop may be folded in.
        column.prop(properties, "crop", text="Only", icon="MESH_CUBE")
    column.operator(BONEMESH_OT_render_surface_mesh.bl_idname)
    row = column.row(align=True)
    row.operator(BONEMESH_OT_render_again.bl_idname)
    row.operator(BONEMESH_OT_read_sidecar.bl_idname, text="", icon="FILE_FOLDER")


def draw_region(column: UILayout, context: Context, filled: Any) -> None:
    """Draws how thick the region is, what it is called, and the button that cuts it out."""
    properties = context.scene.bonemesh
    column.prop(properties, "cut_thickness")
    column.label(text="Segmented Mesh Filename")
    column.prop(properties, "roi_name", text="", placeholder=filled.roi_name)
    files_box.draw(column, context, filled.mesh_directory, filled.roi_name)
    column.operator(BONEMESH_OT_select_roi.bl_idname)


def draw_check(column: UILayout, context: Context) -> None:
    """Draws the button with the name of what it looks at, and what was found."""
    active = context.active_object
    is_mesh = active is not None and active.type == "MESH"
    text = f"Check Mesh: {active.name}" if is_mesh else "Check Mesh"
    column.operator(BONEMESH_OT_check_mesh.bl_idname, text=text)
    mesh_box.draw(column, context)


def draw_progress(layout: UILayout, running: job.Job) -> None:
    """Draws how far the running job is and the button that stops it."""
    stage, fraction = running.progress
    left = running.time_left
    column = layout.column()
    column.label(text=f"{running.title}: {left}" if left else running.title)
    column.progress(factor=fraction, text=stage.capitalize(), type="BAR")
    column.operator(BONEMESH_OT_cancel.bl_idname, icon="X")


def register() -> None:
    """Adds the panel."""
    bpy.utils.register_class(BONEMESH_PT_segment_ct)


def unregister() -> None:
    """Takes the panel away."""
    bpy.utils.unregister_class(BONEMESH_PT_segment_ct)
