"""The patient's sides and letters, of a bone in its place, turned, and rewritten; a picture from the front."""

from importlib import import_module
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import stage
from mathutils import Vector

SIDES = ("front", "back", "left", "right", "top", "bottom")


def view() -> Any:
    """The first 3D view."""
    manager = bpy.context.window_manager
    areas = (a for w in manager.windows for a in w.screen.areas)
    return next(a for a in areas if a.type == "VIEW_3D")


def seen(placed: Any) -> dict[str, Any]:
    """For each side: where the view looks and what is right and up in it, and how much of it the bone fills."""
    area = view()
    space = area.spaces.active
    region = next(r for r in area.regions if r.type == "WINDOW")
    left_px, right_px = import_module(f"{stage.MODULE}.views.views").covered_px(area)
    answer = {}
    for side in SIDES:
        assert bpy.ops.bonemesh.view_patient(side=side) == {"FINISHED"}
        r3d = space.region_3d
        turn = r3d.view_rotation
        right, up, looks = (
            list(turn @ Vector(axis)) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, -1))
        )
        mm = r3d.view_distance * 72.0 / space.lens / max(region.width, region.height)
        corners = [
            turn.inverted() @ (placed.matrix_world @ Vector(c))
            for c in placed.bound_box
        ]
        spread = np.ptp(np.array(corners), axis=0).tolist()
        middle = sum(corners, Vector()) / 8
        off = turn.inverted() @ r3d.view_location - middle
        answer[side] = {
            "right": right,
            "up": up,
            "looks": looks,
            "fills": [
                spread[0] / mm / (region.width - left_px - right_px),
                spread[1] / mm / region.height,
            ],
            "perspective": r3d.view_perspective,
            "off": [off[0] / mm - (right_px - left_px) / 2.0, off[1] / mm],
        }
    return answer


def letters(placed: Any) -> dict[str, list[float]]:
    """Where each letter stands."""
    directions = import_module(f"{stage.MODULE}.views.directions")
    return {letter: list(place) for letter, place in directions.places(placed).items()}


def hidden(placed: Any, looks: Any) -> str:
    """The letters that are not drawn for whoever looks along a direction."""
    directions = import_module(f"{stage.MODULE}.views.directions")
    kept = directions.seen_letters(placed, Vector(looks).normalized())
    return "".join(sorted(set("RLAPSI") - set(kept)))


def picture(placed: Any, out: str) -> str:
    """The bone from the front as the view shows it, drawn by a camera in the view's place."""
    bpy.ops.bonemesh.view_patient(side="front")
    r3d = view().spaces.active.region_3d
    camera = bpy.data.cameras.new("front")
    camera.type, camera.ortho_scale = "ORTHO", 1.2 * max(placed.dimensions)
    camera.clip_end = 10_000.0
    taken = bpy.data.objects.new("front", camera)
    turn = r3d.view_rotation
    taken.rotation_mode = "QUATERNION"
    taken.rotation_quaternion = turn
    taken.location = r3d.view_location + turn @ Vector((0.0, 0.0, 1000.0))
    scene = bpy.context.scene
    scene.collection.objects.link(taken)
    scene.camera = taken
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.render.resolution_x = scene.render.resolution_y = 400
    scene.render.filepath = str(Path(out) / "front.png")
    bpy.ops.render.render(write_still=True)
    return scene.render.filepath


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """In place, turned, rewritten."""
    stage.install(zip)
    stage.clear_scene()
    stage.fill_panel(ct, out)
    poll = bpy.ops.bonemesh.view_patient.poll()
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    answer: dict[str, Any] = {
        "poll": poll,
        "in place": seen(bone),
        "letters": letters(bone),
    }
    answer["hidden"] = {
        "front": hidden(bone, (0, 1, 0)),
        "aslant": hidden(bone, (1, 1, 1)),
    }
    answer["picture"] = picture(bone, out)
    bone.hide_viewport = True
    answer["hidden bone"] = seen(bone)
    bone.hide_viewport = False
    bone.rotation_euler = (0.4, 0.2, 1.1)
    bone.location = (0.0, 0.0, 0.0)
    answer["turned"] = seen(bone)
    answer["turn"] = np.array(bone.matrix_world.to_3x3()).tolist()
    answer["turned letters"] = letters(bone)
    bpy.ops.object.mode_set(mode="EDIT")
    answer["in edit mode"] = seen(bone)
    bpy.ops.object.mode_set(mode="OBJECT")
    bone.select_set(True)  # being hidden has deselected it
    bpy.ops.object.transform_apply(location=True, rotation=True)
    answer["applied"] = seen(bone)
    return answer
