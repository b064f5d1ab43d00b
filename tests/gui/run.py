"""Runs the story in a Blender with a window: blender --enable-event-simulate --python run.py -- ZIP OUT.

Each step of the story is one claim; how it ended goes to OUT/result.json, pictures of the screen
beside it. Blender ends with the last step.
"""

from __future__ import annotations

import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))

from desk import Desk
from story import STORY
from waiting import Steps

TICK_S = 0.01
PATIENCE_S = 150.0  # for one claim

Claim = Callable[[Desk], Steps]


class Run:
    """Goes through the story, a tick of a timer at a time."""

    def __init__(self, desk: Desk, story: list[Claim]) -> None:
        self.desk = desk
        self.results = [
            {"claim": spoken(claim), "problem": "was not tried"} for claim in story
        ]
        self.steps = self.all_claims(story)

    def tick(self) -> float | None:
        """What Blender's timer calls; None ends the timer."""
        self.desk.watch()
        return TICK_S if next(self.steps, "ended") != "ended" else None

    def all_claims(self, story: list[Claim]) -> Steps:
        """One claim after the other, whether or not the ones before it held."""
        for claim, result in zip(story, self.results, strict=True):
            print(f"-- {result['claim']}", flush=True)
            # A Blender that dies leaves this behind.
            result["problem"] = "Blender ended meanwhile"
            self.desk.write("result.json", self.results)
            begun = time.monotonic()
            result["problem"] = yield from self.problem_of(claim, begun)
            result["seconds"] = round(time.monotonic() - begun, 1)
            print(f"   {result['problem'] or 'passed'}", flush=True)
            self.desk.write("result.json", self.results)
        bpy.ops.wm.quit_blender()

    def problem_of(self, claim: Claim, begun: float) -> Steps:
        """Why the claim does not hold; empty where it does."""
        try:
            for _ in claim(self.desk):
                late = time.monotonic() - begun > PATIENCE_S
                assert not late, f"not done within {PATIENCE_S:.0f} s"
                yield
        except Exception as error:  # noqa: BLE001 - a claim that fails is a result
            # Not to the console, where Tracebacks are the add-on's.
            with (self.desk.out / "failures.txt").open("a") as file:
                traceback.print_exc(file=file)
            yield from self.desk.picture("failure")
            return f"{type(error).__name__}: {error}"
        return ""


def spoken(claim: Claim) -> str:
    """The claim's name in words."""
    return claim.__name__.replace("_", " ")


def main(zip_path: str, out: str) -> None:
    """Starts the timer; Blender's own loop does the rest."""
    bpy.context.preferences.view.show_splash = False
    run = Run(Desk(Path(zip_path), Path(out)), STORY)
    # Persistent: a step may open another file.
    bpy.app.timers.register(run.tick, first_interval=1.0, persistent=True)


main(*sys.argv[sys.argv.index("--") + 1 :])
