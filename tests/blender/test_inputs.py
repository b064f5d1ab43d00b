"""The panel's fields are checked before any work begins (needs no Blender)."""

from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from blender_addon.request.inputs import (
    METHODS_OF_VOXELS,
    RefusalError,
    RegionInputs,
    RenderInputs,
    after_care_options,
    file_stem,
    series_choice,
)


def fields(folder: Path, **changes: Any) -> Any:
    values = {
        "ct_directory": str(folder),
        "mesh_directory": str(folder),
        "hu_threshold": 350,
        "cut_thickness": 5.0,
        "mesh_name": "bone",
        "roi_name": "region",
        "sigma": 1.0,
        "sample_percent": 100.0,
        "sampler": "uniform",
        "method": "alpha",
        "series": "",
        "one_series": False,
        "crop": "",
        "damp_metal": False,
        "leave_out_table": True,
        "fill_holes": "none",
        "holes_mm": 10.0,
        "remove_islands": "specks",
        "islands_mm3": 1000.0,
        "fill_cavities": "none",
        "cavities_mm3": 100.0,
        "smooth_mm": 0.0,
        "reduce_triangles": "none",
        "triangles": 200_000,
        "decimate_mm": 0.05,
    }
    return SimpleNamespace(**(values | changes))


def test_defaults_ask_for_everything_there_is(tmp_path: Path) -> None:
    inputs = RenderInputs.read(fields(tmp_path))
    assert inputs.output == tmp_path / "bone.stl"
    assert inputs.options["sample_percent"] is None
    assert inputs.options["series"] is None
    assert inputs.options["crop"] is None


def test_the_table_is_left_out_unless_it_is_wanted(tmp_path: Path) -> None:
    for leave_out in (True, False):
        voxels = fields(tmp_path, leave_out_table=leave_out, method="isosurface")
        assert RenderInputs.read(voxels).options["keep_table"] is not leave_out
        # Of edge points it is never left out, and the library refuses to be asked.
        points = fields(tmp_path, leave_out_table=leave_out, method="alpha")
        assert "keep_table" not in RenderInputs.read(points).options


def test_streaks_of_metal_are_damped_only_when_asked_for(tmp_path: Path) -> None:
    for damp in (True, False):
        inputs = RenderInputs.read(fields(tmp_path, damp_metal=damp))
        assert inputs.options["damp_metal"] is damp


def test_a_number_is_the_one_that_was_typed(tmp_path: Path) -> None:
    as_blender_keeps_it = 0.10000000149011612
    inputs = RenderInputs.read(
        fields(tmp_path, sample_percent=as_blender_keeps_it, sigma=as_blender_keeps_it)
    )
    assert inputs.options["sample_percent"] == 0.1
    assert inputs.options["sigma"] == 0.1
    assert (
        RegionInputs.read(
            fields(tmp_path, cut_thickness=as_blender_keeps_it)
        ).thickness_mm
        == 0.1
    )


@pytest.mark.parametrize(
    ("changes", "keywords"),
    [
        ({}, {}),
        ({"fill_holes": "all"}, {"holes": "all"}),
        ({"fill_holes": "small", "holes_mm": 2.5}, {"holes": 2.5}),
        ({"remove_islands": "none"}, {"islands": 0.0}),
        ({"remove_islands": "others"}, {"islands": "largest"}),
        ({"remove_islands": "small"}, {"islands": 1000.0}),
        ({"remove_islands": "small", "islands_mm3": 0.0}, {"islands": 0.0}),
        ({"fill_cavities": "all"}, {"cavities": "all"}),
        ({"fill_cavities": "small", "cavities_mm3": 2.5}, {"cavities": 2.5}),
        ({"smooth_mm": 0.10000000149011612}, {"smooth_mm": 0.1}),
        ({"reduce_triangles": "number", "triangles": 5000}, {"triangles": 5000}),
        ({"reduce_triangles": "error", "decimate_mm": 0.25}, {"decimate_mm": 0.25}),
        ({"reduce_triangles": "error", "decimate_mm": 0.0}, {"decimate_mm": 0.0}),
        (
            {"holes_mm": 7.0, "islands_mm3": 7.0, "cavities_mm3": 7.0, "triangles": 7},
            {},
        ),
    ],
)
def test_only_the_after_care_that_is_asked_for_is_passed_on(
    tmp_path: Path, changes: dict[str, Any], keywords: dict[str, Any]
) -> None:
    properties = fields(tmp_path, **changes)
    assert after_care_options(properties) == keywords
    options = RenderInputs.read(properties).options
    assert {n: options[n] for n in keywords} == keywords
    care = {"holes", "islands", "cavities", "smooth_mm", "triangles", "decimate_mm"}
    assert care & set(options) == set(keywords)


def test_what_chooses_edge_points_is_passed_on_only_where_there_are_some(
    tmp_path: Path, bonemesh: ModuleType
) -> None:
    volume = bonemesh.phantom("tube", coarser=3.0)
    edges = {"sigma": 1.0, "sample_percent": 50.0, "sampler": "uniform"}
    for method in bonemesh.methods():
        properties = fields(tmp_path, method=method, sample_percent=50.0)
        options = RenderInputs.read(properties).options
        passed = {name: options[name] for name in edges if name in options}
        assert passed == ({} if method in METHODS_OF_VOXELS else edges)
        if method in METHODS_OF_VOXELS:
            with pytest.raises(bonemesh.BonemeshError, match="sample"):
                bonemesh.render(volume, method=method, sample_percent=50.0)


@pytest.mark.parametrize("name", ["skull", "Schädel 2", "skull.v2", "頭"])
def test_plain_names_are_taken(name: str) -> None:
    assert file_stem(name, "Mesh Filename") == name


@pytest.mark.parametrize("name", ["skull.stl", " skull ", "skull.STL"])
def test_the_suffix_is_not_doubled(name: str) -> None:
    assert file_stem(name, "Mesh Filename") == "skull"


@pytest.mark.parametrize(
    "name",
    ["", " ", ".stl", ".", "..", "../x", "a/b", "a\\b", "/x", "C:x", "C:\\x", "a\0b", "a\nb", "x.", ".x", "con", "LPT1", "nul.txt", "a*b", "~/x"],
)  # fmt: skip
def test_names_that_are_none_or_leave_the_folder_are_refused(name: str) -> None:
    with pytest.raises(RefusalError, match="Mesh Filename"):
        file_stem(name, "Mesh Filename")


@pytest.mark.parametrize("thickness", [0.0, -1.0, float("nan")])
def test_a_region_needs_a_thickness(tmp_path: Path, thickness: float) -> None:
    with pytest.raises(RefusalError, match="Thickness of Cut"):
        RegionInputs.read(fields(tmp_path, cut_thickness=thickness))


def test_a_region_never_overwrites_the_whole_mesh(tmp_path: Path) -> None:
    with pytest.raises(RefusalError, match="overwrite"):
        RegionInputs.read(fields(tmp_path, roi_name="BONE.stl"))


def test_paths_are_resolved_before_they_are_looked_at(tmp_path: Path) -> None:
    properties = fields(tmp_path, ct_directory="//ct", mesh_directory="//out")
    inputs = RenderInputs.read(properties, resolve=lambda _path: str(tmp_path))
    assert inputs.ct_images == tmp_path


def test_a_series_is_a_number_or_a_uid() -> None:
    assert series_choice(" 2 ") == 2
    assert series_choice("1.2.840.99") == "1.2.840.99"
    assert series_choice("  ") is None


def test_a_sampler_is_asked_for_only_where_points_are_left_out(tmp_path: Path) -> None:
    def options(percent: float, sampler: str) -> tuple[float | None, str]:
        chosen = RenderInputs.read(
            fields(tmp_path, sample_percent=percent, sampler=sampler)
        ).options
        return chosen["sample_percent"], chosen["sampler"]

    assert options(40.0, "targeted") == (40.0, "targeted")
    # It has percentages of its own, and the library refuses another.
    assert options(40.0, "thesis-targeted") == (None, "thesis-targeted")
    assert options(100.0, "thesis-targeted") == (None, "uniform")
