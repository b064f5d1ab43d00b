"""The error analysis as Markdown: bars, a summary, every row."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

Row = Mapping[str, Any]

# What a method has to reach at the setting that the bars are set for, away from creases.
BAR_SETTING = "0.5/1.5 mm"
BAR_HU = (250.0, 800.0)
BARS: dict[str, tuple[float, str, Callable[[Row], float]]] = {
    "mean": (0.06, "mm", lambda r: r["away"]["mean_mm"]),
    "p95": (0.15, "mm", lambda r: r["away"]["p95_mm"]),
    "signed mean": (0.02, "mm", lambda r: abs(r["away"]["signed_mm"])),
    "volume": (1.0, "%", lambda r: 100.0 * abs(r["volume"])),
}
FAULTS = {
    "boundary_edges": "open",
    "non_manifold_edges": "non-manifold edges",
    "non_manifold_vertices": "non-manifold vertices",
    "self_intersections": "self-intersections",
}


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def measured(rows: Sequence[Row]) -> list[Row]:
    """Rows with a mesh that has points away from creases."""
    return [r for r in rows if "error" not in r and r["away"]["points"]]


def names(rows: Sequence[Row], what: str) -> list[Any]:
    """The values of a column, each once, in their order."""
    return list(dict.fromkeys(r[what] for r in rows))


def bars(rows: Sequence[Row]) -> str:
    """The worst of each engine and body over the thresholds that the bars are set for."""
    low, high = BAR_HU
    chosen = [
        r
        for r in measured(rows)
        if r["setting"] == BAR_SETTING and low <= r["hu"] <= high
    ]
    lines = []
    for engine in names(chosen, "engine"):
        for body in names(chosen, "body"):
            own = [r for r in chosen if r["engine"] == engine and r["body"] == body]
            if not own:
                continue
            cells = [engine, body, str(len(own))]
            for bar, unit, value in BARS.values():
                worst = max(own, key=value)
                met = "" if value(worst) <= bar else " **missed**"
                cells.append(f"{value(worst):.3f} {unit} ({worst['hu']:g} HU){met}")
            lines.append(cells)
    wanted = [
        f"{name}, at most {bar:g} {unit}" for name, (bar, unit, _) in BARS.items()
    ]
    return table(["engine", "body", "thresholds", *wanted], lines)


def faults(row: Row) -> str:
    """What is wrong with a mesh as a body."""
    found = row["topology"]
    said = [f"{found[key]} {word}" for key, word in FAULTS.items() if found.get(key)]
    return ", ".join(said) or "none"


def average(rows: Sequence[Row], value: Callable[[Row], float]) -> float:
    """The mean of a figure."""
    return sum(map(value, rows)) / len(rows)


def summary(rows: Sequence[Row]) -> str:
    """Each engine at each setting, over all bodies and thresholds that it made a mesh of."""
    lines = []
    for setting in names(rows, "setting"):
        for engine in names(rows, "engine"):
            own = [
                r
                for r in measured(rows)
                if r["engine"] == engine and r["setting"] == setting
            ]
            if not own:
                continue
            printable = sum(r["topology"].get("printable", False) for r in own)
            lines.append(
                [
                    setting,
                    engine,
                    f"{average(own, lambda r: r['away']['mean_mm']):.3f}",
                    f"{average(own, lambda r: r['away']['signed_mm']):+.3f}",
                    f"{average(own, lambda r: r['away']['p95_mm']):.3f}",
                    f"{average(own, lambda r: r['all']['mean_mm']):.3f}",
                    f"{max(r['all']['max_mm'] for r in own):.2f}",
                    f"{100 * average(own, lambda r: r['complete']):.1f} %",
                    f"{100 * average(own, lambda r: abs(r['volume'])):.2f} %",
                    f"{printable} of {len(own)}",
                    f"{average(own, lambda r: r['seconds']):.2f}",
                ]
            )
    head = [
        "pixel/slice",
        "engine",
        "mean",
        "signed mean",
        "p95",
        "mean with creases",
        "max",
        "complete",
        "volume off by",
        "printable",
        "s",
    ]
    return table(head, lines)


def every(rows: Sequence[Row]) -> str:
    """One line a mesh."""
    lines = []
    for r in rows:
        start = [r["setting"], r["body"], f"{r['hu']:g}", r["engine"]]
        if "error" in r:
            lines.append([*start, *[""] * 7, r["error"]])
            continue
        away, both = r["away"], r["all"]
        numbers = (
            [
                f"{away['mean_mm']:.3f}",
                f"{away['signed_mm']:+.3f}",
                f"{away['p95_mm']:.3f}",
            ]
            if away["points"]
            else ["", "", ""]
        )
        rest = [
            f"{both['max_mm']:.2f}",
            f"{100 * r['complete']:.1f} %",
            f"{100 * r['volume']:+.2f} %",
            f"{r['seconds']:.2f}",
            faults(r),
        ]
        lines.append([*start, *numbers, *rest])
    head = ["pixel/slice", "body", "HU", "engine", "mean", "signed mean", "p95"]
    rest = ["max", "complete", "volume", "s", "faults"]
    return table([*head, *rest], lines)


def causes(rows: Sequence[Row]) -> str:
    """Where the errors of our own meshes come from: by part of the body, at one threshold."""
    lines = []
    for r in measured(rows):
        if not r["is_ours"] or r["setting"] != BAR_SETTING or r["hu"] != 400.0:
            continue
        for name, found in r["parts"].items():
            share = found["points"] / r["all"]["points"]
            lines.append(
                [
                    r["engine"],
                    r["body"],
                    name,
                    f"{100 * share:.1f} %",
                    f"{found['mean_mm']:.3f}",
                    f"{found['signed_mm']:+.3f}",
                    f"{found['p95_mm']:.3f}",
                    f"{found['max_mm']:.2f}",
                ]
            )
    return table(
        ["method", "body", "where", "share", "mean", "signed mean", "p95", "max"], lines
    )


def markdown(rows: Sequence[Row], machine: str, how: str) -> str:
    """All of it."""
    return (
        f"# Accuracy\n\n{how}\n\n{machine}\n\n"
        "Lengths in mm; away from creases unless said otherwise.\n\n"
        f"## Bars\n\nThe worst over thresholds from {BAR_HU[0]:g} to {BAR_HU[1]:g} HU, "
        f"{BAR_SETTING}.\n\n{bars(rows)}\n"
        f"## Means over bodies and thresholds\n\n{summary(rows)}\n"
        f"## Where errors come from, 400 HU\n\n{causes(rows)}\n"
        f"## Every mesh\n\n{every(rows)}"
    )
