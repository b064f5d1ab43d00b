# SPDX-License-Identifier: GPL-3.0-or-later
"""What folders and files of CT images hold: read beside the main thread, kept until Blender ends. Knows no bpy."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import bonemesh

from ..jobs.job import Job
from ..request.inputs import series_choice

KEPT = 16  # finished scans: so that undo and other scenes need no second one


class Request(NamedTuple):
    """What is to be scanned, and how; the path is absolute, the same for every way to write it."""

    path: str
    one_series: bool

    @classmethod
    def of(cls, path: str, *, one_series: bool) -> Request | None:
        """None where no path is given."""
        return cls(str(Path(path)), one_series) if path.strip() else None


class FolderScan:
    """One look at a folder or file, running or ended."""

    def __init__(self, request: Request) -> None:
        self.request = request
        self.contents: bonemesh.Scan | None = None
        """What was found, once the scan has ended well."""
        self.error: BaseException | None = None
        """Why nothing was found, once the scan has ended otherwise."""
        self.job = Job("Scan", self._work)

    def run_here(self) -> bonemesh.Scan:
        """Scans on the calling thread; raises what stands against it."""
        self._work(self.job)
        if self.error is not None:
            raise self.error
        return self.contents

    def chosen(self, series: str) -> bonemesh.Series | None:
        """The one series that `scene.bonemesh.series` names; where that is empty, the recommended one."""
        if self.contents is None:
            return None
        choice = series_choice(series)
        if choice is None:
            choice = self.contents.recommended
        named = [s for s in self.contents.series if choice in (s.number, s.uid)]
        return named[0] if len(named) == 1 else None

    def choice(self, series: str) -> int | str | None:
        """How to name the chosen series to the library; None where there is none.

        By its UID if that tells it apart: files that come or go meanwhile change the numbers.
        """
        chosen = self.chosen(series)
        if chosen is None:
            return None
        has_own_uid = chosen.uid and self.chosen(chosen.uid) is chosen
        return chosen.uid if has_own_uid else chosen.number

    def _work(self, job: Job) -> None:
        try:
            contents = bonemesh.scan(
                self.request.path,
                one_series=self.request.one_series,
                progress=job.note_progress,
                cancel=job.cancel_token,
            )
            job.stop_if_cancelled()
            self.contents = contents
        except BaseException as error:  # noqa: BLE001 - kept for the panel, which shows it
            self.error = error


_scans: dict[Request, FolderScan] = {}
_replaced: list[FolderScan] = []


def known(request: Request) -> FolderScan | None:
    """The newest scan of `request`, running or ended."""
    return _scans.get(request)


def running() -> list[FolderScan]:
    """The scans whose worker threads are at work and whose results are still wanted."""
    return [scan for scan in _scans.values() if scan.job.is_running()]


def keep(scan: FolderScan) -> None:
    """Makes `scan` the one that is known of its request; whatever runs is cancelled, its result dropped."""
    for other in running():
        other.job.cancel()
        _replaced.append(_scans.pop(other.request))
    _scans.pop(scan.request, None)
    _scans[scan.request] = scan
    _replaced[:] = [old for old in _replaced if old.job.is_running()]
    for request in tuple(_scans)[:-KEPT]:
        del _scans[request]


def forget() -> None:
    """Forgets what ended scans found: it is looked at again where it is shown."""
    for request, scan in tuple(_scans.items()):
        if not scan.job.is_running():
            del _scans[request]


def stop_all(timeout_s: float) -> bool:
    """Cancels and forgets every scan and waits; False when one is still at work after `timeout_s`."""
    stopping = [*_replaced, *_scans.values()]
    _scans.clear()
    _replaced.clear()
    for scan in stopping:
        scan.job.cancel()
    return all(scan.job.wait(timeout_s) for scan in stopping if scan.job.is_running())
