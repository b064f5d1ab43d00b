# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel asks for, checked before any work begins. Knows no bpy."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

RESERVED_ON_WINDOWS = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)
NOT_IN_NAMES = re.compile(r'[\x00-\x1f\x7f/\\:*?"<>|]')
LONGEST_NAME = 200  # bytes: file systems take 255, and endings are added
WHOLE_NUMBER = re.compile(r"[0-9]{1,9}")
METHODS_OF_VOXELS = ("isosurface", "labelled")
"""They need no edge points, so what chooses these does not apply."""
NO_CT_IMAGES = (
    "no folder of CT images is chosen; press Select File Directory of CT Images"
)
NO_MESH_FOLDER = (
    "no folder for the meshes is chosen; press Select File Location to Save Mesh"
)
EMPTY_NAME = "{} is empty; give the mesh a name"


class RefusalError(Exception):
    """The request cannot be carried out as it stands; the message is one line with the remedy."""


@dataclass(frozen=True)
class RenderInputs:
    """A checked request for a surface mesh."""

    ct_images: Path
    """A folder, or one file with a whole volume."""
    output: Path
    name: str
    options: dict[str, Any]
    """The keyword arguments of bonemesh.render."""

    @classmethod
    def read(cls, properties: Any, resolve: Callable[[str], str] = str) -> RenderInputs:
        """From `scene.bonemesh`; `resolve` makes Blender's relative paths absolute."""
        ct_images = existing_path(
            resolve(properties.ct_directory), missing=NO_CT_IMAGES
        )
        directory = output_directory(resolve(properties.mesh_directory))
        name = file_stem(properties.mesh_name, "Mesh Filename")
        options = {
            "threshold_hu": float(properties.hu_threshold),
            "method": properties.method,
            "series": series_choice(properties.series),
            "one_series": properties.one_series,
            "crop": properties.crop.strip() or None,
            "damp_metal": properties.damp_metal,
            **voxel_options(properties),
            **edge_options(properties),
            **after_care_options(properties),
        }
        return cls(ct_images, directory / f"{name}.stl", name, options)


@dataclass(frozen=True)
class RegionInputs:
    """A checked request for a region of interest."""

    output: Path
    name: str
    thickness_mm: float

    @classmethod
    def read(cls, properties: Any, resolve: Callable[[str], str] = str) -> RegionInputs:
        """From `scene.bonemesh`; `resolve` makes Blender's relative paths absolute."""
        directory = output_directory(resolve(properties.mesh_directory))
        name = file_stem(properties.roi_name, "Segmented Mesh Filename")
        if name.casefold() == without_suffix(properties.mesh_name).casefold():
            raise RefusalError(
                f"the region would overwrite {name}.stl of the whole mesh; change Segmented Mesh Filename"
            )
        thickness_mm = as_typed(properties.cut_thickness)
        if not thickness_mm > 0.0:
            raise RefusalError(
                "the thickness of cut is 0 mm; set Thickness of Cut (mm) above 0"
            )
        return cls(directory / f"{name}.stl", name, thickness_mm)

    def outputs(self, regions: int) -> list[Path]:
        """The files of so many regions: numbered where there are several."""
        if regions == 1:
            return [self.output]
        numbers = range(1, regions + 1)
        return [self.output.with_stem(f"{self.name}-{number}") for number in numbers]


@dataclass(frozen=True)
class ExportInputs:
    """A checked request for a file of a mesh."""

    output: Path
    frame: str

    @classmethod
    def read(
        cls,
        properties: Any,
        mesh_directory: str,
        object_name: str,
        resolve: Callable[[str], str] = str,
    ) -> ExportInputs:
        """From `scene.bonemesh_output`; an object without a file's name goes by its own."""
        directory = output_directory(resolve(mesh_directory))
        name = without_suffix(properties.file_name, properties.format)
        stem = file_stem(name or object_name, "Filename")
        return cls(directory / f"{stem}.{properties.format}", properties.frame)


def region_options(
    properties: Any, view: tuple[float, float, float] | None
) -> dict[str, Any]:
    """The keyword arguments of bonemesh.select_roi; `view`: where the user looks, in the patient."""
    if properties.method == "thesis":
        return {"method": "thesis"}
    options = {
        "method": "solid",
        "hidden": properties.hidden,
        "separate": properties.separate,
    }
    options["direction"] = properties.direction
    if properties.direction == "outward":
        options["clearance_mm"] = as_typed(properties.clearance)
    if properties.direction == "view":
        if view is None:
            raise RefusalError(
                "there is no 3D view to look along; choose another direction, or press the button in the view's sidebar"
            )
        options["direction"] = view
    if properties.direction == "given":
        options["direction"] = tuple(properties.direction_numbers)
    return options


def uses_edge_points(properties: Any) -> bool:
    """Whether the method makes its surface of edge points."""
    return properties.method not in METHODS_OF_VOXELS


def voxel_options(properties: Any) -> dict[str, Any]:
    """The keyword arguments of bonemesh.render for the voxels, where the method starts from them."""
    if uses_edge_points(properties):
        return {}
    return {"keep_table": not properties.leave_out_table}


def edge_options(properties: Any) -> dict[str, Any]:
    """The keyword arguments of bonemesh.render for the edge points, where the method has some."""
    if not uses_edge_points(properties):
        return {}
    percent = as_typed(properties.sample_percent)
    sampler = properties.sampler if percent < 100.0 else "uniform"
    has_percent = percent < 100.0 and sampler != "thesis-targeted"
    return {
        "sigma": as_typed(properties.sigma),
        "sample_percent": percent if has_percent else None,
        "sampler": sampler,
    }


def after_care_options(properties: Any) -> dict[str, Any]:
    """The keyword arguments of bonemesh.render for what is done to the finished mesh: only what is asked for."""
    holes = {"all": "all", "small": as_typed(properties.holes_mm)}
    islands = {
        "none": 0.0,
        "others": "largest",
        "small": as_typed(properties.islands_mm3),
    }
    cavities = {"all": "all", "small": as_typed(properties.cavities_mm3)}
    reduced = properties.reduce_triangles
    asked = {
        "holes": holes.get(properties.fill_holes),
        "islands": islands.get(properties.remove_islands),
        "cavities": cavities.get(properties.fill_cavities),
        "smooth_mm": as_typed(properties.smooth_mm) or None,
        "triangles": properties.triangles if reduced == "number" else None,
        "decimate_mm": as_typed(properties.decimate_mm) if reduced == "error" else None,
    }
    return {name: value for name, value in asked.items() if value is not None}


def as_typed(value: float) -> float:
    """The decimal number that was typed: Blender keeps 32 bits of it, so 0.1 comes back as 0.1000000015."""
    return round(value, 5)


def existing_path(path: str, missing: str) -> Path:
    """`path` as a folder or file that exists; `missing` is said where it is empty."""
    if not path.strip():
        raise RefusalError(missing)
    if not Path(path).exists():
        raise RefusalError(f"{path} does not exist; choose another folder")
    return Path(path)


def existing_directory(path: str, missing: str) -> Path:
    """`path` as a folder that exists; `missing` is said where it is empty."""
    directory = existing_path(path, missing)
    if not directory.is_dir():
        raise RefusalError(f"{path} is a file; choose the folder it is in")
    return directory


def output_directory(path: str) -> Path:
    """`path` as a folder that exists and can be written to."""
    directory = existing_directory(path, missing=NO_MESH_FOLDER)
    if not os.access(directory, os.W_OK | os.X_OK):
        raise RefusalError(f"{path} cannot be written to; choose another folder")
    return directory


def without_suffix(name: str, ending: str = "stl") -> str:
    """`name` without blanks around it and without its ending, which is added again to the file."""
    name = name.strip()
    has_it = name.lower().endswith(f".{ending}")
    return name[: -len(ending) - 1].rstrip() if has_it else name


def file_stem(name: str, label: str) -> str:
    """`name` as the name of one file inside its folder, on every system, without its suffix."""
    stem = without_suffix(name)
    if not stem:
        raise RefusalError(EMPTY_NAME.format(label))
    if NOT_IN_NAMES.search(stem) or stem.startswith(".") or stem.endswith("."):
        raise RefusalError(
            f'{label} "{stem}" is no plain file name; use no folders, no leading or final dot and none of / \\ : * ? " < > |'
        )
    if len(stem.encode()) > LONGEST_NAME:
        raise RefusalError(
            f"{label} is too long for the name of a file; take {LONGEST_NAME} letters at most"
        )
    if RESERVED_ON_WINDOWS.fullmatch(stem):
        raise RefusalError(
            f'{label} "{stem}" is reserved by Windows; choose another name'
        )
    return stem


def series_choice(text: str) -> int | str | None:
    """A 1-based number, a series UID, or None for the only series of the folder."""
    text = text.strip()
    if not text:
        return None
    return int(text) if WHOLE_NUMBER.fullmatch(text) else text
