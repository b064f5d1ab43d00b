# SPDX-License-Identifier: GPL-3.0-or-later
"""What a button still needs, and which step is next, in plain words. Knows no bpy.

Only what is seen at a glance: this is asked at every drawing of the panel. Whether a folder exists or a name
can be used is found out when the button is pressed.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from .inputs import EMPTY_NAME, NO_CT_IMAGES, NO_MESH_FOLDER

NO_SELECTION = "no vertex is selected; draw around some with the lasso (Select with Lasso, or Ctrl and the right mouse button)"


class Scene(NamedTuple):
    """What the steps depend on besides the panel's fields."""

    has_images: bool
    """Whether the chosen images can be rendered, as far as that is known."""
    has_bone: bool
    """Whether a surface was made of them."""
    active: str
    """`bone`, `region`, `crop` (the box), `mesh` (another one) or empty."""
    is_edited: bool
    """Whether the active mesh is in Edit Mode."""
    selected: int
    """Its selected vertices in Edit Mode."""
    is_cut: bool
    """Whether a region was cut from so many of them."""


def missing_for_surface(properties: Any) -> str | None:
    """What Render Surface Mesh still needs."""
    if not properties.ct_directory.strip():
        return NO_CT_IMAGES
    if not properties.mesh_name.strip():
        return EMPTY_NAME.format("Mesh Filename")
    if not properties.mesh_directory.strip():
        return NO_MESH_FOLDER
    return None


def missing_for_region(properties: Any) -> str | None:
    """What a region still needs besides a mesh."""
    if not properties.roi_name.strip():
        return EMPTY_NAME.format("Segmented Mesh Filename")
    if not properties.mesh_directory.strip():
        return NO_MESH_FOLDER
    return None


def missing_selection(active: Any) -> str | None:
    """What is missing of a selection, as far as Blender counts it by itself: in Edit Mode."""
    is_empty = active.mode == "EDIT" and active.data.total_vert_sel == 0
    return NO_SELECTION if is_empty else None


def next_step(properties: Any, seen: Scene) -> str:
    """One line: what to do now."""
    if not properties.ct_directory.strip():
        return "Select the folder of CT images"
    if not seen.has_images:
        return "Select a folder that holds CT images, or a series of it"
    if seen.active == "crop":
        return "Move and scale the box, then press Render Surface Mesh"
    if not seen.has_bone:
        return before_surface(properties)
    if seen.active == "region":
        return "Check Mesh, then print; or go on with the bone"
    if seen.active != "bone":
        return "Click the bone to make it active"
    return before_region(properties, seen)


def before_surface(properties: Any) -> str:
    """What to do until the surface is made."""
    if not properties.mesh_name.strip():
        return "Give a Mesh Filename"
    if not properties.mesh_directory.strip():
        return "Select where to save the mesh"
    return "Set the HU Threshold, then press Render Surface Mesh"


def before_region(properties: Any, seen: Scene) -> str:
    """What to do until a region is cut out of the bone."""
    if not seen.is_edited:
        return "Press Select with Lasso, to choose a region of the bone"
    if seen.selected == 0:
        return "Draw around the region with the lasso"
    if seen.is_cut:
        return "Press F9 with the mouse over the view to adjust the region, then Tab to see it"
    if not properties.roi_name.strip():
        return "Give a Segmented Mesh Filename"
    return "Press Select Region of Interest"
