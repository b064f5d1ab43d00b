"""Every step beside the published method's, how far the results agree, and the reading beside SimpleITK's."""

from bench_process import Measured
from bench_programs import OURS, PUBLISHED, READER

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
RESULTS = ["points", "alpha_mm", "tetrahedra", "triangles", "volume_mm3"]


def row(name: str, ours: float, peer: float | None, unit: str) -> str:
    """Two figures and how often ours fits into the peer's."""
    if peer is None:
        return f"| {name} | {ours:.3g} {unit} | - | |"
    ratio = f"{peer / ours:.1f}x" if ours > 0 else ""
    return f"| {name} | {ours:.3g} {unit} | {peer:.3g} {unit} | {ratio} |"


def steps(measured: Measured) -> list[str]:
    """Seconds of each step and peak memory."""
    lines = ["| | Bonemesh | published method | ratio |", "|---|---|---|---|"]
    for step in STEPS:
        peer = measured.median(PUBLISHED, "seconds", step)
        lines.append(row(step, measured.ours(OURS, "seconds", step), peer, "s"))
    peer = measured.median(PUBLISHED, "peak_mb")
    return [*lines, row("peak memory", measured.ours(OURS, "peak_mb"), peer, "MB")]


def results(measured: Measured) -> list[str]:
    """What both programs found."""
    lines = []
    for key in RESULTS:
        ours, peer = measured.ours(OURS, key), measured.median(PUBLISHED, key)
        if peer is not None:
            lines.append(
                f"| {key} | {ours:.10g} | {peer:.10g} | {(ours / peer - 1) * 100:+.4f} % |"
            )
    tight = [
        "yes" if measured.median(p, "watertight") else "no" for p in (OURS, PUBLISHED)
    ]
    return [*lines, f"| watertight | {tight[0]} | {tight[1]} | |"]


def reading(measured: Measured) -> list[str]:
    """Files to volume."""
    lines = [
        "| reading the series | Bonemesh | SimpleITK | ratio |",
        "|---|---|---|---|",
    ]
    ours = measured.ours(OURS, "seconds", "read")
    for work, key in [
        ("files found and decoded", "read"),
        ("SimpleITK's decoding alone", "decode"),
    ]:
        lines.append(row(work, ours, measured.median(READER, "seconds", key), "s"))
    return lines


def details(name: str, measured: Measured) -> str:
    """All three tables."""
    lines = [f"### {name}", "", *steps(measured)]
    if PUBLISHED not in measured.absent:
        lines += results(measured)
    return "\n".join([*lines, "", *reading(measured)]) + "\n"
