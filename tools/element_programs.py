"""The example of an element: the program in docs/elements/KIND.md, or one that is made from its declaration."""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from clutchwork.declare.examples import example
from clutchwork.declare.schema import REGISTRY, Role, Spec, specs

WORDS = Path(__file__).resolve().parent.parent / "docs" / "elements"
# how the shafts, masses and thermal nodes of the examples are made
NODES = {
    "engine": 'engine = d.shaft("engine", inertia=0.2, speed=100.0)  # kg m2, rad/s',
    "load": 'load = d.shaft("load", inertia=0.8)',
    "output": 'output = d.shaft("output", inertia=0.5)',
    "car": 'car = d.mass("car", mass=10.0)  # kg',
    "plates": 'plates = d.thermal("plates", capacity=500.0, temperature=350.0)  # J/K, K',
    "air": 'air = d.ambient("air", temperature=293.0)  # K',
}


def words(name: str) -> str:
    """What is written by hand about an element, empty when nothing is; its page is one folder lower."""
    path = WORDS / f"{name}.md"
    return path.read_text(encoding="utf-8").replace("](../", "](../../") if path.exists() else ""


def program(cls: Any) -> str:
    """The program of an element's page; it defines the driveline `d` and its `run`."""
    written = re.search(r"^```python\n(.*?)^```", words(cls.kind), re.DOTALL | re.MULTILINE)
    return written[1] if written else made(cls)


def made(cls: Any) -> str:
    """A program from the declaration alone: one element between shafts, with the examples of its fields."""
    given = dict(_fields(cls))
    used = [name for name in NODES if name == "engine" or name in given.values()]
    fields = "".join(f"        {name}={value},\n" for name, value in given.items())
    nodes = "".join(f"{NODES[name]}\n" for name in used)
    title = cls.kind.replace("_", " ")
    return (
        f'import clutchwork as cw\n\nd = cw.Driveline("{title}")\n{nodes}d.add(\n    cw.{cls.__name__}(\n        "x",\n'
        f"{fields}    )\n)\nrun = d.simulate(1.0)  # s\nprint(run.events)\n"
    )


def performed(source: str, name: str) -> dict[str, Any]:
    """Run a program, without what it prints, and return what it defines."""
    names: dict[str, Any] = {}
    with contextlib.redirect_stdout(io.StringIO()):
        exec(compile(source, f"example of {name}", "exec"), names)  # noqa: S102, the pages are our own
    return names


def _fields(cls: Any) -> Iterator[tuple[str, str]]:
    sorts = {item.name: spec for item, spec in specs(cls)}
    for name, value in example(cls).items():
        yield name, _python(value, sorts[name])


def _python(value: Any, spec: Spec) -> str:
    """A value of a model file as Python writes it."""
    if spec.what in ("port", "thermal"):
        return "d.housing" if value == "housing" else str(value)
    if spec.what == "law":
        inner = ", ".join(f"{name}={number!r}" for name, number in value.items() if name != "type")
        return f"cw.{REGISTRY[Role.LAW][value['type']].__name__}({inner})"
    if spec.what == "curve":
        return repr([tuple(point) for point in value])
    return repr(tuple(value) if isinstance(value, list) else value)
