# SPDX-License-Identifier: GPL-3.0-or-later
"""The crop box as an object: like scene/meshes.py, from where alone Blender's data are written.

A mesh and not an empty: its faces can be dragged in Edit Mode, one at a time, and a tilted gantry's sheared
box is shown as it is.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from . import crop_box
from .crop_box import Box, Grid

NAME = "Bonemesh Crop Box"
TAG = "bonemesh_crop_box"
NOTED = "bonemesh_noted_mm"
SAME_MM = 1e-3


def place(context: Any, box: Box, grid: Grid) -> Any:
    """Shows the box at its place in the patient; one that is there already goes there."""
    corners = crop_box.corners_mm(box, grid)
    centre, turned = corners.mean(axis=0), crop_box.frame(grid)
    placed = found(context.scene)
    if placed is None:
        placed = bpy.data.objects.new(NAME, bpy.data.meshes.new(NAME))
        placed[TAG] = True
        placed.display_type = "WIRE"
        placed.show_in_front = True
        placed.hide_render = True
        context.scene.collection.objects.link(placed)
    placed.data.clear_geometry()
    placed.data.from_pydata((corners - centre) @ turned, [], crop_box.FACES)
    placed.data.update()
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turned, centre
    placed.matrix_world = Matrix(matrix.tolist())
    placed.hide_set(False)
    note_place(context, placed)
    return placed


def found(scene: Any) -> Any:
    """The box in `scene`, if there is one."""
    return next((o for o in scene.objects if TAG in o and o.type == "MESH"), None)


def corners_mm(context: Any, placed: Any) -> NDArray[np.float64]:
    """(N, 3) places of its corners in the world, wherever the user moved them."""
    context.view_layer.update()  # a script may just have moved it
    if placed.mode == "EDIT":
        placed.update_from_editmode()
    local = np.empty(3 * len(placed.data.vertices), dtype=np.float32)
    placed.data.vertices.foreach_get("co", local)
    matrix = np.asarray(placed.matrix_world, dtype=np.float64)
    corners: NDArray[np.float64] = (
        local.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    )
    return corners


def note_place(context: Any, placed: Any) -> None:
    """Notes where the box is, now that the field Crop says the same."""
    placed[NOTED] = corners_mm(context, placed).ravel().tolist()


def is_moved(context: Any, placed: Any) -> bool:
    """Whether the user moved, scaled or edited the box since then."""
    noted = np.array(placed.get(NOTED, ()), dtype=np.float64)
    now = corners_mm(context, placed).ravel()
    return noted.shape != now.shape or not np.allclose(noted, now, atol=SAME_MM, rtol=0)


def remove(placed: Any) -> None:
    """Takes the box away."""
    data = placed.data
    bpy.data.objects.remove(placed)
    if data.users == 0:
        bpy.data.meshes.remove(data)
