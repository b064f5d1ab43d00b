# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.remove_crop_box: back to all of the images."""

from typing import ClassVar

from bpy.types import Context, Operator

from ..crop import scene_crop
from .on_crop_box import OnCropBox


class BONEMESH_OT_remove_crop_box(OnCropBox, Operator):
    """Take the box away and use all of the images again"""

    bl_idname = "bonemesh.remove_crop_box"
    bl_label = "Remove Crop Box"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    def execute(self, context: Context) -> set[str]:
        """Empties the field Crop, too."""
        scene_crop.remove(scene_crop.found(context.scene))
        context.scene.bonemesh.crop = ""
        return {"FINISHED"}
