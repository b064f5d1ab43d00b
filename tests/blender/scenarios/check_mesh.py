"""Checks meshes that can be printed and meshes that cannot, by a script and with the button."""

import json
from typing import Any

import bmesh
import bpy
import numpy as np
import stage
from background import press, until_end
from panel import drawn


def box() -> list[str]:
    """What the box of the active mesh shows now, below its button."""
    shown = drawn()
    button = next(row for row in shown if row[:10] == "Check Mesh")
    below = shown[shown.index(button) + 1 :]
    return next((item for item in below if isinstance(item, list)), [])


def cube(name: str, **options: Any) -> Any:
    """A new active cube of 2 mm, named."""
    bpy.ops.mesh.primitive_cube_add(size=2.0, **options)
    placed = bpy.context.view_layer.objects.active
    placed.name = name
    return placed


def without_a_face(placed: Any) -> Any:
    """Takes a face of the cube away."""
    mesh = bmesh.new()
    mesh.from_mesh(placed.data)
    mesh.faces.ensure_lookup_table()
    bmesh.ops.delete(mesh, geom=[mesh.faces[0]], context="FACES_ONLY")
    mesh.to_mesh(placed.data)
    mesh.free()
    return placed


def selected(placed: Any) -> list[bool]:
    """Which vertices of the object are selected."""
    flags = np.empty(len(placed.data.vertices), dtype=bool)
    placed.data.vertices.foreach_get("select", flags)
    return flags.tolist()


def checked(placed: Any) -> dict[str, Any]:
    """Calls the operator as a script does; what is kept and shown."""
    before = selected(placed)
    result = sorted(bpy.ops.bonemesh.check_mesh())
    return {
        "result": result,
        "report": json.loads(placed["bonemesh_check"]),
        "box": box(),
        "untouched": selected(placed) == before,
        "mode": placed.mode,
    }


def rendered() -> dict[str, Any]:
    """A mesh as it was rendered; then another one beside the window."""
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    answer = {"after rendering": box(), "by script": checked(bone)}
    bone.location.x += 500.0
    bone.rotation_euler.z = 1.0
    answer["moved"] = checked(bone)
    bpy.ops.object.mode_set(mode="EDIT")
    answer["in edit mode"] = checked(bone)
    bpy.ops.object.mode_set(mode="OBJECT")
    del bone["bonemesh_check"]
    answer["pressed"] = pressed(bone)
    operator, context, gate = press("check_mesh", "check")
    bpy.data.objects.remove(bone)
    gate.open()
    answer["deleted meanwhile"] = [until_end(operator, context), operator.reports]
    return answer


def pressed(bone: Any) -> dict[str, Any]:
    """Presses the button; looks at the panel meanwhile and afterwards; stops a second one."""
    operator, context, gate = press("check_mesh", "check")
    busy = drawn()
    gate.open()
    answer = {
        "busy": [item for item in busy if isinstance(item, str)],
        "end": until_end(operator, context),
        "reports": operator.reports,
        "box": box(),
        "report": json.loads(bone["bonemesh_check"]),
    }
    del bone["bonemesh_check"]
    operator, context, gate = press("check_mesh", "check")
    bpy.ops.bonemesh.cancel()
    gate.open()
    answer["cancelled"] = [until_end(operator, context), operator.reports]
    answer["kept"] = "bonemesh_check" in bone
    return answer


def by_hand() -> dict[str, Any]:
    """Meshes that a user made: whole, open, scaled, mirrored, repaired by a modifier."""
    answer = {"whole": checked(cube("whole"))}
    opened = without_a_face(cube("open"))
    answer["open"] = checked(opened)
    bpy.context.view_layer.objects.active = bpy.data.objects["whole"]
    answer["another one"] = box()
    bpy.context.view_layer.objects.active = opened
    opened.modifiers.new("wall", "SOLIDIFY").thickness = 0.5
    answer["changed"] = box()
    answer["with a modifier"] = checked(opened)
    bpy.ops.object.mode_set(mode="EDIT")
    answer["with a modifier, in edit mode"] = checked(opened)
    bpy.ops.object.mode_set(mode="OBJECT")
    answer["scaled"] = checked(cube("scaled", scale=(2.0, 3.0, 4.0)))
    mirrored = cube("mirrored", location=(9.0, 0.0, 0.0))
    mirrored.scale = (-1.0, 1.0, 1.0)
    answer["mirrored"] = checked(mirrored)
    nothing = cube("nothing")
    nothing.data.clear_geometry()
    answer["nothing"] = checked(nothing)
    nothing["bonemesh_check"] = "written by hand"
    answer["spoilt"] = box()
    return answer


def main(zip: str, out: str, shell: str) -> dict[str, Any]:
    """Everything in one Blender."""
    stage.install(zip)
    fields = {"fill_cavities": "all", "reduce_triangles": "number", "triangles": 3000}
    stage.fill_panel(shell, out, **fields)
    answer = rendered()
    bpy.context.scene.bonemesh.ct_directory = ""
    return answer | by_hand()
