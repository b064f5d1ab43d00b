# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.select_roi: the selected vertices, and the bone under them, as a mesh of its own."""

from typing import Any, ClassVar

import bonemesh
import bpy
from bpy.props import EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Operator

from ..jobs.job import Job
from ..properties.region_properties import DIRECTIONS, METHODS
from ..reports.findings import counted
from ..request import steps, suggestions
from ..request.inputs import RegionInputs, region_options
from ..scene import meshes, scene_distances, selection
from ..views import window
from .background import BackgroundOperator
from .on_mesh import OnSelection
from .saving import save


class RegionOperator(OnSelection, BackgroundOperator):
    """What Select Region of Interest and its mirrored sister share."""

    title = ""

    @classmethod
    def missing(cls, context: Context) -> str | None:
        """Needs a name and a folder, too."""
        return super().missing(context) or steps.missing_for_region(
            suggestions.filled(context)
        )

    def fields(self, context: Context) -> tuple[Any, Any]:
        """`scene.bonemesh` and `scene.bonemesh_region`, or what stands for them."""
        return suggestions.filled(context, anew=True), context.scene.bonemesh_region

    def take_back(self) -> None:
        """Takes away what the operator made before, if it is done again."""

    def remember(self, names: list[str]) -> None:
        """Notes the regions that were added."""

    def mirror_options(self, _context: Context) -> dict[str, Any]:
        """Keyword arguments of bonemesh.select_roi for the other side."""
        return {}

    def prepare(self, context: Context) -> Job[list[bonemesh.Mesh]]:
        """Checks the panel's fields and copies the active object's mesh and selection."""
        fields, region_fields = self.fields(context)
        self._inputs = inputs = RegionInputs.read(fields, bpy.path.abspath)
        context.view_layer.update()  # a script may just have moved the object
        self._source = source = selection.read_with_selection(context.active_object)
        view = window.view_direction(context)
        self._options = options = {
            **region_options(region_fields, source.patient_direction(view)),
            **self.mirror_options(context),
        }

        def work(job: Job) -> list[bonemesh.Mesh]:
            whole = bonemesh.Mesh(source.vertices, source.triangles)
            watched = {"progress": job.note_progress, "cancel": job.cancel_token}
            found = bonemesh.select_roi(
                whole,
                source.selected,
                thickness_mm=inputs.thickness_mm,
                **options,
                **watched,
            )
            regions = found if isinstance(found, list) else [found]
            outputs = inputs.outputs(len(regions))
            answers = [
                save(region, output, job)
                for region, output in zip(regions, outputs, strict=True)
            ]
            self._not_saved = next((why for why in answers if why), None)
            return regions

        return Job(self.title, work)

    def finish(self, context: Context, result: list[bonemesh.Mesh]) -> str:
        """Adds the regions where they were taken from; the selection and the active object stay."""
        suggestions.forget()
        outputs = self._inputs.outputs(len(result))
        self.take_back()
        placed = [
            meshes.add_region(context, output.stem, region, self._source, self._options)
            for region, output in zip(result, outputs, strict=True)
        ]
        scene_distances.set_shown(context, False)  # a new region has none
        self.remember([region.name for region in placed])
        triangles = sum(len(region.triangles) for region in result)
        last = f" to {outputs[-1].name}" if len(outputs) > 1 else ""
        if self._not_saved is not None:
            self.say("WARNING", self._not_saved)
        where = outputs[0] if self._not_saved is None else placed[0].name
        said = f"{where}{last}: {counted(triangles, 'triangle', 'triangles')}"
        dropped = result[0].report.get("dropped_pieces", 0)
        if dropped:
            pieces = counted(dropped, "piece", "pieces")
            said += f"; {pieces} of the selection left out (crumbs, or hidden behind others)"
        return said


class BONEMESH_OT_select_roi(RegionOperator, Operator):
    """Cut the region under the selected vertices out as its own mesh, save it as STL and add it to the scene"""

    # Blender's Adjust Last Operation calls `execute` with other values for these; else they are the panel's.
    bl_idname = "bonemesh.select_roi"
    bl_label = "Select Region of Interest"
    bl_options: ClassVar[set[str]] = {"REGISTER", "UNDO"}
    title = "Select Region of Interest"

    thickness: FloatProperty(
        name="Thickness of Cut (mm)",
        description="How deep the region is cut",
        min=0.0,
        soft_min=0.5,  # dragging to less would take long
        default=5.0,
        options={"SKIP_SAVE"},
    )
    method: EnumProperty(
        name="Method",
        description="How the region is found",
        items=METHODS,
        options={"SKIP_SAVE"},
    )
    direction: EnumProperty(
        name="Direction",
        description="Which way the region is cut",
        items=DIRECTIONS,
        options={"SKIP_SAVE"},
    )

    made: StringProperty(
        description="The regions that this operator added, one name a line",
        options={"HIDDEN", "SKIP_SAVE"},
    )
    file: StringProperty(
        description="What the file that it wrote is called",
        options={"HIDDEN", "SKIP_SAVE"},
    )

    def take_back(self) -> None:
        """Takes away what it made before: what Edit Mode undoes has no objects in it."""
        for name in self.made.splitlines():
            meshes.remove_region(name)

    def remember(self, names: list[str]) -> None:
        """Notes what it made."""
        self.made = "\n".join(names)

    def fields(self, context: Context) -> tuple[Any, Any]:
        """The panel's, but for what is given to the operator."""
        fields, region_fields = super().fields(context)
        panel = {
            "thickness": fields.cut_thickness,
            "method": region_fields.method,
            "direction": region_fields.direction,
        }
        if not self.made:
            self.file = fields.roi_name
        for name, value in panel.items():
            if not self.properties.is_property_set(name):
                setattr(self, name, value)
        return (
            # Done again, it writes the same file again.
            suggestions.Filled(
                fields, cut_thickness=self.thickness, roi_name=self.file
            ),
            suggestions.Filled(
                region_fields, method=self.method, direction=self.direction
            ),
        )
