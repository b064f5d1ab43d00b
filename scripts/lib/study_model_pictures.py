"""The study's drawn models as each method makes them: figures 3.11 to 3.20."""

from pathlib import Path
from typing import Any

import bonemesh
import study_pictures
from study_models import CYLINDER_ALPHAS_MM, THRESHOLD_HU, stacked
from study_report import Picture

SLICE_MM = 5.0
SLICES = 10
CYLINDER_SLICES = 20
CYLINDER_METHODS = ("tetrahedra", "alpha", "labelled", "isosurface")
ALPHA_SPACINGS_MM = (1.0, 5.0)
# So that the bore and the slices are seen.
FROM_ABOVE = (0.5, -1.0, 0.9)


def pictures(folder: Path) -> list[Picture]:
    """One for the line, one for the hollow cylinder, one for alpha."""
    line = stacked("line", SLICES, SLICE_MM)
    cylinder = stacked("cylinder", CYLINDER_SLICES, SLICE_MM)
    shown = {
        "line.png": {name: made(line, name) for name in bonemesh.methods()},
        "cylinder.png": {name: made(cylinder, name) for name in CYLINDER_METHODS},
        "alphas.png": alphas(),
    }
    said = {
        "line.png": f"Figures 3.11 to 3.14: the line model, {SLICES} slices of {SLICE_MM:g} mm, by every method",
        "cylinder.png": f"Figures 3.15 and 3.16: the hollow cylinder, {CYLINDER_SLICES} slices of {SLICE_MM:g} mm",
        "alphas.png": f"Figures 3.17 to 3.20: alpha on a cylinder of {SLICES} slices, where it leaves anything",
    }
    for name, meshes in shown.items():
        known = {title: (mesh, None) for title, mesh in meshes.items() if mesh}
        study_pictures.meshes(known, folder / name, view_from=FROM_ABOVE)
    return [Picture(name, said[name]) for name in shown]


def alphas() -> dict[str, bonemesh.Mesh | None]:
    """The cylinder with every alpha at every spacing."""
    return {
        f"slices of {slice_mm:g} mm, alpha {alpha_mm:g} mm": made(
            stacked("cylinder", SLICES, slice_mm), "alpha", alpha_mm=alpha_mm
        )
        for slice_mm in ALPHA_SPACINGS_MM
        for alpha_mm in CYLINDER_ALPHAS_MM
    }


def made(volume: bonemesh.Volume, method: str, **options: Any) -> bonemesh.Mesh | None:
    """The mesh, or none where the method refuses, which the tables say."""
    try:
        return bonemesh.render(
            volume, threshold_hu=THRESHOLD_HU, method=method, **options
        )
    except bonemesh.BonemeshError:
        return None
