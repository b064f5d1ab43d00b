"""Where the story takes place: Blender's window, the add-on in it, folders, and a camera."""

from __future__ import annotations

import json
import time
from collections.abc import Generator
from importlib import import_module
from pathlib import Path
from typing import Any

import bpy
from buttons import Region
from screen import Camera, Rectangle, rectangle
from waiting import Steps, wait_until

MODULE = "bl_ext.user_default.bonemesh"
TAB = "Segment CT"


class Desk:
    """What the steps of the story share."""

    def __init__(self, zip_path: Path, out: Path) -> None:
        self.zip, self.out = zip_path, out
        self.camera = Camera(out)
        self.ct = Path.home() / "head CT"
        self.meshes = Path.home() / "meshes"
        self.longest_pause_s = 0.0
        """The longest time that the window did not react, since `begin_watching`."""
        self.progress: list[Any] = []
        """What the running job said of its progress since then, once each."""
        self.figures: dict[str, float] = {}
        self._last_tick = time.monotonic()
        self._sidebar: Region | None = None
        self._canvas: Region | None = None

    # The window.

    @property
    def window(self) -> Any:
        """Blender's first window."""
        return bpy.context.window_manager.windows[0]

    @property
    def view(self) -> Any:
        """The area of the 3D view."""
        return next(a for a in self.window.screen.areas if a.type == "VIEW_3D")

    @property
    def sidebar(self) -> Region:
        """The sidebar of the 3D view, with the add-on's tab."""
        if self._sidebar is None:
            self._sidebar = Region(self.window, self.view, "UI")
        return self._sidebar

    @property
    def canvas(self) -> Region:
        """The 3D view itself."""
        if self._canvas is None:
            self._canvas = Region(self.window, self.view, "WINDOW")
        return self._canvas

    def to_the_middle(self) -> Steps:
        """The mouse to the middle of what is seen of the view, where keys are the view's."""
        left, _, width, _ = self.parts()["view"]
        region = self.canvas.region
        x, y = left + width // 2, region.y + region.height // 2
        yield from self.canvas.hand.move(x, y)

    def parts(self) -> dict[str, Rectangle]:
        """Where things are in a picture that is taken now; the view without what lies over it."""
        left, top, width, height = rectangle(self.window, self.view)
        panel = rectangle(self.window, self.sidebar.region)
        parts = {"area": (left, top, width, height)}
        if panel[2] > 1:
            parts["panel"] = panel
            width = panel[0] - left
        # Below the headers, right of the tools, left of the sidebar and of the axes above it.
        parts["view"] = (left + 60, top + 130, width - 60, height - 150)
        return parts

    def picture(self, name: str) -> Generator[None, None, Path]:
        """A picture of the screen as it is."""
        file = yield from self.camera.take(name, self.parts())
        self.write("parts.json", self.camera.parts)
        return file

    def begin_watching(self) -> None:
        """Forgets the pauses and the progress so far."""
        self.longest_pause_s = 0.0
        self.progress = []

    def watch(self) -> None:
        """Called at every tick."""
        now = time.monotonic()
        self.longest_pause_s = max(self.longest_pause_s, now - self._last_tick)
        self._last_tick = now
        job = self.running() if hasattr(bpy.types.Scene, "bonemesh") else None
        if job is not None and job.progress not in self.progress[-1:]:
            self.progress.append(job.progress)

    def note_figure(self, name: str, figure: float) -> None:
        """What was measured on the way."""
        self.figures[name] = round(figure, 3)
        self.write("figures.json", self.figures)

    # The add-on.

    def module(self, name: str) -> Any:
        """One of the add-on's modules."""
        return import_module(f"{MODULE}.{name}")

    @property
    def properties(self) -> Any:
        """`scene.bonemesh`."""
        return self.window.scene.bonemesh

    def running(self) -> Any:
        """The job that runs, if any."""
        return self.module("jobs.job").running()

    def until_done(self, patience_s: float = 60.0) -> Steps:
        """Waits for the end of the job that runs, and for what becomes of its result."""
        watches = self.module("operators.background").watches
        yield from wait_until(
            lambda: not watches and self.running() is None,
            "the job ends",
            patience_s,
        )

    def messages(self) -> str:
        """Everything that Blender has told its user so far, as its Info editor lists it."""
        area = next(a for a in self.window.screen.areas if a.type != "VIEW_3D")
        kind, area.type = area.type, "INFO"
        try:
            region = next(r for r in area.regions if r.type == "WINDOW")
            with bpy.context.temp_override(
                window=self.window, area=area, region=region
            ):
                bpy.ops.info.select_all(action="SELECT")
                bpy.ops.info.report_copy()
        finally:
            area.type = kind
        return bpy.context.window_manager.clipboard

    # Files.

    def write(self, name: str, content: Any) -> None:
        """A JSON file beside the pictures."""
        (self.out / name).write_text(json.dumps(content, indent=1), encoding="utf-8")
