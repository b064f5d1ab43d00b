# SPDX-License-Identifier: GPL-3.0-or-later
"""Bonemesh in Blender: bone meshes from CT images, and regions of interest cut out of them.

    series -> preview, crop -> request -> jobs -> scene -> slices, views, reports

Which images there are, what they look like, what is asked for, the work beside the window, and what
becomes of its result. `operators` take one step each, `panels` show the steps, `properties` keep what
was typed. No algorithm is here: these are in the library.
"""

from types import ModuleType

from . import library


def parts() -> tuple[ModuleType, ...]:
    """What is registered, in this order, where the compiled library loads."""
    from . import operators
    from .panels import (
        advanced_panel,
        after_care_panel,
        compare_panel,
        crop_panel,
        export_panel,
        help_panel,
        region_panel,
        segment_ct,
        slices_panel,
        views_panel,
    )
    from .preview import previewing
    from .properties import (
        compare_properties,
        output_properties,
        region_properties,
        slice_properties,
        surface_properties,
    )
    from .scene import edges
    from .slices import slice_updates
    from .views import directions

    return (
        surface_properties,
        region_properties,
        output_properties,
        compare_properties,
        slice_properties,
        slice_updates,
        operators,
        previewing,
        segment_ct,
        crop_panel,
        region_panel,
        after_care_panel,
        advanced_panel,
        views_panel,
        slices_panel,
        compare_panel,
        export_panel,
        help_panel,
        directions,
        edges,
    )


def register() -> None:
    """Called by Blender when the add-on is enabled."""
    problem = library.problem()
    if problem is None:
        for part in parts():
            part.register()
    else:
        from .panels import without_library

        without_library.register(problem)


def unregister() -> None:
    """Called by Blender when the add-on is disabled and when Blender ends."""
    from .panels import without_library

    if without_library.is_registered():
        without_library.unregister()
    else:
        for part in reversed(parts()):
            part.unregister()
