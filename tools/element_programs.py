"""The example of an element: the program in docs/elements/KIND.md, or one that is made from its declaration."""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Iterator
from dataclasses import MISSING
from pathlib import Path
from typing import Any

from clutchwork.declare.schema import Spec, inputs, specs

WORDS = Path(__file__).resolve().parent.parent / "docs" / "elements"
# ports that are not joined to the shaft "a"
OTHERS = {
    "follower": "b",
    "output": "b",
    "ring": "b",
    "carrier": "c",
    "mass": "m",
    "cold": "air",
    "inlet": "air",
    "hot": "plates",
    "heat": "plates",
    "support": "d.housing",
}
NODES = {
    "a": 'a = d.shaft("a", inertia=0.2, speed=100.0)  # kg m2, rad/s',
    "b": 'b = d.shaft("b", inertia=0.8)',
    "c": 'c = d.shaft("c", inertia=0.5)',
    "m": 'm = d.mass("m", mass=10.0)  # kg',
    "plates": 'plates = d.thermal("plates", capacity=500.0, temperature=350.0)  # J/K, K',
    "air": 'air = d.ambient("air", temperature=293.0)  # K',
}
# what to give where the declaration names no example
USUAL = {"Pa": 2e5, "N": 100.0, "N m": 10.0, "rad/s": 100.0, "K": 300.0, "s": 0.05, "m3": 5e-4}


def words(kind: str) -> str:
    """What is written by hand about an element, empty when nothing is."""
    path = WORDS / f"{kind}.md"
    return path.read_text(encoding="utf-8") if path.exists() else ""


def program(cls: Any) -> str:
    """The program of an element's page; it defines the driveline `d` and its `run`."""
    written = re.search(r"^```python\n(.*?)^```", words(cls.kind), re.DOTALL | re.MULTILINE)
    return written[1] if written else made(cls)


def made(cls: Any) -> str:
    """A program from the declaration alone: one element between shafts, with the examples of its fields."""
    given = dict(_fields(cls))
    used = [name for name in NODES if name == "a" or name in given.values()]
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
    needed = {names[0] for names, spec in inputs(cls) if spec.otherwise is None}
    for item, spec in specs(cls):
        required = item.default is MISSING or item.name in needed or spec.example is not None
        # teeth may stand in place of a ratio, diameters in place of a radius
        if required or item.name in ("ratio", "radius"):
            yield item.name, _value(item.name, spec)


def _value(name: str, spec: Spec) -> str:
    if spec.what in ("port", "thermal"):
        return OTHERS.get(name, "m" if spec.domain == "translation" else "a")
    if spec.what == "law":
        return "cw.Coulomb(static=0.12, kinetic=0.1)"
    if spec.what == "curve":
        return repr(list(spec.example or [(0.0, 1.0), (100.0, 0.5)]))
    if spec.what == "signal":
        return repr(USUAL.get(spec.unit, 1.0))
    return repr(spec.example) if spec.example is not None else _number(spec)


def _number(spec: Spec) -> str:
    """A number within the bounds, or the first choice."""
    if spec.choices or spec.flag:
        return repr(spec.choices[0] if spec.choices else True)
    usual = USUAL.get(spec.unit)
    if usual is not None and spec.allows(usual):
        return repr(usual)
    low = max((bound for bound in (spec.above, spec.at_least) if bound is not None), default=0.0)
    if spec.whole:
        return repr(int(low) + 30)
    high = min((bound for bound in (spec.below, spec.at_most) if bound is not None), default=low + 2.0)
    return repr((low + high) / 2)
