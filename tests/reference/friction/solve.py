"""Radau from kink to kink."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.integrate import Radau
from scipy.optimize import brentq

from reference.friction.law import Array, Guard
from reference.friction.systems import Course, Moved, Pushed


class Hit(NamedTuple):
    """The end of a branch: when, why (None: the slip is zero), and the slip just behind it."""

    time: float
    guard: Guard | None
    behind: float


@dataclass(frozen=True)
class Solution:
    """Samples."""

    time: Array
    position: Array
    speed: Array
    friction: Array  # force against the motion
    states: Array  # (sample, state)
    turns: int  # how often the slip passed through zero


def _zero(over: Course, start: float, end: float, first: float) -> float:
    """Where a function falls through zero; dense output is a little off at the ends of a step."""
    if first <= 0.0 or over(start) <= 0.0:
        return start
    return end if over(end) >= 0.0 else brentq(over, start, end, xtol=1e-15, rtol=1e-14)


@dataclass
class _Run:
    """One integration under way."""

    system: Moved | Pushed
    times: Array
    rtol: float
    atol: float
    step: float

    def __post_init__(self) -> None:
        self.t, self.y, self.branch = 0.0, self.system.start(), self.system.law.start()
        self.rows: list[tuple[float, ...]] = []
        self.turns = 0

    def states(self, y: Array) -> Array:
        return y[len(y) - self.system.law.size :]

    def slope(self, t: float, y: Array) -> Array:
        return self.system.slope(t, y, self.branch)

    def _radau(self, t: float, y: Array, stop: float, first_step: float) -> Radau:
        return Radau(
            self.slope, t, y, stop, rtol=self.rtol, atol=self.atol, jac=self.jacobian, first_step=first_step,
            max_step=self.step,
        )  # fmt: skip

    def jacobian(self, t: float, y: Array) -> Array:
        """By differences; nothing depends on the position, which is the first of y."""
        base, found = self.slope(t, y), np.zeros((len(y), len(y)))
        for j in range(1, len(y)):
            step = 1e-8 + 1e-7 * abs(y[j])
            moved = y.copy()
            moved[j] += step
            found[:, j] = (self.slope(t, moved) - base) / step
        return found

    def advance(self, stop: float) -> None:
        """Up to the next knot of the forcing."""
        while self.t < stop:
            self._branch(stop)

    def _branch(self, stop: float) -> None:
        """Up to the end of the branch, at most to the knot."""
        solver = self._radau(self.t, self.y, stop, min(1e-6, stop - self.t))
        while solver.status == "running":
            before = solver.t, solver.y.copy()
            message = solver.step()
            assert solver.status != "failed", message
            hit = self._hit(*before, solver)
            self._sample(solver.dense_output(), hit.time if hit else solver.t)
            if hit:
                self._switch(*before, hit)
                return
        self.t, self.y = solver.t, solver.y

    def _hit(self, t0: float, y0: Array, solver: Radau) -> Hit | None:
        """The first guard that fell through zero in the last step."""
        slip, law = self.system.slip, self.system.law
        guards: list[tuple[Guard | None, Callable[[float, Array], float]]] = []
        if law.kinked:
            guards.append((None, lambda t, y: self.branch.way * slip(t, y)))
        guards += [
            (guard, lambda t, y, g=guard: g.value(slip(t, y), self.states(y))) for guard in law.guards(self.branch)
        ]
        dense, hits = solver.dense_output(), []
        for guard, value in guards:
            if value(solver.t, solver.y) >= 0.0:
                continue
            over = lambda t, f=value: f(t, dense(t))  # noqa: E731
            hits.append(Hit(_zero(over, t0, solver.t, value(t0, y0)), guard, slip(solver.t, solver.y)))
        return min(hits, key=lambda hit: hit.time, default=None)

    def _switch(self, t0: float, y0: Array, hit: Hit) -> None:
        """To the next branch; the state there is integrated anew, because dense output is less accurate."""
        y = y0
        if hit.time > t0:
            last = self._radau(t0, y0, hit.time, hit.time - t0)
            while last.status == "running":
                last.step()
            y = last.y.copy()
        s = self.states(y)
        if hit.guard is not None:
            s[:], self.branch = hit.guard.switch(s.copy(), self.branch)
        else:
            self.turns += 1
            y = self.system.rest(y)
            s = self.states(y)
            s[:], self.branch = self.system.law.turned(s.copy(), self.branch)
            self.branch = self.branch._replace(way=self._leaves(hit, t0, y))
        self.t, self.y = hit.time, y

    def _leaves(self, hit: Hit, t0: float, y: Array) -> int:
        """Direction in which a slip of zero is left."""
        if isinstance(self.system, Moved) or hit.time == t0:
            return 1 if hit.behind > 0.0 else -1
        return 1 if self.slope(hit.time, y)[1] > 0.0 else -1

    def _sample(self, dense: Callable[[float], Array], end: float) -> None:
        while len(self.rows) < len(self.times) and self.times[len(self.rows)] <= end:
            t = float(self.times[len(self.rows)])
            y = dense(t)
            v = self.system.slip(t, y)
            friction = self.system.load(t) * self.system.law.coefficient(v, self.states(y), self.branch)
            self.rows.append((t, y[0], v, friction, *self.states(y)))


def solve(
    system: Moved | Pushed,
    times: Iterable[float],
    *,
    knots: Iterable[float] = (),
    rtol: float = 1e-10,
    atol: float = 1e-12,
    step: float = 0.01,
) -> Solution:
    """Samples at rising times from rest at 0; the forcing is smooth between the knots.

    No step is longer than `step` [s]: an equilibrium that the error estimate sees no end of may end within it.
    """
    samples = np.asarray(list(times), dtype=float)
    run = _Run(system, samples, rtol, atol, step)
    end = float(samples[-1])
    for stop in [*sorted(k for k in set(knots) if 0.0 < k < end), end]:
        run.advance(stop)
    rows = np.array(run.rows)
    return Solution(rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3], rows[:, 4:], run.turns)
