"""Undo and redo of both steps, in Object Mode and in Edit Mode."""

from typing import Any

import bpy
import stage


def names() -> list[str]:
    """The objects that the add-on made."""
    return sorted(
        o.name for o in bpy.context.scene.objects if o.name in ("bone", "region")
    )


def main(zip: str, out: str, ct: str, edit: bool) -> dict[str, Any]:
    """Renders, cuts out, goes back and forth; each step by its name."""
    stage.install(zip)
    stage.fill_panel(ct, out, method="alpha")
    bpy.ops.ed.undo_push(message="begin")
    seen = {}
    bpy.ops.bonemesh.render_surface_mesh("EXEC_DEFAULT", True)
    stage.select_front(bpy.context.view_layer.objects.active)
    if edit:
        bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="EDIT")
    bpy.ops.bonemesh.select_roi("EXEC_DEFAULT", True)
    seen["done"] = names()
    steps_back = 0
    while bpy.ops.ed.undo.poll() and names():
        bpy.ops.ed.undo()
        steps_back += 1
        seen[f"undo {steps_back}"] = names()
    for step in range(steps_back):
        bpy.ops.ed.redo()
        seen[f"redo {step + 1}"] = names()
    return {"seen": seen, "steps": steps_back}
