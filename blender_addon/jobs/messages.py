# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said of an error. Knows no bpy."""

import bonemesh

from ..request.inputs import RefusalError
from .job import BusyError

EXPECTED = (RefusalError, BusyError, bonemesh.BonemeshError, OSError, MemoryError)


def one_line(error: BaseException) -> str:
    """What is said of `error`, with its remedy."""
    if isinstance(error, MemoryError):
        return (
            "not enough memory; crop the images (Crop) or keep fewer points (Advanced)"
        )
    if isinstance(error, OSError) and error.strerror and error.filename:
        return f"{error.filename}: {error.strerror}; check the folder's rights and free space"
    if isinstance(error, EXPECTED):
        return str(error)
    return f"unexpected {type(error).__name__}: {error}; please report it with the text in the system console"
