# SPDX-License-Identifier: GPL-3.0-or-later
"""The box at the top of the panel: which step is next, and what the last one said."""

from typing import Any

import bpy

from ..crop import scene_crop
from ..jobs import last_messages
from ..operators.start_lasso import BONEMESH_OT_start_lasso
from ..request import steps, suggestions
from ..scene.meshes import REGIONS, SOURCE
from ..series import scanning
from .text import draw_text

SERIES = "bonemesh_series_uid"
SELECTED = "bonemesh_selected"
ICONS = {"INFO": "INFO", "WARNING": "ERROR", "ERROR": "CANCEL"}


def draw(layout: Any, context: Any) -> None:
    """Draws the box."""
    box, now = layout.box().column(align=True), seen(context)
    text = steps.next_step(suggestions.filled(context), now)
    draw_text(box, context, text, icon="FORWARD")
    if now.active == "bone" and not (now.is_edited and now.selected):
        box.operator(BONEMESH_OT_start_lasso.bl_idname, icon="RESTRICT_SELECT_OFF")
    for message in last_messages.of_step(text):
        draw_text(box, context, message.text, icon=ICONS[message.kind])


def seen(context: Any) -> steps.Scene:
    """What the steps depend on in the scene."""
    active = context.active_object
    is_mesh = active is not None and active.type == "MESH"
    is_edited = is_mesh and active.mode == "EDIT"
    selected = active.data.total_vert_sel if is_edited else 0
    return steps.Scene(
        has_images=not scanning.has_failed(context.scene.bonemesh),
        has_bone=has_bone(context),
        active=kind(active) if is_mesh else "",
        is_edited=is_edited,
        selected=selected,
        is_cut=selected > 0 and is_cut(active, selected),
    )


def has_bone(context: Any) -> bool:
    """Whether a surface of the chosen images is there; of any, as long as these are not known."""
    bones = [placed for placed in context.scene.objects if is_bone(placed)]
    series = scanning.marked_series(context.scene.bonemesh)
    if series is None or not series.uid:
        return bool(bones)
    return any(bone.get(SERIES, series.uid) == series.uid for bone in bones)


def is_cut(bone: Any, selected: int) -> bool:
    """Whether a region was cut from a selection of so many vertices of the bone."""
    regions = bpy.data.collections.get(REGIONS)
    return regions is not None and any(
        region.get(SOURCE) == bone.name and len(region.get(SELECTED, ())) == selected
        for region in regions.objects
    )


def kind(mesh: Any) -> str:
    """What a mesh object is."""
    if SOURCE in mesh:
        return "region"
    if scene_crop.TAG in mesh:
        return "crop"
    return "bone" if is_bone(mesh) else "mesh"


def is_bone(placed: Any) -> bool:
    """Whether an object is a rendered surface."""
    return "bonemesh_version" in placed and SOURCE not in placed
