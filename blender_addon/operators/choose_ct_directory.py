# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.choose_ct_directory: picks the folder of CT images, or one file with a whole volume."""

import os
from typing import ClassVar

import bpy
from bpy.props import StringProperty
from bpy.types import Context, Event, Operator

from ..request import ct_images, inputs
from .choose_directory import NO_FOLDER, DirectoryPicker


class BONEMESH_OT_choose_ct_directory(DirectoryPicker, Operator):
    """Choose the folder of CT images, or one file with a whole volume (NIfTI, NRRD)"""

    bl_idname = "bonemesh.choose_ct_directory"
    bl_label = "Select File Directory of CT Images"
    bl_options: ClassVar[set[str]] = {"UNDO", "INTERNAL"}

    target = "ct_directory"
    advice = (
        "Open the folder that holds the slices and press the blue button. Any one of the slices will do, "
        "too: it stands for its folder. A NIfTI or NRRD file is a whole volume"
    )

    directory: StringProperty(name="Folder", subtype="DIR_PATH", options={"SKIP_SAVE"})
    filepath: StringProperty(name="File", subtype="FILE_PATH", options={"SKIP_SAVE"})

    def invoke(self, context: Context, _event: Event) -> set[str]:
        """Opens the file browser at the last choice."""
        path = context.scene.bonemesh.ct_directory
        # Without the separator at its end Blender would show the folder as a file of the one above.
        is_folder = bool(path) and os.path.isdir(bpy.path.abspath(path))
        self.filepath = os.path.join(path, "") if is_folder else path
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def chosen(self) -> str:
        """The file with a whole volume, or else the folder that it is in or that is shown; raises RefusalError."""
        if not self.filepath:
            return super().chosen()
        path = inputs.existing_path(bpy.path.abspath(self.filepath), missing=NO_FOLDER)
        if path.is_dir() or ct_images.is_volume(path):
            return self.filepath
        return os.path.join(path.parent, "")
