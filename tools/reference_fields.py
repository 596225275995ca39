"""What reference pages say of any declaration: its words, its entry in the index, a table of its fields."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from dataclasses import MISSING, Field
from pathlib import Path
from typing import Any

from clutchwork.declare.schema import REGISTRY, Spec, specs

ROOT = Path(__file__).resolve().parent.parent
SORTS = {
    "param": "number",
    "alternative": "signal",
    "option": "setting",
    "law": "friction law",
    "thermal": "thermal port",
}


def prose(cls: type) -> str:
    """The docstring without its list of parameters."""
    return (inspect.getdoc(cls) or "").partition("\n\nParameters:\n")[0]


def summary(cls: type) -> str:
    """First sentence or two, for a cell of a table."""
    return prose(cls).partition("\n\n")[0].replace("\n", " ").replace("|", "\\|")


def described(cls: Any) -> str:
    """How it is called, which is also its entry in the index."""
    positional = [item.name for item, _ in specs(cls) if not item.kw_only]
    keywords = [item.name for item, _ in specs(cls) if item.kw_only and item.default is MISSING]
    first = ["name"] if "name" in inspect.signature(cls).parameters else []
    more = ["..."] if any(item.kw_only and item.default is not MISSING for item, _ in specs(cls)) else []
    call = ", ".join([*first, *positional, *(["*", *keywords, *more] if keywords or more else [])])
    return f"```{{eval-rst}}\n.. py:class:: clutchwork.{cls.__name__}({call})\n```\n"


def linked(cls: type, root: str = "../..") -> str:
    """The docstring with links: digital object identifiers, pages of the theory, other elements and laws."""
    text = re.sub(r"doi:(10\.[^\s,]*[^\s,.])", r"[doi:\1](<https://doi.org/\1>)", prose(cls))
    text = re.sub(r"docs/theory/([\w-]+)\.md", rf"[\1]({root}/theory/\1.md)", text)
    known = {other.__name__: kind for kinds in REGISTRY.values() for kind, other in kinds.items() if other is not cls}
    return re.sub(
        r"`([A-Z]\w+)`",
        lambda found: f"{{ref}}`{found[1]} <{known[found[1]]}>`" if found[1] in known else found[0],
        text,
    )


def table(cls: type) -> Iterator[str]:
    """All fields with unit, default, bound and meaning."""
    yield "## Fields\n\n| field | unit | default | meaning |\n|---|---|---|---|"
    for item, spec in specs(cls):
        cells = (f"`{item.name}`", _unit(spec), _default(item, spec), _meaning(spec))
        yield f"| {' | '.join(cells)} |"
    yield ""


def header(kind: str, folder: str) -> str:
    """Where the equations are in the code."""
    found = sorted((ROOT / "cpp" / "include").rglob(f"{folder}/{kind}.hpp"))
    return f"Header: `{found[0].relative_to(ROOT)}`\n" if found else ""


def _unit(spec: Spec) -> str:
    if spec.flag or spec.choices or spec.what == "law":
        return ""
    unit = f"{spec.unit_x} -> {spec.unit}" if spec.what == "curve" else spec.unit
    return " or ".join(dict.fromkeys((unit.replace("*", "of its input"), *spec.units))) if unit else ""


def _meaning(spec: Spec) -> str:
    sort = (
        "flag"
        if spec.flag
        else f"one of {', '.join(spec.choices)}"
        if spec.choices
        else SORTS.get(spec.what, spec.what)
    )
    instead = f" (instead of `{spec.instead_of}`)" if spec.instead_of else ""
    bound = f", {spec.bound}" if spec.bound else ""
    return f"{spec.doc}{instead}; *{sort}{bound}*"


def _default(item: Field[Any], spec: Spec) -> str:
    if item.default is MISSING:
        return "required"
    if item.default is None:
        return "the housing" if spec.what == "port" else "none"
    if spec.flag:
        return "true" if item.default else "false"
    return f"{item.default:g}" if isinstance(item.default, int | float) else str(item.default)
