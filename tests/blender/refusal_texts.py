"""The messages with which the add-on refuses, read from its source: each must have been seen in a test."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ADDON = Path(__file__).resolve().parents[2] / "blender_addon"
ERRORS = ("RefusalError", "BusyError")


class Refusal(NamedTuple):
    """One message, what varies in it being anything."""

    place: str
    pattern: re.Pattern[str]


def of_addon() -> list[Refusal]:
    """Every refusal in the add-on's source."""
    modules = {path: ast.parse(path.read_text()) for path in ADDON.rglob("*.py")}
    constants = {
        target.id: node.value
        for module in modules.values()
        for node in module.body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    return [
        Refusal(f"{path.relative_to(ADDON)}:{text.lineno}", re.compile(pattern))
        for path, module in sorted(modules.items())
        for text in texts(module)
        if (pattern := pattern_of(text, constants)) is not None
    ]


def texts(module: ast.Module) -> Iterator[ast.expr]:
    """What is raised as a refusal, said at a grey button, or named as what is missing."""
    for node in ast.walk(module):
        match node:
            case ast.Raise(exc=ast.Call(func=ast.Name(id=name), args=[text])):
                if name in ERRORS:
                    yield text
            case ast.Call(func=ast.Attribute(attr="poll_message_set"), args=[text]):
                yield text
            case ast.keyword(arg="missing", value=text):
                yield text
            case ast.Assign(targets=[ast.Name(id="remedy")], value=text):
                yield text
            case ast.FunctionDef(name=name) if name.startswith("missing"):
                yield from returned(node)


def returned(function: ast.FunctionDef) -> Iterator[ast.expr]:
    """What the function returns, each side of a choice by itself."""
    for node in ast.walk(function):
        match node:
            case ast.Return(value=ast.IfExp(body=body, orelse=orelse)):
                yield from (body, orelse)
            case ast.Return(value=ast.expr() as text):
                yield text


def pattern_of(text: ast.expr, constants: dict[str, ast.expr]) -> str | None:
    """What matches the text; None where it is no text of its own, but one that is handed on."""
    match text:
        case ast.Constant(value=str() as value):
            return re.escape(value)
        case ast.JoinedStr(values=parts):
            return "".join(pattern_of(part, constants) or ".*" for part in parts)
        case ast.Name(id=name) if name in constants:
            return pattern_of(constants[name], constants)
        case ast.Call(func=ast.Attribute(attr="format", value=template)):
            known = pattern_of(template, constants)
            return known and known.replace(re.escape("{}"), ".*")
    return None
