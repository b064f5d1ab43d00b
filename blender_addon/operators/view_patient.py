# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.view_patient: the bone as seen from one of the patient's sides."""

from typing import ClassVar

from bpy.props import EnumProperty
from bpy.types import Context, Operator, OperatorProperties

from ..views import patient, views, window
from ..views.patient import SIDES

TOOLTIPS = {
    "front": "Look the patient in the face",
    "back": "Look at the patient's back",
    "left": "Look at the patient's left side",
    "right": "Look at the patient's right side",
    "top": "Look down on the patient's head, the front on top",
    "bottom": "Look up from the patient's feet, the front on top, as axial slices are shown",
}


class BONEMESH_OT_view_patient(Operator):
    """Look at the bone from a side of the patient"""

    bl_idname = "bonemesh.view_patient"
    bl_label = "View Patient"
    bl_options: ClassVar[set[str]] = {"INTERNAL"}

    side: EnumProperty(
        name="Side",
        description="The patient's side that is looked at",
        items=[(key, side.name, TOOLTIPS[key]) for key, side in SIDES.items()],
    )

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Needs a mesh."""
        if patient.shown_mesh(context) is None:
            cls.poll_message_set("There is no mesh to look at")
            return False
        return True

    @classmethod
    def description(cls, _context: Context, properties: OperatorProperties) -> str:
        """What the button of a side does."""
        return TOOLTIPS[properties.side]

    def execute(self, context: Context) -> set[str]:
        """Turns the view of the panel that was pressed in, or else all of them."""
        context.view_layer.update()  # a script may just have moved the object
        placed = patient.shown_mesh(context)
        here = context.area
        areas = [area for _, area in window.views(context)]
        for area in [here] if here in areas else areas:
            views.look(placed, SIDES[self.side], area)
            area.tag_redraw()
        return {"FINISHED"}
