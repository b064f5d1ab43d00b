"""Text in panels is broken into lines that fit, and nothing of it is lost (needs no Blender)."""

import pytest

from blender_addon.panels.wrapping import fitting_lines

TEXT = (
    "1 slice is missing (after -1.50 mm along the stack); UID 2.25.6727711009569020663"
)


@pytest.mark.parametrize("width", range(1, 90))
def test_no_line_is_wider_and_nothing_is_lost(width: int) -> None:
    lines = fitting_lines(TEXT, width, len)
    assert all(0 < len(line) <= width for line in lines)
    assert "".join(lines).replace(" ", "") == TEXT.replace(" ", "")


def test_lines_are_broken_between_words_where_that_is_possible() -> None:
    assert fitting_lines("rows to the back", 8, len) == ["rows to", "the back"]
    assert fitting_lines("a 123456789", 4, len) == ["a", "1234", "5678", "9"]


def test_a_letter_that_is_too_wide_gets_a_line_of_its_own() -> None:
    assert fitting_lines("ab", 0.5, len) == ["a", "b"]


def test_no_text_is_no_line() -> None:
    assert fitting_lines("  ", 10, len) == []
