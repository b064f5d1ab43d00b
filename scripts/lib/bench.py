"""Times `bonemesh render` beside the published method, run by run in turn, and writes a table.

Its reading is timed beside SimpleITK's series reader, in the same runs.

usage: bench.py BONEMESH OUT_DIR RUNS HU NAME=DICOM_DIR...

Whole processes, folder to STL; peak memory is the operating system's own figure of each process.
"""

import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

PEER = Path(__file__).with_name("published_method.py")
READER = Path(__file__).with_name("simpleitk_reading.py")
STEPS = [
    "read",
    "edges",
    "cloud",
    "neighbours",
    "tetrahedra",
    "surface",
    "write",
    "total",
]


def run(command: list[str]) -> dict:
    """The command's JSON report with the process's peak memory in MiB."""
    with tempfile.TemporaryFile() as out:
        process = subprocess.Popen(command, stdout=out)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            sys.exit(f"error: {' '.join(command)} ended with {process.returncode}")
        out.seek(0)
        report = json.loads(out.read().splitlines()[-1])
    return report | {"peak_mib": usage.ru_maxrss / 1024}


def measure(bonemesh: str, folder: str, hu: str, runs: int) -> dict[str, list[dict]]:
    """All programs in turn, `runs` times."""
    found: dict[str, list[dict]] = {"bonemesh": [], "published": [], "simpleitk": []}
    with tempfile.TemporaryDirectory() as scratch:
        for _ in range(runs):
            ours = [
                bonemesh,
                "render",
                folder,
                "--hu",
                hu,
                "--method",
                "alpha",
                "--json",
                "-o",
            ]
            found["bonemesh"].append(run([*ours, f"{scratch}/ours.stl"]))
            peer = [sys.executable, str(PEER), folder, hu, f"{scratch}/peer.stl"]
            found["published"].append(run(peer))
            found["simpleitk"].append(run([sys.executable, str(READER), folder]))
    return found


def median(reports: list[dict], *keys: str) -> float:
    def value(report: dict) -> float:
        for key in keys:
            report = report[key]
        return float(report)

    return statistics.median(value(r) for r in reports)


def row(name: str, ours: float, peer: float, unit: str) -> str:
    ratio = f"{peer / ours:.1f}x" if ours > 0 else "-"
    return f"| {name} | {ours:.3g} {unit} | {peer:.3g} {unit} | {ratio} |"


def table(name: str, found: dict[str, list[dict]]) -> str:
    ours, peer = found["bonemesh"], found["published"]
    lines = [
        f"### {name}",
        "",
        "| | Bonemesh | published method | ratio |",
        "|---|---|---|---|",
    ]
    lines += [
        row(s, median(ours, "seconds", s), median(peer, "seconds", s), "s")
        for s in STEPS
    ]
    lines.append(
        row("peak memory", median(ours, "peak_mib"), median(peer, "peak_mib"), "MiB")
    )
    for key in ["points", "alpha_mm", "tetrahedra", "triangles", "volume_mm3"]:
        a, b = median(ours, key), median(peer, key)
        lines.append(f"| {key} | {a:.10g} | {b:.10g} | {(a / b - 1) * 100:+.4f} % |")
    lines.append(
        f"| watertight | {ours[0]['watertight']} | {peer[0]['watertight']} | |"
    )
    reader = found["simpleitk"]
    lines += [
        "",
        "| reading the series | Bonemesh | SimpleITK | ratio |",
        "|---|---|---|---|",
    ]
    for step, of_reader in [
        ("files found and decoded", "read"),
        ("SimpleITK's decoding alone", "decode"),
    ]:
        seconds = median(ours, "seconds", "read"), median(reader, "seconds", of_reader)
        lines.append(row(step, *seconds, "s"))
    return "\n".join(lines) + "\n"


def main(bonemesh: str, out: str, runs: str, hu: str, *folders: str) -> None:
    cores = os.cpu_count()
    head = f"{platform.system()} {platform.machine()}, {cores} cores; medians of {runs} runs in turn; {hu} HU"
    text, data = [f"## Folder to STL, method alpha\n\n{head}\n"], {}
    for named in folders:
        name, folder = named.split("=", 1)
        data[name] = measure(bonemesh, folder, hu, int(runs))
        text.append(table(name, data[name]))
        print(text[-1], flush=True)
    target = Path(out)
    (target / "bench.md").write_text("\n".join(text))
    (target / "bench.json").write_text(
        json.dumps({"machine": head, "runs": data}, indent=1)
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
