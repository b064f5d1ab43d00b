"""A user's hand: the mouse and the keyboard, as events that Blender cannot tell from real ones."""

from __future__ import annotations

import itertools
from typing import Any

import bpy
from waiting import Steps, ticks

DRAG_PX = 20  # from one event of a drag to the next


class Hand:
    """Moves, clicks, drags and types in one of Blender's windows; places are pixels from its bottom left."""

    def __init__(self, window: Any) -> None:
        self.window = window
        self._pointer = window.as_pointer()
        self.place = (0, 0)

    def event(self, kind: str, value: str, **more: Any) -> None:
        """One event where the mouse is; AssertionError when the window is gone, which Blender would die of."""
        windows = bpy.context.window_manager.windows
        assert self._pointer in [window.as_pointer() for window in windows], (
            "the window was closed"
        )
        x, y = self.place
        self.window.event_simulate(type=kind, value=value, x=x, y=y, **more)

    def move(self, x: int, y: int) -> Steps:
        """The mouse to a place."""
        self.place = (int(x), int(y))
        self.event("MOUSEMOVE", "NOTHING")
        yield from ticks(2)

    def click(self, button: str = "LEFTMOUSE") -> Steps:
        """A click where the mouse is."""
        yield from self.press(button)

    def press(self, key: str, **held: bool) -> Steps:
        """A key or a mouse button, pressed and let go."""
        self.event(key, "PRESS", **held)
        yield
        self.event(key, "RELEASE", **held)
        yield from ticks(2)

    def type(self, text: str) -> Steps:
        """Text into the field that is being edited, in place of what it holds."""
        yield from self.press("A", ctrl=True)
        for letter in text:
            self.event("A", "PRESS", unicode=letter)
            yield
            self.event("A", "RELEASE")
        yield

    def drag(self, path: list[tuple[int, int]]) -> Steps:
        """Along the corners of a path with the left button pressed."""
        yield from self.move(*path[0])
        self.event("LEFTMOUSE", "PRESS")
        yield from ticks(2)
        for (x0, y0), (x1, y1) in itertools.pairwise(path):
            steps = max(1, round(max(abs(x1 - x0), abs(y1 - y0)) / DRAG_PX))
            for step in range(1, steps + 1):
                self.place = (
                    x0 + (x1 - x0) * step // steps,
                    y0 + (y1 - y0) * step // steps,
                )
                self.event("MOUSEMOVE", "NOTHING")
                yield
        self.event("LEFTMOUSE", "RELEASE")
        yield from ticks(2)
