# SPDX-License-Identifier: GPL-3.0-or-later
"""`scene.bonemesh`: what the panel asks for."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)
from bpy.types import Context, PropertyGroup

from ..crop import cropping
from ..preview import previewing
from ..request import ct_images
from ..series import scanning

METHODS = [
    (
        "isosurface",
        "Isosurface",
        "Closed surface between voxels at the true edges of the bone, nearly whatever the threshold",
    ),
    (
        "alpha",
        "Alpha",
        "3D Delaunay tetrahedra of the edge points, those no larger than alpha kept; alpha comes from the points' mean distance",
    ),
    (
        "labelled",
        "Labelled Tetrahedra",
        "Closed surface of Delaunay tetrahedra, each bone or not by what lies in it; fewer triangles, more time",
    ),
    (
        "ball-pivoting",
        "Ball Pivoting",
        "For study: a ball rolls from edge point to edge point; open where slices are far apart",
    ),
    (
        "poisson",
        "Poisson",
        "For study: smooth closed surface that fits the edge points and their normals",
    ),
    (
        "tetrahedra",
        "Tetrahedra",
        "For study: all Delaunay tetrahedra of the edge points, that is their convex hull",
    ),
    (
        "planar",
        "Planar",
        "For study: triangles of the edge points seen along z, one sheet",
    ),
]
SAMPLERS = [
    ("uniform", "Uniform", "Points at even steps along each contour"),
    (
        "targeted",
        "Targeted",
        "Points along each contour, more where it bends",
    ),
    ("random", "Random", "Points drawn by lot"),
    (
        "thesis-uniform",
        "Thesis, Uniform",
        "Ten neighbours at a time, in steps of ten percent (Rier's pseudo-uniform sampling)",
    ),
    (
        "thesis-targeted",
        "Thesis, Targeted",
        "Cells of 10 pixels, each thinned by how alike its normals are, to 10, 25, 50 or 75 percent whatever Points Kept says (Rier's targeted sampling)",
    ),
]
FILLED_HOLES = [
    ("none", "None", "Leaves the holes of an open mesh as they are"),
    ("all", "All", "Closes every hole of an open mesh"),
    ("small", "Up To", "Closes the holes that are no longer than this"),
]
REMOVED_ISLANDS = [
    (
        "specks",
        "Specks",
        "Removes what is too small for a bone, less than 1 mm³, from a closed surface (isosurface, labelled tetrahedra)",
    ),
    ("none", "None", "Keeps every part of the mesh"),
    ("others", "All but the Largest", "Keeps the largest part of the mesh alone"),
    ("small", "Smaller Than", "Keeps the parts of at least this volume"),
]
FILLED_CAVITIES = [
    ("none", "None", "Leaves closed hollows inside the bone as they are"),
    ("all", "All", "Fills every closed hollow inside the bone"),
    ("small", "Up To", "Fills the closed hollows of at most this volume"),
]
REDUCED_TRIANGLES = [
    ("none", "Keep All", "Leaves the triangles as they are"),
    ("number", "Reduce to", "Takes triangles away until a number of them is left"),
    (
        "error",
        "Reduce within",
        "Takes triangles away as long as the surface hardly moves",
    ),
]


def ct_images_changed(self: "BonemeshProperties", _context: Context) -> None:
    """Looks at what was chosen; series and crop of other images mean nothing in these."""
    folder = ct_images.folder_of_slice(bpy.path.abspath(self.ct_directory))
    if folder is not None:
        self.ct_directory = folder  # which calls this again
        return
    request = scanning.request_of(self)
    source = "" if request is None else f"{request.path} {request.one_series}"
    if self.series_source not in ("", source):
        self.series = ""
        cropping.forget(self.id_data)
    self.series_source = source
    if scanning.is_watched:
        scanning.begin(self)
    previewing.choose(images=True)


def series_changed(_self: "BonemeshProperties", _context: Context) -> None:
    """Shows the other series."""
    previewing.choose(images=True)


def preview_changed(_self: "BonemeshProperties", _context: Context) -> None:
    """Shows what the preview is now."""
    previewing.choose()


class BonemeshProperties(PropertyGroup):
    """One property for each field of the panel."""

    ct_directory: StringProperty(
        name="CT Images",
        description="Folder of CT images (DICOM files; folders inside it are searched too), or one file with a whole volume (NIfTI, NRRD, multi-frame DICOM)",
        subtype="FILE_PATH",
        update=ct_images_changed,
    )
    mesh_directory: StringProperty(
        name="Mesh Folder",
        description="Folder in which the meshes are saved as STL; empty takes the one shown in grey",
        subtype="DIR_PATH",
    )
    hu_threshold: IntProperty(
        name="HU Threshold",
        description="Bone is above this many Hounsfield units: 350 for skulls, 600 for cortical bone of the limbs",
        default=350,
        min=-1024,
        max=3071,
        update=preview_changed,
    )
    show_preview: BoolProperty(
        name="Live Preview",
        description="Shows a coarse surface at the threshold in the 3D view, at once, a little too thick and with the scanner's table, until the surface itself is made",
        default=True,
        update=preview_changed,
    )
    cut_thickness: FloatProperty(
        name="Thickness of Cut (mm)",
        description="How deep the region reaches below the selected surface",
        default=5.0,
        min=0.0,
        soft_max=50.0,
        precision=2,
    )
    mesh_name: StringProperty(
        name="Mesh Filename",
        description="Name of the surface mesh and of its STL file; empty takes the one shown in grey",
    )
    roi_name: StringProperty(
        name="Segmented Mesh Filename",
        description="Name of the region of interest and of its STL file; empty takes the one shown in grey",
    )
    sigma: FloatProperty(
        name="Edge Smoothing",
        description="How far the images are smoothed before edges are looked for, in pixels (sigma of a Gaussian); 0 smooths nothing. Not for isosurfaces and labelled tetrahedra, which use the voxels as they are",
        default=1.0,
        min=0.0,
        max=10.0,
        soft_max=4.0,
    )
    sample_percent: FloatProperty(
        name="Points Kept",
        description="Part of the edge points that is meshed; 100 keeps them all. Not for isosurfaces and labelled tetrahedra, which use the voxels themselves",
        default=100.0,
        min=0.1,
        max=100.0,
        precision=1,
        subtype="PERCENTAGE",
    )
    sampler: EnumProperty(
        name="Sampling",
        description="How the points are chosen when not all are kept",
        items=SAMPLERS,
    )
    method: EnumProperty(
        name="Method",
        description="How the surface is made",
        items=METHODS,  # the first is the default
    )
    leave_out_table: BoolProperty(
        name="Leave Out Table",
        description="Recognises the scanner's table and headrest, where they touch no bone, and leaves them out of a closed surface (isosurface, labelled tetrahedra)",
        default=True,
    )
    damp_metal: BoolProperty(
        name="Damp Metal Streaks",
        description="Takes most of the streaks of fillings, crowns, implants and screws off the slices that they are in; takes a few seconds for each of these slices",
        default=False,
    )
    fill_holes: EnumProperty(
        name="Fill Holes",
        description="Which holes of the mesh are closed when it is rendered; isosurfaces and labelled tetrahedra have none",
        items=FILLED_HOLES,
    )
    holes_mm: FloatProperty(
        name="Length (mm)",
        description="Holes up to this length are closed",
        default=10.0,
        min=0.0,
        precision=1,
    )
    remove_islands: EnumProperty(
        name="Remove Islands",
        description="Which loose parts of the mesh are removed",
        items=REMOVED_ISLANDS,
    )
    islands_mm3: FloatProperty(
        name="Volume (mm³)",
        description="Islands smaller than this are removed",
        default=1000.0,
        min=0.0,
        precision=1,
    )
    fill_cavities: EnumProperty(
        name="Fill Cavities",
        description="Which closed hollows inside the bone are filled, such as marrow and closed sinuses",
        items=FILLED_CAVITIES,
    )
    cavities_mm3: FloatProperty(
        name="Volume (mm³)",
        description="Cavities up to this volume are filled",
        default=100.0,
        min=0.0,
        precision=1,
    )
    smooth_mm: FloatProperty(
        name="Smooth (mm)",
        description="Smooths without shrinking and moves no vertex further than this; 0 does not smooth",
        default=0.0,
        min=0.0,
        soft_max=2.0,
        precision=3,
        step=1,
    )
    reduce_triangles: EnumProperty(
        name="Triangles",
        description="Takes triangles away where that changes the surface least",
        items=REDUCED_TRIANGLES,
    )
    triangles: IntProperty(
        name="Number",
        description="How many triangles are left",
        default=200_000,
        min=1,
        soft_min=1000,
        soft_max=2_000_000,
        step=10_000,
    )
    decimate_mm: FloatProperty(
        name="Error (mm)",
        description="The surface moves no further than this",
        default=0.05,
        min=0.0,
        soft_max=1.0,
        precision=3,
        step=1,
    )
    series: StringProperty(
        name="Series",
        description="Number or UID of the series, where the folder holds several; empty takes the one that is marked",
        update=series_changed,
    )
    series_source: StringProperty(
        description="What `series` was chosen from", options={"HIDDEN"}
    )
    one_series: BoolProperty(
        name="Treat Folder as One Series",
        description="Takes all slices that fit together as one series, for folders whose files were exported with a number of their own each",
        update=ct_images_changed,
    )
    crop: StringProperty(
        name="Crop",
        description="Part of the images that is rendered; Show Crop Box sets it with the mouse, Remove Crop Box uses all again. Typed: first:end of columns, rows and slices, counted from 0, the end left out, such as 0:255,0:345,2:90; empty uses all",
        update=preview_changed,
    )
    center_in_world: BoolProperty(
        name="Center in World",
        description="Puts the mesh at the world's centre instead of its place in the patient",
    )


class BonemeshFolds(PropertyGroup):
    """What is folded out in the panel; not in the scene, where a click would be a step to undo."""

    show_histogram: BoolProperty(
        name="Histogram",
        description="How often each value occurs in the images, and the thresholds found in them or published",
    )
    show_details: BoolProperty(
        name="Details", description="How the series is stored, and its UID"
    )
    show_left_out: BoolProperty(
        name="Files Left Out", description="The files that are in no series, and why"
    )


def register() -> None:
    """Adds `scene.bonemesh` and what is folded out."""
    bpy.utils.register_class(BonemeshProperties)
    bpy.utils.register_class(BonemeshFolds)
    bpy.types.WindowManager.bonemesh_folds = PointerProperty(type=BonemeshFolds)
    bpy.types.Scene.bonemesh = PointerProperty(type=BonemeshProperties)


def unregister() -> None:
    """Takes `scene.bonemesh` away."""
    del bpy.types.Scene.bonemesh
    del bpy.types.WindowManager.bonemesh_folds
    bpy.utils.unregister_class(BonemeshFolds)
    bpy.utils.unregister_class(BonemeshProperties)
