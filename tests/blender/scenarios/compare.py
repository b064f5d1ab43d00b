"""Two balls against each other: by a script, pressed, refused, moved afterwards."""

from importlib import import_module
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import stage
from background import press, until_end
from panel import drawn

RADIUS, OTHER_RADIUS = 10.0, 10.5


def ball(name: str, radius: float, **options: Any) -> Any:
    """A new ball, active and selected alone."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=radius, **options)
    placed = bpy.context.view_layer.objects.active
    placed.name = name
    return placed


def choose(active: Any, *others: Any) -> None:
    """Selects these alone."""
    bpy.ops.object.select_all(action="DESELECT")
    for placed in (active, *others):
        placed.select_set(True)
    bpy.context.view_layer.objects.active = active


def seen(placed: Any) -> dict[str, Any]:
    """What the mesh has of the comparison, and what is shown."""
    data = placed.data
    distance = np.empty(len(data.vertices), dtype=np.float32)
    data.attributes["distance_mm"].data.foreach_get("value", distance)
    colour = np.empty(4 * len(data.vertices), dtype=np.float32)
    data.attributes["distance"].data.foreach_get("color", colour)
    space = next(
        area.spaces.active
        for window in bpy.context.window_manager.windows
        for area in window.screen.areas
        if area.type == "VIEW_3D"
    )
    return {
        "distances": [float(distance.min()), float(distance.max())],
        "colour": colour.reshape(-1, 4).mean(axis=0).tolist(),
        "active colour": data.color_attributes.active_color.name,
        "shading": space.shading.color_type,
        "panel": drawn("BONEMESH_PT_compare"),
    }


def refused(ball_: Any, other: Any) -> dict[str, str]:
    """What is said where two meshes are not selected."""
    compare = bpy.ops.bonemesh.compare_meshes
    answer = {}
    choose(ball_)
    answer["alone"] = stage.message_of(compare)
    third = ball("third", 1.0)
    choose(ball_, other, third)
    answer["three"] = stage.message_of(compare)
    choose(ball_, other)
    bpy.ops.object.mode_set(mode="EDIT")
    answer["edit mode"] = stage.message_of(compare)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.objects.remove(third)
    bpy.context.view_layer.objects.active = None
    answer["none active"] = stage.message_of(compare)
    choose(ball_, other)
    nothing = ball("nothing", 1.0)
    nothing.data.clear_geometry()
    choose(ball_, nothing)
    answer["nothing there"] = stage.message_of(compare)
    bpy.data.objects.remove(nothing)
    return answer


def pressed(ball_: Any, other: Any) -> dict[str, Any]:
    """Beside the window: to its end, cancelled, and with the mesh changed meanwhile."""
    choose(ball_, other)
    operator, context, gate = press("compare_meshes", "compare")
    answer: dict[str, Any] = {"busy": drawn()[0]}
    gate.open()
    answer["end"] = [until_end(operator, context), operator.reports]
    operator, context, gate = press("compare_meshes", "compare")
    bpy.ops.bonemesh.cancel()
    gate.open()
    answer["cancelled"] = [until_end(operator, context), operator.reports]
    operator, context, gate = press("compare_meshes", "compare")
    ball_.data.clear_geometry()
    gate.open()
    answer["changed"] = [until_end(operator, context), operator.reports]
    return answer


def main(zip: str, out: str) -> dict[str, Any]:
    """Everything in one Blender."""
    stage.install(zip)
    stage.clear_scene()
    other = ball("other", OTHER_RADIUS, location=(3.0, 4.0, 5.0))
    first = ball("first", RADIUS, location=(3.0, 4.0, 5.0))
    answer: dict[str, Any] = {"refused": refused(first, other)}
    choose(first, other)
    properties = bpy.context.scene.bonemesh_compare
    answer["result"] = sorted(bpy.ops.bonemesh.compare_meshes())
    answer["compared"] = seen(first)
    local = np.empty(3 * len(first.data.vertices), dtype=np.float32)
    first.data.vertices.foreach_get("co", local)
    np.save(Path(out) / "first.npy", local.reshape(-1, 3))
    properties.full_mm = 0.25
    answer["full colour"] = seen(first)["colour"]
    properties.show = False
    answer["plain"] = [seen(first)["shading"], properties.show]
    properties.show = True
    answer["shown again"] = [seen(first)["shading"], properties.show]
    first.location.x += 1.0
    bpy.context.view_layer.update()
    answer["moved"] = drawn("BONEMESH_PT_compare")
    bpy.ops.bonemesh.compare_meshes()
    answer["compared anew"] = seen(first)["distances"]
    choose(other, first)
    bpy.ops.bonemesh.compare_meshes()
    answer["other way"] = seen(other)["distances"]
    bpy.data.objects.remove(other)
    choose(first)
    answer["without the other"] = drawn("BONEMESH_PT_compare")
    answer["pressed"] = pressed(first, ball("other", OTHER_RADIUS))
    distances = import_module(f"{stage.MODULE}.reports.distances")
    return answer | {"grey": distances.NEAR.tolist(), "blue": distances.INSIDE.tolist()}
