"""Pages of the elements: one each, with an example, its picture, what it reads and what it reports."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import element_figures
import element_programs
from clutchwork.declare.purposes import ELEMENT_ROLES, groups
from clutchwork.declare.schema import Spec, inputs, specs
from clutchwork.elements.plate_contact import PlateContact
from reference_fields import entry, linked, summary, table

INTRODUCTION = """# Elements

The components of a driveline. Ports name the shafts that an element joins; `torque` is what it applies to its follower,
or to its shaft, see [signs](../guide/signs.md). Each page has an example that runs."""

# what the signals of shafts and masses inside of an element mean
INSIDE = {
    "speed": "speed of a shaft or mass inside",
    "angle": "its angle",
    "position": "its position",
    "acceleration": "its acceleration",
}
# what the signals of a result mean that are not inputs or states
MEANINGS = {
    "torque": "torque on its follower, or on its shaft",
    "slip": "follower minus base, exactly zero while locked",
    "rate": "follower minus base",
    "power": "torque times slip or rate, the work done on the driveline",
    "work": "integral of the power",
    "heat": "heat that it has made, or taken",
    "heat_flow": "heat that flows from hot to cold, or to the inlet",
    "mode": "1 forward, 0 locked, -1 backward, 2 open",
    "state": "the mode in a word",
    "capacity": "largest torque that it can hold",
    "temperature": "temperature",
    "twist": "follower minus base, the free angle taken off",
}


def pages() -> Iterator[tuple[str, str]]:
    """Name and text of the overview and of every page."""
    yield "elements", "\n".join(_overview())
    for kinds in groups(*ELEMENT_ROLES).values():
        for kind, cls in kinds.items():
            yield f"elements/{kind}", "\n".join(_page(kind, cls))


def _overview() -> Iterator[str]:
    yield INTRODUCTION
    for heading, kinds in groups(*ELEMENT_ROLES).items():
        yield f"\n## {heading}\n\n{{.fields}}\n| element | type in files | |\n|---|---|---|"
        for kind, cls in kinds.items():
            yield f"| [{cls.__name__}](elements/{kind}.md) | `{kind}` | {summary(cls)} |"
    yield "\n```{toctree}\n:hidden:\n:maxdepth: 1\n"
    yield from (f"elements/{kind}" for kinds in groups(*ELEMENT_ROLES).values() for kind in kinds)
    yield "```\n"


def _page(kind: str, cls: Any) -> Iterator[str]:
    source = element_programs.program(cls)
    example = element_figures.example(cls, source)
    before, after, sections = _words(kind)
    yield f"({kind})=\n# {cls.__name__}\n"
    yield entry(cls)
    yield f'In model files: `type = "{kind}"`.\n'
    yield f"{linked(cls)}\n"
    yield f"## Example\n\n{before}```python\n{source}```\n\n{after}"
    yield f"```{{figure}} {kind}.svg\n:alt: Result of the example of {cls.__name__}\n:width: 100%\n```\n"
    yield sections or _gain(cls)
    yield "## Fields\n"
    yield from table(cls)
    yield from _results(cls, example)
    if _has_linings(cls):
        yield _shared("_linings")


def _words(kind: str) -> tuple[str, str, str]:
    """What is written by hand: before the program, after it, and in sections of its own."""
    text, _, sections = element_programs.words(kind).partition("\n## ")
    before, _, rest = text.partition("```python\n")
    after = rest.partition("\n```\n")[2].strip() if rest else ""
    return before, f"{after}\n\n" if after else "", f"## {sections}" if sections else ""


def _gain(cls: Any) -> str:
    """How the gain follows from the geometry, where it is a field."""
    return _shared("_gain") if any(item.name == "gain" and spec.unit == "m3" for item, spec in specs(cls)) else ""


def _has_linings(cls: Any) -> bool:
    """Whether its friction law is that of linings, and not a torque over a given one."""
    found = [(item, spec) for item, spec in specs(cls)]
    return any(spec.what == "law" for _, spec in found) and not any(
        spec.what == "param" and spec.unit == "N m" for _, spec in found
    )


def _shared(name: str) -> str:
    return (element_programs.WORDS / f"{name}.md").read_text(encoding="utf-8")


def _results(cls: Any, example: element_figures.Example) -> Iterator[str]:
    """The signals that the example reports of the element."""
    docs = INSIDE | _meanings(PlateContact, *_elements()) | _meanings(cls) | MEANINGS
    unused = {name for name, spec in _optional(cls) if name not in example.given}
    yield (
        f'## Results\n\n`run["{example.name}.torque"]` and so on, of the example:\n'
        if any(name.endswith(".torque") for name, _ in example.signals)
        else "## Results\n\nOf the example:\n"
    )
    yield "{.fields}\n| signal | unit | |\n|---|---|---|"
    for name, unit in example.signals:
        last = name.rpartition(".")[2]
        if last not in unused:
            meaning = docs.get(last) or _meanings(cls).get(last.removesuffix("_signal")) or _at_port(last)
            yield f"| `{name}` | {unit} | {meaning} |"
    yield ""


def _meanings(*known: Any) -> dict[str, str]:
    """Meanings of the inputs and states of some elements, the first one that has a name gives its meaning."""
    found: dict[str, str] = {}
    for cls in known:
        for item, spec in specs(cls, "signal", "alternative"):
            found.setdefault(item.name, spec.doc)
        for state in cls.states:
            found.setdefault(state.name, state.doc)
    return found


def _elements() -> Iterator[Any]:
    for kinds in groups(*ELEMENT_ROLES).values():
        yield from kinds.values()


def _optional(cls: type) -> Iterator[tuple[str, Spec]]:
    """Inputs that count as a number where they are not given, those of plates inside included."""
    for known in (cls, PlateContact):
        for names, spec in inputs(known):
            if spec.otherwise is not None:
                yield from ((name, spec) for name in names)


def _at_port(name: str) -> str:
    found = re.fullmatch(r"torque_(\w+)", name)
    return f"torque on the {found[1]}" if found else ""
