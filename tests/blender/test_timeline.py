"""Progress of the whole never goes back, and time left is told once it means something (needs no Blender)."""

import pytest

from blender_addon.jobs.timeline import Timeline, left_text


def test_stages_count_by_their_weights() -> None:
    timeline = Timeline({"read": 1.0, "edges": 2.0, "surface": 5.0})
    assert timeline.done("read", 0.5) == pytest.approx(1 / 16)
    assert timeline.done("edges", 0.0) == pytest.approx(1 / 8)
    assert timeline.done("surface", 0.2) == pytest.approx(4 / 8)
    assert timeline.done("surface", 1.0) == pytest.approx(1.0)


def test_what_comes_again_or_is_unknown_moves_nothing_back() -> None:
    timeline = Timeline({"read": 1.0, "surface": 1.0})
    assert timeline.done("surface", 0.5) == pytest.approx(0.75)
    assert timeline.done("read", 0.1) == pytest.approx(0.75)
    assert timeline.done("polish", 0.9) == pytest.approx(0.75)


def test_time_left_is_told_once_it_can_be() -> None:
    timeline = Timeline({"read": 1.0, "surface": 3.0})
    assert timeline.seconds_left(10.0) is None
    timeline.done("read", 0.2)
    assert timeline.seconds_left(10.0) is None
    timeline.done("surface", 0.0)
    assert timeline.seconds_left(1.0) is None
    assert timeline.seconds_left(10.0) == pytest.approx(30.0)


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (None, ""),
        (0.4, "a few seconds left"),
        (12.0, "about 10 s left"),
        (58.0, "about 60 s left"),
        (80.0, "about 90 s left"),
        (400.0, "about 7 min left"),
    ],
)
def test_time_left_is_in_round_numbers(seconds: float | None, text: str) -> None:
    assert left_text(seconds) == text
