# SPDX-License-Identifier: GPL-3.0-or-later
"""What the long operators share: blocking when a script calls, beside the window when a button does.

An operator says in `prepare` what is to be calculated and in `finish` what becomes of the result.
`execute` does one after the other. `invoke` starts a worker thread and a timer; at each tick `step`
looks at the thread, and after its end calls `finish` on the main thread, where Blender allows it.
"""

from __future__ import annotations

import logging
from contextlib import AbstractContextManager, nullcontext
from typing import Any

import bonemesh
import bpy

from ..jobs import last_messages
from ..jobs.job import BusyError, Job, refuse_while_running
from ..jobs.job import stop as stop_job
from ..jobs.messages import EXPECTED, one_line
from ..views import window
from .step import Step

TICK_S = 0.1
PATIENCE_S = (
    5.0  # a cancelled job ends within 0.2 s; a busy disk may hold it a little longer
)

log = logging.getLogger(__name__)


class Watch:
    """A started job with the timer that makes Blender look at it."""

    def __init__(self, job: Job, context: Any) -> None:
        self.job = job
        self._timer = context.window_manager.event_timer_add(
            TICK_S, window=context.window
        )
        watches.append(self)

    def close(self, context: Any) -> None:
        """Takes the timer and the text in the status bar away."""
        if self in watches:
            self._forget(context)
            window.clear_status(context)
            window.redraw_views(context)

    def close_with_window(self, context: Any) -> None:
        """The same where Blender is about to free the window: until it has, nothing may be asked of that."""
        if self in watches:
            self._forget(context)
            window.clear_status_soon()

    def _forget(self, context: Any) -> None:
        watches.remove(self)
        context.window_manager.event_timer_remove(self._timer)


watches: list[Watch] = []


def stop_all(context: Any) -> None:
    """Cancels the running job and removes its timer: when the add-on is disabled or Blender ends."""
    if not stop_job(PATIENCE_S):
        log.warning("Bonemesh: the running job did not stop within %s s", PATIENCE_S)
    for watch in tuple(watches):
        watch.close(context)


class BackgroundOperator(Step):
    """Mixed into an operator that has `prepare` and `finish`."""

    is_pressed = False
    """Whether a button in a window began it, so that the user sees the panel."""

    @classmethod
    def missing(cls, context: Any) -> str | None:
        """Needs the job before it to have ended."""
        try:
            refuse_while_running()
        except BusyError as busy:
            return str(busy)
        return super().missing(context)

    def prepare(self, context: Any) -> Job:
        """Checks the request, reads what is needed from Blender and says what is to be calculated."""
        raise NotImplementedError

    def finish(self, context: Any, result: Any) -> str:
        """Puts the result into the scene; returns what is said of it."""
        raise NotImplementedError

    def execute(self, context: Any) -> set[str]:
        """Does everything before it returns."""
        try:
            refuse_while_running()
            last_messages.clear()
            job = self.prepare(context)
            with window.CursorProgress(context) as cursor:
                job.on_progress = cursor.show
                result = job.run_here()
            message = self.finish(context, result)
        except bonemesh.Cancelled:
            return self._stopped()
        except EXPECTED as error:
            return self._failed(error)
        self.say("INFO", message)
        return {"FINISHED"}

    def invoke(self, context: Any, _event: Any) -> set[str]:
        """Starts the work beside the window; without a window, as `execute`."""
        if context.window is None:
            return self.execute(context)
        self.is_pressed = True
        try:
            refuse_while_running()
            last_messages.clear()
            job = self.prepare(context)
            job.start()
        except EXPECTED as error:
            return self._failed(error)
        self._scene = context.scene.name
        self._watch = Watch(job, context)
        context.window_manager.modal_handler_add(self)
        window.show_status(context, status_text(job))
        window.redraw_views(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: Any, event: Any) -> set[str]:
        """Lets every event through but Esc, which cancels, and looks at the job at each tick."""
        if event.type == "ESC" and event.value == "PRESS":
            self._watch.job.cancel()
            return {"RUNNING_MODAL"}
        if event.type == "TIMER":
            return self.step(context)
        return {"PASS_THROUGH"}

    def step(self, context: Any) -> set[str]:
        """Shows how far the job is or, after its end, takes its result."""
        job = self._watch.job
        if job.is_running():
            window.show_status(context, status_text(job))
            window.redraw_views(context)
            return {"PASS_THROUGH"}
        self._watch.close(context)
        try:
            with in_scene(context, self._scene):
                message = self.finish(context, job.result())
        except bonemesh.Cancelled:
            return self._stopped()
        except Exception as error:
            if not isinstance(error, EXPECTED):
                log.exception("Bonemesh: %s ended unexpectedly", job.title)
            return self._failed(error)
        self.say("INFO", message)
        return {"FINISHED"}

    def cancel(self, context: Any) -> None:
        """Called by Blender when it ends the operator itself: another file, a closed window."""
        self._watch.job.cancel()
        self._watch.close_with_window(context)

    def say(self, kind: str, text: str) -> None:
        """Reports, and keeps for the panel."""
        last_messages.say(kind, text)
        self.report({kind}, text)

    def _stopped(self) -> set[str]:
        self.say("INFO", "Stopped; nothing was kept")
        return {"CANCELLED"}

    def _failed(self, error: BaseException) -> set[str]:
        self.say("ERROR", one_line(error))
        return {"CANCELLED"}


def in_scene(context: Any, name: str) -> AbstractContextManager[Any]:
    """The scene that a job was begun in, as long as it is there: the user may look at another one now."""
    scene = bpy.data.scenes.get(name)
    if scene is None or scene == context.scene:
        return nullcontext()
    override: AbstractContextManager[Any] = context.temp_override(
        scene=scene, view_layer=scene.view_layers[0]
    )
    return override


def status_text(job: Job) -> str:
    """One line for the status bar."""
    left = f", {job.time_left}" if job.time_left else ""
    return f"{job.title}: {job.progress.stage} {job.progress.fraction:.0%}{left}   (Esc cancels)"
