# SPDX-License-Identifier: GPL-3.0-or-later
"""The box below the buttons: what was done to the active mesh, and whether it can be printed."""

from typing import Any

from ..operators.select_faults import BONEMESH_OT_select_faults
from ..reports import findings
from ..scene import meshes
from .text import draw_text


def draw(layout: Any, context: Any) -> None:
    """Draws the box, where anything is known of the active mesh."""
    active = context.active_object
    if active is None or active.type != "MESH":
        return
    cared = meshes.kept_report(active, meshes.AFTER_CARE)
    checked = meshes.kept_report(active, meshes.CHECK)
    if cared is None and checked is None:
        return
    column = layout.box().column(align=True)
    column.label(text=active.name, icon="MESH_DATA")
    if cared is not None:
        for line in findings.after_care_lines(cared):
            draw_text(column, context, line, icon="DOT")
    if checked is not None:
        column.separator(factor=0.5)
        draw_check(column, context, active, checked)


def draw_check(column: Any, context: Any, active: Any, checked: dict[str, Any]) -> None:
    """Draws the verdict, the reasons with their remedies, and the figures."""
    if checked.get(meshes.STATE) != meshes.state(active):
        text = "Changed since it was checked; press Check Mesh again"
        draw_text(column, context, text, icon="ERROR")
        return
    icon = "CHECKMARK" if checked.get("printable") else "CANCEL"
    column.label(text=findings.verdict(checked), icon=icon)
    for reason in checked.get("reasons", ()):
        draw_text(column, context, reason, icon="ERROR")
    for line in findings.check_lines(checked):
        draw_text(column, context, line, icon="DOT")
    draw_places(column, context, checked)


def draw_places(column: Any, context: Any, checked: dict[str, Any]) -> None:
    """Draws the buttons that select what was found, and thin walls where walls were measured."""
    for kind, text in findings.faults_found(checked).items():
        draw_select(column, kind, f"Select {text}")
    if checked.get("thinnest_wall_mm") is not None:
        column.prop(context.scene.bonemesh_output, "thin_mm")
        draw_select(column, "thin_vertices", "Select Thin Walls")


def draw_select(layout: Any, kind: str, text: str) -> None:
    """Draws the button of one kind."""
    button = layout.operator(
        BONEMESH_OT_select_faults.bl_idname, text=text, icon="RESTRICT_SELECT_OFF"
    )
    button.kind = kind
