"""Write the list of rooms into CONTRIBUTING.md: from the layers that are enforced, in the words of each room."""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "CONTRIBUTING.md"
SOURCE = ROOT / "src" / "clutchwork"
# the list stands between the folder of the package and that of the core
LIST = re.compile(r"(    src/clutchwork/ .*\n)(?:      .*\n)*(?=    cpp/)")


def floors() -> list[list[str]]:
    """The rooms of each floor, the lowest first."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    layers = settings["tool"]["importlinter"]["contracts"][0]["layers"]
    return [re.findall(r"\w+", floor) for floor in reversed(layers)]


def purpose(room: str) -> str:
    """The first sentence of a room."""
    text = ast.get_docstring(ast.parse((SOURCE / room / "__init__.py").read_text(encoding="utf-8"))) or ""
    return re.split(r"\.(?:\s|$)", text.replace("\n", " "))[0]


def lines() -> Iterator[str]:
    """One line for each room, with the number of its floor."""
    for number, floor in enumerate(floors(), 1):
        for room in floor:
            yield f"      {room + '/':<14} {number:>2}  {purpose(room)}\n"


def page() -> str:
    """CONTRIBUTING.md with the list of today."""
    return LIST.sub(lambda found: found[1] + "".join(lines()), PAGE.read_text(encoding="utf-8"))


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
