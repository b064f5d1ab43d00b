# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.select_roi: the selected vertices, and the bone under them, as a mesh of its own."""

from typing import ClassVar

import bonemesh
import bpy
from bpy.types import Context, Operator

from .. import scene, selection
from ..inputs import RefusalError, RegionInputs
from ..job import Job
from .background import BackgroundOperator

METHOD = "thesis"


class BONEMESH_OT_select_roi(BackgroundOperator, Operator):
    """Cut the region under the selected vertices out as its own mesh, save it as STL and add it to the scene"""

    bl_idname = "bonemesh.select_roi"
    bl_label = "Select Region of Interest"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Needs a mesh to select on."""
        active = context.active_object
        if active is None or active.type != "MESH":
            cls.poll_message_set(
                "Make a mesh object active and select vertices of it in Edit Mode"
            )
            return False
        return True

    def prepare(self, context: Context) -> Job[bonemesh.Mesh]:
        """Checks the panel's fields and copies the active object's mesh and selection."""
        self._inputs = inputs = RegionInputs.read(
            context.scene.bonemesh, bpy.path.abspath
        )
        context.view_layer.update()  # a script may just have moved the object
        self._source = source = selection.read(context.active_object)
        if len(source.selected) == 0:
            raise RefusalError(
                f'no vertex of "{source.name}" is selected; select some in Edit Mode, for example with the lasso'
            )

        def work(job: Job) -> bonemesh.Mesh:
            whole = bonemesh.Mesh(source.vertices, source.triangles)
            region = bonemesh.select_roi(
                whole,
                source.selected,
                thickness_mm=inputs.thickness_mm,
                method=METHOD,
                progress=job.note_progress,
                cancel=job.cancel_token,
            )
            job.stop_if_cancelled()
            region.save(
                inputs.output, progress=job.note_progress, cancel=job.cancel_token
            )
            return region

        return Job("Select Region of Interest", work)

    def finish(self, context: Context, result: bonemesh.Mesh) -> str:
        """Adds the region where it was taken from; the selection and the active object stay."""
        scene.add_region(context, self._inputs.name, result, self._source)
        return f"{self._inputs.output}: {len(result.triangles):,} triangles"
