# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.choose_mesh_directory: picks the folder for the meshes."""

from typing import ClassVar

from bpy.props import BoolProperty, StringProperty
from bpy.types import Operator

from .choose_directory import DirectoryPicker


class BONEMESH_OT_choose_mesh_directory(DirectoryPicker, Operator):
    """Choose the folder in which the meshes are saved"""

    bl_idname = "bonemesh.choose_mesh_directory"
    bl_label = "Select File Location to Save Mesh"
    bl_options: ClassVar[set[str]] = {"UNDO", "INTERNAL"}

    target = "mesh_directory"
    advice = "Open the folder for the meshes, then press the blue button. Files are not listed here"

    directory: StringProperty(name="Folder", subtype="DIR_PATH")
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
