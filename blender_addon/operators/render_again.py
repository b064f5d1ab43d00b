# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.render_again, bonemesh.read_sidecar: the panel's fields as they were when a bone was rendered."""

from pathlib import Path
from typing import Any, ClassVar

import bpy
from bpy.props import StringProperty
from bpy.types import Context, Event, Operator

from ..jobs import last_messages
from ..jobs.messages import EXPECTED, one_line
from ..reports import provenance
from ..reports.provenance import Facts
from ..request.inputs import RefusalError, existing_path
from ..scene import meshes
from ..series import scanning

NO_FILE = (
    "no file is chosen; choose one such as bone.stl.json, which was saved beside a mesh"
)
OTHER_IMAGES = "{} was made of other images than those in the panel; choose their folder, then press the button again"


class RestoresFields:
    """Mixed into an operator that has `facts`."""

    def facts(self, context: Context) -> tuple[str, Facts]:
        """The name of the mesh, and how it was rendered."""
        raise NotImplementedError

    def execute(self, context: Context) -> set[str]:
        """Sets the panel's fields and says what has none."""
        try:
            name, facts = self.facts(context)
            uid = facts.get("series_uid")
            if uid and not scanning.may_hold(context.scene.bonemesh, str(uid)):
                raise RefusalError(OTHER_IMAGES.format(name))
            fields = provenance.fields(facts)
            restore(context.scene.bonemesh, {"mesh_name": name, **fields})
        except EXPECTED as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        last_messages.clear()
        missing = provenance.without_field(facts)
        if missing:
            self.say(
                "WARNING",
                f"the panel has no field for {', '.join(missing)}; use the command bonemesh render",
            )
        self.say(
            "INFO", f"The fields are as they were for {name}; press Render Surface Mesh"
        )
        return {"FINISHED"}

    def say(self, kind: str, text: str) -> None:
        """Reports, and keeps for the panel."""
        last_messages.say(kind, text)
        self.report({kind}, text)


class BONEMESH_OT_render_again(RestoresFields, Operator):
    """Set the panel's fields as they were when the active bone was rendered, to render it again, with another threshold for example"""

    bl_idname = "bonemesh.render_again"
    bl_label = "Render Again"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Needs a bone that says how it was rendered."""
        active = context.active_object
        if active is None or meshes.kept_report(active, meshes.OPTIONS) is None:
            cls.poll_message_set("Make a bone active that was rendered here")
            return False
        return True

    def facts(self, context: Context) -> tuple[str, Facts]:
        """From the object's properties."""
        active = context.active_object
        return active.name, meshes.kept_facts(active)


class BONEMESH_OT_read_sidecar(RestoresFields, Operator):
    """Set the panel's fields as they were when a mesh was rendered, from the file that was saved beside it"""

    bl_idname = "bonemesh.read_sidecar"
    bl_label = "Settings from File"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    filepath: StringProperty(
        name="File",
        description="The file beside a mesh that says how it was made, such as bone.stl.json",
        subtype="FILE_PATH",
    )
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    def invoke(self, context: Context, _event: Event) -> set[str]:
        """Opens the file browser where the meshes are."""
        self.filepath = context.scene.bonemesh.mesh_directory
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def facts(self, _context: Context) -> tuple[str, Facts]:
        """From the file."""
        path = existing_path(bpy.path.abspath(self.filepath), missing=NO_FILE)
        if path.is_dir():
            raise RefusalError(NO_FILE)
        facts = provenance.read_sidecar(path)
        return Path(str(facts.get("file", path.stem))).stem, facts


def restore(properties: Any, fields: dict[str, Any]) -> None:
    """Sets the fields; a value that Blender refuses names its field."""
    for name, value in fields.items():
        try:
            setattr(properties, name, value)
        except (TypeError, ValueError) as error:
            label = properties.bl_rna.properties[name].name
            raise RefusalError(
                f"{label} cannot be {value!r}, as the settings have it; they were changed, or made by another version"
            ) from error
