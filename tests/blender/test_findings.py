"""What was done and found is told in plain lines (needs no Blender)."""

from typing import Any

import pytest

from blender_addon.reports.findings import (
    after_care_lines,
    check_lines,
    of_rendering,
    verdict,
    volume_text,
)

NOTHING = {
    "removed_islands": 0,
    "removed_islands_mm3": 0.0,
    "removed_cavities": 0,
    "removed_cavities_mm3": 0.0,
    "largest_move_mm": None,
    "put_back_vertices": None,
    "removed_triangles": None,
    "held_vertices": None,
    "missed_triangles": None,
    "seconds": 0.1,
}


@pytest.mark.parametrize(
    ("report", "lines"),
    [
        ({}, ["Nothing had to be removed"]),
        (
            {"removed_islands": 1, "removed_islands_mm3": 12.34},
            ["1 island removed (12.3 mm³)"],
        ),
        (
            {"removed_cavities": 1200, "removed_cavities_mm3": 45678.0},
            ["1,200 cavities removed (45.68 cm³)"],
        ),
        (
            {"largest_move_mm": 0.25, "put_back_vertices": 0},
            ["Smoothed: vertices moved up to 0.250 mm"],
        ),
        (
            {"largest_move_mm": 0.25, "put_back_vertices": 1},
            ["Smoothed: vertices moved up to 0.250 mm, 1 vertex left in place"],
        ),
        (
            {"removed_triangles": 5000, "held_vertices": 20},
            ["5,000 triangles removed, 20 vertices left as they were"],
        ),
        (
            {"removed_triangles": 7, "held_vertices": 0, "missed_triangles": 1000},
            [
                "7 triangles removed",
                "Not as few as 1,000: no more could go without bending the surface too much",
            ],
        ),
        ({"removed_triangles": 0, "held_vertices": 0}, ["0 triangles removed"]),
        (
            {
                "left_out_table": {"islands": 3, "volume_mm3": 172_630.0},
                "left_out_specks": {"islands": 1, "volume_mm3": 0.5},
            },
            ["Scanner's table left out (172.63 cm³)", "1 speck left out (0.5 mm³)"],
        ),
        ({"filled_holes": 2, "left_holes": 0}, ["2 holes filled"]),
        ({"filled_holes": 1, "left_holes": 1200}, ["1 hole filled, 1,200 left"]),
    ],
)
def test_after_care_is_told(report: dict[str, Any], lines: list[str]) -> None:
    assert after_care_lines(NOTHING | report) == lines


def test_only_what_was_left_out_or_done_is_kept() -> None:
    table = {"islands": 1, "volume_mm3": 7.0}
    nothing = {"after_care": None, "left_out_table": None, "left_out_specks": None}
    assert of_rendering(nothing) is None
    assert of_rendering(nothing | {"left_out_table": table}) == {
        "left_out_table": table
    }
    assert of_rendering(nothing | {"after_care": NOTHING}) == NOTHING


def test_volumes_have_the_unit_that_keeps_them_short() -> None:
    assert volume_text(999.94) == "999.9 mm³"
    assert volume_text(1000.0) == "1.00 cm³"
    assert volume_text(697_123.0) == "697.12 cm³"


def test_what_cannot_be_measured_is_not_told_as_zero() -> None:
    opened = {
        "bounds_mm": [[0.0, 0.0, 0.0], [10.0, 20.0, 30.5]],
        "watertight": False,
        "volume_mm3": 17.0,
        "triangles": 1,
        "components": 1,
        "thinnest_wall_mm": None,
        "wall_5_percent_mm": None,
    }
    assert check_lines(opened) == [
        "Size: 10 x 20 x 30.5 mm",
        "1 triangle in 1 shell",
        "Walls: not measured, the surface encloses no volume",
    ]


@pytest.mark.parametrize(
    ("report", "said"),
    [
        ({"printable": True, "thinnest_wall_mm": 1.2}, "Printable"),
        ({"printable": True, "thinnest_wall_mm": None}, "Printable"),
        (
            {"printable": True, "thinnest_wall_mm": 0.06},
            "Printable, but for walls below 0.4 mm",
        ),
        ({"printable": False, "thinnest_wall_mm": 0.06}, "Not printable"),
    ],
)
def test_the_verdict_names_walls_that_most_printers_cannot_make(
    report: dict[str, Any], said: str
) -> None:
    assert verdict(report) == said
