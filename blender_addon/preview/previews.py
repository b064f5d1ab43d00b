# SPDX-License-Identifier: GPL-3.0-or-later
"""The chosen series, read once beside the main thread: coarse surfaces of it, histogram, thresholds. Knows no bpy."""

from __future__ import annotations

import threading
from typing import Any, NamedTuple

import bonemesh

from ..jobs.job import Job
from ..scene.mesh_edges import Edges, edges_of

KEPT = 4  # finished readings, a few MB each: to go back to another series without reading it again
BIN_HU = 10


class SeriesRequest(NamedTuple):
    """Which series is read, as the library wants it named."""

    path: str
    one_series: bool
    series: int | str


class Reading:
    """What is kept of one series; each part is there as soon as it is known."""

    def __init__(self, request: SeriesRequest) -> None:
        self.request = request
        self.preview: bonemesh.Preview | None = None
        self.suggestions: list[dict[str, Any]] = []
        self.histogram: bonemesh.Histogram | None = None
        """Comes last."""
        self.error: BaseException | None = None
        self.job = Job("Preview", self._work)

    def _work(self, job: Job) -> None:
        watched = {"progress": job.note_progress, "cancel": job.cancel_token}
        try:
            volume = bonemesh.read_series(
                self.request.path,
                self.request.series,
                one_series=self.request.one_series,
                **watched,
            )
            self.preview = bonemesh.Preview(volume, **watched)
            self.suggestions = bonemesh.suggest_thresholds(volume, **watched)
            self.histogram = bonemesh.histogram(volume, bin_hu=BIN_HU, **watched)
        except BaseException as error:  # noqa: BLE001 - kept for the panel, which shows it
            self.error = error


class Wanted(NamedTuple):
    """Which coarse surface is to be seen."""

    series: SeriesRequest
    threshold_hu: int
    crop: str | None


class Surface(NamedTuple):
    """A coarse surface, or why there is none."""

    wanted: Wanted
    mesh: bonemesh.Mesh | None
    edges: Edges | None
    error: BaseException | None


class SurfaceWorker:
    """Makes coarse surfaces one after the other; of those asked for meanwhile only the newest.

    What is being made is not stopped by a newer wish: else nothing would be seen as long as the
    slider moves.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._pending: tuple[bonemesh.Preview, Wanted] | None = None
        self._newest: Surface | None = None
        self._asked: Wanted | None = None
        self._thread: threading.Thread | None = None
        self._cancel = bonemesh.Cancel()

    @property
    def asked(self) -> Wanted | None:
        """What was asked for last."""
        return self._asked

    def ask(self, preview: bonemesh.Preview, wanted: Wanted) -> None:
        """Returns at once; `take` gives the surface when it is made."""
        with self._lock:
            self._asked = wanted
            self._pending = (preview, wanted)
            if self._thread is None:
                self._cancel = bonemesh.Cancel()
                self._thread = threading.Thread(
                    target=self._run,
                    args=(self._cancel,),
                    name="bonemesh preview",
                    daemon=True,
                )
                self._thread.start()

    def take(self) -> Surface | None:
        """The newest surface that was made since the last call."""
        with self._lock:
            newest, self._newest = self._newest, None
            return newest

    def forget(self) -> None:
        """Drops what is pending or made, and stops what is being made."""
        with self._lock:
            self._asked = self._pending = self._newest = None
            self._cancel.cancel()

    def stop(self, timeout_s: float) -> bool:
        """Does so and waits; False when the thread is still at work after `timeout_s`."""
        self.forget()
        thread = self._thread
        if thread is None:
            return True
        thread.join(timeout_s)
        return not thread.is_alive()

    def _run(self, cancel: bonemesh.Cancel) -> None:
        while True:
            with self._lock:
                if self._pending is None:
                    self._thread = None
                    return
                preview, wanted = self._pending
                self._pending = None
                if cancel.is_cancelled:
                    self._cancel = cancel = bonemesh.Cancel()
            mesh = edges = error = None
            try:
                mesh = preview.surface(
                    wanted.threshold_hu, crop=wanted.crop, cancel=cancel
                )
                edges = edges_of(mesh.triangles, len(mesh.vertices))
            except BaseException as raised:  # noqa: BLE001 - kept for the panel, which shows it
                error = raised
            with self._lock:
                if not cancel.is_cancelled:
                    self._newest = Surface(wanted, mesh, edges, error)


_readings: dict[SeriesRequest, Reading] = {}
_replaced: list[Reading] = []
worker = SurfaceWorker()


def known(request: SeriesRequest) -> Reading | None:
    """The reading of `request`, running or ended."""
    return _readings.get(request)


def running() -> list[Reading]:
    """The readings that are at work and still wanted."""
    return [reading for reading in _readings.values() if reading.job.is_running()]


def begin(request: SeriesRequest) -> Reading:
    """Reads a series on a worker thread; whatever else is being read is stopped and dropped."""
    for other in running():
        other.job.cancel()
        _replaced.append(_readings.pop(other.request))
    _replaced[:] = [old for old in _replaced if old.job.is_running()]
    reading = Reading(request)
    _readings.pop(request, None)
    _readings[request] = reading
    reading.job.start_beside()
    for old in tuple(_readings)[:-KEPT]:
        del _readings[old]
    return reading


def forget(path: str) -> None:
    """Drops what is kept of a folder or file that is looked at anew."""
    for request in [r for r in _readings if r.path == path]:
        reading = _readings.pop(request)
        reading.job.cancel()
        _replaced.append(reading)


def stop_all(timeout_s: float) -> bool:
    """Stops and forgets everything and waits; False when something is still at work after `timeout_s`."""
    stopping = [*_replaced, *_readings.values()]
    _readings.clear()
    _replaced.clear()
    for reading in stopping:
        reading.job.cancel()
    ended = [reading.job.wait(timeout_s) for reading in stopping]
    return worker.stop(timeout_s) and all(ended)
