# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.export_mesh: the active mesh as a file for printers and other programs."""

from pathlib import Path

import bonemesh
import bpy
from bpy.types import Context, Operator

from ..jobs.job import Job
from ..reports import provenance
from ..request import suggestions
from ..request.inputs import ExportInputs
from ..scene import selection
from .background import BackgroundOperator
from .on_mesh import OnMesh


class BONEMESH_OT_export_mesh(OnMesh, BackgroundOperator, Operator):
    """Save the active mesh, with its modifiers, in millimetres in the chosen format and frame"""

    bl_idname = "bonemesh.export_mesh"
    bl_label = "Export Mesh"
    remedy = "Make the mesh object that is to be exported active"

    def prepare(self, context: Context) -> Job[Path]:
        """Checks the fields and copies the active object's mesh."""
        active = context.active_object
        suggestions.forget()  # what is on the disk now
        folder = suggestions.filled(context).mesh_directory
        inputs = ExportInputs.read(
            context.scene.bonemesh_output,
            folder,
            suggestions.export_name(context, folder) or active.name,
            bpy.path.abspath,
        )
        context.view_layer.update()  # a script may just have moved the object
        source = selection.as_exported(
            active,
            context.evaluated_depsgraph_get(),
            as_placed=context.scene.bonemesh_output.as_placed,
        )

        def work(job: Job) -> Path:
            mesh = bonemesh.Mesh(source.vertices, source.triangles)
            mesh.save(
                inputs.output,
                frame=inputs.frame,
                progress=job.note_progress,
                cancel=job.cancel_token,
            )
            provenance.remove_sidecar(inputs.output)
            return inputs.output

        self._triangles = len(source.triangles)
        return Job("Export Mesh", work)

    def finish(self, context: Context, result: Path) -> str:
        """Says where the file is."""
        suggestions.forget()
        frame = context.scene.bonemesh_output.frame
        return f"{result}: {self._triangles:,} triangles, mm, {frame}"
