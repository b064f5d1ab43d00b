"""The panel shows the published fields in their order, and the job that runs."""

from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from conftest import Blender

FIELDS = [
    "Select File Directory of CT Images",
    "[ct_directory]",
    "HU Threshold [hu_threshold]",
    "[show_preview]",
    "Mesh Filename",
    "[mesh_name]",
    "Select File Location to Save Mesh",
    "[mesh_directory]",
    "Render Surface Mesh",
    "Render Again",
    "Settings from File",
    "Thickness of Cut (mm) [cut_thickness]",
    "Segmented Mesh Filename",
    "[roi_name]",
    "Select Region of Interest",
    "Check Mesh",
]
AFTER_CARE = [
    "Fill Holes [fill_holes]",
    "Remove Islands [remove_islands]",
    "Fill Cavities [fill_cavities]",
    "Smooth (mm) [smooth_mm]",
    "Triangles [reduce_triangles]",
]
ADVANCED = [
    "series",
    "one_series",
    "damp_metal",
    "method",
    "leave_out_table",
    "sigma",
    "sample_percent",
    "sampler",
    "center_in_world",
]


@pytest.fixture(scope="module")
def panel(
    extension_zip: Path, ct: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    return Blender(extension_zip, tmp_path_factory.mktemp("panel")).run("panel", ct=ct)


def without_boxes(shown: list[Any]) -> list[str]:
    return [item for item in shown if isinstance(item, str)]


def test_what_the_images_hold_is_shown_below_their_path(panel: dict[str, Any]) -> None:
    shown = panel["main"]
    assert isinstance(shown[shown.index("[ct_directory]") + 1], list)


def test_the_first_line_says_what_to_do_next(panel: dict[str, Any]) -> None:
    assert " ".join(panel["main"][0]).endswith("press Render Surface Mesh")
    assert not isinstance(panel["busy"][0], list)


def test_the_fields_are_in_the_published_order(panel: dict[str, Any]) -> None:
    assert without_boxes(panel["main"]) == FIELDS
    assert panel["tabs"] == ["Segment CT"] * 5


def test_the_region_is_measured_cut_and_mirrored_from_a_part_of_its_own(
    panel: dict[str, Any],
) -> None:
    assert panel["region"] == [
        "Measure Thickness Here",
        "Method [method]",
        "Direction [direction]",
        "Take Hidden Pieces [hidden]",
        "One for Each Piece [separate]",
        "Take Region Up Again",
        "Mirror Plane [plane]",
        "Plane from Three Vertices",
        "Put at the Selection [mirror_back]",
        "Mirror Region of Interest",
    ]


def test_the_crop_box_is_shown_used_and_removed_from_a_part_of_its_own(
    panel: dict[str, Any],
) -> None:
    assert panel["crop"] == [
        "Crop [crop]",
        "Show Crop Box",
        "Use Crop Box",
        "Remove Crop Box",
    ]


def test_advanced_settings_are_there_but_closed(panel: dict[str, Any]) -> None:
    assert panel["closed"] == [False, True, True, True, True]
    assert [text.split("[")[1].rstrip("]") for text in panel["advanced"]] == ADVANCED


def test_after_care_is_there_but_closed_and_asks_for_numbers_only_where_they_count(
    panel: dict[str, Any],
) -> None:
    assert panel["after_care"] == AFTER_CARE
    holes, islands, cavities, smooth, triangles = AFTER_CARE
    assert panel["after_care asked for"] == [
        [
            holes,
            "Length (mm) [holes_mm]",
            islands,
            "Volume (mm³) [islands_mm3]",
            cavities,
            "Volume (mm³) [cavities_mm3]",
            smooth,
            triangles,
            field,
        ]
        for field in ("Number [triangles]", "Error (mm) [decimate_mm]")
    ]


def test_the_methods_are_the_librarys_and_the_default_makes_closed_surfaces(
    panel: dict[str, Any], bonemesh: ModuleType
) -> None:
    assert sorted(panel["methods"]) == sorted(bonemesh.methods())
    assert panel["method"] == panel["methods"][0] == "isosurface"


def test_limits_and_defaults_are_the_published_ones(panel: dict[str, Any]) -> None:
    assert panel["limits"]["hu_threshold"] == [-1024, 3071, 350]
    assert panel["limits"]["cut_thickness"][0] == 0.0
    assert panel["limits"]["cut_thickness"][2] == 5.0


def test_the_check_names_the_mesh_that_it_looks_at(panel: dict[str, Any]) -> None:
    assert without_boxes(panel["with a mesh"])[-1] == "Check Mesh: bone"


def test_a_file_that_would_be_replaced_is_named_before_it_is(
    panel: dict[str, Any],
) -> None:
    told = without_boxes(panel["with a mesh"])
    button = told.index("Render Surface Mesh")
    assert told[button - 1] == "bone.stl will be replaced"
    assert told[told.index("Select Region of Interest") - 1] == "[roi_name]"


def test_empty_fields_show_what_is_taken_for_them(
    panel: dict[str, Any],
) -> None:
    empty = panel["empty"]
    assert empty["shown"]["mesh_directory"] == empty["folder"]
    assert empty["shown"]["mesh_name"] == "phantom"
    assert empty["shown"]["roi_name"] == "bone region"
    assert "press Render Surface Mesh" in " ".join(empty["next"])
    assert empty["end"] == ["FINISHED"]
    assert empty["files"] == ["phantom.stl", "phantom.stl.json"]
    assert empty["then"]["mesh_name"] == "phantom-2"
    assert empty["then"]["roi_name"] == "phantom region"
    assert empty["fields"] == ["", "", ""]


def test_a_script_has_to_say_what_it_wants(panel: dict[str, Any]) -> None:
    assert "Mesh Filename is empty" in panel["empty for a script"]


def test_the_pickers_say_what_they_want(panel: dict[str, Any]) -> None:
    assert "slices" in " ".join(panel["ct picker"])
    assert "not listed" in " ".join(panel["mesh picker"])


def test_a_running_job_is_shown_with_its_cancel_button(panel: dict[str, Any]) -> None:
    title, progress, button = panel["busy"][:3]
    assert without_boxes(panel["busy"])[3:] == FIELDS
    assert title == "Render Surface Mesh"
    assert progress.startswith("progress: ")
    assert len(progress) > len("progress: ")
    assert button == "Cancel"
