# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.choose_ct_directory: picks the folder of CT images."""

from typing import ClassVar

from bpy.props import BoolProperty, StringProperty
from bpy.types import Operator

from .choose_directory import DirectoryPicker


class BONEMESH_OT_choose_ct_directory(DirectoryPicker, Operator):
    """Choose the folder of CT images"""

    bl_idname = "bonemesh.choose_ct_directory"
    bl_label = "Select File Directory of CT Images"
    bl_options: ClassVar[set[str]] = {"UNDO", "INTERNAL"}

    target = "ct_directory"

    directory: StringProperty(name="Folder", subtype="DIR_PATH")
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
