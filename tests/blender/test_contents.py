"""The panel shows what the chosen images hold, without waiting for it, and renders the series that is marked."""

import os
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from conftest import Blender

METHOD = "isosurface"  # the panel's default
FIRST, SECOND = "1  ", "2  "


@pytest.fixture(scope="module")
def answers(
    extension_zip: Path,
    ct: Path,
    two: Path,
    nifti: Path,
    tmp_path_factory: pytest.TempPathFactory,
) -> dict[str, Any]:
    return Blender(extension_zip, tmp_path_factory.mktemp("contents")).run(
        "contents", ct=ct, two=two, nifti=nifti
    )


def marked(box: list[str]) -> list[str]:
    """The numbers of the rows that are marked."""
    return [row.split()[1] for row in box if row.startswith("> ")]


def words(box: list[str]) -> str:
    """Everything in the box as one text, whatever the lines."""
    return " ".join(box)


def letters(text: str) -> str:
    """`text` without blanks: a long word is broken at the panel's edge."""
    return "".join(text.split())


def test_without_a_folder_there_is_no_box(answers: dict[str, Any]) -> None:
    assert answers["nothing chosen"] == []
    assert "Select File Directory" in answers["nothing to look at"]


def test_a_slow_scan_shows_its_progress_and_does_not_block(
    answers: dict[str, Any],
) -> None:
    slow = answers["slow"]
    progress, stop = slow["held"]
    assert progress.startswith("progress: ")
    assert stop == "Stop"
    assert slow["timer"]
    assert 0.0 < slow["tick"] <= 0.2
    assert not slow["job"], "a rendering must be possible meanwhile"
    assert slow["last_tick"] is None


def test_the_series_are_listed_and_the_recommended_one_is_marked(
    answers: dict[str, Any], bonemesh: ModuleType, two: Path
) -> None:
    scan = bonemesh.scan(two)
    assert len(scan.series) == 2
    assert scan.alternatives
    box = answers["slow"]["ended"]
    assert "2 series" in box
    assert marked(box) == [str(scan.recommended)]
    for series in scan.series:
        assert any(
            row.removeprefix("> ") == f"{series.number}  {series.description}"
            for row in box
        )
        assert f"{series.slices} x {series.spacing_mm[2]:.4g} mm" in box
    assert answers["choosing"]["numbers"] == [s.number for s in scan.series]
    assert "(recommended)" in answers["choosing"]["titles"][0]
    assert "(could be meant as well)" in answers["choosing"]["titles"][1]


def test_the_user_is_told_to_look_until_one_is_chosen(answers: dict[str, Any]) -> None:
    assert "2 series could be meant" in words(answers["slow"]["ended"])
    choosing = answers["choosing"]
    assert choosing["click"] == ["FINISHED"]
    assert choosing["series"] == "2"
    assert marked(choosing["second"]) == ["2"]
    assert "could be meant" not in words(choosing["second"])


def test_the_report_is_the_commands(
    answers: dict[str, Any], bonemesh: ModuleType, two: Path
) -> None:
    series = bonemesh.scan(two).series[1]
    shown = letters(words(answers["choosing"]["unfolded"]).replace("! ", ""))
    for line in series.lines:
        assert letters(line.removeprefix("note: ")) in shown
    assert series.uid in shown
    folded = letters(words(answers["choosing"]["second"]))
    assert series.uid not in folded
    assert letters(series.orientation) not in folded


def test_a_warning_is_seen_without_unfolding(
    answers: dict[str, Any], bonemesh: ModuleType, two: Path
) -> None:
    series = bonemesh.scan(two).series[1]
    assert series.warnings
    box = answers["choosing"]["second"]
    for warning in series.warnings:
        assert warning in words(box)
        assert any(
            row.startswith("! ") and warning.startswith(row.removeprefix("! "))
            for row in box
        )


def test_files_left_out_are_listed_with_their_reasons_up_to_twenty(
    answers: dict[str, Any], bonemesh: ModuleType, two: Path
) -> None:
    number = len(bonemesh.scan(two).left_out)
    assert number > 20
    assert f"{number} files left out [show_left_out]" in answers["choosing"]["second"]
    assert "not a DICOM file" not in words(answers["choosing"]["second"])
    shown = answers["choosing"]["unfolded"]
    name = str(Path("notes", "00.txt"))
    assert any(row.startswith(f"{name}: not a DICOM file") for row in shown)
    assert sum("not a DICOM file" in row for row in shown) == 20
    assert any(row.startswith(f"and {number - 20} more") for row in shown)


def test_a_typed_uid_marks_its_row_and_an_unknown_series_is_named(
    answers: dict[str, Any],
) -> None:
    assert marked(answers["choosing"]["by uid"]) == ["2"]
    unknown = answers["choosing"]["unknown"]
    assert marked(unknown) == []
    assert "17" in words(unknown)
    assert "choose one of the list" in words(unknown)


@pytest.mark.parametrize(
    ("case", "said"),
    [
        ("missing", "does not exist"),
        ("empty", "it is empty"),
        ("no volume", "not a DICOM file"),
    ],
)
def test_what_stands_against_a_scan_is_said_in_the_box(
    answers: dict[str, Any], case: str, said: str
) -> None:
    box = answers[case]
    assert box[0].startswith("! ")
    assert said in words(box)
    assert box[-1] == "Look Again"


def test_a_script_gets_the_error_of_a_scan(answers: dict[str, Any]) -> None:
    assert "no volume by itself" in answers["missing for a script"]


def test_one_file_with_a_whole_volume_can_be_chosen(
    answers: dict[str, Any], nifti: Path
) -> None:
    assert "1 series" in answers["nifti"]
    assert any(row.startswith("40 x ") for row in answers["nifti"])
    assert answers["file picked"] == [["FINISHED"], str(nifti)]


def test_a_slice_stands_for_its_folder(answers: dict[str, Any], ct: Path) -> None:
    folder = next(ct.rglob("*.dcm")).parent
    assert answers["slice picked"] == [["FINISHED"], f"{folder}{os.sep}"]


def test_the_chosen_series_is_forgotten_with_its_folder(
    answers: dict[str, Any],
) -> None:
    remembered = answers["remembered"]
    assert remembered["same folder"] == "2"
    assert remembered["other folder"] == ""
    assert remembered["one series"] == ""


def test_a_newer_choice_drops_the_result_of_the_older_one(
    answers: dict[str, Any],
) -> None:
    replaced = answers["replaced"]
    assert "1 series" in replaced["before"]
    assert replaced["after"] == replaced["before"]
    assert not replaced["kept"]
    assert replaced["cancelled"] == "Cancelled"


def test_a_scan_can_be_stopped_and_begun_again(answers: dict[str, Any]) -> None:
    stopped = answers["stopped"]
    assert stopped["stop"] == ["FINISHED"]
    assert stopped["stopped"] == ["Stopped looking", "Look Again"]
    assert stopped["again"] == ["FINISHED"]
    assert "2 series" in stopped["shown"]


def test_two_scenes_wait_for_each_other(answers: dict[str, Any]) -> None:
    scenes = answers["two scenes"]
    assert scenes["waiting"] == [True, True]
    assert scenes["series"] == [2, 1]
    assert scenes["still known"]


def test_undo_and_another_file_bring_their_folder_back(answers: dict[str, Any]) -> None:
    assert "2 series" in answers["undone"]
    assert answers["new file"] == []
    assert "2 series" in answers["opened"]


@pytest.mark.parametrize("how", ["disable", "quit"])
def test_no_scan_outlives_the_addon_or_blender(
    blender: Blender, ct: Path, how: str
) -> None:
    answer = blender.run("scan_interrupted", ct=ct, how=how)
    assert answer["running"] is (how == "quit")
    assert answer["timer"] is (how == "quit")


@pytest.fixture(scope="module")
def several(
    extension_zip: Path,
    two: Path,
    own_uids: Path,
    tmp_path_factory: pytest.TempPathFactory,
) -> dict[str, Any]:
    return Blender(extension_zip, tmp_path_factory.mktemp("several")).run(
        "several_series", two=two, own_uids=own_uids
    )


def assert_same(file: str, expected: Any) -> None:
    got = np.load(file)
    assert np.array_equal(got["patient"], expected.vertices)
    assert np.array_equal(got["triangles"], expected.triangles)


@pytest.mark.parametrize(("case", "number"), [("marked", 1), ("clicked", 2)])
def test_the_series_that_the_panel_marks_is_rendered(
    several: dict[str, Any], bonemesh: ModuleType, two: Path, case: str, number: int
) -> None:
    reports, file = several[case]
    assert reports[-1][0] == "INFO"
    assert_same(file, bonemesh.render(two, series=number, method=METHOD))


def test_the_series_that_was_seen_is_rendered_though_the_numbers_changed(
    several: dict[str, Any], bonemesh: ModuleType, two: Path
) -> None:
    _, file = several["renumbered"]
    assert_same(file, bonemesh.render(two, series=2, method=METHOD))


def test_nothing_is_picked_that_nobody_has_seen(several: dict[str, Any]) -> None:
    ((kind, unseen),) = several["unseen"]
    assert kind == "ERROR"
    for message in (several["by script"], unseen):
        assert "Phantom tube" in message
        assert "Phantom box-with-hole" in message


def test_a_folder_of_single_slices_can_be_taken_as_one_series(
    several: dict[str, Any], bonemesh: ModuleType, own_uids: Path
) -> None:
    assert "1 series" not in several["each"]
    shown, file = several["as one"]
    assert "1 series" in shown
    assert_same(file, bonemesh.render(own_uids, one_series=True, method=METHOD))


def test_a_file_with_a_whole_volume_is_rendered(
    blender: Blender, bonemesh: ModuleType, nifti: Path
) -> None:
    answer = blender.run("render", ct=nifti, fields={})
    assert_same(answer["mesh"], bonemesh.render(nifti, method=METHOD))
