# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.select_faults: where the active mesh is not fit for printing, selected in Edit Mode."""

from typing import Any, ClassVar

import bonemesh
import bpy
from bpy.props import EnumProperty
from bpy.types import Context, Operator, OperatorProperties

from ..jobs.job import Job
from ..reports import findings
from ..request.inputs import RefusalError, as_typed
from ..scene import meshes, selection
from ..views import window
from .background import BackgroundOperator
from .on_mesh import OnMesh


class BONEMESH_OT_select_faults(OnMesh, BackgroundOperator, Operator):
    """Select in Edit Mode where the mesh is not fit for printing"""

    bl_idname = "bonemesh.select_faults"
    bl_label = "Select Places"
    bl_options: ClassVar[set[str]] = {"UNDO"}
    remedy = "Make the mesh object whose places are to be selected active"

    kind: EnumProperty(
        name="Kind",
        description="What is selected",
        items=[
            (kind, fault.label, fault.tooltip)
            for kind, fault in findings.FAULTS.items()
        ],
    )

    @classmethod
    def description(cls, _context: Context, properties: OperatorProperties) -> str:
        """What the button of a kind does."""
        return findings.FAULTS[properties.kind].tooltip

    def prepare(self, context: Context) -> Job[dict[str, Any]]:
        """Copies the active object's own mesh, without modifiers: theirs cannot be selected."""
        context.view_layer.update()  # a script may just have moved the object
        self._source = source = selection.as_exported(context.active_object, None)
        thin_mm = as_typed(context.scene.bonemesh_output.thin_mm)
        asked_mm = thin_mm if self.kind == "thin_vertices" else None

        def work(job: Job) -> dict[str, Any]:
            mesh = bonemesh.Mesh(source.vertices, source.triangles)
            found = bonemesh.faults(
                mesh,
                thinner_than_mm=asked_mm,
                progress=job.note_progress,
                cancel=job.cancel_token,
            )
            job.stop_if_cancelled()
            return found

        return Job("Select Places", work)

    def finish(self, context: Context, result: dict[str, Any]) -> str:
        """Enters Edit Mode with the places selected and in view."""
        fault = findings.FAULTS[self.kind]
        source = self._source
        placed = bpy.data.objects.get(source.name)
        if placed is None or len(placed.data.vertices) != len(source.vertices):
            raise RefusalError(
                f'"{source.name}" was changed meanwhile; press the button again'
            )
        numbers = result[self.kind]
        if not len(numbers):
            return f"{source.name}: none found"
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        meshes.select_only(context, placed)
        meshes.select_elements(context, placed, fault.domain, numbers)
        bpy.ops.object.mode_set(mode="EDIT")
        window.frame_selected(context)
        counted = findings.counted(len(numbers), *fault.noun)
        return f"{source.name}: {counted} selected"
