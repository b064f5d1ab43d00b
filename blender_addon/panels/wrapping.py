# SPDX-License-Identifier: GPL-3.0-or-later
"""Text broken into lines of a given width. Knows no bpy."""

from collections.abc import Callable


def fitting_lines(
    text: str, width: float, measure: Callable[[str], float]
) -> list[str]:
    """`text` in lines no wider than `width` by `measure`; a word that is wider is broken."""
    lines: list[str] = []
    line = ""
    for word in text.split():
        longer = f"{line} {word}" if line else word
        if measure(longer) <= width:
            line = longer
            continue
        if line:
            lines.append(line)
        while measure(word) > width and len(word) > 1:
            fits = fitting_letters(word, width, measure)
            lines.append(word[:fits])
            word = word[fits:]
        line = word
    return [*lines, line] if line else lines


def fitting_letters(word: str, width: float, measure: Callable[[str], float]) -> int:
    """How many of the first letters of `word` are no wider than `width`; at least one."""
    fits = 1
    while fits < len(word) and measure(word[: fits + 1]) <= width:
        fits += 1
    return fits
