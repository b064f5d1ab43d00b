# SPDX-License-Identifier: GPL-3.0-or-later
"""Bonemesh in Blender: bone meshes from CT images, and regions of interest cut out of them."""

from . import library


def register() -> None:
    """Called by Blender when the add-on is enabled."""
    problem = library.problem()
    if problem is None:
        from . import operators, panels, previewing, properties, region_properties

        properties.register()
        region_properties.register()
        operators.register()
        previewing.register()
        panels.register()
    else:
        from . import panel_without_library

        panel_without_library.register(problem)


def unregister() -> None:
    """Called by Blender when the add-on is disabled and when Blender ends."""
    from . import panel_without_library

    if panel_without_library.is_registered():
        panel_without_library.unregister()
    else:
        from . import operators, panels, previewing, properties, region_properties

        panels.unregister()
        previewing.unregister()
        operators.unregister()
        region_properties.unregister()
        properties.unregister()
