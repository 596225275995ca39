"""Drivelines with a ratio that varies, for clutchwork and for the independent solver."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

import clutchwork as cw
from reference import independent

from . import random_drivelines


@dataclass(frozen=True)
class Tie:
    """First rate = ratio times second rate."""

    first: np.ndarray
    second: np.ndarray
    ratio: Callable[[float, np.ndarray], float]  # over time and states
    slope: Callable[[float, np.ndarray, np.ndarray], float]  # over time, speeds and states

    def row(self, t: float, s: np.ndarray) -> np.ndarray:
        return self.first - self.ratio(t, s) * self.second


@dataclass(frozen=True)
class Tied(independent.Model):
    """A model whose speeds ties hold together."""

    ties: tuple[Tie, ...] = ()

    def multipliers(
        self, t: float, v: np.ndarray, s: np.ndarray, modes: Sequence[int]
    ) -> tuple[np.ndarray, np.ndarray]:
        """As of a model without ties, the ties held too."""
        locked = [c.direction for c, mode in zip(self.contacts, modes, strict=True) if mode == independent.LOCKED]
        rows = np.array([*locked, *(tie.row(t, s) for tie in self.ties)])
        wanted = [0.0] * len(locked) + [tie.slope(t, v, s) * (tie.second @ v) for tie in self.ties]
        total = self.applied(t, v, s, modes)
        compliance = rows @ np.linalg.solve(self.mass, rows.T)
        free = rows @ np.linalg.solve(self.mass, total)
        lam = np.linalg.pinv(compliance, rcond=1e-12) @ (np.array(wanted) - free)
        return lam[: len(locked)], np.linalg.solve(self.mass, total + rows.T @ lam)

    def settled(self, t: float, v: np.ndarray, s: np.ndarray, modes: Sequence[int]) -> np.ndarray:
        """Nearest speeds, in the sense of kinetic energy, that keep the ties and the locked contacts."""
        locked = [c.direction for c, mode in zip(self.contacts, modes, strict=True) if mode == independent.LOCKED]
        rows = np.array([*locked, *(tie.row(t, s) for tie in self.ties)])
        compliance = rows @ np.linalg.solve(self.mass, rows.T)
        return v - np.linalg.solve(self.mass, rows.T @ (np.linalg.pinv(compliance, rcond=1e-12) @ (rows @ v)))


def table(points: Sequence[tuple[float, float]]) -> tuple[Callable[[float], float], Callable[[float], float]]:
    """A line through points and its slope, the right one at a knot."""
    times, values = map(np.array, zip(*points, strict=True))

    def slope(t: float) -> float:
        k = int(np.searchsorted(times, t, side="right"))
        if k in (0, len(times)):
            return 0.0
        return float((values[k] - values[k - 1]) / (times[k] - times[k - 1]))

    return lambda t: float(np.interp(t, times, values)), slope


@dataclass(frozen=True)
class Description:
    """A random driveline, and a ratio between two of its shafts."""

    base: random_drivelines.Description
    input: int
    output: int
    points: tuple[tuple[float, float], ...]

    def driveline(self, **more: object) -> cw.Driveline:
        """As a clutchwork model."""
        d = self.base.driveline()
        nodes = {node.name: node for node in d.shafts}
        ratio = cw.Table(list(self.points))
        ends = {"input": nodes[f"s{self.input}"], "output": nodes[f"s{self.output}"]}
        d.add(cw.VariableRatio("v", ratio=ratio, **ends, **more))
        return d

    def independent(self) -> Tied:
        """For the independent solver."""
        plain = self.base.independent()
        ratio, slope = table(self.points)
        rows = np.eye(len(self.base.inertia))
        tie = Tie(rows[self.input], rows[self.output], lambda t, s: ratio(t), lambda t, v, s: slope(t))
        knots = (*plain.knots, *(t for t, _ in self.points))
        return Tied(plain.mass, plain.contacts, plain.force, plain.rates, knots, (tie,))


def describe(seed: int) -> Description:
    """A random driveline of three clutches with a ratio to a shaft of its own, or across two that it has."""
    rng = np.random.default_rng(1000 + seed)
    base = random_drivelines.describe(seed)
    n = len(base.inertia)
    times = np.sort(rng.uniform(0.0, random_drivelines.T_END, int(rng.integers(2, 6)))) + 1e-3 * np.arange(5)[:1]
    values = np.exp(rng.uniform(math.log(0.3), math.log(3.0), len(times))) * (1 if rng.random() < 0.8 else -1)
    points = tuple((float(t), float(x)) for t, x in zip(times, values, strict=True))
    start = points[0][1]
    if rng.random() < 0.7:
        # a shaft of its own, to which the load moves
        at = int(rng.integers(0, n))
        inertia = (*base.inertia, float(np.exp(rng.uniform(math.log(0.02), math.log(2.0)))))
        loads = tuple(replace(load, shaft=n) for load in base.loads)
        speed = (*base.speed, base.speed[at] / start)
        return Description(replace(base, inertia=inertia, loads=loads, speed=speed), at, n, points)
    first, second = (int(x) for x in rng.choice(n, 2, replace=False))
    speed = list(base.speed)
    speed[first] = start * speed[second]
    return Description(replace(base, speed=tuple(speed)), first, second, points)
