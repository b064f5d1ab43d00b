"""From a CT folder to a bone mesh, and from a selection on it to a region of its own.

    mesh = bonemesh.render("scan/", threshold_hu=350)
    mesh.save("skull.stl")
    region = bonemesh.select_roi(mesh, [17, 18, 19], thickness_mm=5.0)

Lengths are millimetres; coordinates are DICOM's patient frame (LPS) unless said otherwise. Arrays
that objects show are read-only views. Long calls release the GIL and take

- `threads`: how many worker threads; None is one per core. The result never depends on it.
- `progress`: called as `progress(stage, fraction)` about every 50 ms, on the thread that called.
- `cancel`: a `Cancel` that stops the work within 0.2 s, which then raises `Cancelled`.

Ctrl-C stops them as well. What cannot be done is a `BonemeshError`, what is wrong with a file or
folder itself an `OSError`; the message is one line that names the remedy.
"""

from bonemesh._native import (
    ArgumentError,
    BonemeshError,
    Cancel,
    Cancelled,
    DicomError,
    Histogram,
    LeftOut,
    Mesh,
    MeshError,
    PhantomSurface,
    Preview,
    Scan,
    Series,
    Volume,
    __version__,
    alpha_surface,
    canny,
    check,
    decimate,
    face_outward,
    fill_cavities,
    fill_holes,
    find_series,
    histogram,
    keep_islands,
    label_components,
    local_thickness,
    main,
    mean_neighbour_distance,
    methods,
    mirror,
    phantom,
    point_cloud,
    read_mesh,
    read_series,
    render,
    sample,
    scan,
    select_roi,
    smooth,
    suggest_thresholds,
    symmetry_plane,
    tetrahedralize,
    wall_thickness,
    write_phantom,
)

__all__ = [
    "ArgumentError",
    "BonemeshError",
    "Cancel",
    "Cancelled",
    "DicomError",
    "Histogram",
    "LeftOut",
    "Mesh",
    "MeshError",
    "PhantomSurface",
    "Preview",
    "Scan",
    "Series",
    "Volume",
    "__version__",
    "alpha_surface",
    "canny",
    "check",
    "decimate",
    "face_outward",
    "fill_cavities",
    "fill_holes",
    "find_series",
    "histogram",
    "keep_islands",
    "label_components",
    "local_thickness",
    "main",
    "mean_neighbour_distance",
    "methods",
    "mirror",
    "phantom",
    "point_cloud",
    "read_mesh",
    "read_series",
    "render",
    "sample",
    "scan",
    "select_roi",
    "smooth",
    "suggest_thresholds",
    "symmetry_plane",
    "tetrahedralize",
    "wall_thickness",
    "write_phantom",
]
