"""Pages of the documentation as tests read them."""

from __future__ import annotations

import re

from support.project import ROOT


def page(name: str) -> str:
    """Text of a page below docs."""
    return (ROOT / "docs" / name).read_text(encoding="utf-8")


def table(text: str, head: str) -> list[list[str]]:
    """Cells of the rows of the table whose head begins with a word."""
    found = re.search(rf"^\| *{re.escape(head)} *\|.*\n\|[-| ]+\|\n((?:\|.*\n)+)", text, re.MULTILINE)
    assert found, f"no table with the head {head!r}"
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in found[1].splitlines()]


def code(text: str) -> list[str]:
    """Everything between backticks."""
    return re.findall(r"`([^`]+)`", text)


def plain(text: str) -> str:
    """Text on one line without marks."""
    return " ".join(text.replace("`", "").split())
