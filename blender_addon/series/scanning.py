# SPDX-License-Identifier: GPL-3.0-or-later
"""When the CT images of a scene are scanned, and the timer that shows how far it is.

A choice (a folder picked or typed, a setting changed, the button Look Again) scans at once and
replaces the scan that runs. The panel, which also meets folders that nobody chose just now (a file
was opened, a step undone, another scene shown), asks for a scan only where none is known and none
runs: two windows with two scenes then wait for each other instead of cancelling each other.
"""

from __future__ import annotations

import logging
from typing import Any

import bonemesh
import bpy

from ..views import window
from . import scans
from .scans import FolderScan, Request

TICK_S = 0.1
PATIENCE_S = 5.0  # as for a job

# Without a window nobody looks, no timer ever fires, and a script scans when it wants to know.
is_watched = not bpy.app.background

log = logging.getLogger(__name__)


def request_of(properties: Any) -> Request | None:
    """What is to be scanned for `scene.bonemesh`."""
    path = bpy.path.abspath(properties.ct_directory)
    return Request.of(path, one_series=properties.one_series)


def begin(properties: Any) -> FolderScan | None:
    """Scans for a choice that was just made; None where no folder is chosen."""
    request = request_of(properties)
    return None if request is None else _start(request)


def shown(properties: Any) -> FolderScan | None:
    """The scan for the panel, begun if need be; None where there is no folder, or another scan runs."""
    request = request_of(properties)
    if request is None:
        return None
    scan = scans.known(request)
    if scan is None and not scans.running():
        scan = _start(request)
    return scan


def marked_choice(properties: Any) -> int | str | None:
    """The series that the panel marks, once the scan has ended, as the library wants it named."""
    request = request_of(properties)
    scan = None if request is None else scans.known(request)
    return None if scan is None else scan.choice(properties.series)


def marked_series(properties: Any) -> bonemesh.Series | None:
    """What is known of the series that the panel marks, once the scan has ended."""
    request = request_of(properties)
    scan = None if request is None else scans.known(request)
    return None if scan is None else scan.chosen(properties.series)


def has_failed(properties: Any) -> bool:
    """Whether the chosen images were looked at and cannot be rendered: none are there, or no series is meant."""
    request = request_of(properties)
    scan = None if request is None else scans.known(request)
    if scan is None or scan.job.is_running():
        return False
    return scan.contents is None or scan.chosen(properties.series) is None


def may_hold(properties: Any, uid: str) -> bool:
    """Whether the chosen images may hold the series: False only where they were looked at and do not."""
    request = request_of(properties)
    scan = None if request is None else scans.known(request)
    contents = None if scan is None else scan.contents
    return contents is None or any(series.uid == uid for series in contents.series)


def stop() -> None:
    """Ends every scan and the timer: neither may outlive the add-on or Blender."""
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    if not scans.stop_all(PATIENCE_S):
        log.warning("Bonemesh: a scan did not stop within %s s", PATIENCE_S)


def _start(request: Request) -> FolderScan:
    scan = FolderScan(request)
    scan.job.start_beside()
    scans.keep(scan)
    if is_watched and not bpy.app.timers.is_registered(_tick):
        # Persistent: opening another file must not leave the panel without news.
        bpy.app.timers.register(_tick, first_interval=TICK_S, persistent=True)
    return scan


def _tick() -> float | None:
    still_running = bool(scans.running())
    window.redraw_views(bpy.context)
    return TICK_S if still_running else None
