"""An example of everything that is declared, as plain values of a model file, made from the declaration."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import MISSING
from typing import Any

from clutchwork.declare.schema import Role, Spec, inputs, specs

# shafts, masses and thermal nodes that the examples join, by port; all other shafts are "engine"
ENDS = {
    "follower": "load",
    "output": "load",
    "ring": "load",
    "carrier": "output",
    "forward": "load",
    "backward": "output",
    "wheel": "load",
    "turbine": "load",
    "mass": "car",
    "cold": "air",
    "inlet": "air",
    "hot": "plates",
    "heat": "plates",
    "support": "housing",
}
# what to give where the declaration names no example, by unit and, before that, by name
USUAL = {
    "Pa": 2e5, "N": 100.0, "N m": 10.0, "rad/s": 100.0, "K": 300.0, "s": 0.05, "m3": 5e-4, "m": 0.1, "m2": 0.01,
    "N m/rad": 1e4, "N m s/rad": 2.0, "m3/J": 1e-14, "W/K": 5.0, "kg/s": 0.05, "kg/m3": 7800.0,
}  # fmt: skip
NAMED = {"ratio": 2.5, "thickness": 0.005, "conductivity": 50.0, "specific_heat": 480.0, "travel": 0.004, "bore": 0.05}
LAW = {"type": "coulomb", "static": 0.12, "kinetic": 0.1}
# fields of signals, which drive a pressure in the examples
OF_SIGNALS = {"width": 0.2, "points": [[0.0, 0.0], [0.2, 2e5]], "*": 2e5, "s": 0.5, "Hz": 10.0, "1/s": 2.0}
WORDS = {"path": "pressures.csv", "column": "c1"}


def example(cls: Any) -> dict[str, Any]:
    """Values of the fields that must be given, and of those with an example, by name; empty where Python is needed."""
    if specs(cls, "function"):
        return {}
    if cls.role is Role.SIGNAL:
        return {item.name: _of_signal(item.name, spec) for item, spec in specs(cls) if item.default is MISSING}
    return dict(_fields(cls))


def _fields(cls: Any) -> Iterator[tuple[str, Any]]:
    needed = {names[0] for names, spec in inputs(cls) if spec.otherwise is None}
    for item, spec in specs(cls):
        required = item.default is MISSING or item.name in needed or spec.example is not None
        # teeth may stand in place of a ratio, diameters in place of a radius
        if required or item.name in ("ratio", "radius"):
            yield item.name, _value(item.name, spec)


def _value(name: str, spec: Spec) -> Any:
    if spec.what in ("port", "thermal"):
        return ENDS.get(name, "car" if spec.domain == "translation" else "engine")
    if spec.what == "law":
        return dict(LAW)
    if spec.what == "curve":
        return _listed(spec.example or [(0.0, 1.0), (100.0, 0.5)])
    if spec.what == "signal":
        return NAMED.get(name, USUAL.get(spec.unit, 1.0))
    return _listed(spec.example) if spec.example is not None else _number(name, spec)


def _of_signal(name: str, spec: Spec) -> Any:
    if spec.what == "text":
        return WORDS.get(name, name)
    return _listed(OF_SIGNALS.get(name) or OF_SIGNALS.get(spec.unit) or _number(name, spec))


def _listed(value: Any) -> Any:
    """Tuples as the lists of a model file."""
    return [_listed(item) for item in value] if isinstance(value, list | tuple) else value


def _number(name: str, spec: Spec) -> Any:
    """A number within the bounds, or the first choice."""
    if spec.choices or spec.flag:
        return spec.choices[0] if spec.choices else True
    for usual in (NAMED.get(name), USUAL.get(spec.unit)):
        if usual is not None and spec.allows(usual):
            return usual
    low = max((bound for bound in (spec.above, spec.at_least) if bound is not None), default=0.0)
    if spec.whole:
        return int(low) + 30
    high = min((bound for bound in (spec.below, spec.at_most) if bound is not None), default=low + 2.0)
    return (low + high) / 2
