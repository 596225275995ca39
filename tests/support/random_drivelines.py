"""Random three-clutch drivelines with realistic figures, from a seed.

Four or five shafts of 0.02 to 2 kg m2 in a chain; three of the links are clutches (one may be a brake), the others are
elastic shafts (natural frequency 5 to 120 Hz, damping ratio 0.5 to 10 %). Engines give 50 to 400 N m with a ripple of
0.3 to 8 Hz, loads oppose the motion. Each clutch has static above or equal kinetic friction, a capacity of 0.3 to 4
times the engine torque, and a pressure that fills, holds, modulates and empties along 4 to 7 knots. The run lasts 2 s.
So a run has a handful of lock-ups and break-aways, some of them short, some close together.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

import clutchwork as cw
from reference import independent

T_END = 2.0
HOUSING = -1


@dataclass(frozen=True)
class Link:
    """A clutch (base, follower) with exponential friction and its pressure table."""

    base: int
    follower: int
    static: float
    slow: float
    fast: float
    speed: float
    gain: float
    pressure: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Elastic:
    """An elastic shaft (base, follower)."""

    base: int
    follower: int
    stiffness: float
    damping: float


@dataclass(frozen=True)
class Drive:
    """Torque offset + amplitude sin(2 pi frequency t) on a shaft."""

    shaft: int
    offset: float
    amplitude: float
    frequency: float


@dataclass(frozen=True)
class Load:
    """Torque -torque tanh(w / speed) on a shaft."""

    shaft: int
    torque: float
    speed: float


@dataclass(frozen=True)
class Description:
    """A driveline in plain numbers, from which any solver can be fed."""

    seed: int
    inertia: tuple[float, ...]
    speed: tuple[float, ...]
    clutches: tuple[Link, ...]
    shafts: tuple[Elastic, ...]
    drives: tuple[Drive, ...]
    loads: tuple[Load, ...]

    def mirrored(self) -> Description:
        """The same driveline turning the other way."""
        drives = tuple(Drive(d.shaft, -d.offset, -d.amplitude, d.frequency) for d in self.drives)
        return Description(
            self.seed, self.inertia, tuple(-w for w in self.speed), self.clutches, self.shafts, drives, self.loads
        )

    def driveline(self, order: tuple[int, ...] | None = None) -> cw.Driveline:
        """As a clutchwork model; `order` is the order in which shafts and elements are added."""
        d = cw.Driveline(f"random {self.seed}")
        nodes: dict[int, cw.Node] = {HOUSING: d.housing}
        ranks = order or tuple(range(len(self.inertia)))
        for i in ranks:
            nodes[i] = d.shaft(f"s{i}", inertia=self.inertia[i], speed=self.speed[i])
        parts = []
        for i, c in enumerate(self.clutches):
            law = cw.Exponential(static=c.static, slow=c.slow, fast=c.fast, speed=c.speed)
            parts.append(
                cw.Clutch(
                    f"c{i}",
                    base=nodes[c.base],
                    follower=nodes[c.follower],
                    friction=law,
                    gain=c.gain,
                    pressure=cw.Table(list(c.pressure)),
                )
            )
        for i, k in enumerate(self.shafts):
            parts.append(
                cw.SpringDamper(
                    f"k{i}", base=nodes[k.base], follower=nodes[k.follower], stiffness=k.stiffness, damping=k.damping
                )
            )
        for i, t in enumerate(self.drives):
            sine = cw.Sine(amplitude=t.amplitude, frequency=t.frequency, offset=t.offset)
            parts.append(cw.Torque(f"t{i}", shaft=nodes[t.shaft], torque=sine))
        for i, r in enumerate(self.loads):
            parts.append(cw.ResistingTorque(f"r{i}", shaft=nodes[r.shaft], torque=r.torque, speed=r.speed))
        if order:
            parts = [parts[j] for j in np.argsort([math.sin(1 + 7 * j + sum(order)) for j in range(len(parts))])]
        for part in parts:
            d.add(part)
        return d

    def _direction(self, base: int, follower: int) -> np.ndarray:
        row = np.zeros(len(self.inertia))
        if base != HOUSING:
            row[base] = -1.0
        if follower != HOUSING:
            row[follower] = 1.0
        return row

    def independent(self) -> independent.Model:
        """For the independent solver."""
        contacts = tuple(
            independent.Contact(
                f"c{i}",
                self._direction(c.base, c.follower),
                lambda t, c=c: c.gain * float(np.interp(t, *zip(*c.pressure, strict=True))),
                c.static,
                lambda w, c=c: c.fast + (c.slow - c.fast) * math.exp(-w / c.speed),
            )
            for i, c in enumerate(self.clutches)
        )
        rows = [self._direction(k.base, k.follower) for k in self.shafts]

        def force(t: float, v: np.ndarray, s: np.ndarray) -> np.ndarray:
            total = np.zeros(len(v))
            for k, row, torque in zip(self.shafts, rows, s, strict=True):
                total -= row * (torque + k.damping * (row @ v))
            for d in self.drives:
                total[d.shaft] += d.offset + d.amplitude * math.sin(2 * math.pi * d.frequency * t)
            for r in self.loads:
                total[r.shaft] -= r.torque * math.tanh(v[r.shaft] / r.speed)
            return total

        def rates(t: float, v: np.ndarray, s: np.ndarray) -> np.ndarray:
            return np.array([k.stiffness * (row @ v) for k, row in zip(self.shafts, rows, strict=True)])

        knots = tuple(t for c in self.clutches for t, _ in c.pressure)
        return independent.Model(np.diag(self.inertia), contacts, force, rates, knots)


def describe(seed: int) -> Description:
    """The driveline of a seed."""
    rng = np.random.default_rng(seed)

    def log(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    n = int(rng.integers(4, 6))
    inertia = tuple(log(0.02, 2.0) for _ in range(n))
    speed = tuple(float(rng.uniform(-50, 300)) if rng.random() < 0.6 else 0.0 for _ in range(n))
    engine = log(50, 400)
    links = [(i, i + 1) for i in range(n - 1)]
    if n == 4 and rng.random() < 0.5:
        links.append((HOUSING, int(rng.integers(0, n))))
    chosen = set(rng.choice(len(links), 3, replace=False).tolist())
    clutches, shafts = [], []
    for place, (base, follower) in enumerate(links):
        if place in chosen or base == HOUSING:
            if len(clutches) < 3:
                clutches.append(_clutch(rng, log, base, follower, engine))
            continue
        reduced = 1 / (1 / inertia[base] + 1 / inertia[follower])
        omega = 2 * math.pi * log(5, 120)
        zeta = log(0.005, 0.1)
        shafts.append(Elastic(base, follower, reduced * omega**2, 2 * zeta * reduced * omega))
    drives = [Drive(0, engine * float(rng.uniform(0.5, 1)), engine * float(rng.uniform(0, 0.5)), log(0.3, 8))]
    if rng.random() < 0.3:
        drives.append(Drive(n - 1, 0.0, engine * float(rng.uniform(0.1, 0.8)), log(0.3, 8)))
    loads = [Load(n - 1, engine * float(rng.uniform(0.1, 0.9)), log(0.5, 5))]
    return Description(seed, inertia, speed, tuple(clutches), tuple(shafts), tuple(drives), tuple(loads))


def _clutch(rng: np.random.Generator, log, base: int, follower: int, engine: float) -> Link:
    slow = float(rng.uniform(0.08, 0.15))
    static = slow * (1.0 if rng.random() < 0.3 else float(rng.uniform(1.02, 1.4)))
    fast = slow * float(rng.uniform(0.5, 1.0))
    gain = engine * log(0.3, 4) / (slow * 1e6)
    # fill, hold or modulate, empty
    count = int(rng.integers(4, 8))
    times = np.sort(rng.uniform(0.0, T_END, count))
    times = times + 1e-3 * np.arange(count)
    level = rng.uniform(0.0, 1.0, count) * (rng.random(count) < 0.8)
    level[0] = 0.0 if rng.random() < 0.5 else level[0]
    pressure = tuple((float(t), float(1e6 * x)) for t, x in zip(times, level, strict=True))
    return Link(base, follower, static, slow, fast, log(5, 100), gain, pressure)


def sequence(events: list[tuple[float, str, str]], together: float = 1e-7) -> list[tuple[str, str]]:
    """Order of events as (contact, new mode); events less than `together` seconds apart are sorted by name.

    Two events within 0.1 us have no order that a solver at rtol 1e-4 could be asked for.
    """
    groups: list[list[tuple[str, str]]] = []
    last = -math.inf
    for time, contact, mode in events:
        if time - last > together or not groups:
            groups.append([])
        groups[-1].append((contact, mode))
        last = time
    return [item for group in groups for item in sorted(group)]
