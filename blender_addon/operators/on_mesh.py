# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators on the active mesh share."""

from bpy.types import Context

from ..crop import scene_crop
from ..request import steps
from .step import Step


class OnMesh(Step):
    """Mixed into an operator that works on the active object's mesh."""

    remedy = "Make a mesh object active and select vertices of it in Edit Mode"
    """What is said where there is none."""

    @classmethod
    def missing(cls, context: Context) -> str | None:
        """Needs a mesh."""
        active = getattr(context, "active_object", None)  # a timer has none
        is_mesh = active is not None and active.type == "MESH"
        if not is_mesh or scene_crop.TAG in active:
            return cls.remedy
        return super().missing(context)


class OnSelection(OnMesh):
    """Mixed into an operator that works on the selected vertices of the active object's mesh."""

    @classmethod
    def missing(cls, context: Context) -> str | None:
        """Needs a selection."""
        return super().missing(context) or steps.missing_selection(
            context.active_object
        )
