# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges of a bone out of sight while a region is selected with the lasso; like meshes.py a writer of Blender's data.

Edit Mode draws every edge in black: from afar the edges of a million triangles cover the bone. Blender has
no switch for that, but does not draw edges that are hidden, and shows their faces all the same. They come
back when Edit Mode is left.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from bpy.app.handlers import persistent

HIDDEN = ".hide_edge"  # Blender's own name for it
TAG = "bonemesh_edges_hidden"


_is_entering = False


def edit_without(placed: Any) -> None:
    """Takes a mesh object to Edit Mode, its edges hidden."""
    global _is_entering
    if placed.mode == "EDIT" and TAG in placed.data:
        return
    _is_entering = True
    try:
        if placed.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        hide(placed.data)
        bpy.ops.object.mode_set(mode="EDIT")
    finally:
        _is_entering = False


def hide(data: Any) -> None:
    """Hides the edges of a mesh that is not in Edit Mode."""
    hidden = data.attributes.get(HIDDEN)
    if hidden is None:
        hidden = data.attributes.new(HIDDEN, "BOOLEAN", "EDGE")
    hidden.data.foreach_set("value", np.ones(len(data.edges), dtype=bool))
    data[TAG] = True


def show(data: Any) -> None:
    """Shows them again."""
    del data[TAG]
    hidden = data.attributes.get(HIDDEN)
    if hidden is not None:
        data.attributes.remove(hidden)


@persistent
def bring_back(_scene: Any, _depsgraph: Any) -> None:
    """After every change: Edit Mode may have been left."""
    active = bpy.context.view_layer.objects.active
    if _is_entering or active is None or active.type != "MESH":
        return
    if active.mode != "EDIT" and TAG in active.data:
        show(active.data)


def register() -> None:
    """Listens."""
    bpy.app.handlers.depsgraph_update_post.append(bring_back)


def unregister() -> None:
    """Listens no longer."""
    if bring_back in bpy.app.handlers.depsgraph_update_post:
        bpy.app.handlers.depsgraph_update_post.remove(bring_back)
