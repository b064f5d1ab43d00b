"""Render, lasso vertices in Edit Mode, cut the region out."""

import math
from pathlib import Path
from typing import Any

import bmesh
import bpy
import gpu
import numpy as np
import stage
from mathutils import Euler


def make_gpu_context(folder: Path) -> None:
    """Selecting on the screen needs a GPU context, which a background Blender makes only on demand."""
    if hasattr(gpu, "init"):  # Blender 5.0 does not have it yet
        gpu.init()
        return
    scene = bpy.context.scene
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.render.filepath = str(folder / "pixel.png")
    if scene.camera is None:
        camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        scene.collection.objects.link(camera)
        scene.camera = camera
    bpy.ops.render.render(write_still=True)


def lasso_middle(placed: Any, x_part: float, y_part: float) -> None:
    """Looks at the object from the patient's front and draws a lasso around its middle."""
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    region = next(r for r in area.regions if r.type == "WINDOW")
    space = area.spaces.active
    space.shading.show_xray = True
    view = space.region_3d
    view.view_perspective = "ORTHO"
    view.view_location = placed.location
    view.view_rotation = Euler((math.pi / 2, 0.0, 0.0)).to_quaternion()
    view.view_distance = 2.0 * max(placed.dimensions)
    view.update()
    x, y = region.width / 2, region.height / 2
    dx, dy = x * x_part, y * y_part
    corners = [(x - dx, y - dy), (x + dx, y - dy), (x + dx, y + dy), (x - dx, y + dy)]
    path = [{"name": "", "loc": corner, "time": 0.0} for corner in corners]
    with bpy.context.temp_override(
        window=window, screen=window.screen, area=area, region=region
    ):
        bpy.ops.view3d.select_lasso(path=path, mode="SET")


def hide_all_but(placed: Any, patch: Any) -> None:
    """Hides the rest in Edit Mode: only a window can tell what lies behind what, so a lasso takes all."""
    mesh = bmesh.from_edit_mesh(placed.data)
    mesh.verts.ensure_lookup_table()
    for index in np.flatnonzero(~patch):
        mesh.verts[index].hide_set(True)
    bmesh.update_edit_mesh(placed.data)


def main(zip: str, out: str, ct: str, fields: dict[str, Any]) -> dict[str, Any]:
    """Says what was selected and what became of it."""
    folder = Path(out)
    stage.install(zip)
    stage.fill_panel(ct, out, method="alpha", **fields)
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    make_gpu_context(folder)
    patch = stage.front(bone)
    bpy.ops.object.mode_set(mode="EDIT")
    hide_all_but(bone, patch)
    lasso_middle(bone, 0.3, 0.2)
    bone.update_from_editmode()
    before = stage.save_mesh(folder / "before.npz", bone)
    result = bpy.ops.bonemesh.select_roi()
    region = bpy.data.objects["region"]
    bpy.context.view_layer.update()
    answer = {
        "result": sorted(result),
        "mode": bone.mode,
        "active": bpy.context.view_layer.objects.active.name,
        "before": before,
        "region": stage.save_mesh(folder / "region.npz", region),
        "properties": stage.custom_properties(region),
        "in_front": region.show_in_front,
        "in_scene": region.name in bpy.context.scene.objects,
    }
    # The user goes on: another lasso, another region.
    lasso_middle(bone, 0.15, 0.1)
    bpy.context.scene.bonemesh.roi_name = "second"
    answer["again"] = sorted(bpy.ops.bonemesh.select_roi())
    bpy.ops.object.mode_set(mode="OBJECT")
    answer["after"] = stage.save_mesh(folder / "after.npz", bone)
    answer["objects"] = sorted(o.name for o in bpy.context.scene.objects)
    return answer
