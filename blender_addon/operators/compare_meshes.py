# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.compare_meshes: how far the active mesh lies from another selected one."""

from typing import Any, ClassVar, NamedTuple

import bonemesh
import bpy
import numpy as np
from bpy.types import Context, Operator
from numpy.typing import NDArray

from ..crop import scene_crop
from ..jobs.job import Job
from ..reports import distances
from ..request.inputs import RefusalError
from ..scene import meshes, scene_distances, selection
from .background import BackgroundOperator
from .on_mesh import OnMesh

NO_OTHER = (
    "select the mesh to compare with, too: in the list at the top right click its name, then with Ctrl held "
    "that of the one to be coloured"
)
SEVERAL_OTHERS = (
    "more than two meshes are selected; select the two that are to be compared"
)
IN_EDIT_MODE = "leave Edit Mode first: press Tab with the mouse over the view"


class Compared(NamedTuple):
    """What the comparison found."""

    signed_mm: NDArray[np.float32]
    report: dict[str, Any]


class BONEMESH_OT_compare_meshes(OnMesh, BackgroundOperator, Operator):
    """Measure how far the active mesh lies from the other selected one, where both are in the scene, and show it in colours"""

    bl_idname = "bonemesh.compare_meshes"
    bl_label = "Compare Meshes"
    bl_options: ClassVar[set[str]] = {"UNDO"}
    remedy = "Select two meshes; the one that is clicked last is coloured"

    @classmethod
    def missing(cls, context: Context) -> str | None:
        """Needs exactly one other mesh."""
        lacking = super().missing(context)
        if lacking is not None:
            return lacking
        if context.mode != "OBJECT":
            return IN_EDIT_MODE
        others = len(other_meshes(context))
        if others != 1:
            return SEVERAL_OTHERS if others else NO_OTHER
        return None

    def prepare(self, context: Context) -> Job[Compared]:
        """Copies both meshes as they lie in the scene, the other one with its modifiers."""
        context.view_layer.update()  # a script may just have moved them
        active, (other,) = context.active_object, other_meshes(context)
        mesh = selection.as_exported(active, None, as_placed=True)
        reference = selection.as_exported(
            other, context.evaluated_depsgraph_get(), as_placed=True
        )
        self._name, self._vertices = active.name, len(mesh.vertices)
        self._place = scene_distances.place(active, other)

        def work(job: Job) -> Compared:
            watched = {"progress": job.note_progress, "cancel": job.cancel_token}
            against = bonemesh.Mesh(reference.vertices, reference.triangles)
            compared = bonemesh.compare(
                bonemesh.Mesh(mesh.vertices, mesh.triangles),
                against,
                residual=False,
                **watched,
            )
            job.stop_if_cancelled()
            signed_mm = bonemesh.signed_distances(mesh.vertices, against, **watched)
            report = distances.report(signed_mm, compared, reference.name)
            return Compared(signed_mm.astype(np.float32), report)

        return Job("Compare Meshes", work)

    def finish(self, context: Context, result: Compared) -> str:
        """Keeps the distances on the mesh, and shows them."""
        placed = bpy.data.objects.get(self._name)
        is_same = placed is not None and len(placed.data.vertices) == self._vertices
        if not is_same or placed.mode == "EDIT":
            raise RefusalError(
                f'"{self._name}" was changed meanwhile; press the button again'
            )
        full_mm = context.scene.bonemesh_compare.full_mm
        scene_distances.keep(placed, result.signed_mm, full_mm)
        kept = {**result.report, scene_distances.PLACE: self._place}
        meshes.keep_report(placed, scene_distances.COMPARED, kept)
        scene_distances.set_shown(context, True)
        first, second, _ = distances.lines(result.report, self._name)
        return f"{self._name}: {first}, {second}"


def other_meshes(context: Context) -> list[bpy.types.Object]:
    """The selected meshes but for the active one and the crop box."""
    return [
        placed
        for placed in context.selected_objects
        if placed.type == "MESH"
        and placed != context.active_object
        and scene_crop.TAG not in placed
    ]
