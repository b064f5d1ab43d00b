"""A report in parts: tables as Markdown and CSV, pictures, and what is to be said of them."""

import csv
import io
import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

Cell = str | int | float | None


@dataclass(frozen=True)
class Table:
    """One table; `note` says what agrees with the thesis, what does not, and why."""

    name: str
    title: str
    head: Sequence[str]
    rows: Sequence[Sequence[Cell]]
    note: str = ""

    def markdown(self) -> str:
        """With numbers to three places and nothing where there is nothing."""
        lines = [self.head, ["---"] * len(self.head)]
        lines += [[shown(cell) for cell in row] for row in self.rows]
        body = "\n".join(f"| {' | '.join(line)} |" for line in lines)
        note = f"\n{self.note}\n" if self.note else ""
        return f"### {self.title}\n\n{body}\n{note}"

    def csv(self) -> str:
        """With all places."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.head)
        writer.writerows(self.rows)
        return text.getvalue()


@dataclass(frozen=True)
class Picture:
    """A file that is already in the report's folder."""

    file: str
    title: str

    def markdown(self) -> str:
        """The picture with its title under it."""
        return f"![{self.title}]({self.file})\n\n*{self.title}*\n"


@dataclass
class Report:
    """Everything in the order in which it is read."""

    folder: Path
    title: str
    parts: list[str] = field(default_factory=list)

    def heading(self, text: str) -> None:
        """Begins a part."""
        self.parts.append(f"## {text}\n")

    def text(self, text: str) -> None:
        """A paragraph."""
        self.parts.append(f"{text}\n")

    def add(self, part: Table | Picture) -> None:
        """A table, which also becomes a CSV file of its own, or a picture."""
        self.parts.append(part.markdown())
        if isinstance(part, Table):
            write(self.folder / f"{part.name}.csv", part.csv())
        self.save()

    def save(self) -> None:
        """All that there is so far."""
        write(self.folder / "study.md", "\n".join([f"# {self.title}\n", *self.parts]))


def shown(cell: Cell) -> str:
    """A cell as it is read."""
    if cell is None:
        return ""
    if isinstance(cell, float):
        return f"{cell:.3f}" if abs(cell) < 1000 else f"{cell:,.1f}"
    return f"{cell:,}" if isinstance(cell, int) else cell


def write(path: Path, text: str) -> None:
    """The whole file or none."""
    with tempfile.TemporaryDirectory(dir=path.parent) as scratch:
        made = Path(scratch) / path.name
        made.write_text(text, encoding="utf-8")
        os.replace(made, path)
