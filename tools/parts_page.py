"""The page that compares part by part, from docs/parts.toml and the declarations.

A part of that file that is not declared does not count as a claim: it is listed as missing.
"""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from clutchwork.declare.registry import REGISTRY, Role
from clutchwork.declare.schema import specs

FILE = Path(__file__).resolve().parent.parent / "docs" / "parts.toml"
KEYS = {"group", "what", "use", "ours", "names", "alone", "missing", "amesim"} | {
    f"{tool}{end}" for tool in ("modelica", "simscape") for end in ("", "_least")
}
INTRODUCTION = """# Part by part

The parts of a driveline here, in the Modelica Standard Library 4.0, in Simscape Driveline and in Simcenter Amesim,
where they mean the same. A number is that of the fields that the first of them needs at least, ports and initial
values not counted: ours are counted in a use of it that is checked, a law of friction as one, those of the Modelica
library in its source, those of Simscape in its public reference with the simplest options. The public pages of Amesim
name its parts and not their fields, so that column says what a part is. Laws of friction, signals, sweeps, fits and
export do not count as parts and are left out.
"""
HEAD = """
| part | here | | Modelica | | Simscape Driveline | | Amesim |
|---|---|---|---|---|---|---|---|"""


def parts() -> list[dict[str, Any]]:
    """The rows of the file."""
    found: list[dict[str, Any]] = tomllib.loads(FILE.read_text(encoding="utf-8"))["part"]
    return found


def declared() -> dict[str, Any]:
    """All elements by the name of their class."""
    return {
        cls.__name__: cls for role in Role if role not in (Role.LAW, Role.SIGNAL) for cls in REGISTRY[role].values()
    }


def given(part: dict[str, Any]) -> tuple[str, list[str]]:
    """The class of a short use of a part, and the fields that are given in it, ports left out."""
    call: Any = ast.parse(part["use"], mode="eval").body
    name = str(call.func.id)
    cls = declared().get(name)
    ports = {item.name for item, _ in specs(cls, "port", "thermal")} if cls else set()
    return name, [str(item.arg) for item in call.keywords if item.arg not in ports]


def page() -> str:
    """The page."""
    known = declared()
    return "\n".join([INTRODUCTION, *_tables(known), *_alone(known), *_missing(known)])


def _there(part: dict[str, Any], known: dict[str, Any]) -> list[str]:
    return [name for name in part.get("ours", ()) if name in known]


def _first(part: dict[str, Any], known: dict[str, Any]) -> bool:
    """Whether what the claims of a row are about is there."""
    return bool(part.get("names")) or part["ours"][0] in known


def _tables(known: dict[str, Any]) -> Iterator[str]:
    group = ""
    for part in parts():
        ours = _there(part, known)
        if not ours and not part.get("names"):
            continue
        if part["group"] != group:
            group = part["group"]
            yield f"\n## {group}\n{HEAD}"
        links = [f"[{name}](elements/{known[name].kind}.md)" for name in ours]
        links += [f"`cw.{name}`" for name in part.get("names", ())]
        count = str(len(given(part)[1])) if "use" in part and given(part)[0] in known else ""
        cells = [part["what"], ", ".join(links), count]
        for tool in ("modelica", "simscape"):
            cells += [part.get(tool, "-"), str(part.get(f"{tool}_least", ""))]
        yield f"| {' | '.join([*cells, part.get('amesim') or '-'])} |"


def _alone(known: dict[str, Any]) -> Iterator[str]:
    yield "\n## What is different here\n"
    for part in parts():
        if part.get("alone") and _first(part, known):
            yield f"- **{part['what']}**: {part['alone']}"


def _missing(known: dict[str, Any]) -> Iterator[str]:
    yield "\n## What is still missing\n"
    for part in parts():
        lacking = [name for name in part.get("ours", ()) if name not in known]
        if lacking and not _first(part, known):
            yield f"- **{part['what']}**: {', '.join(lacking)}"
        elif part.get("missing"):
            yield f"- **{part['what']}**: {part['missing']}"
