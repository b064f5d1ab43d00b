"""Regions of bones that were scaled, mirrored, or sheared by a parent: as large as they are seen."""

from pathlib import Path
from typing import Any

import bpy
import numpy as np
import stage
from mathutils import Matrix

THICKNESS_MM = 6.0
PLACES = {
    "as made": Matrix.Identity(4),
    "moved and turned": Matrix.Translation((40.0, -30.0, 20.0))
    @ Matrix.Rotation(0.7, 4, "X"),
    "twice as large": Matrix.Diagonal((2.0, 2.0, 2.0, 1.0)),
    "mirrored": Matrix.Diagonal((-1.0, 1.0, 1.0, 1.0)),
    "sheared": Matrix.Diagonal((1.0, 1.6, 1.0, 1.0)) @ Matrix.Rotation(0.5, 4, "Z"),
}


def world_vertices(placed: Any) -> Any:
    """(N, 3), as they are seen."""
    local = np.empty(3 * len(placed.data.vertices), dtype=np.float32)
    placed.data.vertices.foreach_get("co", local)
    matrix = np.asarray(placed.matrix_world, dtype=np.float64)
    return local.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def sides(vertices: Any) -> list[float]:
    """Of the box around them."""
    return np.ptp(vertices, axis=0).tolist()


def saved_vertices(file: Path) -> Any:
    """Of an STL file, three for each triangle."""
    triangles = np.frombuffer(file.read_bytes()[84:], dtype=np.uint8).reshape(-1, 50)
    return triangles[:, 12:48].copy().view("<f4").reshape(-1, 3)


def cut(bone: Any, out: str, name: str, matrix: Matrix) -> dict[str, Any]:
    """A region of the bone at that place."""
    bone.matrix_world = matrix @ bone.matrix_world
    bpy.context.view_layer.update()
    bpy.context.view_layer.objects.active = bone
    bpy.context.scene.bonemesh.roi_name = name
    front = world_vertices(bone)[stage.front(bone)]
    bpy.ops.bonemesh.select_roi()
    region = bpy.data.objects[name]
    seen, saved = world_vertices(region), saved_vertices(Path(out) / f"{name}.stl")
    beyond = np.maximum(front.min(axis=0) - seen.max(axis=0), 0.0)
    beyond += np.maximum(seen.min(axis=0) - front.max(axis=0), 0.0)
    answer = {
        "seen": sides(seen),
        "saved": sides(saved),
        "patch": sides(front),
        "off": beyond.max(),
    }
    bone.matrix_world = matrix.inverted() @ bone.matrix_world
    return answer


def main(zip: str, out: str, ct: str) -> dict[str, Any]:
    """One region for each place."""
    stage.install(zip)
    stage.fill_panel(ct, out, cut_thickness=THICKNESS_MM)
    bpy.ops.bonemesh.render_surface_mesh()
    bone = bpy.context.view_layer.objects.active
    stage.select_front(bone)
    answer = {name: cut(bone, out, name, matrix) for name, matrix in PLACES.items()}
    bone.scale = (0.0, 1.0, 1.0)
    answer["flat"] = stage.message_of(bpy.ops.bonemesh.check_mesh)
    return answer
