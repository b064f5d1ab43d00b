"""Times Bonemesh beside what else does its work, run by run in turn, and writes the table.

usage: bench.py --bonemesh BINARY --examples DIR --peers DIR --out DIR --runs N --hu HU NAME=DICOM_DIR...

Seconds of steps are what the programs themselves report, peak memory is the system's own figure of
each process. `bench.md` and `bench.json` go to the folder `--out`.
"""

import argparse
import dataclasses
import json
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

import bench_rows as of
from bench_details import details
from bench_machine import machine
from bench_process import Measured
from bench_programs import THREADS, Tools
from bench_table import Row, beside, markdown


def say(text: str) -> None:
    """Tells who waits."""
    print(f"   {text}", file=sys.stderr, flush=True)


def parsed() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser()
    for word in ["--bonemesh", "--hu"]:
        parser.add_argument(word, required=True)
    for word in ["--examples", "--peers", "--out"]:
        parser.add_argument(word, required=True, type=Path)
    parser.add_argument("--runs", required=True, type=int)
    parser.add_argument("folders", nargs="+", metavar="NAME=DICOM_DIR")
    return parser.parse_args()


def folder_rows(
    words: argparse.Namespace, tools: Tools
) -> tuple[dict[str, dict[str, list[Row]]], dict[str, Measured]]:
    """Of each folder the rows of its subjects, and what they were made of."""
    rows, found = {}, {}
    for name, folder in (named.split("=", 1) for named in words.folders):
        say(name)
        with tempfile.TemporaryDirectory() as scratch:
            place = Path(scratch)
            measured = of.measure_folder(tools, folder, words.hu, words.runs, place)
            rows[name] = {
                "tetrahedra": of.tetrahedra_rows(name, measured),
                "surface": [of.surface_row(name, measured)],
                "default": of.default_rows(name, measured),
                "line": of.line_rows(name, measured),
                "threads": of.thread_rows(
                    name, tools, folder, words.hu, measured, place
                ),
            }
        found[name] = measured
    return rows, found


def other_rows(
    words: argparse.Namespace, tools: Tools
) -> tuple[dict[str, list[Row]], dict[str, Measured]]:
    """The same of random points and of growth."""
    with tempfile.TemporaryDirectory() as scratch:
        place = Path(scratch)
        say("random points")
        free = of.measure_random(tools, words.runs, place)
        say("growth")
        growth = of.measure_growth(tools, words.hu, words.runs, place)
    rows = {"random": of.random_rows(free), "growth": of.growth_rows(growth)}
    return rows, {"random points": free, "growth": growth}


def all_rows(
    by_folder: dict[str, dict[str, list[Row]]], others: dict[str, list[Row]]
) -> list[Row]:
    """Subject by subject."""
    rows = []
    for subject in [
        "default",
        "tetrahedra",
        "surface",
        "random",
        "line",
        "growth",
        "threads",
    ]:
        rows += others.get(subject, [])
        for of_one in by_folder.values():
            rows += of_one.get(subject, [])
    return rows


def engines(measured: Mapping[str, Measured]) -> list[str]:
    """Names and versions of the engines that ran."""
    reports = [
        r for m in measured.values() for each in m.reports.values() for r in each
    ]
    return sorted({report["engine"] for report in reports if "engine" in report})


def heading(
    words: argparse.Namespace, place: Mapping[str, str | int], names: list[str]
) -> str:
    """The machine, what ran, and how was measured."""
    runs = f"medians of {words.runs} runs in turn" if words.runs > 1 else "one run"
    return (
        f"{place['processor']}, {place['cores']} cores, {place['system']}; {place['rust']}, {place['cpp']}; "
        f"{', '.join(names)}.\n{THREADS} threads, {words.hu} HU; {runs} (of Qhull and Open3D always one)."
    )


def main() -> None:
    """Prints the tables and writes them beside the figures they were made of."""
    words = parsed()
    tools = Tools(words.bonemesh, words.examples, words.peers)
    by_folder, measured = folder_rows(words, tools)
    others, more = other_rows(words, tools)
    rows = all_rows(by_folder, others)
    columns = {
        of.titled(name, measured[name]): of_one["tetrahedra"]
        for name, of_one in by_folder.items()
    }
    surfaces = [row for of_one in by_folder.values() for row in of_one["surface"]]
    place = machine()
    text = f"{heading(words, place, engines(measured))}\n\n{beside(columns, surfaces)}\n{markdown(rows)}"
    print(text)
    steps = "\n".join(details(name, m) for name, m in measured.items())
    (words.out / "bench.md").write_text(f"{text}\n{steps}", encoding="utf-8")
    data = {
        "machine": place,
        "threads": THREADS,
        "runs": words.runs,
        "threshold_hu": float(words.hu),
        "rows": [dataclasses.asdict(row) for row in rows],
        "measured": {
            name: dataclasses.asdict(m) for name, m in (measured | more).items()
        },
    }
    (words.out / "bench.json").write_text(json.dumps(data, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
