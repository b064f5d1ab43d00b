# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a job of several stages is as a whole, and how long it still takes. Knows no bpy.

Each stage has a weight, its usual part of the time. Time left follows from the time so far; it is told
once enough is done for that to mean something, and in round numbers, since it is no more than an estimate.
"""

from __future__ import annotations

from collections.abc import Mapping

LEAST_PART = 0.1
LEAST_S = 2.0


class Timeline:
    """Stages in their order with their weights; a stage that is not among them moves nothing."""

    def __init__(self, weights: Mapping[str, float]) -> None:
        total = sum(weights.values()) or 1.0
        self._parts = {stage: weight / total for stage, weight in weights.items()}
        self._begins: dict[str, float] = {}
        begin = 0.0
        for stage, part in self._parts.items():
            self._begins[stage] = begin
            begin += part
        self._done = 0.0

    def done(self, stage: str, fraction: float) -> float:
        """The done part of the whole, 0 to 1; never less than before, since a stage may come again."""
        if stage in self._parts:
            reached = self._begins[stage] + self._parts[stage] * fraction
            self._done = min(1.0, max(self._done, reached))
        return self._done

    def seconds_left(self, elapsed_s: float) -> float | None:
        """How long it still takes; None as long as that cannot be told."""
        if self._done < LEAST_PART or elapsed_s < LEAST_S:
            return None
        return elapsed_s * (1.0 - self._done) / self._done


def left_text(seconds: float | None) -> str:
    """Time left in round numbers; empty where it is not known."""
    if seconds is None:
        return ""
    if seconds < 5.0:
        return "a few seconds left"
    if seconds < 60.0:
        return f"about {5 * round(seconds / 5.0)} s left"
    if seconds < 150.0:
        return f"about {30 * round(seconds / 30.0)} s left"
    return f"about {round(seconds / 60.0)} min left"
