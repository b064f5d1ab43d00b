"""The add-on's guide (blender_addon/README.md) as a page for a browser, with its pictures, to be read without a network."""

import re
import shutil
from pathlib import Path

import markdown

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
body {{ max-width: 52rem; margin: 2rem auto; padding: 0 1rem; font: 1rem/1.5 system-ui, sans-serif; color: #222; }}
img {{ max-width: 100%; border: 1px solid #ccc; border-radius: 4px; }}
table {{ border-collapse: collapse; }}
th, td {{ border: 1px solid #ccc; padding: 0.3rem 0.6rem; text-align: left; vertical-align: top; }}
code {{ background: #eee; padding: 0.1rem 0.3rem; border-radius: 3px; }}
</style>
</head>
<body>
{body}
</body>
</html>
"""


def write_guide(addon: Path, folder: Path) -> None:
    """Writes index.html and images/ into `folder`, which is made."""
    text = (addon / "README.md").read_text(encoding="utf-8")
    # What lies outside of the add-on is not in the extension.
    text = re.sub(r"\[([^\]]+)\]\(\.\./[^)]*\)", r"\1", text)
    title = text.splitlines()[0].removeprefix("# ")
    body = markdown.markdown(text, extensions=["tables", "toc", "fenced_code"])
    folder.mkdir()
    page = PAGE.format(title=title, body=body)
    (folder / "index.html").write_text(page, encoding="utf-8")
    shutil.copytree(addon / "images", folder / "images")
