# SPDX-License-Identifier: GPL-3.0-or-later
"""The box at the top of the panel: which step is next, and what the last one said."""

from typing import Any

from ..jobs.last_messages import messages
from ..operators.start_lasso import BONEMESH_OT_start_lasso
from ..request import steps, suggestions
from ..scene.meshes import SOURCE
from .text import draw_text

ICONS = {"INFO": "INFO", "WARNING": "ERROR", "ERROR": "CANCEL"}


def draw(layout: Any, context: Any) -> None:
    """Draws the box."""
    box, now = layout.box().column(align=True), seen(context)
    text = steps.next_step(suggestions.filled(context), now)
    draw_text(box, context, text, icon="FORWARD")
    if now.active == "bone" and not (now.is_edited and now.selected):
        box.operator(BONEMESH_OT_start_lasso.bl_idname, icon="RESTRICT_SELECT_OFF")
    for message in messages:
        draw_text(box, context, message.text, icon=ICONS[message.kind])


def seen(context: Any) -> steps.Scene:
    """What the steps depend on in the scene."""
    active = context.active_object
    is_mesh = active is not None and active.type == "MESH"
    is_edited = is_mesh and active.mode == "EDIT"
    return steps.Scene(
        has_bone=any(is_bone(placed) for placed in context.scene.objects),
        active=kind(active) if is_mesh else "",
        is_edited=is_edited,
        selected=active.data.total_vert_sel if is_edited else 0,
    )


def kind(mesh: Any) -> str:
    """What a mesh object is."""
    if SOURCE in mesh:
        return "region"
    return "bone" if is_bone(mesh) else "mesh"


def is_bone(placed: Any) -> bool:
    """Whether an object is a rendered surface."""
    return "bonemesh_version" in placed and SOURCE not in placed
