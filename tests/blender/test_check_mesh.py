"""Check Mesh says what the API says of the mesh as its file would be, and changes nothing."""

from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from conftest import Blender


@pytest.fixture(scope="module")
def checks(
    extension_zip: Path, bonemesh: ModuleType, tmp_path_factory: pytest.TempPathFactory
) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("check_mesh")
    shell = folder / "shell"
    bonemesh.write_phantom("sphere-shell", shell, coarser=2.5)
    blender = Blender(extension_zip, folder)
    answer = blender.run("check_mesh", shell=shell)
    written = bonemesh.read_mesh(blender.out / "bone.stl")
    return answer | {"api": bonemesh.check(written)}


def without_state(check: dict[str, Any]) -> dict[str, Any]:
    return {name: v for name, v in check["report"].items() if name != "state"}


def words(box: list[str]) -> str:
    """Everything in the box as one text, whatever the lines."""
    return " ".join(box)


def test_after_care_is_told_in_a_box(checks: dict[str, Any]) -> None:
    title, *lines = checks["after rendering"]
    assert title == "bone"
    told = words(lines)
    assert "1 cavity removed (" in told
    assert "cm³)" in told
    assert "triangles removed" in told


@pytest.mark.parametrize("case", ["by script", "moved", "in edit mode", "pressed"])
def test_the_findings_are_the_apis_of_the_saved_file(
    checks: dict[str, Any], case: str
) -> None:
    assert without_state(checks[case]) == checks["api"]
    assert checks["api"]["printable"]


def test_the_box_tells_the_verdict_and_the_figures(checks: dict[str, Any]) -> None:
    api, box = checks["api"], checks["pressed"]["box"]
    assert "Printable" in box
    assert f"Volume: {api['volume_mm3'] / 1000:,.2f} cm³" in box
    assert f"Thinnest wall: {api['thinnest_wall_mm']:.2f} mm" in box
    assert f"{api['triangles']:,} triangles in 1 shell" in box
    assert not any(row.startswith("! ") for row in box)
    assert checks["by script"]["box"] == box


def test_a_pressed_check_runs_beside_the_window(checks: dict[str, Any]) -> None:
    pressed = checks["pressed"]
    assert pressed["busy"][2] == "Cancel"
    assert "Check Mesh" in pressed["busy"][0]
    assert pressed["end"] == ["FINISHED"]
    assert pressed["reports"] == [["INFO", "bone: Printable"]]
    end, reports = pressed["cancelled"]
    assert end == ["CANCELLED"]
    assert reports == [["INFO", "Stopped; nothing was kept"]]
    assert not pressed["kept"]


def test_a_mesh_that_is_deleted_meanwhile_is_still_reported(
    checks: dict[str, Any],
) -> None:
    end, reports = checks["deleted meanwhile"]
    assert end == ["FINISHED"]
    assert reports == [["INFO", "bone: Printable"]]


@pytest.mark.parametrize(
    "case", ["by script", "in edit mode", "open", "with a modifier, in edit mode"]
)
def test_nothing_is_selected_nor_left(checks: dict[str, Any], case: str) -> None:
    assert checks[case]["result"] == ["FINISHED"]
    assert checks[case]["untouched"]
    assert checks[case]["mode"] == ("EDIT" if "edit mode" in case else "OBJECT")


def test_an_open_mesh_is_not_printable_and_the_remedy_is_shown(
    checks: dict[str, Any],
) -> None:
    opened = checks["open"]
    assert not opened["report"]["printable"]
    (reason,) = opened["report"]["reasons"]
    assert reason.startswith("4 open edges")
    assert "Not printable" in opened["box"]
    assert reason in words(opened["box"]).replace("! ", "")
    assert "! 4 open edges" in words(opened["box"])
    assert "Volume" not in words(opened["box"])
    assert "Walls: not measured" in words(opened["box"])


def test_the_box_is_the_active_meshs_and_not_a_stale_one(
    checks: dict[str, Any],
) -> None:
    assert checks["another one"] == checks["whole"]["box"]
    assert "press Check Mesh again" in words(checks["changed"])
    assert "Not printable" not in checks["changed"]


@pytest.mark.parametrize("case", ["with a modifier", "with a modifier, in edit mode"])
def test_modifiers_count_as_in_an_exported_file(
    checks: dict[str, Any], case: str
) -> None:
    assert checks[case]["report"]["printable"], checks[case]["report"]["reasons"]
    # The modifier moves corners by 0.5 along their normals, which is less across the walls.
    wall_mm = 0.5 / 3.0**0.5
    assert checks[case]["report"]["thinnest_wall_mm"] == pytest.approx(wall_mm, 1e-5)


@pytest.mark.parametrize(
    ("case", "volume_mm3"), [("whole", 8.0), ("scaled", 192.0), ("mirrored", 8.0)]
)
def test_a_mesh_is_measured_at_the_size_it_is_shown(
    checks: dict[str, Any], case: str, volume_mm3: float
) -> None:
    report = checks[case]["report"]
    assert report["printable"], report["reasons"]
    assert report["volume_mm3"] == pytest.approx(volume_mm3, rel=1e-5)


def test_an_empty_mesh_has_an_answer(checks: dict[str, Any]) -> None:
    assert checks["nothing"]["result"] == ["FINISHED"]
    assert "without triangles" in words(checks["nothing"]["box"])


def test_a_property_that_was_overwritten_by_hand_does_not_break_the_panel(
    checks: dict[str, Any],
) -> None:
    assert checks["spoilt"] == []
