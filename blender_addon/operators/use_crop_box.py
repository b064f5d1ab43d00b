# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.use_crop_box: from now on only what lies in the crop box is seen and rendered."""

from typing import ClassVar

from bpy.types import Context, Operator

from ..crop import cropping
from ..jobs.messages import one_line
from ..request.inputs import RefusalError
from .on_crop_box import OnCropBox


class BONEMESH_OT_use_crop_box(OnCropBox, Operator):
    """Show in the preview what lies in the box; Render Surface Mesh takes the box as it is then by itself"""

    bl_idname = "bonemesh.use_crop_box"
    bl_label = "Use Crop Box"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    def execute(self, context: Context) -> set[str]:
        """Sets the field Crop."""
        try:
            crop = cropping.use_box(context)
        except RefusalError as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Crop: {crop or 'all of the images'}")
        return {"FINISHED"}
