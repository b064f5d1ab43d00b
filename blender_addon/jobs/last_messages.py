# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last job said, for the panel: Blender's own pop-up goes when the mouse moves. Knows no bpy."""

from __future__ import annotations

from typing import NamedTuple


class Message(NamedTuple):
    """One line that was said."""

    kind: str
    """`INFO`, `WARNING` or `ERROR`, as Blender's reports."""
    text: str


messages: list[Message] = []


def say(kind: str, text: str) -> None:
    """Adds a line."""
    messages.append(Message(kind, text))


def clear() -> None:
    """Forgets them: another job begins, or another file."""
    messages.clear()
