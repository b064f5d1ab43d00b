"""Runs programs in turn and keeps what they report."""

import json
import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

NOT_INSTALLED = 3
"""With this status a peer says that a package it needs is missing."""

Report = dict[str, Any]


class ProgramError(Exception):
    """Why a program gave no report."""


@dataclass(frozen=True)
class Program:
    """A command that ends its standard output with one line of JSON."""

    name: str
    command: Sequence[str]
    is_peer: bool = True
    once: bool = False
    """It is too slow for more than one run."""


@dataclass
class Measured:
    """What programs reported, run by run; and of those that did not, why."""

    reports: dict[str, list[Report]]
    absent: dict[str, str]

    def median(self, name: str, *keys: str) -> float | None:
        """Of the value that `keys` lead to, over all runs of the program."""
        values = []
        for report in self.reports[name] if name not in self.absent else []:
            value: Any = report
            for key in keys:
                value = value[key]
            values.append(float(value))
        return statistics.median(values) if values else None

    def ours(self, name: str, *keys: str) -> float:
        """The median of a program that cannot be absent."""
        value = self.median(name, *keys)
        assert value is not None
        return value


def run(command: Sequence[str]) -> Report:
    """The command's report, and the peak memory that the system saw, in MB."""
    with tempfile.TemporaryFile() as out:
        try:
            process = subprocess.Popen(command, stdout=out)
        except FileNotFoundError:
            raise ProgramError("not installed") from None
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode == NOT_INSTALLED:
            raise ProgramError("not installed")
        if process.returncode:
            raise ProgramError("failed")
        out.seek(0)
        report: Report = json.loads(out.read().splitlines()[-1])
    return report | {"peak_mb": usage.ru_maxrss * 1024 / 1e6}


def in_turn(programs: Sequence[Program], runs: int) -> Measured:
    """Runs each program once, then each again: what disturbs one disturbs the others."""
    measured = Measured({p.name: [] for p in programs}, {})
    for turn in range(runs):
        for program in programs:
            if program.name in measured.absent or (program.once and turn):
                continue
            try:
                measured.reports[program.name].append(run(program.command))
            except ProgramError as error:
                if not program.is_peer:
                    sys.exit(f"error: {' '.join(program.command)} {error}")
                measured.absent[program.name] = str(error)
    return measured
