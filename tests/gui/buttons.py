"""Finds buttons and fields by what they do, wherever a panel shows them.

The mouse goes down a region, and Blender itself says what is under it: the operator of a button (its
"Copy Python Command") or the property of a field ("Copy Full Data Path"). So a panel may be laid out
anew, scrolled or widened, and a button is still found.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

import bpy
from hand import Hand
from waiting import Steps, ticks

ROW_PX = 14  # less than a row's height
COLUMNS = (
    0.3,
    0.8,
    0.06,
    0.93,
)  # a row may be split, or begin or end with a small button
MOST_TURNS = 12
WHEEL_CLICKS = 6
EDGE_PX = 3
UNFOLDING = (
    60  # ticks in which a part of a panel has unfolded, and hears the next click
)


class Region:
    """One region of a window, such as the sidebar of the 3D view."""

    def __init__(self, window: Any, area: Any, kind: str) -> None:
        self.window, self.area, self.kind = window, area, kind
        self.hand = Hand(window)
        self._places: dict[str, tuple[int, int]] = {}

    @property
    def region(self) -> Any:
        """Blender's region, which it makes anew now and then."""
        return next(r for r in self.area.regions if r.type == self.kind)

    def under_mouse(self) -> str:
        """What the button or field under the mouse does; empty where there is none."""
        manager = bpy.context.window_manager
        manager.clipboard = ""
        with bpy.context.temp_override(
            window=self.window, area=self.area, region=self.region
        ):
            if bpy.ops.ui.copy_python_command_button.poll():
                bpy.ops.ui.copy_python_command_button()
            elif bpy.ops.ui.copy_data_path_button.poll():
                bpy.ops.ui.copy_data_path_button(full_path=True)
        return manager.clipboard

    def find(self, name: str) -> Steps:
        """Puts the mouse on the first thing whose operator or property contains `name`; AssertionError where none has."""
        if name in self._places:
            yield from self.hand.move(*self._places[name])
            if name in self.under_mouse():
                return
        looks: list[list[str]] = []
        while len(looks) < MOST_TURNS:
            looks.append((yield from self._look_for(name)))
            if looks[-1] and name in looks[-1][-1]:
                self._places[name] = self.hand.place
                return
            if len(looks) > 2 and set(looks[-1]) == set(looks[-2]):
                break  # the region's end
            # First as the region stands, then from its top on.
            if len(looks) == 1:
                yield from self.turn("WHEELUPMOUSE", MOST_TURNS * WHEEL_CLICKS)
            else:
                yield from self.turn("WHEELDOWNMOUSE", WHEEL_CLICKS)
        there = ", ".join(dict.fromkeys(text for look in looks for text in look))
        raise AssertionError(
            f"{name} is not in the {self.kind} region; there are: {there}"
        )

    def _look_for(self, name: str) -> Generator[None, None, list[str]]:
        """What the mouse meets in the region, as far as the first `name`."""
        region = self.region
        rows = range(region.y + region.height - EDGE_PX, region.y + EDGE_PX, -ROW_PX)
        # Panels are gone through from top to bottom: what is wanted next is mostly further down.
        rows = sorted(rows, key=lambda y: (y > self.hand.place[1], -y))
        met: list[str] = []
        for column in COLUMNS:
            for y in rows:
                yield from self.hand.move(region.x + column * region.width, y)
                found = self.under_mouse()
                if found and found not in met:
                    met.append(found)
                if name in found:
                    met.append(found)
                    return met
        return met

    def shows(self, name: str) -> Generator[None, None, bool]:
        """Whether such a thing is in sight, without scrolling."""
        met = yield from self._look_for(name)
        return bool(met) and name in met[-1]

    def unfold(self, name: str) -> Steps:
        """Opens the folded part of a panel that begins with `name`, by a click on its header; the lowest are tried first."""
        yield from self.turn("WHEELDOWNMOUSE", MOST_TURNS * WHEEL_CLICKS)
        region = self.region
        x, y = region.x + COLUMNS[0] * region.width, region.y + ROW_PX
        while y < region.y + region.height:
            yield from self.hand.move(x, y)
            is_header = not self.under_mouse()
            if is_header:
                yield from self.hand.click()
                yield from ticks(UNFOLDING)
                # A field's own name may stand to its left.
                right = region.x + COLUMNS[1] * region.width
                for below in range(y - ROW_PX, y - 6 * ROW_PX, -ROW_PX // 2):
                    yield from self.hand.move(right, max(below, region.y + EDGE_PX))
                    if name in self.under_mouse():
                        return
                yield from self.hand.move(x, y)
                yield from self.hand.click()
                yield from ticks(UNFOLDING)
            y += 2 * ROW_PX if is_header else ROW_PX
        raise AssertionError(f"no header in the {self.kind} region unfolds {name}")

    def turn(self, wheel: str, clicks: int) -> Steps:
        """Turns the mouse wheel in the middle of the region."""
        region = self.region
        yield from self.hand.move(
            region.x + region.width // 3, region.y + region.height // 2
        )
        for _ in range(clicks):
            self.hand.event(wheel, "PRESS")
            yield
        yield from ticks(2)

    def click(self, name: str) -> Steps:
        """Presses the button."""
        yield from self.find(name)
        yield from self.hand.click()

    def fill(self, name: str, text: str) -> Steps:
        """Types `text` into the text field and confirms it."""
        yield from self.click(name)
        yield from self.hand.type(text)
        yield from self.hand.press("RET")

    def set_number(self, name: str, number: float) -> Steps:
        """Types a number into the field, in which a click alone would begin to drag."""
        yield from self.find(name)
        yield from self.hand.press("RET")
        yield from self.hand.type(f"{number:g}")
        yield from self.hand.press("RET")
