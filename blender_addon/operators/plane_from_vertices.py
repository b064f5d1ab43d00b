# SPDX-License-Identifier: GPL-3.0-or-later
"""bonemesh.plane_from_vertices: the mirror plane through three selected vertices."""

from typing import ClassVar

import numpy as np
from bpy.types import Context, Operator

from ..jobs.messages import one_line
from ..request.inputs import RefusalError
from ..scene import selection
from .on_mesh import OnSelection

# Of the square of the longest side: three places nearer to a line than that make no plane.
LEAST_AREA = 1e-6


class BONEMESH_OT_plane_from_vertices(OnSelection, Operator):
    """Take the plane through the three selected vertices, such as points on the midline, as the mirror plane"""

    bl_idname = "bonemesh.plane_from_vertices"
    bl_label = "Plane from Three Vertices"
    bl_options: ClassVar[set[str]] = {"UNDO"}

    def execute(self, context: Context) -> set[str]:
        """Notes the plane's numbers."""
        try:
            source = selection.read_with_selection(context.active_object)
            if len(source.selected) != 3:
                raise RefusalError(
                    f"{len(source.selected)} vertices are selected; select exactly three for the mirror plane"
                )
            a, b, c = source.vertices[source.selected].astype(np.float64)
            normal = np.cross(b - a, c - a)
            longest = max(np.dot(b - a, b - a), np.dot(c - a, c - a))
            if not np.linalg.norm(normal) > LEAST_AREA * longest:
                raise RefusalError(
                    "the three selected vertices lie in a line; select three that do not"
                )
        except RefusalError as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        normal /= np.linalg.norm(normal)
        properties = context.scene.bonemesh_region
        properties.plane_numbers = (*normal, np.dot(normal, a))
        properties.plane = "given"
        return {"FINISHED"}
