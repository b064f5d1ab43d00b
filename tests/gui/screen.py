"""Pictures of the screen, taken while Blender runs on, and what is seen in them."""

from __future__ import annotations

import subprocess
from collections.abc import Generator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from waiting import Steps, wait_until

Rectangle = tuple[int, int, int, int]
"""Left, top, width and height in pixels, from the picture's top left corner."""


class Camera:
    """Takes numbered pictures into a folder and notes where the window's parts lie in each."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.parts: dict[str, dict[str, Rectangle]] = {}

    def take(
        self, name: str, parts: dict[str, Rectangle] | None = None
    ) -> Generator[None, None, Path]:
        """The picture's file; `parts` are kept for whoever cuts it."""
        file = self.folder / f"{len(self.parts) + 1:02} {name}.png"
        # By a process of its own: Blender's own screenshot is black where nothing but software draws.
        taking = subprocess.Popen(["import", "-window", "root", str(file)])
        yield from wait_until(lambda: taking.poll() is not None, "the picture is taken")
        assert taking.returncode == 0, f"the screen could not be pictured: {file}"
        self.parts[file.name] = parts or {}
        return file


def pixels(file: Path, part: Rectangle) -> NDArray[np.int16]:
    """(height, width, 3) red, green and blue of a part of a picture."""
    left, top, width, height = part
    command = ["convert", str(file), "-crop", f"{width}x{height}+{left}+{top}"]
    raw = subprocess.run(
        [*command, "-depth", "8", "rgb:-"], check=True, capture_output=True
    )
    return (
        np.frombuffer(raw.stdout, np.uint8).reshape(height, width, 3).astype(np.int16)
    )


def share_of_bone(file: Path, part: Rectangle) -> float:
    """How much of a part is of the bone's colour: light, red above green above blue."""
    red, green, blue = np.moveaxis(pixels(file, part), -1, 0)
    return float(
        ((red > green) & (green > blue + 8) & (red - blue < 90) & (red > 60)).mean()
    )


def share_of_region(file: Path, part: Rectangle) -> float:
    """How much of a part is of the region's colour: red, far above green and blue."""
    red, green, blue = np.moveaxis(pixels(file, part), -1, 0)
    return float(((red > 1.5 * green) & (red > 1.8 * blue) & (red > 70)).mean())


def changed(one: Path, other: Path, part: Rectangle) -> float:
    """How much of a part differs between two pictures."""
    return float((pixels(one, part) != pixels(other, part)).any(axis=-1).mean())


def rectangle(window: Any, place: Any) -> Rectangle:
    """Where an area or region of a window, which Blender measures from the bottom, is in a picture."""
    return (
        place.x,
        window.height - place.y - place.height,
        place.width,
        place.height,
    )


__all__ = [
    "Camera",
    "Rectangle",
    "Steps",
    "changed",
    "rectangle",
    "share_of_bone",
    "share_of_region",
]
