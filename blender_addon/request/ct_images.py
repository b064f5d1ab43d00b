# SPDX-License-Identifier: GPL-3.0-or-later
"""What a chosen file stands for: a whole volume for itself, a slice for its folder. Knows no bpy."""

from __future__ import annotations

import os
from pathlib import Path

import bonemesh

MARK_AT, MARK = 128, b"DICM"
"""What a DICOM file says of itself after its preamble (PS3.10, section 7.1)."""


def folder_of_slice(path: str) -> str | None:
    """The folder of a file that is one slice of a series; None for folders, volumes and what is neither."""
    file = Path(path)
    is_slice = bool(path.strip()) and is_dicom(file) and not is_volume(file)
    return os.path.join(file.parent, "") if is_slice else None


def is_volume(file: Path) -> bool:
    """Whether the file is a volume by itself, and no slice of one."""
    try:
        bonemesh.scan(file)
    except (bonemesh.BonemeshError, OSError):
        return False
    return True


def is_dicom(file: Path) -> bool:
    """Whether the file says that it is of DICOM."""
    try:
        with file.open("rb") as opened:
            return opened.read(MARK_AT + len(MARK))[MARK_AT:] == MARK
    except OSError:
        return False
