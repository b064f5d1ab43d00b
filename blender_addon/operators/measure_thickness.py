# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.measure_thickness: how thick the bone is under the selected vertices."""

from typing import ClassVar

import bonemesh
from bpy.types import Context, Operator

from ..jobs.job import Job
from ..scene import selection
from .background import BackgroundOperator
from .on_mesh import OnSelection


class BONEMESH_OT_measure_thickness(OnSelection, BackgroundOperator, Operator):
    """Measure how thick the bone is under the selected vertices; nothing is changed"""

    bl_idname = "bonemesh.measure_thickness"
    bl_label = "Measure Thickness Here"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    def prepare(self, context: Context) -> Job[dict[str, float] | None]:
        """Copies the active object's mesh and selection."""
        context.view_layer.update()
        source = selection.read_with_selection(context.active_object)
        self._name = source.name

        def work(job: Job) -> dict[str, float] | None:
            return bonemesh.local_thickness(
                bonemesh.Mesh(source.vertices, source.triangles),
                source.selected,
                progress=job.note_progress,
                cancel=job.cancel_token,
            )

        return Job("Measure Thickness Here", work)

    def finish(self, context: Context, result: dict[str, float] | None) -> str:
        """Notes it where the panel shows it."""
        said = "nothing lies opposite within 40 mm"
        if result is not None:
            said = f"{result['median_mm']:.1f} mm ({result['min_mm']:.1f} to {result['max_mm']:.1f})"
        context.scene.bonemesh_region.measured = f"{self._name}: {said}"
        return f"Thickness of the bone here: {said}"
