"""A load that passes zero is the same as one that ends there: the contact opens, and no accuracy is lost.

Every random force exists twice: as a table that runs through zero, and as one that stays at zero for as long. The
second needs no guard, so at tight tolerance it is the reference. Sines and products have integrals in closed form.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount
from support.sweep import log_uniform, simulate, stopped, sweep

METHODS = ("rodas5p", "dopri5", "auto")
TOLERANCES = (1e-4, 1e-6, 1e-8)
# asked for: error of a speed, relative to full scale, over rtol
FACTOR = 10.0
T_END = 1.0
GRID = np.linspace(0.0, T_END, 201)
Points = list[tuple[float, float]]


def through_zero(rng: np.random.Generator, most: float) -> tuple[Points, Points]:
    """A force that passes zero, back and forth, and the same one kept at zero where the first is below."""
    count = int(rng.integers(2, 6))
    times = np.cumsum(rng.uniform(0.05, 0.4, count))
    sign = np.where(np.arange(count) % 2 == int(rng.random() < 0.2), 1.0, -1.0)
    values = most * sign * np.exp(rng.uniform(np.log(0.05), np.log(2.0), count))
    points = [(float(t), float(y)) for t, y in zip(times, values, strict=True)]
    clipped: Points = []
    for (t, y), (t_next, y_next) in zip(points, [*points[1:], points[-1]], strict=True):
        clipped.append((t, max(y, 0.0)))
        if y * y_next < 0.0:
            clipped.append((t - y * (t_next - t) / (y_next - y), 0.0))
    return points, clipped


def law(rng: np.random.Generator, compliant: bool) -> Any:
    kinetic = float(rng.uniform(0.2, 0.35))
    static, speed = kinetic * float(rng.uniform(1.01, 1.3)), log_uniform(rng, 2.0, 30.0)
    if compliant:
        curve = {"static": static, "kinetic": kinetic, "speed": speed}
        return (
            cw.Tanh(kinetic=kinetic, speed=speed),
            cw.RegularisedStribeck(**curve, width=0.2 * speed),
            cw.LuGre(**curve, stiffness=50.0, damping=0.0),
            cw.Dahl(kinetic=kinetic, stiffness=50.0),
        )[int(rng.integers(4))]
    return (
        cw.Coulomb(static=static, kinetic=kinetic),
        cw.Exponential(static=static, slow=kinetic, fast=0.7 * kinetic, speed=speed),
        cw.Stribeck(static=static, kinetic=kinetic, speed=speed),
    )[int(rng.integers(3))]


@dataclass(frozen=True)
class Part:
    """A contact of a random kind whose force is one of the tables."""

    kind: int
    law: Any
    through: Points
    clipped: Points

    def add(self, d: cw.Driveline, name: str, base: cw.Node, follower: cw.Node, *, clipped: bool) -> None:
        force = cw.Table(self.clipped if clipped else self.through)
        if self.kind == 1:
            d.add(cw.BandBrake(name, shaft=follower, base=base, friction=self.law, radius=1.0, wrap=2.5, force=force))
        elif self.kind == 2:
            shape = {"radius": 0.15, "hinge": 0.12, "arm": 0.2, "start": 0.2, "end": 2.2, "leading": "duplex"}
            d.add(cw.DoubleShoeBrake(name, shaft=follower, base=base, friction=self.law, **shape, force=force))
        elif self.kind == 3:
            d.add(cw.OneWayClutch(name, base=base, follower=follower, friction=self.law, gain=1.0, normal_force=force))
        else:
            d.add(cw.Clutch(name, base=base, follower=follower, friction=self.law, gain=1.0, normal_force=force))


@dataclass(frozen=True)
class Model:
    """Shafts that start at rest, coupled by springs; every contact leads to a member that turns at a speed of its own.

    So the speeds are what the contacts make of them, and full scale is what a force gives.
    """

    inertia: tuple[float, ...]
    stiffness: float
    parts: tuple[Part, ...]
    turning: tuple[float, ...]

    def driveline(self, *, clipped: bool) -> cw.Driveline:
        d = cw.Driveline("through zero")
        nodes = [d.shaft(f"s{i}", inertia=j) for i, j in enumerate(self.inertia)]
        for i, (part, speed) in enumerate(zip(self.parts, self.turning, strict=True)):
            base = d.shaft(f"p{i}", inertia=1.0)
            d.add(cw.PrescribedSpeed(f"m{i}", shaft=base, speed=speed))
            part.add(d, f"c{i}", base, nodes[i % len(nodes)], clipped=clipped)
        for i, (base, follower) in enumerate(pairwise(nodes)):
            d.add(cw.SpringDamper(f"k{i}", base=base, follower=follower, stiffness=self.stiffness, damping=0.1))
        return d


def model(seed: int, *, compliant: bool) -> Model:
    """One to three shafts with one to four contacts."""
    rng = np.random.default_rng([seed, 20, int(compliant)])
    count, contacts = int(rng.integers(1, 4)), int(rng.integers(1, 5))
    most = log_uniform(rng, 5.0, 20.0)
    parts, turning = [], []
    for _ in range(contacts):
        kind, sign = int(rng.integers(4)), 1.0 if rng.random() < 0.5 else -1.0
        parts.append(Part(kind, law(rng, compliant), *through_zero(rng, most)))
        # a freewheel whose follower is ahead
        turning.append(float(rng.uniform(40.0, 80.0)) * (-1.0 if kind == 3 else sign))
    inertia = tuple(most * float(rng.uniform(0.2, 0.6)) for _ in range(count))
    return Model(inertia, most * log_uniform(rng, 1.0, 100.0), tuple(parts), tuple(turning))


def speeds(run: Any, count: int) -> np.ndarray:
    return np.array([run[f"s{i}.speed"] for i in range(count)])


def against(exact: np.ndarray, made: Callable[[], cw.Driveline]) -> str:
    """Every method at every tolerance."""
    found, scale = [], float(np.max(np.abs(exact)))
    for method in METHODS:
        for rtol in TOLERANCES:
            run = simulate(made(), T_END, times=GRID, method=method, rtol=rtol, atol=1e-2 * rtol)
            error = float(np.max(np.abs(speeds(run, len(exact)) - exact))) / scale if not stopped(run) else np.inf
            if not error <= FACTOR * rtol:
                found.append(f"{method} {rtol:g}: {error / rtol:.0f} x rtol {stopped(run)}")
    return ", ".join(found)


def same_as_clipped(seed: int, compliant: bool) -> str:
    made = model(seed, compliant=compliant)
    tight = simulate(made.driveline(clipped=True), T_END, times=GRID, rtol=1e-11, atol=1e-12)
    if text := stopped(tight):
        return f"reference: {text}"
    exact = speeds(tight, len(made.inertia))
    return against(exact, lambda: made.driveline(clipped=False))


@pytest.mark.random
@pytest.mark.parametrize("compliant", [False, True], ids=["sticking", "compliant"])
def test_tables_through_zero(compliant: bool) -> None:
    sweep(lambda seed: same_as_clipped(seed, compliant), amount() // 2)


def impulse(force: Callable[[np.ndarray], np.ndarray], knots: Sequence[float] = ()) -> np.ndarray:
    """Integral of the positive part of a force up to each instant of the grid, its zeros found on a fine grid."""
    fine = np.linspace(0.0, T_END, 20001)
    value = force(fine)
    ends = [fine[0]]
    for i in np.flatnonzero(value[:-1] * value[1:] < 0.0):
        low, high, sign = fine[i], fine[i + 1], np.sign(value[i])
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if float(force(np.array(middle))) * sign > 0 else (low, middle)
        ends.append(low)
    ends = np.unique([*ends, *GRID, *(t for t in knots if t < T_END)])
    nodes, weights = np.polynomial.legendre.leggauss(12)
    half, middle = np.diff(ends) / 2, (ends[1:] + ends[:-1]) / 2
    pieces = half * (np.maximum(force(middle[:, None] + half[:, None] * nodes), 0.0) @ weights)
    total = np.append(0.0, np.cumsum(pieces))
    return np.asarray(total[np.searchsorted(ends, GRID)])


def waves(rng: np.random.Generator, plates: bool) -> tuple[Callable[[np.ndarray], np.ndarray], dict[str, Any]]:
    """A sine for a clutch, or the product of derating and pressure for plates that wear; as function and as fields."""
    most = log_uniform(rng, 5.0, 20.0)
    amplitude, offset = most, most * float(rng.uniform(-0.8, 0.8))
    frequency, phase = log_uniform(rng, 0.5, 5.0), float(rng.uniform(0.0, 6.0))
    sine = cw.Sine(amplitude=amplitude, frequency=frequency, phase=phase, offset=offset)

    def wave(t: np.ndarray) -> np.ndarray:
        return offset + amplitude * np.sin(2 * np.pi * frequency * t + phase)

    if not plates:
        return wave, {"normal_force": sine}
    worn, depth, shift = float(rng.uniform(0.4, 0.9)), 1e-4, float(rng.uniform(0.0, 0.5)) * most / 2e-4
    wear = cw.Ramp(height=2 * depth, duration=T_END)

    def product(t: np.ndarray) -> np.ndarray:
        wear_depth = 2 * depth * t / T_END
        return (worn + (1 - worn) * np.exp(-wear_depth / depth)) * (wave(t) - shift * wear_depth)

    return product, {"normal_force": sine, "worn": worn, "running_in": depth, "touch_shift": shift, "wear": wear}


def closed_form(seed: int, plates: bool) -> str:
    """A shaft between two members that turn: its speed is the integral of the two forces."""
    rng = np.random.default_rng([seed, 21])
    inertia, coefficient = log_uniform(rng, 1.0, 5.0), float(rng.uniform(0.2, 0.4))
    one = cw.Coulomb(static=1.2 * coefficient, kinetic=coefficient)
    forces = [waves(rng, plates), waves(rng, plates)]
    kind = cw.PlateContact if plates else cw.Clutch

    def made() -> cw.Driveline:
        d = cw.Driveline("waves")
        a = d.shaft("s0", inertia=inertia)
        for i, (speed, (_, fields)) in enumerate(zip((50.0, -60.0), forces, strict=True)):
            base = d.shaft(f"p{i}", inertia=1.0)
            d.add(cw.PrescribedSpeed(f"m{i}", shaft=base, speed=speed))
            d.add(kind(f"c{i}", base=base, follower=a, friction=one, gain=1.0, **fields))
        return d

    first, second = (coefficient / inertia * impulse(force) for force, _ in forces)
    return against((first - second)[None, :], made)


@pytest.mark.random
@pytest.mark.parametrize("plates", [False, True], ids=["sines", "products"])
def test_waves_through_zero(plates: bool) -> None:
    sweep(lambda seed: closed_form(seed, plates), amount() // 2)


def test_reference_is_the_closed_form() -> None:
    """The run with tables that stay at zero is right: with Coulomb friction it is the integral of the forces."""
    one = cw.Coulomb(static=0.4, kinetic=0.3)
    for seed in range(20):
        through, clipped = through_zero(np.random.default_rng([seed, 22]), 10.0)
        made = Model((1.0,), 0.0, (Part(0, one, through, clipped),), (50.0,)).driveline(clipped=True)
        run = simulate(made, T_END, times=GRID, rtol=1e-11, atol=1e-12)
        exact = 0.3 * impulse(lambda t, p=through: np.interp(t, *np.array(p).T), [t for t, _ in through])
        assert run["s0.speed"] == pytest.approx(exact, abs=1e-9)
