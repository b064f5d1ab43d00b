# SPDX-License-Identifier: GPL-3.0-or-later
"""What the parts below the panel share."""

from typing import ClassVar

from bpy.types import Context, UILayout


class Part:
    """Mixed into the parts below the panel, which are folded in at first."""

    bl_parent_id = "BONEMESH_PT_segment_ct"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Segment CT"
    bl_options: ClassVar[set[str]] = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """Draws the part's fields with their names before them."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        self.draw_fields(context, layout)

    def draw_fields(self, context: Context, layout: UILayout) -> None:
        """Draws the fields."""
        raise NotImplementedError
