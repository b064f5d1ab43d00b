# SPDX-License-Identifier: GPL-3.0-or-later
"""What the two pickers share: Blender's file browser, and a refusal of what is no folder."""

import bpy
from bpy.types import Context, Event

from ..panels.text import draw_text
from ..request import inputs

NO_FOLDER = "no folder is chosen; choose one"


class DirectoryPicker:
    """Mixed into an operator with a `directory`; names the property of `scene.bonemesh` to set."""

    target: str
    advice: str
    """What is said beside the list of files."""

    def draw(self, context: Context) -> None:
        """In the file browser, at its right."""
        draw_text(self.layout, context, self.advice, icon="INFO")

    def invoke(self, context: Context, _event: Event) -> set[str]:
        """Opens the file browser where the last choice was."""
        self.directory = getattr(context.scene.bonemesh, self.target)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """Takes the chosen folder, or refuses what is none."""
        try:
            path = self.chosen()
        except inputs.RefusalError as refusal:
            self.report({"ERROR"}, str(refusal))
            return {"CANCELLED"}
        setattr(context.scene.bonemesh, self.target, path)
        return {"FINISHED"}

    def chosen(self) -> str:
        """The folder as it was picked; raises RefusalError where it is none."""
        inputs.existing_directory(bpy.path.abspath(self.directory), missing=NO_FOLDER)
        return self.directory
