"""Steps that wait for what they need instead of sleeping: a step is a generator, one `yield` a tick of Blender's timer."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator

Steps = Generator[None, None, None]
PATIENCE_S = 30.0


def wait_until(
    is_true: Callable[[], object], what: str, patience_s: float = PATIENCE_S
) -> Steps:
    """Goes on once `is_true` holds; AssertionError with `what` did not happen after `patience_s`."""
    end = time.monotonic() + patience_s
    while not is_true():
        assert time.monotonic() < end, f"not within {patience_s:.0f} s: {what}"
        yield


def ticks(number: int) -> Steps:
    """Lets Blender handle what it was sent and draw."""
    for _ in range(number):
        yield
