"""A job runs on while the user does something else to Blender."""

from pathlib import Path
from typing import Any

import bpy
import stage
from background import press, until_end


def start_region(ct: str, out: str) -> tuple[Any, Any, Any]:
    """Renders, selects everything, presses Select Region of Interest."""
    stage.fill_panel(ct, out)
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    return bone, *press("select_roi")


def main(zip: str, out: str, ct: str, how: str) -> dict[str, Any]:
    """Deletes the source, undoes, opens another file, disables the add-on, or quits."""
    stage.install(zip)
    if how == "quit":
        stage.fill_panel(ct, out)
        press("render_surface_mesh")
        return {"running": stage.addon_job().running() is not None}
    if how == "disable":
        stage.fill_panel(ct, out)
        press("render_surface_mesh")
        job, watches = stage.addon_job(), stage.addon_watches()
        bpy.ops.preferences.addon_disable(module=stage.MODULE)
        return {
            "running": job.running() is not None,
            "timers": len(watches),
            "files": sorted(p.name for p in Path(out).glob("*.stl")),
        }
    bpy.ops.ed.undo_push(message="before")
    bone, operator, context = start_region(ct, out)
    bpy.ops.ed.undo_push(message="after")
    if how == "delete":
        bpy.data.objects.remove(bone)
    elif how == "undo":
        bpy.ops.ed.undo()
    elif how == "edit":
        bpy.ops.object.mode_set(mode="EDIT")
    end = until_end(operator, context)
    return {
        "end": end,
        "reports": operator.reports,
        "mode": bpy.context.mode,
        "objects": sorted(o.name for o in bpy.context.scene.objects),
        "files": sorted(p.name for p in Path(out).glob("*.stl")),
    }
