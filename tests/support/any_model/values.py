"""Random values for declared fields, as a model file holds them: their size is that of the unit or of the example."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, Field
from typing import Any

import numpy as np

from clutchwork.declare.schema import REGISTRY, Role, Spec, inputs, specs
from support import random_formulas

Rng = np.random.Generator
Plain = dict[str, Any]

# usual sizes by unit: the smallest and the largest of what is drawn
SIZES: dict[str, tuple[float, float]] = {
    "1": (0.1, 5.0),
    "rad": (0.003, 1.5),
    "rad/s": (0.3, 200.0),
    "rad/s2": (1.0, 500.0),
    "N m": (0.3, 300.0),
    "N": (3.0, 3000.0),
    "kg m2": (0.003, 2.0),
    "kg": (0.1, 300.0),
    "kg/m": (0.05, 1.0),
    "kg/m3": (1.0, 2000.0),
    "kg/s": (1e-3, 0.5),
    "m": (0.02, 0.3),
    "m2": (1e-4, 0.5),
    "m3": (1e-4, 3e-3),
    "m/s": (0.1, 30.0),
    "m3/J": (1e-12, 1e-10),
    "N m/rad": (10.0, 3e4),
    "N/m": (1e3, 1e6),
    "N m s/rad": (0.01, 50.0),
    "N m s2/rad2": (1e-5, 1e-2),
    "N s/m": (10.0, 1e4),
    "Pa": (1e4, 1e6),
    "Pa/s": (1e5, 1e8),
    "Pa/m": (1e5, 1e9),
    "Pa/m3": (1e8, 1e11),
    "m2/s": (1e-6, 1e-4),
    "m3/s": (1e-7, 1e-4),
    "s": (0.003, 0.2),
    "s/rad": (1e-4, 0.1),
    "1/rad": (1e2, 1e4),
    "1/s": (1.0, 200.0),
    "1/m": (1e-2, 10.0),
    "s/m": (1e-3, 1.0),
    "1/K": (1e-4, 1e-2),
    "K": (260.0, 480.0),
    "W": (1.0, 1e5),
    "W/K": (0.1, 100.0),
    "W s/rad": (0.01, 10.0),
    "W s2/rad2": (1e-4, 0.1),
    "W/(N2 m2)": (1e-3, 1.0),
    "W/(m K)": (1.0, 100.0),
    "J/K": (10.0, 1e4),
    "J/(kg K)": (300.0, 4000.0),
    "Hz": (0.5, 30.0),
    "m/s2": (1.0, 20.0),
    "A": (0.05, 1.5),
}
# shares and coefficients, whose unit says nothing
SHARES = {"static": (0.05, 0.5), "kinetic": (0.05, 0.4), "slow": (0.05, 0.4), "fast": (0.05, 0.4)}
SHARES |= {"friction_coefficient": (0.01, 0.4), "efficiency": (0.6, 1.0), "backward_efficiency": (0.4, 1.0)}
SHARES |= {"ratio": (0.3, 4.0), "heat_share": (0.2, 1.0), "restitution": (0.05, 0.9), "phase": (0.05, 0.9)}
# whole numbers, where nothing else is said
TEETH = (12, 90)
SIGNALS = ("sine", "table", "step", "ramp", "pulse", "constant")


def log(rng: Rng, low: float, high: float) -> float:
    """A number between two bounds, uniform in its logarithm; three digits, so that it reads well."""
    return float(f"{math.exp(rng.uniform(math.log(low), math.log(high))):.3g}")


def size(rng: Rng, spec: Spec, name: str) -> float:
    """A positive size for a quantity."""
    if spec.example is not None and isinstance(spec.example, int | float) and spec.example:
        return log(rng, abs(spec.example) / 5, abs(spec.example) * 5)
    return log(rng, *SHARES.get(name, SIZES.get(spec.unit, (0.1, 10.0))))


def signed(rng: Rng, spec: Spec) -> float:
    """A sign that the bounds allow."""
    below = spec.unit != "K" and all(bound is None or bound < 0.0 for bound in (spec.above, spec.at_least))
    return -1.0 if below and rng.random() < 0.5 else 1.0


def number(rng: Rng, spec: Spec, name: str) -> Any:
    """A number, a word or a flag within the bounds."""
    if spec.choices:
        return str(rng.choice(spec.choices))
    if spec.flag:
        return bool(rng.random() < 0.4)
    if name == "tolerance":
        return 0.0 if rng.random() < 0.3 else log(rng, 1e-5, 0.1)
    for _ in range(50):
        if spec.at_least == 0.0 and spec.what != "signal" and rng.random() < 0.15:
            return 0.0
        if spec.whole:
            value: float = int(rng.integers(1, 6)) if spec.at_most else int(rng.integers(*TEETH))
        else:
            value = signed(rng, spec) * size(rng, spec, name)
            if spec.at_most is not None and spec.at_least is not None and rng.random() < 0.5:
                value = float(f"{rng.uniform(spec.at_least, spec.at_most):.3g}")
        if spec.allows(value):
            return value
    return spec.at_most if spec.at_most is not None else (spec.at_least or 0.0) + 0.5 * (spec.below or 1.0)


def curve(rng: Rng, spec: Spec) -> list[list[float]]:
    """Points with rising x: the example with other sizes, or a line of either sign that may bend and fall."""
    if spec.example is not None and not isinstance(spec.example, int | float) and rng.random() < 0.8:
        wide, high = (log(rng, 0.4, 2.5) for _ in "xy")
        if spec.unit_x in ("rad", "K") or spec.unit in ("K",):
            wide = 1.0
        return [
            [x * wide, y * high * (float(rng.uniform(0.7, 1.3)) if rng.random() < 0.3 else 1.0)]
            for x, y in spec.example
        ]
    low, high = SIZES.get(spec.unit_x, (0.1, 10.0))
    count = int(rng.integers(1, 6))
    span = log(rng, low, high)
    xs = np.sort(rng.uniform(-span if rng.random() < 0.5 and spec.unit_x != "K" else 0.0, span, count))
    ys = np.array([size(rng, spec, "") for _ in xs])
    if spec.at_least is None:
        # falling with x, so that it is a load; or anything
        ys = -np.sign(xs) * ys if rng.random() < 0.6 else ys * rng.choice([-1.0, 1.0], count)
        ys = np.sort(ys)[::-1] if rng.random() < 0.5 else ys
    return [[float(f"{x:.4g}"), float(f"{y:.4g}")] for x, y in zip(xs, ys, strict=True)]


def numbers(rng: Rng, spec: Spec, name: str, factors: dict[str, float]) -> Any:
    """A list or rows of numbers: the example in other sizes, the same for all lists of a unit; or a few that rise."""
    if spec.example is None:
        count = int(factors.setdefault("count", float(rng.integers(1, 4))))
        found = sorted(size(rng, spec, name) for _ in range(count))
        return [float(x) for x in found] if spec.rising else [signed(rng, spec) * x for x in found]
    factor = 1.0 if spec.unit in ("1", "K", "m/rad2") else factors.setdefault(spec.unit, log(rng, 0.3, 3.0))
    steady = spec.unit in ("1", "m/rad2") or spec.rising

    def one(x: float) -> float:
        return float(f"{x * factor * (1.0 if steady or rng.random() < 0.5 else rng.uniform(0.8, 1.2)):.4g}")

    return [[one(x) for x in row] if hasattr(row, "__len__") else one(row) for row in spec.example]


def law(rng: Rng, sticks: bool | None = None) -> Plain:
    """A friction law of any kind within its declaration; whether it makes sense is for the checks of the package."""
    kinds = [kind for kind, cls in REGISTRY[Role.LAW].items() if sticks is None or cls.sticks == sticks]
    kind = "coulomb" if rng.random() < 0.3 and sticks is not False else str(rng.choice(kinds))
    made: Plain = {"type": kind}
    cls = REGISTRY[Role.LAW][kind]
    if cls.takes_numbers:
        return made | random_formulas.drawn(rng, cls.sticks)
    factors: dict[str, float] = {}
    for item, spec in specs(cls):
        if item.default is not MISSING and rng.random() < 0.6:
            continue
        made[item.name] = value(rng, item, spec, factors)
    made = {name: given for name, given in made.items() if given is not None}
    static, kinetic = made.get("static"), made.get("kinetic")
    if isinstance(static, float) and isinstance(kinetic, float):
        made["static"] = float(f"{kinetic * (1.0 if rng.random() < 0.3 else rng.uniform(1.0, 1.5)):.4g}")
    if kind == "exponential":
        made["static"] = max(made["static"], made["slow"]) if rng.random() < 0.8 else made["static"]
    return made


def signal(rng: Rng, spec: Spec, name: str, t_end: float, kind: str = "") -> Any:
    """A number or a signal over time of any kind; within the bounds where there are some."""
    scale = size(rng, spec, name) * signed(rng, spec)
    if not kind and rng.random() < 0.35:
        return scale if spec.allows(scale) else number(rng, spec, name)
    kind = kind or str(rng.choice(SIGNALS))
    early = lambda: float(f"{t_end * rng.uniform(0.0, 0.9):.4g}")  # noqa: E731
    level = lambda: float(f"{scale * (0.0 if rng.random() < 0.2 else rng.uniform(0.2, 1.5)):.4g}")  # noqa: E731
    both = spec.above is None and spec.at_least is None and spec.unit != "K"
    if kind == "constant":
        return {"type": kind, "value": scale}
    if kind == "step":
        return {"type": kind, "height": level() * _swing(rng, both), "start": early(), "offset": level()}
    if kind == "ramp":
        return {
            "type": kind,
            "height": level() * _swing(rng, both),
            "start": early(),
            "offset": level(),
            "duration": log(rng, 0.02, 1.0) * t_end,
        }
    if kind == "pulse":
        period = log(rng, 0.05, 1.0) * t_end
        return {
            "type": kind,
            "height": level() * _swing(rng, both),
            "period": period,
            "width": float(f"{period * rng.uniform(0.1, 0.9):.4g}"),
            "start": early() if rng.random() < 0.5 else 0.0,
            "offset": level(),
        }
    if kind == "sine":
        made = {
            "type": kind,
            "amplitude": abs(scale) * float(f"{rng.uniform(0.1, 1.0):.3g}"),
            "frequency": log(rng, 0.5, 10.0) / (2 * t_end),
        }
        made["offset"] = scale if not both else level() * _swing(rng, both)
        made |= {"phase": float(f"{rng.uniform(0, 6.28):.3g}")} if rng.random() < 0.5 else {}
        made |= {"start": early()} if rng.random() < 0.2 else {}
        return made | ({"damping": log(rng, 0.5, 20.0)} if rng.random() < 0.2 else {})
    times = sorted(early() for _ in range(int(rng.integers(1, 6))))
    if len(times) > 1 and rng.random() < 0.5:
        place = int(rng.integers(1, len(times)))
        # a jump
        times[place] = times[place - 1]
    return {"type": "table", "points": [[t, level() * _swing(rng, both)] for t in times]}


def _swing(rng: Rng, both: bool) -> float:
    return -1.0 if both and rng.random() < 0.4 else 1.0


def value(rng: Rng, item: Field[Any], spec: Spec, factors: dict[str, float], t_end: float = 0.3) -> Any:
    """A value for a field that is no port; None: it is left out."""
    if spec.what in ("param", "option"):
        return number(rng, spec, item.name)
    if spec.what in ("signal", "alternative"):
        return signal(rng, spec, item.name, t_end)
    if spec.what == "curve":
        return curve(rng, spec)
    if spec.what == "numbers":
        return numbers(rng, spec, item.name, factors)
    return law(rng) if spec.what == "law" else None


def chosen(rng: Rng, cls: type, given: Mapping[str, Any]) -> list[tuple[Field[Any], Spec]]:
    """The fields to fill: all that must be given, some of the others, one of each pair of alternatives."""
    wanted: set[str] = set()
    for names, spec in inputs(cls):
        must = spec.otherwise is None and (len(names) > 1 or not spec.optional)
        wanted |= {str(rng.choice(names))} if must or rng.random() < 0.4 else set()
    share = float(rng.choice([0.1, 0.3, 0.5]))
    return [
        (item, spec)
        for item, spec in specs(cls)
        if spec.what not in ("port", "thermal")
        and item.name not in given
        and (
            item.name in wanted
            if spec.what in ("signal", "alternative")
            else item.default is MISSING or rng.random() < share
        )
    ]
