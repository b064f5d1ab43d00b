"""Measure, cut, mirror: the buttons of the panel's part Region."""

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import stage
from mathutils import Euler


def select(placed: Any, vertices: Any) -> None:
    """Selects these vertices, in Object Mode."""
    chosen = np.zeros(len(placed.data.vertices), dtype=bool)
    chosen[vertices] = True
    placed.data.vertices.foreach_set("select", chosen)


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Says what each button gave and what is kept of it."""
    folder = Path(out)
    stage.install(zip)
    stage.fill_panel(ct, out, cut_thickness=4.0)
    region = bpy.context.scene.bonemesh_region
    region.plane = "y"
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    stage.select_front(bone)
    bpy.ops.bonemesh.measure_thickness()
    answer: dict[str, Any] = {"measured": region.measured}
    for name, settings in {
        "inward": {},
        "thrice": {"direction": "through"},
        "plate": {"direction": "outward", "clearance": 0.5},
    }.items():
        region.direction = "normal"
        for key, value in settings.items():
            setattr(region, key, value)
        bpy.context.scene.bonemesh.roi_name = name
        bpy.ops.bonemesh.select_roi()
    region.direction = "normal"
    for name, back in {"other": False, "template": True}.items():
        region.mirror_back = back
        bpy.context.scene.bonemesh.roi_name = name
        bpy.ops.bonemesh.mirror_roi()
    bpy.context.view_layer.update()
    for name in ("inward", "thrice", "plate", "other", "template"):
        placed = bpy.data.objects[name]
        answer[name] = stage.save_mesh(folder / f"{name}.npz", placed)
        properties = stage.custom_properties(placed)
        answer[f"{name} properties"] = {
            key: properties.get(f"bonemesh_{key}")
            for key in ("direction", "clearance_mm", "mirror", "mirror_back")
        }
        answer[f"{name} collections"] = [c.name for c in placed.users_collection]
    answer["patch"] = stage.save_mesh(folder / "patch.npz", bone)
    answer["two points"] = plane_of(bone, [0, 1])
    answer["three points"] = plane_of(bone, [0, 500, 1000])
    answer["plane"] = [region.plane, list(region.plane_numbers)]
    stage.select_front(bone)
    region.direction = "view"
    bpy.context.scene.bonemesh.roi_name = "seen"
    look_from_front()
    bpy.ops.bonemesh.select_roi()
    seen = stage.custom_properties(bpy.data.objects["seen"])
    answer["view"] = seen["bonemesh_direction"]
    for name in ("plate", "template", "seen"):
        answer[f"{name} resumed"] = resumed(bone, name)
    select(bone, range(0, len(bone.data.vertices), 7))
    bpy.context.view_layer.objects.active = bpy.data.objects["plate"]
    bone.name = "renamed"
    answer["source gone"] = stage.message_of(bpy.ops.bonemesh.resume_roi)
    del bpy.data.objects["plate"]["bonemesh_thickness_mm"]
    answer["settings gone"] = stage.message_of(bpy.ops.bonemesh.resume_roi)
    return answer


def resumed(bone: Any, name: str) -> dict[str, Any]:
    """What the panel says and what is selected after a region was taken up again."""
    region = bpy.context.scene.bonemesh_region
    region.direction, region.clearance, region.mirror_back = "normal", 0.1, False
    region.plane = "auto"
    bpy.context.scene.bonemesh.cut_thickness = 1.0
    select(bone, [])
    bpy.context.view_layer.objects.active = bpy.data.objects[name]
    bpy.ops.bonemesh.resume_roi()
    answer = {
        "mode": bpy.context.mode,
        "active": bpy.context.view_layer.objects.active.name,
        "thickness": bpy.context.scene.bonemesh.cut_thickness,
        "direction": [region.direction, list(region.direction_numbers)],
        "clearance": region.clearance,
        "plane": region.plane,
        "mirror_back": region.mirror_back,
    }
    bpy.ops.object.mode_set(mode="OBJECT")
    kept = list(bpy.data.objects[name]["bonemesh_selected"])
    chosen = np.zeros(len(bone.data.vertices), dtype=bool)
    bone.data.vertices.foreach_get("select", chosen)
    answer["same vertices"] = np.flatnonzero(chosen).tolist() == kept
    faces = np.zeros(len(bone.data.polygons), dtype=bool)
    bone.data.polygons.foreach_get("select", faces)
    answer["faces"] = int(faces.sum())
    return answer


def look_from_front() -> None:
    """Turns every 3D view to look at the patient's face."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                view = area.spaces.active.region_3d
                turned = Euler((math.pi / 2, 0.0, 0.0))
                view.view_rotation = turned.to_quaternion()


def plane_of(bone: Any, vertices: list[int]) -> str:
    """The refusal of the plane through these vertices, or an empty string."""
    select(bone, vertices)
    return stage.message_of(bpy.ops.bonemesh.plane_from_vertices)
