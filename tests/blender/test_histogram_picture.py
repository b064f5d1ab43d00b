"""The histogram's picture shows counts, the threshold and what is above it (needs no Blender)."""

import numpy as np

from blender_addon.preview import histogram_picture as picture


def bars() -> np.ndarray:
    counts = np.array([1_000_000, 0, 50_000, 2_000], dtype=np.uint64)
    return picture.heights(counts, np.array([-1100.0, -500.0, 0.0, 500.0, 1500.0]))


def colours(drawn: np.ndarray) -> set[tuple[int, ...]]:
    return {tuple(int(c) for c in pixel) for pixel in drawn.reshape(-1, 4)}


def test_the_most_frequent_value_is_the_highest_bar() -> None:
    heights = bars()
    assert heights[0] == heights.max() == 1.0
    assert heights[picture.column(-250.0)] == 0.0
    assert 0.0 < heights[picture.column(1000.0)] < heights[picture.column(250.0)] < 1.0
    assert heights[picture.column(3000.0)] == 0.0


def test_what_is_above_the_threshold_has_the_colour_of_bone() -> None:
    drawn = picture.drawn(bars(), 250.0, [])
    below, above = (drawn[0, picture.column(hu)] for hu in (100.0, 1000.0))
    assert tuple(below) == picture.BAR
    assert tuple(above) == picture.BONE_BAR
    assert tuple(drawn[-1, picture.column(250.0)]) == picture.THRESHOLD


def test_the_threshold_and_the_suggestions_are_lines_within_the_picture() -> None:
    for hu in (-9000.0, -1024.0, 350.0, 3071.0, 9000.0):
        assert picture.THRESHOLD in colours(picture.drawn(bars(), hu, []))
    drawn = picture.drawn(bars(), 0.0, [(350.0, True), (9000.0, False)])
    assert tuple(drawn[0, picture.column(350.0)]) == picture.RECOMMENDED
    assert tuple(drawn[0, -1]) == picture.SUGGESTED


def test_an_empty_histogram_is_a_picture_without_bars() -> None:
    empty = picture.heights(np.array([], dtype=np.uint64), np.array([0.0]))
    drawn = picture.drawn(empty, 350.0, [])
    assert drawn.shape == (picture.SIDE, picture.SIDE, 4)
    assert colours(drawn) == {picture.PAPER, picture.THRESHOLD}
