# SPDX-License-Identifier: GPL-3.0-or-later
"""Saving what was calculated: what cannot be written is in the scene all the same."""

from pathlib import Path

import bonemesh

from ..jobs.job import Job
from ..jobs.messages import EXPECTED, one_line


def save(mesh: bonemesh.Mesh, output: Path, job: Job) -> str | None:
    """Saves with its sidecar; returns why not, where that failed for another reason than a cancel."""
    job.stop_if_cancelled()
    try:
        mesh.save(
            output, sidecar=True, progress=job.note_progress, cancel=job.cancel_token
        )
    except bonemesh.Cancelled:
        raise
    except EXPECTED as error:
        return f"Not saved, but in the scene; Export saves it. {one_line(error)}"
    return None
