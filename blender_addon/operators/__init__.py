# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators, one file each."""

import atexit

import bpy

from ..preview import previewing
from ..series import scanning
from ..views import window
from . import background
from .cancel import BONEMESH_OT_cancel
from .check_mesh import BONEMESH_OT_check_mesh
from .choose_ct_directory import BONEMESH_OT_choose_ct_directory
from .choose_mesh_directory import BONEMESH_OT_choose_mesh_directory
from .choose_series import BONEMESH_OT_choose_series
from .compare_meshes import BONEMESH_OT_compare_meshes
from .export_mesh import BONEMESH_OT_export_mesh
from .hide_slices import BONEMESH_OT_hide_slices
from .measure_thickness import BONEMESH_OT_measure_thickness
from .mirror_roi import BONEMESH_OT_mirror_roi
from .plane_from_vertices import BONEMESH_OT_plane_from_vertices
from .remove_crop_box import BONEMESH_OT_remove_crop_box
from .render_again import BONEMESH_OT_read_sidecar, BONEMESH_OT_render_again
from .render_surface_mesh import BONEMESH_OT_render_surface_mesh
from .resume_roi import BONEMESH_OT_resume_roi
from .scan_ct_directory import BONEMESH_OT_scan_ct_directory
from .select_faults import BONEMESH_OT_select_faults
from .select_roi import BONEMESH_OT_select_roi
from .show_crop_box import BONEMESH_OT_show_crop_box
from .show_slices import BONEMESH_OT_show_slices
from .start_lasso import BONEMESH_OT_start_lasso
from .stop_scan import BONEMESH_OT_stop_scan
from .use_crop_box import BONEMESH_OT_use_crop_box
from .use_threshold import BONEMESH_OT_use_threshold
from .view_patient import BONEMESH_OT_view_patient

CLASSES = (
    BONEMESH_OT_choose_ct_directory,
    BONEMESH_OT_choose_series,
    BONEMESH_OT_scan_ct_directory,
    BONEMESH_OT_stop_scan,
    BONEMESH_OT_use_threshold,
    BONEMESH_OT_show_crop_box,
    BONEMESH_OT_use_crop_box,
    BONEMESH_OT_remove_crop_box,
    BONEMESH_OT_choose_mesh_directory,
    BONEMESH_OT_render_surface_mesh,
    BONEMESH_OT_start_lasso,
    BONEMESH_OT_render_again,
    BONEMESH_OT_read_sidecar,
    BONEMESH_OT_select_roi,
    BONEMESH_OT_mirror_roi,
    BONEMESH_OT_resume_roi,
    BONEMESH_OT_plane_from_vertices,
    BONEMESH_OT_measure_thickness,
    BONEMESH_OT_check_mesh,
    BONEMESH_OT_select_faults,
    BONEMESH_OT_export_mesh,
    BONEMESH_OT_compare_meshes,
    BONEMESH_OT_show_slices,
    BONEMESH_OT_hide_slices,
    BONEMESH_OT_view_patient,
    BONEMESH_OT_cancel,
)


def stop_jobs() -> None:
    """Ends what runs, and its timers: nothing of it may outlive the operators or Blender."""
    background.stop_all(bpy.context)
    scanning.stop()
    previewing.stop()
    window.stop()


def register() -> None:
    """Adds the operators."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    atexit.register(stop_jobs)


def unregister() -> None:
    """Stops what runs and takes the operators away."""
    atexit.unregister(stop_jobs)
    stop_jobs()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
