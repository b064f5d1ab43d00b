"""Prints how every claim ended and a last line `N passed, N failed`: verdict.py OUT STATUS_OF_BLENDER."""

import json
import sys
from pathlib import Path


def main(out: Path, status: int) -> int:
    """1 where something failed, 0 otherwise."""
    result = out / "result.json"
    claims = json.loads(result.read_text()) if result.is_file() else []
    claims.append(
        {"claim": "Blender starts and ends well", "problem": ending(out, status)}
    )
    for claim in claims:
        seconds = f" ({claim['seconds']} s)" if "seconds" in claim else ""
        outcome = f"FAILED: {claim['problem']}" if claim["problem"] else "passed"
        print(f"{claim['claim']}{seconds}: {outcome}")
    failed = sum(1 for claim in claims if claim["problem"])
    figures = out / "figures.json"
    if figures.is_file():
        for name, figure in json.loads(figures.read_text()).items():
            print(f"{name}: {figure}")
    print(f"{len(claims) - failed} passed, {failed} failed")
    return int(failed > 0)


def ending(out: Path, status: int) -> str:
    """What was wrong with how Blender ended; empty where nothing was."""
    if status == 124:
        return "it had to be stopped"
    if status != 0:
        return f"it ended with {status}; see {out / 'blender.log'}"
    if "Traceback" in (out / "blender.log").read_text(errors="replace"):
        return f"an error went through to the console; see {out / 'blender.log'}"
    return ""


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), int(sys.argv[2])))
