"""The guide: every message in it is one that is really said, every picture is there (needs no Blender)."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
GUIDE = (ROOT / "blender_addon" / "README.md").read_text(encoding="utf-8")
# Said by Blender or the system, not by us.
OTHERS_SAY = {"library load disallowed"}


def said_in_the_code() -> str:
    """All text of the add-on and the library, with the gaps between parts of one text closed."""
    files = [
        *(ROOT / "blender_addon").rglob("*.py"),
        *(ROOT / "crates").glob("*/src/**/*.rs"),
    ]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    text = re.sub(r'"\s*\n\s*f?"', "", text)  # Python joins neighbours
    return re.sub(r"\\\n\s*", "", text)  # and Rust lines that end so


def test_every_message_of_the_guide_is_said() -> None:
    rows = [line for line in GUIDE.splitlines() if line.startswith("| ")]
    messages = {
        m for row in rows for m in re.findall(r"`([^`]{8,})`", row.split("|")[1])
    }
    assert len(messages) > 20
    code = said_in_the_code()
    assert [m for m in sorted(messages - OTHERS_SAY) if m not in code] == []


def test_every_picture_of_the_guide_is_there_and_small() -> None:
    pictures = re.findall(r"!\[[^\]]{20,}\]\(([^)]+)\)", GUIDE)
    assert len(pictures) == GUIDE.count("![") > 3
    for picture in pictures:
        assert (ROOT / "blender_addon" / picture).stat().st_size < 200_000
