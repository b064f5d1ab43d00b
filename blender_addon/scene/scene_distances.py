# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances on a mesh as attributes, and as its colours in the 3D views; with meshes.py a writer of Blender's data."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ..reports import distances
from ..views import window
from . import meshes

DISTANCE = "distance_mm"
"""Of each vertex, positive outside of the other mesh."""
COLOUR = "distance"
COMPARED = "compared"
PLACE = "place"
"""Key of the report of how the two lay to each other."""


def keep(placed: Any, signed_mm: NDArray[np.float32], full_mm: float) -> None:
    """The distances of an object's vertices, and the colours that they are shown in."""
    fresh(placed.data, DISTANCE, "FLOAT").data.foreach_set("value", signed_mm)
    paint(placed.data, signed_mm, full_mm)


def paint(data: Any, signed_mm: NDArray[np.float32], full_mm: float) -> None:
    """The colours alone."""
    colour = fresh(data, COLOUR, "FLOAT_COLOR")
    colour.data.foreach_set("color", distances.colours(signed_mm, full_mm).ravel())
    data.color_attributes.active_color_name = COLOUR
    data.update()


def paint_again(full_mm: float) -> None:
    """All meshes that were compared, on another scale."""
    for data in bpy.data.meshes:
        kept = data.attributes.get(DISTANCE)
        # In Edit Mode a mesh hides its attributes.
        if kept is None or kept.data_type != "FLOAT" or not len(kept.data):
            continue
        signed_mm = np.empty(len(kept.data), dtype=np.float32)
        kept.data.foreach_get("value", signed_mm)
        paint(data, signed_mm, full_mm)


def fresh(data: Any, name: str, kind: str) -> Any:
    """The attribute of the vertices, of that kind; made where there is none or another."""
    found = data.attributes.get(name)
    if found is not None and (found.data_type, found.domain) == (kind, "POINT"):
        return found
    if found is not None:
        data.attributes.remove(found)
    return data.attributes.new(name, kind, "POINT")


def place(placed: Any, reference: Any) -> str:
    """What changes when one of the two is moved or changed."""
    between = reference.matrix_world.inverted_safe() @ placed.matrix_world
    numbers = " ".join(f"{n:.5g}" for row in between for n in row)
    return f"{meshes.state(placed)}, {meshes.state(reference)}, {numbers}"


def are_shown(context: Any) -> bool:
    """Whether the first 3D view shows such colours in solid shading."""
    area = next((area for _, area in window.views(context)), None)
    return area is not None and area.spaces.active.shading.color_type == "VERTEX"


def set_shown(context: Any, is_shown: bool) -> None:
    """Shows them in every 3D view, or the materials again."""
    for _, area in window.views(context):
        area.spaces.active.shading.color_type = "VERTEX" if is_shown else "MATERIAL"
