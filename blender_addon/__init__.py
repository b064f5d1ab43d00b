# SPDX-License-Identifier: GPL-3.0-or-later
"""Bonemesh in Blender: bone meshes from CT images, and regions of interest cut out of them."""

from types import ModuleType

from . import library


def parts() -> tuple[ModuleType, ...]:
    """What is registered, in this order, where the compiled library loads."""
    from . import (
        compare_panel,
        compare_properties,
        directions,
        edges,
        export_panel,
        help_panel,
        operators,
        output_properties,
        panels,
        previewing,
        properties,
        region_properties,
        slice_properties,
        slice_updates,
        slices_panel,
        views_panel,
    )

    return (
        properties,
        region_properties,
        output_properties,
        compare_properties,
        slice_properties,
        slice_updates,
        operators,
        previewing,
        panels,
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
        from . import panel_without_library

        panel_without_library.register(problem)


def unregister() -> None:
    """Called by Blender when the add-on is disabled and when Blender ends."""
    from . import panel_without_library

    if panel_without_library.is_registered():
        panel_without_library.unregister()
    else:
        for part in reversed(parts()):
            part.unregister()
