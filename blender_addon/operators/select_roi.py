# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.select_roi: the selected vertices, and the bone under them, as a mesh of its own."""

from typing import Any, ClassVar

import bonemesh
import bpy
from bpy.types import Context, Operator

from .. import scene, selection, window
from ..inputs import RegionInputs, region_options
from ..job import Job
from .background import BackgroundOperator


class RegionOperator(BackgroundOperator):
    """What Select Region of Interest and its mirrored sister share."""

    title = ""

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

    def mirror_options(self, _context: Context) -> dict[str, Any]:
        """Keyword arguments of bonemesh.select_roi for the other side."""
        return {}

    def prepare(self, context: Context) -> Job[bonemesh.Mesh]:
        """Checks the panel's fields and copies the active object's mesh and selection."""
        self._inputs = inputs = RegionInputs.read(
            context.scene.bonemesh, bpy.path.abspath
        )
        context.view_layer.update()  # a script may just have moved the object
        self._source = source = selection.read_with_selection(context.active_object)
        view = window.view_direction(context)
        self._options = options = {
            **region_options(
                context.scene.bonemesh_region, source.patient_direction(view)
            ),
            **self.mirror_options(context),
        }

        def work(job: Job) -> bonemesh.Mesh:
            whole = bonemesh.Mesh(source.vertices, source.triangles)
            region = bonemesh.select_roi(
                whole,
                source.selected,
                thickness_mm=inputs.thickness_mm,
                **options,
                progress=job.note_progress,
                cancel=job.cancel_token,
            )
            job.stop_if_cancelled()
            region.save(
                inputs.output, progress=job.note_progress, cancel=job.cancel_token
            )
            return region

        return Job(self.title, work)

    def finish(self, context: Context, result: bonemesh.Mesh) -> str:
        """Adds the region where it was taken from; the selection and the active object stay."""
        scene.add_region(
            context, self._inputs.name, result, self._source, self._options
        )
        said = f"{self._inputs.output}: {len(result.triangles):,} triangles"
        dropped = result.report.get("dropped_pieces", 0)
        if dropped:
            said += f"; {dropped} pieces of the selection left out (crumbs, or hidden behind others)"
        return said


class BONEMESH_OT_select_roi(RegionOperator, Operator):
    """Cut the region under the selected vertices out as its own mesh, save it as STL and add it to the scene"""

    bl_idname = "bonemesh.select_roi"
    bl_label = "Select Region of Interest"
    bl_options: ClassVar[set[str]] = {"UNDO"}
    title = "Select Region of Interest"
