# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the compiled library can be used, and the remedy where it cannot. Knows no bpy."""

import tomllib
from pathlib import Path


def addon_version() -> str:
    """Version of this add-on, as its manifest says."""
    manifest = (
        Path(__file__).with_name("blender_manifest.toml").read_text(encoding="utf-8")
    )
    return str(tomllib.loads(manifest)["version"])


def problem() -> str | None:
    """Why the library cannot be used, as one line with its remedy, or None when it can."""
    try:
        import bonemesh
    except ImportError as error:
        return (
            f"Its compiled part does not load ({error}). Remove the extension, download the file "
            "for this system, install that from disk and restart Blender."
        )
    # A native module stays in memory until Blender ends, also when its extension is replaced.
    wanted = addon_version()
    if bonemesh.__version__ != wanted:
        return (
            f"Its compiled part {bonemesh.__version__} is still in memory, the add-on is {wanted}. "
            "Restart Blender."
        )
    return None
