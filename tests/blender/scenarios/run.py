"""Runs one scenario in a fresh Blender: run.py SCENARIO JSON_ARGUMENTS; the answer goes to OUT/SCENARIO.json."""

import importlib
import json
import sys
from pathlib import Path

import bpy  # noqa: F401 - Blender must be up before anything else is imported


def main(scenario: str, arguments: str) -> None:
    """Calls the scenario's `main` with the arguments by name."""
    request = json.loads(arguments)
    result = importlib.import_module(scenario).main(**request)
    answer = Path(request["out"]) / f"{scenario}.json"
    answer.write_text(json.dumps(result))


if __name__ == "__main__":
    main(*sys.argv[1:])
