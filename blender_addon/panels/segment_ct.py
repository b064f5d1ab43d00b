# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab "Segment CT" in the sidebar of the 3D view."""

from typing import Any, ClassVar

import bpy
from bpy.types import Context, Panel, UILayout

from ..jobs import job
from ..operators.cancel import BONEMESH_OT_cancel
from ..operators.check_mesh import BONEMESH_OT_check_mesh
from ..operators.choose_ct_directory import BONEMESH_OT_choose_ct_directory
from ..operators.choose_mesh_directory import BONEMESH_OT_choose_mesh_directory
from ..operators.measure_thickness import BONEMESH_OT_measure_thickness
from ..operators.mirror_roi import BONEMESH_OT_mirror_roi
from ..operators.plane_from_vertices import BONEMESH_OT_plane_from_vertices
from ..operators.remove_crop_box import BONEMESH_OT_remove_crop_box
from ..operators.render_again import BONEMESH_OT_read_sidecar, BONEMESH_OT_render_again
from ..operators.render_surface_mesh import BONEMESH_OT_render_surface_mesh
from ..operators.resume_roi import BONEMESH_OT_resume_roi
from ..operators.select_roi import BONEMESH_OT_select_roi
from ..operators.show_crop_box import BONEMESH_OT_show_crop_box
from ..operators.use_crop_box import BONEMESH_OT_use_crop_box
from ..request import suggestions
from ..request.inputs import uses_edge_points
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


class Part:
    """Mixed into the parts below the panel, which are folded in at first."""

    bl_parent_id = "BONEMESH_PT_segment_ct"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Segment CT"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Draws the part's fields with their names before them."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        self.draw_fields(context, layout)

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws the fields."""
        raise NotImplementedError


class BONEMESH_PT_crop(Part, Panel):
    """Which part of the images is rendered, as a box in the 3D view."""

    bl_label = "Crop"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws the field and what moves the box."""
        column = layout.column()
        column.prop(context.scene.bonemesh, "crop")
        column.operator(BONEMESH_OT_show_crop_box.bl_idname, icon="MESH_CUBE")
        column.operator(BONEMESH_OT_use_crop_box.bl_idname)
        column.operator(BONEMESH_OT_remove_crop_box.bl_idname)


class BONEMESH_PT_region(Part, Panel):
    """How the region is cut, and its counterpart on the other side."""

    bl_label = "Region"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws thickness, cut and mirror."""
        properties = context.scene.bonemesh_region
        column = layout.column()
        column.operator(BONEMESH_OT_measure_thickness.bl_idname)
        if properties.measured:
            column.label(text=properties.measured, icon="DRIVER_DISTANCE")
        column = layout.column()
        column.prop(properties, "method")
        cut = column.column()
        cut.active = properties.method == "solid"
        cut.prop(properties, "direction")
        if properties.direction == "outward":
            cut.prop(properties, "clearance")
        if properties.direction == "given":
            cut.prop(properties, "direction_numbers")
        cut.prop(properties, "hidden")
        cut.prop(properties, "separate")
        column.operator(BONEMESH_OT_resume_roi.bl_idname)
        column = layout.column()
        column.active = properties.method == "solid"
        column.prop(properties, "plane")
        if properties.plane == "given":
            column.prop(properties, "plane_numbers")
        column.operator(BONEMESH_OT_plane_from_vertices.bl_idname)
        column.prop(properties, "mirror_back")
        column.operator(BONEMESH_OT_mirror_roi.bl_idname)


class BONEMESH_PT_after_care(Part, Panel):
    """What is done to the mesh after it was made; little unless asked for."""

    bl_label = "After-Care"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws the steps in the order in which they are done."""
        properties = context.scene.bonemesh
        column = layout.column()
        column.prop(properties, "fill_holes")
        if properties.fill_holes == "small":
            column.prop(properties, "holes_mm")
        column.prop(properties, "remove_islands")
        if properties.remove_islands == "small":
            column.prop(properties, "islands_mm3")
        column.prop(properties, "fill_cavities")
        if properties.fill_cavities == "small":
            column.prop(properties, "cavities_mm3")
        column.prop(properties, "smooth_mm")
        column.prop(properties, "reduce_triangles")
        if properties.reduce_triangles == "number":
            column.prop(properties, "triangles")
        elif properties.reduce_triangles == "error":
            column.prop(properties, "decimate_mm")


class BONEMESH_PT_advanced(Part, Panel):
    """What is right as it stands for most images."""

    bl_label = "Advanced"

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws the settings of the next rendering."""
        properties = context.scene.bonemesh
        column = layout.column()
        column.prop(properties, "series")
        column.prop(properties, "one_series")
        column.prop(properties, "damp_metal")
        column.prop(properties, "method")
        table = column.row()
        table.active = not uses_edge_points(properties)
        table.prop(properties, "leave_out_table")
        edges = column.column()
        edges.active = uses_edge_points(properties)
        edges.prop(properties, "sigma")
        edges.prop(properties, "sample_percent")
        sampler = edges.row()
        sampler.enabled = properties.sample_percent < 100.0
        sampler.prop(properties, "sampler")
        column.prop(properties, "center_in_world")


CLASSES = (
    BONEMESH_PT_segment_ct,
    BONEMESH_PT_crop,
    BONEMESH_PT_region,
    BONEMESH_PT_after_care,
    BONEMESH_PT_advanced,
)


def register() -> None:
    """Adds the panels."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    """Takes the panels away."""
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
