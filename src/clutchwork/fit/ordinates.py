"""Ordinates and axes of the tables of a friction law."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.declare.schema import Spec, specs
from clutchwork.fit.failure import FitError
from clutchwork.laws.bases.tables import Tabulated

if TYPE_CHECKING:
    from clutchwork.declare.node import Law
    from clutchwork.fit.measurement import Measurement


STATIC, KINETIC = "static", "kinetic"
# by so much a static coefficient of a table is above its kinetic ones, at the least
ABOVE = 1.0 + 1e-12
_ROUNDING = 1e-9


def tables(cls: type) -> dict[str, Spec]:
    """Curves, and lists of numbers that are not axes."""
    return {item.name: spec for item, spec in specs(cls, "curve", "numbers") if spec.what == "curve" or not spec.rising}


def ordinates(law: Law, name: str) -> dict[str, float]:
    """Ordinates of a table: `kinetic[2]` is the second one, `kinetic[2][3]` the third one of the second row."""
    value: Any = getattr(law, name)
    made: dict[str, float] = {}
    if tables(type(law))[name].what == "curve":
        value = [y for _, y in value]
    for i, row in enumerate(value, 1):
        if hasattr(row, "__len__"):
            made |= {f"{name}[{i}][{j}]": float(number) for j, number in enumerate(row, 1)}
        else:
            made[f"{name}[{i}]"] = float(row)
    return made


def with_ordinates(law: Law, name: str, values: Sequence[float]) -> Any:
    """What a table is with other ordinates."""
    value, rest = getattr(law, name), iter(values)
    if tables(type(law))[name].what == "curve":
        return [(float(x), next(rest)) for x, _ in value]
    return tuple(tuple(next(rest) for _ in row) if hasattr(row, "__len__") else next(rest) for row in value)


def axis(law: Law, unit: str) -> list[float]:
    """Abscissae of the tables in a unit; empty where there are none."""
    for item, spec in specs(type(law), "curve", "numbers"):
        value = getattr(law, item.name)
        if spec.what == "curve" and spec.unit_x == unit:
            return [float(x) for x, _ in value]
        if spec.what == "numbers" and spec.rising and spec.unit == unit:
            return [float(x) for x in value]
    return []


def rivals(law: Tabulated, point: int) -> list[float]:
    """Kinetic coefficients that one static coefficient must be above."""
    found = list(ordinates(law, KINETIC).values())
    count = len(found) // len(static_ones(law))
    return found[point * count : (point + 1) * count]


def rival(law: Tabulated, point: int) -> float:
    """The static coefficient that one kinetic coefficient must be below."""
    found = static_ones(law)
    return found[point // (len(ordinates(law, KINETIC)) // len(found))]


def static_ones(law: Tabulated) -> list[float]:
    """Static coefficients, one or a table."""
    return list(ordinates(law, STATIC).values()) if STATIC in tables(type(law)) else [float(law.static)]  # type: ignore[arg-type]


def is_outside(law: Law, unit: str, values: Array) -> bool:
    """Whether values are where the tables of a law must not be used."""
    known = axis(law, unit) if law.extrapolation == "error" else []
    if not known:
        return False
    room = _ROUNDING * (known[-1] - known[0])
    return bool(np.min(values) < known[0] - room or np.max(values) > known[-1] + room)


def check_inside(samples: Measurement, law: Law) -> None:
    """Refuse samples where the tables of a law must not be used."""
    rows = [("slip", "rad/s", np.abs(samples.slip))]
    rows += [] if samples.temperature is None else [("temperature", "K", samples.temperature)]
    for name, unit, values in rows:
        if is_outside(law, unit, values):
            shown = "m/s" if samples.translation and name == "slip" else unit
            known, ends = axis(law, unit), (float(np.min(values)), float(np.max(values)))
            fault = f"is {ends[0]:g} to {ends[1]:g} {shown}, the table of the law {known[0]:g} to {known[-1]:g}"
            remedy = 'remove samples beyond it, or set extrapolation to "linear" or "nearest"'
            raise FitError(name, fault, remedy)
