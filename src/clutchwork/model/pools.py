"""Parameters and curves of components as the flat pools that the compiled core reads."""

from __future__ import annotations

from dataclasses import field
from itertools import pairwise
from math import nan
from numbers import Real
from typing import Any

import numpy as np

from clutchwork.base import dataclass
from clutchwork.declare.core import core, number
from clutchwork.declare.node import Law
from clutchwork.declare.schema import WORDS, Spec, specs


@dataclass
class Pools:
    """Numbers of all components in order, and the points of their curves."""

    params: list[float] = field(default_factory=list)
    points: list[tuple[float, float, float]] = field(default_factory=list)
    places: dict[str, int] = field(default_factory=dict)  # "c1.gain" -> offset into params

    def add(self, component: Any, path: str) -> int:
        """Append the parameters of a component; the offset of the first one."""
        offset = len(self.params)
        for item, spec in specs(type(component), *WORDS):
            value = getattr(component, item.name)
            if spec.what == "param":
                self.places[f"{path}.{item.name}"] = len(self.params)
                self.params.append(_number(spec, value))
            else:
                points = _words(component, item.name, spec, value)
                self.params += [float(len(self.points)), float(len(points))]
                self.points += points
        return offset


def _words(component: Any, name: str, spec: Spec, value: Any) -> list[tuple[float, float, float]]:
    """The points of a field."""
    if spec.what == "formula":
        return list(component.code(name))
    return _points(value) if spec.what == "curve" else _plain((0.0,) if value is None else value)


def _number(spec: Spec, value: Any) -> float:
    """A parameter as a number; one that is left out is none."""
    if value is None:
        return nan
    return float(spec.choices.index(value) if spec.choices else value)


def _points(value: Any) -> list[tuple[float, float, float]]:
    """Points of a curve; a number is the same everywhere."""
    pairs = [(0.0, value)] if isinstance(value, Real) else value
    return _with_slopes([(float(x), float(y)) for x, y in pairs])


def _plain(value: Any) -> list[tuple[float, float, float]]:
    """Numbers, or rows of numbers one after another, each as the abscissa of a point."""
    flat = [number for row in value for number in (row if hasattr(row, "__len__") else [row])]
    return [(float(number), 0.0, 0.0) for number in flat]


def _with_slopes(points: list[tuple[float, float]]) -> list[tuple[float, float, float]]:
    """Points with the slope to the next one; the last keeps the slope before it."""
    slopes = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(points)] or [0.0]
    return [(x, y, slope) for (x, y), slope in zip(points, [*slopes, slopes[-1]], strict=False)]


def coefficients(law: Law, slip: float) -> tuple[float, float]:
    """Kinetic and static coefficient of a friction law that sticks at a slip [rad/s], by the compiled core."""
    pools = Pools()
    pools.add(law, "law")
    points = np.array(pools.points, dtype=float).reshape(-1, 3)
    kinetic, static = core().law(number(type(law)), np.array(pools.params, dtype=float), points, slip)
    return kinetic, static
