# SPDX-License-Identifier: GPL-3.0-or-later
"""`scene.bonemesh_slices`: where the CT slices are and how their greys are chosen.

Where a slice is and whether it is seen is not kept here but read from its object, so that the slider and
the object never disagree.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
from bpy.props import BoolProperty, FloatProperty, PointerProperty
from bpy.types import Context, PropertyGroup

from ..slices import scene_slices, slice_store, slice_updates


def part(name: str) -> Callable[[Any], float]:
    """Reads how far a slice is through the volume."""

    def read(_properties: Any) -> float:
        shown, position = slice_store.current(), scene_slices.position_mm(name)
        if shown is None or position is None:
            return 0.0
        low, high = shown.planes[name].positions_mm
        return 100.0 * (position - low) / (high - low) if high > low else 0.0

    return read


def put(name: str) -> Callable[[Any, float], None]:
    """Moves a slice so far through the volume, to the nearest slice that was measured."""

    def write(_properties: Any, percent: float) -> None:
        shown = slice_store.current()
        if shown is None:
            return
        low, high = shown.planes[name].positions_mm
        number = shown.slice_number(name, low + percent / 100.0 * (high - low))
        scene_slices.move(name, low + (number - 1) * shown.planes[name].step_mm)
        slice_updates.draw_moved()

    return write


def seen(name: str) -> Callable[[Any], bool]:
    """Reads whether a slice is seen."""
    return lambda _properties: scene_slices.is_shown(name)


def see(name: str) -> Callable[[Any, bool], None]:
    """Shows or hides a slice."""
    return lambda _properties, is_seen: scene_slices.set_shown(name, is_seen)


def window_changed(_properties: Any, _context: Context) -> None:
    """Draws the slices in their new greys."""
    slice_updates.draw_all()


def slider(name: str, towards: str) -> Any:
    """A slider through the volume."""
    return FloatProperty(
        name=name.capitalize(),
        description=f"Where the {name} slice is, from one end of the images (0 %) to the other (100 %), {towards}. It can also be moved in the view: select it and press G",
        min=0.0,
        max=100.0,
        precision=1,
        subtype="PERCENTAGE",
        get=part(name),
        set=put(name),
        options={"SKIP_SAVE"},
    )


def eye(name: str) -> Any:
    """A switch for a slice."""
    return BoolProperty(
        name=f"Show {name.capitalize()} Slice",
        description=f"Whether the {name} slice and its contour are seen",
        get=seen(name),
        set=see(name),
        options={"SKIP_SAVE"},
    )


class BonemeshSliceProperties(PropertyGroup):
    """One property for each field of the panel's part CT Slices."""

    centre_hu: FloatProperty(
        name="Window Centre (HU)",
        description="Hounsfield units that are shown in middle grey: about 400 for bone, 40 for soft tissue",
        default=400.0,
        soft_min=-1000.0,
        soft_max=3000.0,
        precision=0,
        step=1000,
        update=window_changed,
    )
    width_hu: FloatProperty(
        name="Window Width (HU)",
        description="Hounsfield units from black to white: about 1800 for bone, 400 for soft tissue",
        default=1800.0,
        min=1.0,
        soft_max=4000.0,
        precision=0,
        step=1000,
        update=window_changed,
    )
    axial: slider("axial", "from the feet to the head")
    coronal: slider("coronal", "from the front to the back")
    sagittal: slider("sagittal", "from the right to the left")
    show_axial: eye("axial")
    show_coronal: eye("coronal")
    show_sagittal: eye("sagittal")


def register() -> None:
    """Adds `scene.bonemesh_slices`."""
    bpy.utils.register_class(BonemeshSliceProperties)
    bpy.types.Scene.bonemesh_slices = PointerProperty(type=BonemeshSliceProperties)


def unregister() -> None:
    """Takes it away."""
    del bpy.types.Scene.bonemesh_slices
    bpy.utils.unregister_class(BonemeshSliceProperties)
