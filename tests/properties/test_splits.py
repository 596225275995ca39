"""A clutch split into parallel ones with any shares moves as the one clutch; each carries its share of the torque."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount
from support.sweep import log_uniform, simulate, stopped, sweep

TIGHT: dict[str, Any] = {"rtol": 1e-11, "atol": 1e-13, "dt": 0.001}
T_END = 0.5

# asked for: speeds, relative to full scale
SPEED = 1e-9
# event times [s] at the tolerance of these runs
TIME = 1e-8
# shares of a locked torque, relative to the largest static capacity
SHARE = 1e-7


@dataclass(frozen=True)
class Pair:
    """Three shafts, a clutch between the first two whose parts may be split, a stronger one beside or behind it."""

    seed: int
    inertia: tuple[float, ...]
    speed: tuple[float, ...]
    law: Any
    strong_law: Any
    gain: float
    pressure: Any
    strong: float
    beside: bool
    drives: tuple[tuple[float, float, float], ...]
    stiffness: float
    shares: tuple[float, ...]

    def driveline(self, shares: tuple[float, ...]) -> cw.Driveline:
        d = cw.Driveline(f"split {self.seed}")
        s = [
            d.shaft(f"s{i}", inertia=j, speed=w) for i, (j, w) in enumerate(zip(self.inertia, self.speed, strict=True))
        ]
        for i, share in enumerate(shares):
            ends = {"base": s[0], "follower": s[1]} if i % 2 == 0 else {"base": s[1], "follower": s[0]}
            d.add(cw.Clutch(f"c{i}", **ends, friction=self.law, gain=self.gain * share, pressure=self.pressure))
        far = s[0] if self.beside else s[2]
        d.add(cw.Clutch("strong", base=s[1], follower=far, friction=self.strong_law, gain=self.strong, pressure=1.0))
        for i, (amplitude, frequency, phase) in enumerate(self.drives):
            sine = cw.Sine(amplitude=amplitude, frequency=frequency, phase=phase)
            d.add(cw.Torque(f"t{i}", shaft=s[i], base=s[2] if i == 0 else None, torque=sine))
        d.add(cw.SpringDamper("k", base=s[0], follower=s[2], stiffness=self.stiffness, damping=self.stiffness * 1e-3))
        return d


def laws(rng: np.random.Generator) -> Any:
    """A law that sticks, static above kinetic."""
    kinetic = float(rng.uniform(0.2, 0.5))
    static = kinetic * float(rng.uniform(1.0, 1.4))
    pick = int(rng.integers(3))
    if pick == 0:
        return cw.Coulomb(static=static, kinetic=kinetic)
    if pick == 1:
        return cw.Exponential(static=static, slow=kinetic, fast=0.6 * kinetic, speed=log_uniform(rng, 2.0, 50.0))
    return cw.Stribeck(static=static, kinetic=kinetic, speed=log_uniform(rng, 1.0, 20.0))


def describe(seed: int) -> Pair:
    rng = np.random.default_rng([seed, 9])
    inertia = tuple(log_uniform(rng, 0.02, 0.2) for _ in range(3))
    torque = log_uniform(rng, 5.0, 50.0)
    times = np.sort(rng.uniform(0.0, T_END, 3)) + 0.02 * np.arange(3)
    levels = rng.uniform(0.1, 1.0, 3)
    points = [(float(t), float(y)) for t, y in zip(times, levels, strict=True)]
    if rng.random() < 0.3:
        # empty for a while, then filled again
        place = int(rng.integers(3))
        points[place : place + 1] = [(points[place][0] + late, 0.0) for late in (0.0, 0.01)]
    sine = cw.Sine(amplitude=0.4, frequency=log_uniform(rng, 1.0, 8.0), offset=0.6)
    count = int(rng.integers(2, 7))
    shares = np.exp(rng.uniform(np.log(1e-4), 0.0, count))
    return Pair(
        seed,
        inertia,
        tuple(float(w) for w in rng.uniform(-30.0, 30.0, 3)),
        laws(rng),
        laws(rng),
        torque * log_uniform(rng, 1.0, 10.0),
        cw.Table(points) if rng.random() < 0.7 else sine,
        torque * log_uniform(rng, 1.0, 1e3),
        bool(rng.random() < 0.3),
        tuple((torque * float(rng.uniform(0.2, 1.0)), log_uniform(rng, 1.0, 8.0), 0.0) for _ in range(2)),
        log_uniform(rng, 100.0, 3000.0),
        tuple(float(x) for x in shares / shares.sum()),
    )


def set_events(run: Any, names: set[str]) -> list[tuple[float, str]]:
    """Times at which the set as a whole locks, slips, opens or closes; parts that change together count once.

    Every other part is mounted the other way round, so that forward of one is backward of the other.
    """
    found: list[tuple[float, str]] = []
    for event in run.events.changes():
        name = "set" if event.element in names else event.element
        kind = event.after if event.after in ("locked", "open") else "slips"
        if not found or found[-1][1] != f"{name} {kind}" or event.time - found[-1][0] > TIME:
            found.append((event.time, f"{name} {kind}"))
    return found


def differences(one: Any, split: Any, parts: set[str]) -> str:
    full = max(float(np.max(np.abs(one[f"s{i}.speed"]))) for i in range(3))
    error = max(float(np.max(np.abs(one[f"s{i}.speed"] - split[f"s{i}.speed"]))) for i in range(3)) / full
    a, b = set_events(one, {"c0"}), set_events(split, parts)
    if [name for _, name in sorted(a)] != [name for _, name in sorted(b)]:
        return f"{len(parts)} parts, speeds differ by {error:.1e}, one clutch {a}, split {b}"
    late = max((abs(x[0] - y[0]) for x, y in zip(sorted(a), sorted(b), strict=True)), default=0.0)
    if error <= SPEED and late <= TIME:
        return ""
    return f"{len(parts)} parts, speeds differ by {error:.1e} of full scale, events by {late:.1e} s"


def moves_as_one(seed: int) -> str:
    made = describe(seed)
    one, split = (simulate(made.driveline(shares), T_END, **TIGHT) for shares in ((1.0,), made.shares))
    parts = {f"c{i}" for i in range(len(made.shares))}
    return stopped(one) or stopped(split) or differences(one, split, parts)


def shares_of(seed: int) -> str:
    """While all parts are locked with nothing beside them, each has its share of their torque."""
    made = describe(seed)
    if made.beside:
        return ""
    run = simulate(made.driveline(made.shares), T_END, dt=0.005)
    if text := stopped(run):
        return text
    count = len(made.shares)
    torque = np.array([run[f"c{i}.torque"] * (-1) ** i for i in range(count)])
    locked = np.all([run[f"c{i}.state"] == "locked" for i in range(count)], axis=0)
    capacity = np.max([run[f"c{i}.capacity"] for i in range(count)], axis=0)
    total, wanted = torque.sum(axis=0), np.array(made.shares)[:, None]
    error = np.abs(torque - wanted * total)[:, locked] / capacity[locked]
    if not error.size or error.max() <= SHARE:
        return ""
    return f"shares of {count} parts are off by {error.max():.1e} of the largest capacity"


@pytest.mark.random
def test_split_clutch_moves_as_one() -> None:
    sweep(moves_as_one, amount())


@pytest.mark.random
def test_shares_are_those_of_the_capacity() -> None:
    sweep(shares_of, amount())


def test_the_clutches_lock_and_break_away() -> None:
    """Enough happens to the pair: most runs have a lock, many a break-away."""
    runs = [simulate(describe(seed).driveline((1.0,)), T_END) for seed in range(60)]
    kinds = [[e.after if e.after == "locked" else e.before for e in run.events.of("c0").changes()] for run in runs]
    assert sum("locked" in kind for kind in kinds) >= 30
    assert sum(kind.count("locked") >= 2 for kind in kinds) >= 15
