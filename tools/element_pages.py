"""Pages of the elements: one each, with an example, its picture, what it reads and what it reports."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import element_figures
import element_programs
import element_results
from clutchwork.declare.purposes import ELEMENT_ROLES, groups
from clutchwork.declare.schema import specs
from reference_fields import entry, linked, summary, table

INTRODUCTION = """# Elements

The components of a driveline. Ports name the shafts that an element joins; `torque` is what it applies to its follower,
or to its shaft, see [signs](../guide/signs.md). Each page has an example that runs."""


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
    yield from element_results.section(cls, example)
    if _has_linings(cls):
        yield element_programs.words("_linings")


def _words(kind: str) -> tuple[str, str, str]:
    """What is written by hand: before the program, after it, and in sections of its own."""
    text, _, sections = element_programs.words(kind).partition("\n## ")
    before, _, rest = text.partition("```python\n")
    after = rest.partition("\n```\n")[2].strip() if rest else ""
    return before, f"{after}\n\n" if after else "", f"## {sections}" if sections else ""


def _gain(cls: Any) -> str:
    """How the gain follows from the geometry, where it is a field."""
    return (
        element_programs.words("_gain")
        if any(item.name == "gain" and spec.unit == "m3" for item, spec in specs(cls))
        else ""
    )


def _has_linings(cls: Any) -> bool:
    """Whether its friction law is that of linings, and not a torque over a given one."""
    found = [(item, spec) for item, spec in specs(cls)]
    return any(spec.what == "law" for _, spec in found) and not any(
        spec.what == "param" and spec.unit == "N m" for _, spec in found
    )
