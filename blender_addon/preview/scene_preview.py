# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview as an object: like scene/meshes.py, from where alone Blender's data are written.

An object and not lines drawn over the view: it is shaded, clipped, seen through and hidden as every
other one, on every graphics system that Blender runs on, and is there without a window too. It cannot
be selected, is not rendered, and is in no file: it goes before one is saved and comes back after that.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ..scene.materials import material
from ..scene.mesh_edges import Edges
from ..scene.meshes import fill

if TYPE_CHECKING:
    import bonemesh

NAME = "Bonemesh Preview"
TAG = "bonemesh_preview"
COLOUR = (0.45, 0.60, 0.75, 1.0)


def show(context: Any, mesh: bonemesh.Mesh, edges: Edges | None) -> None:
    """Shows `mesh` at its place in the patient, in place of what was shown before."""
    placed = found(context.scene)
    if placed is None:
        remove()  # that of another scene
        placed = bpy.data.objects.new(NAME, bpy.data.meshes.new(NAME))
        placed[TAG] = placed.data[TAG] = True
        placed.hide_select = True
        placed.hide_render = True
        placed.data.materials.append(material(NAME, COLOUR))
        context.scene.collection.objects.link(placed)
    placed.data.clear_geometry()
    fill(placed.data, mesh.vertices, mesh.triangles, edges)


def found(scene: Any) -> Any:
    """The preview in `scene`, if there is one: never kept, since undo puts others in its place."""
    return next((o for o in scene.objects if TAG in o and o.type == "MESH"), None)


def remove() -> None:
    """Takes the preview away, from whichever scene it is in, with all that it is made of.

    A user who deletes the object leaves its mesh behind: that goes, too.
    """
    for placed in [o for o in bpy.data.objects if TAG in o and o.library is None]:
        bpy.data.objects.remove(placed)
    for data in [m for m in bpy.data.meshes if TAG in m and m.users == 0]:
        bpy.data.meshes.remove(data)
    colour = bpy.data.materials.get(NAME)
    if colour is not None and colour.users == 0:
        bpy.data.materials.remove(colour)
