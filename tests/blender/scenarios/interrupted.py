"""A job runs on while the user does something else to Blender."""

import threading
from pathlib import Path
from typing import Any

import bpy
import stage
from background import press, until_end


def start_region(ct: str, out: str) -> tuple[Any, Any, Any, stage.Gate]:
    """Renders, selects everything, presses Select Region of Interest."""
    stage.fill_panel(ct, out, method="alpha")
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    stage.select_front(bone)
    return bone, *press("select_roi", "select_roi")


def open_soon(gate: stage.Gate) -> None:
    """Opens the gate when the add-on has cancelled its job and waits for the end of it."""
    timer = threading.Timer(1.0, gate.open)
    timer.daemon = (
        True  # Python waits for other threads before it tells anybody that it ends
    )
    timer.start()


def opened(ct: str, out: str) -> dict[str, Any]:
    """Opens a file whose images were moved away while its surface is rendered."""
    properties = stage.fill_panel(str(Path(out) / "moved away"), out)
    file = str(Path(out) / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file, copy=True)
    properties.ct_directory = ct
    operator, context, gate = press("render_surface_mesh", "render")
    operator.cancel(context)  # as Blender does before it opens another file
    bpy.ops.wm.open_mainfile(filepath=file)
    refused = stage.message_of(bpy.ops.bonemesh.check_mesh)
    gate.open()
    assert stage.addon_job().stop(60.0)
    return {
        "refused": refused,
        "again": stage.message_of(bpy.ops.bonemesh.render_surface_mesh),
        "timers": len(stage.addon_watches()),
        "objects": sorted(o.name for o in bpy.data.objects if "bone" in o.name),
        "files": sorted(p.name for p in Path(out).glob("*.stl")),
    }


def main(zip: str, out: str, ct: str, how: str) -> dict[str, Any]:
    """Deletes the source, undoes, opens another file, disables the add-on, or quits."""
    stage.install(zip)
    if how == "quit":
        stage.fill_panel(ct, out)
        *_, gate = press("render_surface_mesh", "render")
        open_soon(gate)
        return {"running": stage.addon_job().running() is not None}
    if how == "disable":
        stage.fill_panel(ct, out)
        *_, gate = press("render_surface_mesh", "render")
        job, watches = stage.addon_job(), stage.addon_watches()
        open_soon(gate)
        bpy.ops.preferences.addon_disable(module=stage.MODULE)
        return {
            "running": job.running() is not None,
            "timers": len(watches),
            "files": sorted(p.name for p in Path(out).glob("*.stl")),
        }
    if how == "open":
        return opened(ct, out)
    bpy.ops.ed.undo_push(message="before")
    bone, operator, context, gate = start_region(ct, out)
    bpy.ops.ed.undo_push(message="after")
    if how == "delete":
        bpy.data.objects.remove(bone)
    elif how == "undo":
        bpy.ops.ed.undo()
    elif how == "edit":
        bpy.ops.object.mode_set(mode="EDIT")
    gate.open()
    end = until_end(operator, context)
    return {
        "end": end,
        "reports": operator.reports,
        "mode": bpy.context.mode,
        "objects": sorted(o.name for o in bpy.context.scene.objects),
        "files": sorted(p.name for p in Path(out).glob("*.stl")),
    }
