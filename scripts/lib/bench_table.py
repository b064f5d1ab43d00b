"""The rows of the table, each with its bar and whether it is met, as Markdown."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """One comparison."""

    work: str
    ours: str
    peer: str = ""
    theirs: str = ""
    ratio: float | None = None
    bar: str = ""
    met: bool | None = None

    def markdown(self) -> str:
        """The row of a Markdown table."""
        ratio = "" if self.ratio is None else f"{self.ratio:.2f}x"
        verdict = {None: "", True: "met", False: "missed"}[self.met]
        peer = f"{self.peer}: {self.theirs}" if self.peer else ""
        cells = [self.work, self.ours, peer, ratio, self.bar, verdict]
        return f"| {' | '.join(cells)} |"


def faster(
    work: str,
    ours: float,
    peer: str,
    theirs: float | str,
    bar: float | None = None,
    *,
    is_goal: bool = False,
) -> Row:
    """Seconds beside a peer's; `theirs` may say why there are none. A goal binds nobody."""
    said = f"at least {bar:g}x{' (a goal)' if is_goal else ''}" if bar else ""
    if isinstance(theirs, str):
        return Row(work, f"{ours:.3g} s", peer, theirs, bar=said)
    ratio = theirs / ours
    met = ratio >= bar if bar else None
    return Row(work, f"{ours:.3g} s", peer, f"{theirs:.3g} s", ratio, said, met)


def at_most(work: str, ours: str, ratio: float, bar: float) -> Row:
    """A ratio of our own figures that must not grow."""
    return Row(work, ours, ratio=ratio, bar=f"at most {bar:g}x", met=ratio <= bar)


def at_least(work: str, ours: str, ratio: float, bar: float) -> Row:
    """A ratio of our own figures that must not shrink."""
    return Row(work, ours, ratio=ratio, bar=f"at least {bar:g}x", met=ratio >= bar)


def same(work: str, ours: float, peer: str, theirs: float | str) -> Row:
    """Two counts that must be equal."""
    if isinstance(theirs, str):
        return Row(work, f"{ours:,.0f}", peer, theirs, bar="equal")
    equal = ours == theirs
    return Row(work, f"{ours:,.0f}", peer, f"{theirs:,.0f}", bar="equal", met=equal)


def markdown(rows: Sequence[Row]) -> str:
    """The rows that have a bar, as one table."""
    head = [
        "| work | Bonemesh | beside it | ratio | bar | |",
        "|---|---|---|---|---|---|",
    ]
    return "\n".join([*head, *(r.markdown() for r in rows if r.bar)]) + "\n"


def beside(columns: Mapping[str, Sequence[Row]], surfaces: Sequence[Row]) -> str:
    """Seconds of Delaunay and alpha, a column for each cloud, a line for each program.

    The rows of a column come in the same order in all of them; a ratio says how often our time
    with alpha fits into the peer's. `surfaces` holds one row a column: ours with the surface.
    """
    ours = [rows[0].ours for rows in columns.values()]
    lines = [
        f"| | {' | '.join(columns)} |",
        "|---" * (1 + len(columns)) + "|",
        f"| **Bonemesh, with alpha** | {' | '.join(f'**{o}**' for o in ours)} |",
        f"| **Bonemesh, with alpha and surface** | {' | '.join(f'**{r.ours}**' for r in surfaces)} |",
    ]
    for rows in zip(*columns.values(), strict=True):
        cells = [
            r.theirs if r.ratio is None else f"{r.theirs} ({r.ratio:.1f}x)"
            for r in rows
        ]
        lines.append(f"| {rows[0].peer} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"
