"""Write the reference pages of elements, friction laws and signals from their declarations.

Usage: gen_docs.py FOLDER. The documentation build calls it; its output is never committed.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Iterator
from dataclasses import MISSING, Field
from pathlib import Path
from typing import Any, NamedTuple

import clutchwork  # noqa: F401  importing the package fills the registry
from clutchwork.schema import REGISTRY, Role, Spec, specs


class Page(NamedTuple):
    """One page: file, title, introduction, heading of each role, folder of the C++ headers."""

    name: str
    title: str
    introduction: str
    roles: dict[Role, str]
    headers: str


PAGES = (
    Page(
        "elements",
        "Elements",
        "A component of the driveline. Ports name the shafts that it joins; `torque` is what it applies to its follower"
        " (or shaft), see [signs](../guide/signs.md).",
        {
            Role.CONTACT: "Contacts: friction that sticks",
            Role.TORQUE: "Springs, dampers and torque sources",
            Role.GEAR: "Gears",
            Role.MOTION: "Prescribed motion",
        },
        "elements",
    ),
    Page(
        "laws",
        "Friction laws",
        "Coefficient of friction over slip, for the field `friction` of a contact.",
        {Role.LAW: ""},
        "laws",
    ),
    Page(
        "signals",
        "Signals",
        "A value over time, for every field of the kind *signal*. A plain number is a constant signal.",
        {Role.SIGNAL: ""},
        "",
    ),
)

SORTS = {"param": "number", "alternative": "signal", "option": "setting", "law": "friction law"}


def write(folder: Path) -> list[Path]:
    """Write all pages and return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    return [_write(folder / f"{page.name}.md", "\n".join(_page(page))) for page in PAGES]


def _write(path: Path, text: str) -> Path:
    # an unchanged file keeps its date, so that the documentation build stays incremental
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
    return path


def _page(page: Page) -> Iterator[str]:
    yield f"# {page.title}\n\n{page.introduction}\n"
    for role, heading in page.roles.items():
        if heading:
            yield f"## {heading}\n"
        level = "###" if heading else "##"
        for kind, cls in sorted(REGISTRY[role].items()):
            yield from _component(level, kind, cls, page.headers)


def _component(level: str, kind: str, cls: type, headers: str) -> Iterator[str]:
    yield f"({kind})=\n{level} {cls.__name__}\n"
    yield f'`cw.{cls.__name__}`, in model files `type = "{kind}"`\n'
    yield f"{inspect.getdoc(cls)}\n"
    yield "| field | sort | unit | default | bound | meaning |\n|---|---|---|---|---|---|"
    yield from (_row(item, spec) for item, spec in specs(cls))
    yield ""
    states = getattr(cls, "states", ())
    if states:
        yield "State: " + "; ".join(f"`{s.name}` [{s.unit}], {s.doc}" for s in states) + ".\n"
    header = Path(__file__).resolve().parent.parent / "cpp" / "include" / "clutchwork" / headers / f"{kind}.hpp"
    if headers and header.exists():
        yield f"Equations: `cpp/include/clutchwork/{headers}/{kind}.hpp`\n"


def _row(item: Field[Any], spec: Spec) -> str:
    sort = "flag" if spec.flag else SORTS.get(spec.what, spec.what)
    unit = f"{spec.unit_x} -> {spec.unit}" if spec.what == "curve" else spec.unit
    units = (
        " or ".join(dict.fromkeys((unit.replace("*", "of its input"), *spec.units))) if unit and not spec.flag else ""
    )
    cells = (f"`{item.name}`", sort, units, _default(item, spec), spec.bound, _meaning(spec))
    return "| " + " | ".join(cells) + " |"


def _meaning(spec: Spec) -> str:
    return f"{spec.doc} (instead of `{spec.instead_of}`)" if spec.instead_of else spec.doc


def _default(item: Field[Any], spec: Spec) -> str:
    if item.default is MISSING:
        return "required"
    if item.default is None:
        return "the housing" if spec.what == "port" else "none"
    if spec.flag:
        return "true" if item.default else "false"
    return f"{item.default:g}" if isinstance(item.default, int | float) else str(item.default)


if __name__ == "__main__":
    for page in write(Path(sys.argv[1])):
        print(page)
