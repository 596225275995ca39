"""Two discs that a clutch engages: the time of the lock against quadrature of J dw/(T mu(w)), default options.

The coefficient rises in the last rad/s before the slip vanishes. A step that runs over it locks too late, and the
lock depends on where the steps happen to lie, that is on t_end.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator

import clutchwork as cw
from support.amount import amount
from support.sweep import log_uniform, simulate, stopped, sweep

# asked for: relative error of a lock time at default options
LOCK_TIME = 2e-5

SHAPES = ("gaussian", "tustin", "lorentz", "power")
Curve = Callable[[np.ndarray], np.ndarray]
NODES, WEIGHTS = np.polynomial.legendre.leggauss(20)


@dataclass(frozen=True)
class Engagement:
    """Two discs, the torque per coefficient [N m], and a friction law with its coefficient over slip."""

    inertia: tuple[float, float]
    speed: float
    torque: float
    law: Any
    coefficient: Curve
    # slip at which it locks [rad/s], and slips where the curve has kinks
    lock: float = 0.0
    kinks: tuple[float, ...] = ()

    def deceleration(self) -> float:
        """Rate at which the slip falls, per coefficient [rad/s2]."""
        return self.torque * (1 / self.inertia[0] + 1 / self.inertia[1])

    def lock_time(self) -> float:
        """Quadrature over pieces that shrink towards zero slip, so that the narrowest rise is resolved."""
        pieces = self.speed * 2.0 ** -np.arange(0, 50)
        ends = np.array([x for x in (*self.kinks, *pieces) if self.lock < x < self.speed] + [self.lock, self.speed])
        ends = np.unique(ends)
        half, middle = np.diff(ends) / 2, (ends[1:] + ends[:-1]) / 2
        slips = middle[:, None] + half[:, None] * NODES
        return float(np.sum(half[:, None] * WEIGHTS / self.coefficient(slips)) / self.deceleration())

    def driveline(self) -> tuple[cw.Driveline, cw.Node, cw.Node]:
        d = cw.Driveline("two discs")
        a, b = d.shaft("a", inertia=self.inertia[0], speed=self.speed), d.shaft("b", inertia=self.inertia[1])
        d.add(cw.Clutch("c", base=a, follower=b, friction=self.law, gain=1.0, normal_force=self.torque))
        return d, a, b


def discs(rng: np.random.Generator) -> dict[str, Any]:
    """Inertias, speed and torque of an engagement that takes about a second."""
    inertia = (log_uniform(rng, 0.02, 2.0), log_uniform(rng, 0.02, 2.0))
    speed = log_uniform(rng, 20.0, 500.0)
    reduced = 1 / (1 / inertia[0] + 1 / inertia[1])
    return {"inertia": inertia, "speed": speed, "torque": reduced * speed / 0.1 / log_uniform(rng, 0.2, 5.0)}


def shape_of(kind: str, exponent: float) -> Curve:
    return {
        "gaussian": lambda x: np.exp(-(x**2)),
        "tustin": lambda x: np.exp(-x),
        "lorentz": lambda x: 1 / (1 + x**2),
        "power": lambda x: np.exp(-(x**exponent)),
    }[kind]


def stribeck_fields(rng: np.random.Generator) -> tuple[dict[str, Any], Curve]:
    """Fields of a law with a Stribeck curve, and its coefficient over slip."""
    kind = SHAPES[int(rng.integers(4))]
    exponent = float(rng.uniform(0.5, 3.0)) if kind == "power" else 2.0
    kinetic = float(rng.uniform(0.06, 0.12))
    static, speed = kinetic * float(rng.uniform(1.05, 1.6)), log_uniform(rng, 0.05, 30.0)
    viscous = log_uniform(rng, 1e-6, 1e-4) if rng.random() < 0.3 else 0.0
    shape = shape_of(kind, exponent)
    fields = {"static": static, "kinetic": kinetic, "speed": speed, "shape": kind, "exponent": exponent}
    return fields | {"viscous": viscous}, lambda w: kinetic + (static - kinetic) * shape(w / speed) + viscous * w


def with_stribeck(rng: np.random.Generator) -> Engagement:
    fields, coefficient = stribeck_fields(rng)
    return Engagement(**discs(rng), law=cw.Stribeck(**fields), coefficient=coefficient)


def with_karnopp(rng: np.random.Generator) -> Engagement:
    """It locks at the edge of its band, where the momentum that is left is taken out at once."""
    fields, coefficient = stribeck_fields(rng)
    band = fields["speed"] * log_uniform(rng, 1e-3, 0.3)
    return Engagement(**discs(rng), law=cw.Karnopp(**fields, band=band), coefficient=coefficient, lock=band)


def with_exponential(rng: np.random.Generator) -> Engagement:
    fast = float(rng.uniform(0.06, 0.12))
    slow, speed = fast * float(rng.uniform(0.7, 1.6)), log_uniform(rng, 0.05, 30.0)
    law = cw.Exponential(static=max(slow, fast) * float(rng.uniform(1.0, 1.3)), slow=slow, fast=fast, speed=speed)
    return Engagement(**discs(rng), law=law, coefficient=lambda w: fast + (slow - fast) * np.exp(-w / speed))


def table(rng: np.random.Generator) -> list[tuple[float, float]]:
    """Coefficients over slips that crowd at zero, up to a slip that no run reaches."""
    first = log_uniform(rng, 0.05, 30.0)
    slips = np.concatenate([[0.0], first * np.cumprod(np.append(1.0, rng.uniform(1.3, 4.0, 4)))])
    slips = np.append(slips, slips[-1] + 600.0)
    values = float(rng.uniform(0.06, 0.12)) * rng.uniform(0.7, 1.4, len(slips))
    return [(float(x), float(y)) for x, y in zip(slips, values, strict=True)]


def with_smooth_table(rng: np.random.Generator) -> Engagement:
    """SciPy's monotone cubic is an implementation of its own."""
    points = table(rng)
    x, y = np.array(points).T
    law = cw.FrictionTable(static=1.02 * float(y.max()), kinetic=points, interpolation="smooth")
    return Engagement(**discs(rng), law=law, coefficient=PchipInterpolator(x, y), kinks=tuple(x))


def with_linear_table(rng: np.random.Generator) -> Engagement:
    points = table(rng)
    x, y = np.array(points).T
    kind = (cw.FrictionTable, cw.CoefficientTable)[int(rng.integers(2))]
    law = kind(static=1.02 * float(y.max()), kinetic=points)
    return Engagement(**discs(rng), law=law, coefficient=lambda w: np.interp(w, x, y), kinks=tuple(x))


def locked_at(run: Any) -> float:
    """Time of the first lock of the clutch; infinite where there is none."""
    return next((e.time for e in run.events.of("c") if e.after == "locked"), np.inf)


def check(made: Engagement, rng: np.random.Generator) -> str:
    """Two ends of the run behind the lock: each time of the lock against the quadrature."""
    driveline, *_ = made.driveline()
    exact = made.lock_time()
    for share in (float(rng.uniform(1.01, 1.3)), float(rng.uniform(1.3, 4.0))):
        run = simulate(driveline, share * exact)
        error = (locked_at(run) - exact) / exact
        if not abs(error) <= LOCK_TIME or stopped(run):
            return f"t_end {share * exact:.6g} s, lock {locked_at(run):.9g} s, exact {exact:.9g} s ({error:.1e})"
    return ""


def checker(make: Callable[[np.random.Generator], Engagement]) -> Callable[[int], str]:
    def of(seed: int) -> str:
        rng = np.random.default_rng([seed, 1])
        return check(make(rng), rng)

    return of


@pytest.mark.random
def test_stribeck() -> None:
    sweep(checker(with_stribeck), amount())


@pytest.mark.random
def test_karnopp() -> None:
    sweep(checker(with_karnopp), amount())


@pytest.mark.random
def test_exponential() -> None:
    sweep(checker(with_exponential), amount())


@pytest.mark.random
def test_smooth_table() -> None:
    sweep(checker(with_smooth_table), amount())


@pytest.mark.random
def test_linear_table() -> None:
    sweep(checker(with_linear_table), amount())


def gms(seed: int) -> str:
    """GMS never locks: the time at which its slip vanishes first, against a solution of its own.

    Until then every element slides once it has been wound up, so that all have the same share of the curve: with
    z = f/share, dw/dt = -D z and dz/dt = C (1 - z/s(w)). Winding up element i takes the deflection d_i s(w0)/static,
    over which it lacks half of its coefficient; what this leaves in speed is put into the start.
    """
    rng = np.random.default_rng([seed, 2])
    fields, _ = stribeck_fields(rng)
    fields["viscous"] = 0.0
    elements = [(2e-5, 0.1), (5e-5, 0.2), (1e-4, 0.3), (2e-4, 0.4)]
    attraction = log_uniform(rng, 50.0, 500.0)
    shape = shape_of(fields["shape"], fields["exponent"])
    made = Engagement(**discs(rng), law=cw.GMS(**fields, elements=elements, attraction=attraction), coefficient=shape)
    rate, rise = made.deceleration(), fields["static"] - fields["kinetic"]

    def level(w: float) -> float:
        return float(fields["kinetic"] + rise * shape(max(w, 0.0) / fields["speed"]))

    start = level(made.speed)
    lacking = sum(share * deflection for deflection, share in elements) / made.speed * start**2 / fields["static"] / 2
    # the slip as the variable: it falls all the way, and its steps see the rise that one over time would miss
    grid = made.speed * 2.0 ** -np.arange(0, 42)

    def rates(w: float, y: np.ndarray) -> list[float]:
        return [-1 / (rate * y[1]), -attraction * (1 - y[1] / level(w)) / (rate * y[1])]

    y = np.array([0.0, start])
    first = made.speed + rate * lacking
    for high, low in zip([first, *grid[1:-1]], [*grid[1:-1], 0.0], strict=True):
        y = solve_ivp(rates, (high, low), y, "LSODA", rtol=1e-9, atol=1e-12).y[:, -1]
    exact = float(y[0])
    run = simulate(made.driveline()[0], exact * float(rng.uniform(1.01, 1.1)))
    slip = run["c.slip"]
    after = np.flatnonzero(slip >= -1e-9)
    found = float(run.time[after[0]]) if after.size else np.inf
    # the zero is an event, at which there is a row; without one the row behind it lies off
    error = (found - exact) / exact
    if not abs(error) <= LOCK_TIME or stopped(run):
        return f"slip vanishes at {found:.9g} s, exact {exact:.9g} s ({error:.1e})"
    return ""


@pytest.mark.random
def test_gms_slip_vanishes() -> None:
    sweep(gms, amount())
