"""Plates whose load rises with the pressure and falls with the wear move as with that load as one signal."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.signals.bases.extremes import extremes
from support.amount import amount
from support.sweep import log_uniform, simulate, stopped, sweep

OPTIONS: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-12, "dt": 0.01}
T_END = 1.0
# of full scale, and of event times [s], at these tolerances
SPEED = 1e-7
TIME = 1e-7
# rise of the threshold with the depth of wear [1/m]
SHIFT = 1e3

# fields of the plates, the same load as one signal, parts that the driveline needs beside
Load = tuple[dict[str, Any], Any, list[Any]]


def sine_of(phasor: complex, frequency: float, offset: float) -> cw.Sine:
    return cw.Sine(amplitude=abs(phasor), frequency=frequency, phase=float(np.angle(phasor)), offset=offset)


def sines(rng: np.random.Generator) -> Load:
    """Two sines of one frequency: their difference is one sine."""
    frequency = log_uniform(rng, 0.5, 6.0)
    up, down = (float(rng.uniform(0.2, 1.0)) * np.exp(1j * rng.uniform(0.0, 6.0)) for _ in range(2))
    offset_up, offset_down = float(rng.uniform(0.0, 1.0)), abs(down) * float(rng.uniform(1.0, 1.5))
    return (
        {
            "normal_force": sine_of(up, frequency, offset_up),
            "wear": sine_of(down / SHIFT, frequency, offset_down / SHIFT),
            "touch_shift": SHIFT,
        },
        sine_of(up - down, frequency, offset_up - offset_down),
        [],
    )


def tables(rng: np.random.Generator) -> Load:
    """Two tables with knots of their own, and the table over all their knots."""
    rows = []
    for low in (-0.2, 0.0):
        times = np.cumsum(rng.uniform(0.05, 0.4, int(rng.integers(2, 6))))
        rows.append((times, rng.uniform(low, 1.0, len(times))))
    knots = np.unique(np.concatenate([times for times, _ in rows]))
    total = np.interp(knots, *rows[0]) - np.interp(knots, *rows[1])
    up, down = (
        cw.Table([(float(t), float(y) / s) for t, y in zip(*row, strict=True)])
        for row, s in zip(rows, (1, SHIFT), strict=True)
    )
    one = cw.Table([(float(t), float(y)) for t, y in zip(knots, total, strict=True)])
    return {"normal_force": up, "wear": down, "touch_shift": SHIFT}, one, []


def reversed_tables(rng: np.random.Generator) -> Load:
    """Closed by a negative pressure, above a threshold."""
    fields, one, parts = tables(rng)
    mirrored = cw.Table([(t, -y) for t, y in fields["normal_force"].points])
    threshold = float(rng.uniform(0.0, 0.3))
    lower = cw.Table([(t, y - threshold) for t, y in one.points])
    return fields | {"normal_force": mirrored, "threshold": threshold, "reversed": True}, lower, parts


def actuator(rng: np.random.Generator) -> Load:
    """The pressure of a piston, a state that several contacts may share, against a wear that settles as fast."""
    lag, wanted, first = log_uniform(rng, 0.05, 0.5), float(rng.uniform(0.0, 1.5)), float(rng.uniform(0.0, 1.5))
    settled, depth = float(rng.uniform(0.2, 1.0)), 0.0
    depth = settled * float(rng.uniform(-1.0, 1.0))
    piston = cw.PressureActuator("piston", command=wanted, lag=lag, filled=True, initial_pressure=first)
    fading = {"frequency": 0.0, "phase": np.pi / 2, "damping": 1 / lag}
    wear = cw.Sine(amplitude=depth / SHIFT, offset=settled / SHIFT, **fading)
    one = cw.Sine(amplitude=first - wanted - depth, offset=wanted - settled, **fading)
    return {"pressure": piston, "wear": wear, "touch_shift": SHIFT}, one, [piston]


def driveline(rng: np.random.Generator, kind: Any, fields: dict[str, Any], parts: list[Any]) -> cw.Driveline:
    """Two discs whose slip the plates take out and two torques drive."""
    d = cw.Driveline("two inputs")
    a = d.shaft("a", inertia=log_uniform(rng, 0.1, 1.0), speed=float(rng.uniform(-10.0, 10.0)))
    b = d.shaft("b", inertia=log_uniform(rng, 0.1, 1.0))
    for part in parts:
        d.add(part)
    kinetic = float(rng.uniform(0.5, 1.0))
    law = cw.Coulomb(static=kinetic * float(rng.uniform(1.0, 1.3)), kinetic=kinetic)
    torque = float(rng.uniform(-10.0, 10.0))
    d.add(cw.Torque("t", shaft=a, base=b, torque=torque))
    d.add(kind("c", base=a, follower=b, friction=law, gain=20.0, **fields))
    return d


def same(seed: int, make: Callable[[np.random.Generator], Load]) -> str:
    fields, one, parts = make(np.random.default_rng([seed, 30]))
    name = "pressure" if "pressure" in fields else "normal_force"
    plates = driveline(np.random.default_rng([seed, 31]), cw.PlateContact, fields, parts)
    # a load that never presses is refused
    presses = max(value for _, value in extremes(one)) > 0
    alone = driveline(np.random.default_rng([seed, 31]), cw.Clutch, {name: one if presses else 0.0}, [])
    two, single = simulate(plates, T_END, **OPTIONS), simulate(alone, T_END, **OPTIONS)
    if text := stopped(two) or stopped(single):
        return text
    exact = np.array([single[name] for name in ("a.speed", "b.speed")])
    error = np.max(np.abs(exact - [two["a.speed"], two["b.speed"]])) / np.max(np.abs(exact))
    events = [[(e.time, e.after) for e in run.events.changes()] for run in (two, single)]
    if not error <= SPEED:
        return f"speeds differ by {error:.1e} of full scale, events {events[0]}, as one signal {events[1]}"
    if [after for _, after in events[0]] != [after for _, after in events[1]]:
        return f"events {events[0]}, as one signal {events[1]}"
    late = max((abs(x[0] - y[0]) for x, y in zip(*events, strict=True)), default=0.0)
    return "" if late <= TIME else f"events differ by {late:.1e} s"


@pytest.mark.random
@pytest.mark.parametrize("make", [sines, tables, reversed_tables, actuator])
def test_same_as_one_signal(make: Callable[[np.random.Generator], Load]) -> None:
    sweep(lambda seed: same(seed, make), amount() // 2)
