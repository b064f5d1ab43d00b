# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.render_surface_mesh: CT images to a surface mesh, in the scene and as STL."""

from typing import ClassVar

import bonemesh
import bpy
from bpy.types import Context, Operator

from ..crop import cropping
from ..jobs import stages
from ..jobs.job import Job
from ..panels import memory_box
from ..preview import previewing
from ..request import steps, suggestions
from ..request.inputs import RenderInputs
from ..scene import meshes, scene_distances
from ..series import scanning
from ..views import views
from .background import BackgroundOperator
from .saving import save


class BONEMESH_OT_render_surface_mesh(BackgroundOperator, Operator):
    """Make the surface mesh of the bone in the CT images, save it as STL and add it to the scene"""

    bl_idname = "bonemesh.render_surface_mesh"
    bl_label = "Render Surface Mesh"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    @classmethod
    def missing(cls, context: Context) -> str | None:
        """Needs images, a name and a folder."""
        return super().missing(context) or steps.missing_for_surface(
            suggestions.filled(context)
        )

    def prepare(self, context: Context) -> Job[bonemesh.Mesh]:
        """Checks the panel's fields."""
        properties = context.scene.bonemesh
        cropping.use_moved_box(context)
        self._inputs = inputs = RenderInputs.read(
            suggestions.filled(context, anew=True), bpy.path.abspath
        )
        short = memory_box.warning(properties)
        if short is not None:
            self.say("WARNING", short)
        self._center_in_world = properties.center_in_world
        options = dict(inputs.options)
        if self.is_pressed:
            # The user sees which series the panel marks; the library alone refuses to guess.
            options["series"] = scanning.marked_choice(properties) or options["series"]

        def work(job: Job) -> bonemesh.Mesh:
            mesh = bonemesh.render(
                inputs.ct_images,
                **options,
                progress=job.note_progress,
                cancel=job.cancel_token,
            )
            self._not_saved = save(mesh, inputs.output, job)
            return mesh

        return Job("Render Surface Mesh", work, stages.of_rendering(inputs.options))

    def finish(self, context: Context, result: bonemesh.Mesh) -> str:
        """Adds the mesh to the scene, selected and in view."""
        previewing.dismiss()
        suggestions.forget()
        meshes.use_millimetres(context)
        bone = meshes.add_bone(
            context, self._inputs.name, result, in_world_centre=self._center_in_world
        )
        scene_distances.set_shown(context, False)  # a new bone has none
        if meshes.select_only(context, bone):
            views.frame(context, bone)
        for warning in result.report["warnings"]:
            self.say("WARNING", warning)
        triangles = f"{len(result.triangles):,} triangles"
        if self._not_saved is not None:
            self.say("WARNING", self._not_saved)
            return f"{bone.name}: {triangles}"
        return f"{self._inputs.output}: {triangles}"
