"""Random friction laws within what their declarations allow, from a generator of numbers."""

from __future__ import annotations

from dataclasses import MISSING, Field
from typing import Any

import numpy as np

from clutchwork.declare.schema import Spec, inputs, specs
from clutchwork.model.fields import law_problems
from clutchwork.model.numbers import At
from support.random_formulas import drawn

# points along every axis of a table
POINTS = 4


def random_law(cls: Any, rng: np.random.Generator) -> Any:
    """A law of a class without a mistake."""
    while True:
        law = cls(**(drawn(rng, cls.sticks) if cls.takes_numbers else _fields(cls, rng)))
        if not any(law_problems(law, At("law", ""))):
            return law


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _axis(rng: np.random.Generator, unit: str) -> list[float]:
    """Temperatures [K], or slips from 0 or from above it."""
    low, high = (250.0, 700.0) if unit == "K" else (0.0, _log(rng, 0.1, 500.0))
    values = np.sort(rng.uniform(low, high, POINTS))
    values[0] = low if unit == "K" or rng.random() < 0.7 else values[0]
    return [float(x) for x in values]


def _coefficient(rng: np.random.Generator, name: str) -> float:
    return float(rng.uniform(0.3, 0.5) if name == "static" else rng.uniform(0.001, 0.3))


def _table(name: str, spec: Spec, rng: np.random.Generator, axes: dict[str, list[float]]) -> Any:
    if spec.what == "numbers" and spec.rising:
        return tuple(axes.setdefault(spec.unit, _axis(rng, spec.unit)))
    if spec.what == "numbers":
        row = lambda: tuple(_coefficient(rng, name) for _ in range(POINTS))  # noqa: E731
        return row() if name == "static" else tuple(row() for _ in range(POINTS))
    if spec.unit_x == "rad":
        # elastic elements: deflections that rise, shares that sum to one
        shares = rng.dirichlet(np.ones(POINTS))
        return [(1e-5 * (k + float(rng.uniform(0.5, 1.4))), float(share)) for k, share in enumerate(shares)]
    return [(x, _coefficient(rng, name)) for x in axes.setdefault(spec.unit_x, _axis(rng, spec.unit_x))]


def _number(item: Field[Any], spec: Spec, rng: np.random.Generator) -> Any:
    if spec.choices:
        return str(rng.choice(spec.choices))
    if spec.flag:
        return bool(rng.random() < 0.3)
    if item.name in ("static", "slow", "fast", "kinetic"):
        return float(rng.uniform(1e-3, 0.4))
    if spec.at_least == 0.0 and rng.random() < 0.2:
        return 0.0
    # a default of zero is a choice, no size
    size = spec.example or (0.0 if item.default is MISSING else item.default)
    return float(size) * _log(rng, 0.1, 10.0)


def _fields(cls: Any, rng: np.random.Generator) -> dict[str, Any]:
    axes: dict[str, list[float]] = {}
    made = {item.name: _table(item.name, spec, rng, axes) for item, spec in specs(cls, "curve", "numbers")}
    made |= {item.name: _number(item, spec, rng) for item, spec in specs(cls, "param")}
    # what counts only with another choice keeps its default
    if made.get("shape", "power") != "power":
        made.pop("exponent", None)
    if made.get("reset", "saturate") != "saturate":
        made.pop("range", None)
    for names, _ in inputs(cls):
        made[names[0]] = float(rng.uniform(100.0, 1500.0))
    return made
