"""What a notebook shows of a friction law: its coefficient over slip, and its parameters."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.declare.core import core, number
from clutchwork.declare.schema import specs
from clutchwork.driveline.driveline import Driveline
from clutchwork.elements.bearing_friction import BearingFriction
from clutchwork.elements.prescribed_speed import PrescribedSpeed
from clutchwork.laws.bases.formula import TEMPERATURES
from clutchwork.model.pools import Pools
from clutchwork.plot import declared
from clutchwork.plot.figure import figure_of
from clutchwork.plot.panels import legend
from clutchwork.plot.style import COLOURS, MILLIMETRE, looks
from clutchwork.run.simulation import simulate
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.declare.node import Law
    from clutchwork.declare.schema import Spec
    from clutchwork.plot.canvas import Picture


SLIP = 10.0  # rad/s, where the law has no slip of its own
BEYOND, BEHIND = 5.0, 1.15  # how far over the slip of a formula, and over the last one of a table
POINTS = 241
# a law with states is asked at fewer slips: each is held until the states have settled
HELD, HOLD, TURN = 25, 2.0, 20.0  # slips, s and rad of each at least
SETTLED = 1e-3
HAND_WARM = 300.0  # K, where none counts
FORMULA = [(kelvin, 0.0) for kelvin in TEMPERATURES]  # of a formula over the temperature
SIZE = (130.0, 55.0)  # mm


def parts(law: Law) -> tuple[Picture | None, list[str]]:
    """The curve and the parameters."""
    return declared.parts(law, lambda: _picture(law, curves(law)))


def curves(law: Law) -> dict[str, tuple[Array, Array, float | None]]:
    """Slip [rad/s], coefficient, and the coefficient at rest where it sticks, by temperature where it has one."""
    if law.own_states():
        slips = _largest(law) * np.linspace(0.0, 1.0, HELD + 1)[1:] ** 1.5
        return {"": (slips, settled(law, slips), None)}
    slips, asked = np.linspace(0.0, _largest(law), POINTS), _asked(law)
    made = {}
    for label, inputs in _temperatures(law).items():
        found = np.array([asked(float(slip), inputs) for slip in slips])
        made[label] = (slips, found[:, 0], float(found[0, 1]) if law.sticks else None)
    return made


def _asked(law: Law) -> Any:
    """The compiled core."""
    pools = Pools()
    pools.add(law, "law")
    params, points = np.array(pools.params, dtype=float), np.array(pools.points, dtype=float).reshape(-1, 3)
    place = number(type(law))
    return lambda slip, inputs: core().law(place, params, points, slip, inputs=inputs)


def _temperatures(law: Law) -> Mapping[str, list[float]]:
    """Inputs at which a law is drawn: the temperature that it holds, or some of its table [K], and its pressure."""
    known = specs(type(law), "signal")
    rest = [_constant(getattr(law, item.name), spec) for item, spec in known if item.name != "temperature"]
    if not known or not law.reads("temperature"):
        return {"": [HAND_WARM, *rest] if known else []}
    given = getattr(law, "temperature", None)
    if isinstance(given, Real):
        return {f"{float(given):g} K": [float(given), *rest]}
    warm = getattr(law, "temperatures", None) or [point[0] for point in law.kinetic or FORMULA]  # type: ignore[union-attr, index]
    chosen = sorted({float(warm[0]), float(warm[len(warm) // 2]), float(warm[-1])})
    return {f"{kelvin:g} K": [kelvin, *rest] for kelvin in chosen}


def _constant(value: Any, spec: Spec) -> float:
    """An input as a number."""
    return float(value) if isinstance(value, Real) else spec.otherwise or 0.0


def _largest(law: Law) -> float:
    """Slip up to which its curve is worth seeing [rad/s]."""
    formula, table = [], []
    for item, spec in specs(type(law)):
        value = getattr(law, item.name)
        if "rad/s" in (spec.unit, *spec.units) and isinstance(value, Real) and spec.what == "param":
            formula.append(float(value))
        elif spec.unit == "rad/s" and spec.what == "numbers":
            table.append(float(value[-1]))
        elif spec.unit_x == "rad/s" and not isinstance(value, Real):
            table.append(float(value[-1][0]))
    if table:
        return BEHIND * max(table) or SLIP
    return BEYOND * max(formula, default=0.0) or SLIP


def settled(law: Law, slips: Array) -> Array:
    """Coefficient of a law with states at constant slips [rad/s]; NaN where it does not come to rest."""
    corners, ends, t = [(0.0, 0.0)], list[float](), 0.0
    for slip in slips.tolist():
        held = max(HOLD, TURN / slip)
        corners += [(t + 0.1 * HOLD, slip), (t + 0.1 * HOLD + held, slip)]
        t = corners[-1][0]
        ends += [t - 0.1 * held, t]
    d = Driveline("law")
    shaft = d.shaft("shaft", inertia=1.0)
    d.add(BearingFriction("friction", shaft=shaft, friction=law, torque=1.0))
    d.add(PrescribedSpeed("motion", shaft=shaft, speed=Table(corners)))
    with warnings.catch_warnings():
        # what is rarely wanted in a run is of no matter here
        warnings.simplefilter("ignore")
        run = simulate(d.assemble(), t, times=ends)
    found = np.full(len(ends), np.nan)
    found[: len(run)] = -run["friction.torque"]
    before, last = found.reshape(-1, 2).T
    return np.where(np.abs(last - before) <= SETTLED * np.abs(last), last, np.nan)


def _picture(law: Law, found: Mapping[str, tuple[Array, Array, float | None]]) -> Picture:
    with figure_of(SIZE[1], formulas=False, width=SIZE[0] * MILLIMETRE) as figure:
        axes = figure.subplots()
        for (label, (slips, kinetic, static)), look in zip(found.items(), looks(len(found)), strict=True):
            axes.plot(slips, kinetic, label=label or "sliding", **look)
            if static is not None:
                axes.plot([0.0], [static], "o", color=look["color"], markersize=4.5, clip_on=False,
                          label="at rest" if not label else "_")  # fmt: skip
        axes.set_xlim(0.0, max(float(slips[-1]) for slips, _, _ in found.values()))
        axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
        axes.set_xlabel("slip, rad/s (m/s at masses)")
        axes.set_ylabel("steady coefficient" if law.own_states() else "coefficient of friction")
        axes.axhline(0.0, color=COLOURS[-1], linewidth=0.5)
        legend(axes)
        return figure
