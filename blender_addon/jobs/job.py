# SPDX-License-Identifier: GPL-3.0-or-later
"""One long calculation, on a worker thread or in place, that can be watched and cancelled. Knows no bpy."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Generic, NamedTuple, TypeVar

import bonemesh

from .timeline import Timeline, left_text

T = TypeVar("T")


class BusyError(Exception):
    """Another job is still running."""


class Progress(NamedTuple):
    """How far a job is: the stage's name and the done part, 0 to 1, of the whole where the stages'
    weights are known and else of that stage."""

    stage: str
    fraction: float


class Job(Generic[T]):
    """`work` gets this job and hands its `note_progress` and `cancel_token` on to the library.

    The work must not touch Blender's data: it may run beside the main thread.
    """

    def __init__(
        self,
        title: str,
        work: Callable[[Job[T]], T],
        weights: Mapping[str, float] | None = None,
    ) -> None:
        """`weights`: of the stages in their order, where the usual part of the time is known."""
        self.title = title
        self._timeline = Timeline(weights) if weights else None
        self._begin_s = time.monotonic()
        self.cancel_token = bonemesh.Cancel()
        self.cancel_requested = False
        self.progress = Progress("starting", 0.0)
        self.on_progress: Callable[[Progress], None] | None = None
        self._work = work
        self._value: T | None = None
        self._error: BaseException | None = None
        # A daemon, so that a Blender that dies without saying goodbye does not wait for it.
        self._thread = threading.Thread(
            target=self._run, name=f"bonemesh {title}", daemon=True
        )

    def start(self) -> None:
        """Begins on a worker thread. Raises BusyError while another job is running."""
        global _current
        refuse_while_running()
        _current = self
        self._begin_s = time.monotonic()
        self._thread.start()

    def start_beside(self) -> None:
        """Begins on a worker thread, whatever else is running: for short work that needs no place of its own."""
        self._thread.start()

    def run_here(self) -> T:
        """Does the work on the calling thread. Raises BusyError while another job is running."""
        refuse_while_running()
        return self._work(self)

    @property
    def time_left(self) -> str:
        """In round numbers; empty where it is not known."""
        if self._timeline is None:
            return ""
        elapsed_s = time.monotonic() - self._begin_s
        return left_text(self._timeline.seconds_left(elapsed_s))

    def note_progress(self, stage: str, fraction: float) -> None:
        """Called by the library on the thread that does the work."""
        if self._timeline is not None:
            fraction = self._timeline.done(stage, fraction)
        self.progress = Progress(stage, fraction)
        if self.on_progress is not None:
            self.on_progress(self.progress)

    def stop_if_cancelled(self) -> None:
        """Raises bonemesh.Cancelled once `cancel` was called; for the gaps between library calls."""
        if self.cancel_requested:
            raise bonemesh.Cancelled("stopped on request")

    def cancel(self) -> None:
        """Asks the work to stop; it does so soon, at its next check."""
        self.cancel_requested = True
        self.cancel_token.cancel()

    def is_running(self) -> bool:
        """Whether the worker thread is at work."""
        return self._thread.is_alive()

    def wait(self, timeout_s: float | None = None) -> bool:
        """Waits for the worker thread; False when it is still at work after `timeout_s`."""
        self._thread.join(timeout_s)
        return not self.is_running()

    def result(self) -> T:
        """What the work returned; raises what it raised. Only after its end."""
        assert not self.is_running(), (
            "the result is asked for before the end: this is a bug"
        )
        if self._error is not None:
            raise self._error
        return self._value  # type: ignore[return-value]

    def _run(self) -> None:
        try:
            self._value = self._work(self)
        except BaseException as error:  # noqa: BLE001 - kept for the main thread, which raises it
            self._error = error


_current: Job | None = None


def running() -> Job | None:
    """The job whose worker thread is at work, if any."""
    return _current if _current is not None and _current.is_running() else None


def refuse_while_running() -> None:
    """Raises BusyError while a worker thread is at work."""
    job = running()
    if job is not None:
        raise BusyError(
            f"{job.title} is still running; wait for its end or press Cancel"
        )


def stop(timeout_s: float) -> bool:
    """Cancels the running job, if any, and waits; False when it is still at work after `timeout_s`."""
    job = running()
    if job is None:
        return True
    job.cancel()
    return job.wait(timeout_s)
