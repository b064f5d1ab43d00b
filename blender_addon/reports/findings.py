# SPDX-License-Identifier: GPL-3.0-or-later
"""What was done to a mesh and what a check found, in lines for the panel. Knows no bpy."""

from typing import Any, NamedTuple

Report = dict[str, Any]
"""What the library reports: the same keys as in its JSON."""


LEFT_OUT = ("left_out_table", "left_out_specks")
"""What a closed surface is made without, as the library names it."""


def of_rendering(report: Report) -> Report | None:
    """Of a rendering's report what was left out and done afterwards; None where nothing was."""
    left_out = {name: report[name] for name in LEFT_OUT if report.get(name)}
    return {**(report.get("after_care") or {}), **left_out} or None


def after_care_lines(report: Report) -> list[str]:
    """What was left out, removed and changed after the mesh was made; at least one line."""
    lines = []
    table, specks = (report.get(name) for name in LEFT_OUT)
    if table:
        lines.append(f"Scanner's table left out ({volume_text(table['volume_mm3'])})")
    if specks:
        count = counted(specks["islands"], "speck", "specks")
        lines.append(f"{count} left out ({volume_text(specks['volume_mm3'])})")
    filled = report.get("filled_holes")
    if filled is not None:
        left = report.get("left_holes")
        rest = f", {left:,} left" if left else ""
        lines.append(f"{counted(filled, 'hole', 'holes')} filled{rest}")
    for name in ("island", "cavity"):
        many = {"island": "islands", "cavity": "cavities"}[name]
        count = report.get(f"removed_{many}") or 0
        if count:
            volume = volume_text(report[f"removed_{many}_mm3"])
            lines.append(f"{counted(count, name, many)} removed ({volume})")
    moved = report.get("largest_move_mm")
    if moved is not None:
        kept = but(report.get("put_back_vertices"), "left in place")
        lines.append(f"Smoothed: vertices moved up to {moved:.3f} mm{kept}")
    removed = report.get("removed_triangles")
    if removed is not None:
        kept = but(report.get("held_vertices"), "left as they were")
        lines.append(f"{counted(removed, 'triangle', 'triangles')} removed{kept}")
    wanted = report.get("missed_triangles")
    if wanted is not None:
        lines.append(
            f"Not as few as {wanted:,}: no more could go without bending the surface too much"
        )
    return lines or ["Nothing had to be removed"]


class Fault(NamedTuple):
    """A kind of place that is not fit for printing."""

    label: str
    tooltip: str
    counted_as: str
    """What a check counts them as."""
    domain: str
    """What is selected in Edit Mode."""
    noun: tuple[str, str]


# By the names of the library's `faults`.
FAULTS = {
    "open_edges": Fault(
        "Open Edges",
        "Select the rims of holes in Edit Mode",
        "boundary_edges",
        "EDGE",
        ("edge", "edges"),
    ),
    "non_manifold_edges": Fault(
        "Edges of More than Two Faces",
        "Select the edges along which parts touch in Edit Mode",
        "non_manifold_edges",
        "EDGE",
        ("edge", "edges"),
    ),
    "non_manifold_vertices": Fault(
        "Vertices of Several Parts",
        "Select the vertices in which parts only touch in Edit Mode",
        "non_manifold_vertices",
        "VERT",
        ("vertex", "vertices"),
    ),
    "inconsistent_edges": Fault(
        "Edges of Turned Faces",
        "Select the edges whose two faces face opposite ways in Edit Mode",
        "inconsistent_edges",
        "EDGE",
        ("edge", "edges"),
    ),
    "intersecting_triangles": Fault(
        "Self-Intersections",
        "Select the triangles that pass through, overlap or touch one another in Edit Mode",
        "intersecting_triangles",
        "FACE",
        ("triangle", "triangles"),
    ),
    "degenerate_triangles": Fault(
        "Triangles without Area",
        "Select the triangles that have no area in Edit Mode",
        "degenerate_triangles",
        "FACE",
        ("triangle", "triangles"),
    ),
    "thin_vertices": Fault(
        "Thin Walls",
        "Select in Edit Mode where the wall is thinner than Thin Below",
        "",
        "VERT",
        ("vertex", "vertices"),
    ),
}


def faults_found(report: Report) -> dict[str, str]:
    """The kinds of places that a check found, with what their buttons say."""
    return {
        kind: f"{fault.label} ({report[fault.counted_as]:,})"
        for kind, fault in FAULTS.items()
        if report.get(fault.counted_as)
    }


THIN_MM = 0.4  # the line that most printers of plastic draw


def verdict(report: Report) -> str:
    """Whether the mesh can be printed, in a few words."""
    if not report.get("printable"):
        return "Not printable"
    thinnest = report.get("thinnest_wall_mm")
    is_thin = thinnest is not None and thinnest < THIN_MM
    return f"Printable, but for walls below {THIN_MM} mm" if is_thin else "Printable"


def check_lines(report: Report) -> list[str]:
    """The figures of a check: size, volume, shells (the outsides of parts and those of cavities), walls."""
    lines = []
    bounds = report.get("bounds_mm")
    if bounds is not None:
        lowest, highest = bounds
        sides = (f"{b - a:.4g}" for a, b in zip(lowest, highest, strict=True))
        lines.append(f"Size: {' x '.join(sides)} mm")
    # Without a closed surface there is no inside whose volume or walls could be measured.
    if report.get("watertight"):
        lines.append(f"Volume: {volume_text(report['volume_mm3'])}")
    triangles = counted(report.get("triangles", 0), "triangle", "triangles")
    shells = counted(report.get("components", 0), "shell", "shells")
    lines.append(f"{triangles} in {shells}")
    thinnest = report.get("thinnest_wall_mm")
    if thinnest is None:
        lines.append("Walls: not measured, the surface encloses no volume")
        return lines
    lines.append(f"Thinnest wall: {thinnest:.2f} mm")
    common = report.get("wall_5_percent_mm")
    if common is not None:
        lines.append(f"Thinner than {common:.2f} mm at one vertex in twenty")
    return lines


def volume_text(mm3: float) -> str:
    """A volume with its unit, mm³ as far as these are few."""
    return f"{mm3:,.1f} mm³" if abs(mm3) < 1000.0 else f"{mm3 / 1000.0:,.2f} cm³"


def counted(count: int, one: str, many: str) -> str:
    """`count` with its noun."""
    return f"1 {one}" if count == 1 else f"{count:,} {many}"


def but(count: int | None, what: str) -> str:
    """An afterthought on the vertices that were not touched, if there are any."""
    return f", {counted(count, 'vertex', 'vertices')} {what}" if count else ""
