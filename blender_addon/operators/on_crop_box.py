# SPDX-License-Identifier: GPL-3.0-or-later
"""What the operators on the crop box share."""

from bpy.types import Context

from ..crop import cropping, scene_crop
from .step import Step


class OnCropBox(Step):
    """Mixed into an operator that works on the crop box."""

    @classmethod
    def missing(cls, context: Context) -> str | None:
        """Needs the box."""
        if scene_crop.found(context.scene) is None:
            return cropping.NO_BOX
        return super().missing(context)
