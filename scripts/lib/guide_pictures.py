"""Cuts the guide's pictures out of those of the real window: guide_pictures.py OUT_OF_TEST_GUI IMAGES."""

import json
import subprocess
import sys
from pathlib import Path

# The guide's picture, the screen's picture it is cut from, which part of it, and how wide it becomes.
PICTURES = [
    ("install", "the zip was dropped", "area", 800),
    ("tab", "the tab", "area", 800),
    ("series", "the series are listed", "panel", None),
    ("rendering", "rendering", "panel", None),
    ("bone", "the bone", "area", 800),
    ("check", "the check", "panel", None),
    ("lasso", "the lasso", "area", 800),
    ("region", "the region", "area", 800),
    ("compare", "the comparison", "area", 800),
]
COLOURS = 160  # enough for Blender's grey and one bone; a third of the size


def main(out: Path, images: Path) -> None:
    """Writes every picture of the guide."""
    parts = json.loads((out / "parts.json").read_text())
    for name, screen, part, width in PICTURES:
        file = next(file for file in parts if file[3:] == f"{screen}.png")
        left, top, across, down = parts[file][part]
        smaller = ["-resize", f"{width}x"] if width else []
        cut = ["-crop", f"{across}x{down}+{left}+{top}", "+repage", "-trim", "+repage"]
        small = ["-strip", "-dither", "None", "-colors", str(COLOURS)]
        level = ["-define", "png:compression-level=9"]
        command = ["convert", str(out / file), *cut, *smaller, *small, *level]
        subprocess.run([*command, str(images / f"{name}.png")], check=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
