"""CT slices through undo and redo; the bone is renamed and deleted meanwhile."""

from typing import Any

import bpy
import numpy as np
import stage
from slices import PLANES, addon, contour, greys, kind

UNDO = ("EXEC_DEFAULT", True)


def state() -> dict[str, Any]:
    """What the axial slice shows."""
    return {
        "position": addon("slices.scene_slices").position_mm("axial"),
        "grey": greys("axial").astype(int).sum().item(),
        "points": len(contour("axial")),
    }


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """Everything in one Blender; the answers by what was done last."""
    stage.install(zip)
    stage.clear_scene()
    stage.fill_panel(ct, out)
    bpy.ops.ed.undo_push(message="begin")
    bpy.ops.bonemesh.render_surface_mesh(*UNDO)
    bpy.ops.bonemesh.show_slices(*UNDO)
    answer: dict[str, Any] = {"shown": state()}
    bpy.context.scene.bonemesh_slices.axial = 20.0
    bpy.ops.ed.undo_push(message="moved")
    answer["moved"] = state()
    bpy.ops.ed.undo()
    answer["move undone"] = state()
    bpy.ops.ed.redo()
    answer["move redone"] = state()
    bpy.data.objects["bone"].name = "another name"
    bpy.context.view_layer.update()
    bpy.context.scene.bonemesh_slices.axial = 40.0
    answer["renamed"] = state() | {
        "surface": addon("slices.slice_updates").surface().name
    }
    bpy.ops.ed.undo_push(message="renamed")
    bpy.data.objects.remove(bpy.data.objects["another name"])
    bpy.context.view_layer.update()
    answer["deleted"] = state()
    answer["panel"] = [
        addon("slices.slice_updates").surface() is None,
        [bool(np.any(greys(name))) for name in PLANES],
    ]
    bpy.ops.ed.undo_push(message="deleted")
    bpy.ops.ed.undo()
    answer["deletion undone"] = state()
    while bpy.ops.ed.undo.poll() and kind("stack") is not None:
        bpy.ops.ed.undo()
    answer["all undone"] = kind("stack") is None
    bpy.ops.ed.redo()
    answer["shown again"] = state()
    return answer
