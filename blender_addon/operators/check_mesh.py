# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.check_mesh: whether the active mesh can be printed."""

from typing import Any, ClassVar

import bonemesh
from bpy.types import Context, Operator

from ..jobs.job import Job
from ..reports import findings
from ..scene import meshes, selection
from .background import BackgroundOperator
from .on_mesh import OnMesh


class BONEMESH_OT_check_mesh(OnMesh, BackgroundOperator, Operator):
    """Find out whether the active mesh can be printed as it stands and, if not, why; it is not changed"""

    bl_idname = "bonemesh.check_mesh"
    bl_label = "Check Mesh"
    bl_options: ClassVar[set[str]] = {"UNDO"}
    remedy = "Make the mesh object that is to be checked active"

    def prepare(self, context: Context) -> Job[dict[str, Any]]:
        """Copies the active object's mesh as a file of it would be."""
        context.view_layer.update()  # a script may just have moved the object
        self._source = source = selection.as_exported(
            context.active_object, context.evaluated_depsgraph_get()
        )

        def work(job: Job) -> dict[str, Any]:
            mesh = bonemesh.Mesh(source.vertices, source.triangles)
            found = bonemesh.check(
                mesh, progress=job.note_progress, cancel=job.cancel_token
            )
            job.stop_if_cancelled()
            return found

        return Job("Check Mesh", work)

    def finish(self, _context: Context, result: dict[str, Any]) -> str:
        """Notes the findings with the object, where the panel shows them."""
        meshes.keep_check(self._source.name, result)
        answer = f"{self._source.name}: {findings.verdict(result)}"
        reasons = result["reasons"]
        return f"{answer}: {'. '.join(reasons)}" if reasons else answer
