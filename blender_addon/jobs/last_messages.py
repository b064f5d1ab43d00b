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
_said_at: dict[int, str] = {}
"""By an error's place in `messages` the step that was next when it was first shown."""


def of_step(step: str) -> list[Message]:
    """What still matters when `step` is next: an error is forgotten once the user has gone on."""
    return [
        message
        for place, message in enumerate(messages)
        if message.kind != "ERROR" or _said_at.setdefault(place, step) == step
    ]


def say(kind: str, text: str) -> None:
    """Adds a line."""
    messages.append(Message(kind, text))


def clear() -> None:
    """Forgets them: another job begins, or another file."""
    messages.clear()
    _said_at.clear()
