"""A job beside the window can be watched, stopped and left alone; only one runs at a time."""

from pathlib import Path
from typing import Any

import pytest
from conftest import Blender


@pytest.fixture(scope="module")
def answers(
    extension_zip: Path, ct: Path, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    return Blender(extension_zip, tmp_path_factory.mktemp("background")).run(
        "background", ct=ct
    )


def test_a_job_that_ends_puts_its_mesh_into_the_scene(answers: dict[str, Any]) -> None:
    finished = answers["finished"]
    assert finished["end"] == ["FINISHED"]
    assert finished["objects"] == ["bone"]
    assert finished["files"] == ["bone.stl", "bone.stl.json"]
    assert finished["timers"] == 0
    assert [kind for kind, _ in finished["reports"]] == ["INFO"]


def test_other_events_reach_blender_while_a_job_runs(answers: dict[str, Any]) -> None:
    assert answers["finished"]["passed"] == [["PASS_THROUGH"]] * 3


def test_progress_is_shown_in_the_status_bar(answers: dict[str, Any]) -> None:
    status = answers["finished"]["status"]
    assert status
    assert all("Render Surface Mesh" in text and "Esc" in text for text in status)


def test_a_second_job_is_refused_while_one_runs(answers: dict[str, Any]) -> None:
    result, reports = answers["finished"]["second"]
    assert result == ["CANCELLED"]
    ((kind, text),) = reports
    assert kind == "ERROR"
    assert "still running" in text
    assert "Cancel" in text
    assert "still running" in answers["finished"]["second_by_script"]


@pytest.mark.parametrize("how", ["escape", "button"])
def test_a_cancelled_job_leaves_nothing_behind(
    answers: dict[str, Any], how: str
) -> None:
    cancelled = answers[how]
    assert cancelled["end"] == ["CANCELLED"]
    assert cancelled["reports"] == [["INFO", "Stopped; nothing was kept"]]
    assert cancelled["objects"] == []
    assert cancelled["files"] == []
    assert cancelled["timers"] == 0
    assert not cancelled["running"]


def test_a_job_ends_when_blender_ends_its_operator(answers: dict[str, Any]) -> None:
    ended = answers["blender"]
    assert ended["timers"] == 0
    assert ended["files"] == []
    assert not ended["running"]


def test_a_failing_job_says_why(answers: dict[str, Any]) -> None:
    failed = answers["failed"]
    assert failed["end"] == ["CANCELLED"]
    ((kind, text),) = failed["reports"]
    assert kind == "ERROR"
    assert "nothing" in text
    assert failed["timers"] == 0


def test_cancel_without_a_job_does_nothing(answers: dict[str, Any]) -> None:
    assert answers["nothing_to_cancel"] == ["CANCELLED"]


@pytest.mark.parametrize("how", ["delete", "undo", "edit"])
def test_a_region_arrives_whatever_became_of_its_source(
    blender: Blender, ct: Path, how: str
) -> None:
    answer = blender.run("interrupted", ct=ct, how=how)
    assert answer["end"] == ["FINISHED"], answer["reports"]
    assert "region" in answer["objects"]
    assert "region.stl" in answer["files"]
    assert answer["mode"] == ("EDIT_MESH" if how == "edit" else "OBJECT")


def test_disabling_the_addon_ends_its_job(blender: Blender, ct: Path) -> None:
    answer = blender.run("interrupted", ct=ct, how="disable")
    assert answer["running"] is False
    assert answer["timers"] == 0
    assert answer["files"] == []


def test_opening_a_file_whose_images_are_gone_ends_the_job(
    blender: Blender, ct: Path
) -> None:
    answer = blender.run("interrupted", ct=ct, how="open")
    assert "still running" in answer["refused"] or "active" in answer["refused"]
    assert "moved away does not exist" in answer["again"]
    assert answer["timers"] == 0
    assert answer["objects"] == answer["files"] == []


def test_quitting_during_a_job_is_clean(blender: Blender, ct: Path) -> None:
    answer = blender.run("interrupted", ct=ct, how="quit")
    assert answer["running"] is True
    assert [p.name for p in blender.out.iterdir()] == ["interrupted.json"]
