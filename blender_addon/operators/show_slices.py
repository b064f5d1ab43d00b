# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.show_slices: the CT images as slices in the scene, with the active surface's contour."""

from typing import Any, ClassVar

import bonemesh
import bpy
from bpy.types import Context, Operator

from ..jobs.job import Job
from ..request.inputs import NO_CT_IMAGES, existing_path, series_choice
from ..scene import meshes
from ..series import scanning
from ..slices import scene_slices, slice_store, slice_updates
from ..slices.slice_store import Shown
from ..views.patient import shown_mesh
from .background import BackgroundOperator


class BONEMESH_OT_show_slices(BackgroundOperator, Operator):
    """Show axial, coronal and sagittal slices of the CT images at their places in the scene, with the contour of the active surface on them"""

    bl_idname = "bonemesh.show_slices"
    bl_label = "Show CT Slices"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    def prepare(self, context: Context) -> Job[Shown]:
        """Says what is to be read: the series that the active bone was made of, or else the chosen one."""
        properties = context.scene.bonemesh
        path = existing_path(
            bpy.path.abspath(properties.ct_directory), missing=NO_CT_IMAGES
        )
        surface = meant_surface(context)
        self._surface = None if surface is None else surface.name
        series = chosen_series(properties, surface, is_pressed=self.is_pressed)
        one_series = properties.one_series
        source = (str(path), series, one_series)
        kept = slice_store.current()

        def work(job: Job) -> Shown:
            if kept is not None and kept.source == source:
                return kept
            volume = bonemesh.read_series(
                path,
                series,
                one_series=one_series,
                progress=job.note_progress,
                cancel=job.cancel_token,
            )
            job.stop_if_cancelled()
            return Shown(source, volume)

        return Job("Show CT Slices", work)

    def finish(self, context: Context, result: Shown) -> str:
        """Keeps the volume and puts its slices into the scene."""
        meshes.use_millimetres(context)
        slice_store.keep(result)
        surface = bpy.data.objects.get(self._surface or "")
        scene_slices.show(context, result, surface)
        slice_updates.take_surface(surface)
        slice_updates.draw_all()
        return result.memory_text()


def meant_surface(context: Context) -> Any:
    """The mesh whose contours are shown: the active one; while a slice is active, the one as before."""
    active = context.active_object
    is_mesh = active is not None and active.type == "MESH"
    return (
        shown_mesh(context)
        if is_mesh
        else slice_updates.surface() or shown_mesh(context)
    )


def chosen_series(
    properties: Any, surface: Any, *, is_pressed: bool
) -> int | str | None:
    """How the series is named to the library."""
    chosen = series_choice(properties.series)
    if is_pressed:
        chosen = scanning.marked_choice(properties) or chosen
    uid = None if surface is None else surface.get("bonemesh_series_uid")
    # A number stands where the UID does not tell series apart; then the panel's mark decides.
    if uid and not isinstance(chosen, int):
        return uid
    return chosen
