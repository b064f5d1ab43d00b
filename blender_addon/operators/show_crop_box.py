# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.show_crop_box: a box around the part of the images that is rendered."""

from contextlib import suppress
from typing import ClassVar

from bpy.types import Context, Operator

from ..crop import crop_box, cropping, scene_crop
from ..jobs.messages import one_line
from ..request.inputs import NO_CT_IMAGES, RefusalError
from ..scene import meshes
from .step import Step


class BONEMESH_OT_show_crop_box(Step, Operator):
    """Show a box around the images, or around the part in Crop; move and scale it, or drag its faces in Edit Mode, so that only what lies in it is rendered"""

    bl_idname = "bonemesh.show_crop_box"
    bl_label = "Show Crop Box"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def missing(cls, context: Context) -> str | None:
        """Needs images."""
        is_chosen = context.scene.bonemesh.ct_directory.strip()
        return super().missing(context) if is_chosen else NO_CT_IMAGES

    def execute(self, context: Context) -> set[str]:
        """Places the box and makes it active."""
        properties = context.scene.bonemesh
        with suppress(RefusalError):  # a box that left the images comes back
            cropping.use_moved_box(context)
        try:
            grid = cropping.grid_of(properties)
        except RefusalError as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        meshes.use_millimetres(context)
        placed = scene_crop.place(context, crop_box.read(properties.crop, grid), grid)
        meshes.select_only(context, placed)
        return {"FINISHED"}
