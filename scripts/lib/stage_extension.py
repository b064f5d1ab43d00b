"""Lays out a Blender extension in a folder: add-on, wheel, licences, the guide, and the manifest filled in.

usage: stage_extension.py WHEEL PLATFORM FOLDER        prints the version
"""

import re
import shutil
import sys
import tomllib
import zipfile
from pathlib import Path

from guide_page import write_guide

ROOT = Path(__file__).resolve().parents[2]
ADDON = ROOT / "blender_addon"
LICENCES = (
    "bonemesh/licenses/"  # where the wheel keeps those of what is compiled into it
)


# Blender itself has no build for them from this version on.
FIRST_BLENDER_WITHOUT = {"macos-x64": "5.0.0"}


def workspace_version() -> str:
    """The one version of everything in this repository."""
    return tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))[
        "workspace"
    ]["package"]["version"]


def filled_in_manifest(version: str, platform: str, wheel: str) -> str:
    """The add-on's manifest with what only a build knows."""
    text = (ADDON / "blender_manifest.toml").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    known = [
        f'version = "{version}"',
        f'platforms = ["{platform}"]',
        f'wheels = ["./wheels/{wheel}"]',
    ]
    if platform in FIRST_BLENDER_WITHOUT:
        known.append(f'blender_version_max = "{FIRST_BLENDER_WITHOUT[platform]}"')
    text, count = re.subn(
        r'^version = ".*"$',
        "\n".join(known),
        "\n".join(lines) + "\n",
        flags=re.MULTILINE,
    )
    if count != 1:
        sys.exit(
            f"error: blender_manifest.toml has {count} lines `version = ...`; it must have one"
        )
    return text


def copy_licences(wheel: Path, folder: Path) -> None:
    """The add-on's own licence and those of the crates in the wheel."""
    shutil.copyfile(ROOT / "LICENSE-GPL-3.0", folder / "LICENSE")
    (folder / "licenses").mkdir()
    with zipfile.ZipFile(wheel) as packed:
        names = [
            n
            for n in packed.namelist()
            if n.startswith(LICENCES) and not n.endswith("/")
        ]
        if not names:
            sys.exit(
                f"error: {wheel.name} carries no {LICENCES}; build it from crates/python"
            )
        for name in names:
            (folder / "licenses" / Path(name).name).write_bytes(packed.read(name))


def main(wheel_path: str, platform: str, folder_path: str) -> None:
    """Writes the folder."""
    wheel, folder, version = Path(wheel_path), Path(folder_path), workspace_version()
    if "-abi3-" not in wheel.name or f"-{version}-" not in wheel.name:
        sys.exit(
            f"error: {wheel.name} is not the abi3 wheel of version {version}; build it from crates/python"
        )
    left_out = shutil.ignore_patterns("__pycache__", "*.toml", "*.md", "images", ".*")
    shutil.copytree(ADDON, folder, ignore=left_out)
    write_guide(ADDON, folder / "guide")
    manifest = filled_in_manifest(version, platform, wheel.name)
    (folder / "blender_manifest.toml").write_text(manifest, encoding="utf-8")
    (folder / "wheels").mkdir()
    shutil.copyfile(wheel, folder / "wheels" / wheel.name)
    copy_licences(wheel, folder)
    print(version)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: stage_extension.py WHEEL PLATFORM FOLDER")
    main(*sys.argv[1:])
