"""Texts of other files within pages, which `make pictures` fills in: <!-- from PATH --> or <!-- from PATH: NAME -->."""

from __future__ import annotations

import ast
import re
from pathlib import Path

INCLUDED = re.compile(
    r"(?m)^<!-- from (\S+?)(?:: (\w+))? -->\n```(\w+)\n(.*?)^```$", re.DOTALL
)


def wanted(page: Path, path: str, name: str | None) -> str:
    """The text of a file, or the source of a class or function in it."""
    text = (page.parent / path).read_text(encoding="utf-8")
    if name is None:
        return text
    (node,) = (one for one in ast.parse(text).body if getattr(one, "name", "") == name)
    first = min(one.lineno for one in (node, *getattr(node, "decorator_list", ())))
    return "".join(text.splitlines(keepends=True)[first - 1 : node.end_lineno])


def updated(page: Path) -> str:
    """The text of a page with all that it includes as it is now."""

    def filled(found: re.Match[str]) -> str:
        head, _, _ = found[0].partition("```")
        return f"{head}```{found[3]}\n{wanted(page, found[1], found[2])}```"

    return INCLUDED.sub(filled, page.read_text(encoding="utf-8"))


def update(page: Path) -> None:
    """Write a page whose included texts have changed."""
    text = updated(page)
    if text != page.read_text(encoding="utf-8"):
        page.write_text(text, encoding="utf-8")
