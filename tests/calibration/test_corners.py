"""Corners: a certificate that holds at the least goal and nowhere else, and a way out of any other."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import linprog

import clutchwork as cw
from clutchwork.calibration.corners import around, is_optimal, left_behind
from clutchwork.calibration.evaluate import Evaluator
from clutchwork.calibration.rows import Row
from clutchwork.calibration.scaled import Samples, Scaled
from clutchwork.gradients.differentiable import differentiable
from support.engagement import BOTH, ENGINE, GAIN, LINING, PRESSURE, SPEED, discs


class Peaks:
    """The largest of random planes over a cube, as a solver sees it: only the largest one has a gradient."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.own, count = int(rng.integers(1, 7)), int(rng.integers(4, 20))
        self.planes = rng.standard_normal((count, self.own))
        self.planes[0] = -np.sum(self.planes[1:], axis=0) / count
        self.heights = rng.uniform(0.5, 1.0, count)
        self.width, self.worst, self.rows = np.ones(self.own), False, list[Any]()
        self.linear, self.evaluator = (np.zeros((0, self.own)), np.zeros(0)), SimpleNamespace(runs=0)
        # the least one as a linear program
        found = linprog(
            np.append(np.zeros(self.own), 1.0), np.column_stack([self.planes, -np.ones(count)]), -self.heights,
            bounds=[*[(0.0, 1.0)] * self.own, (None, None)],
        )  # fmt: skip
        self.best, self.least = found.x[:-1], float(found.fun)

    def goal(self, y: Any) -> float:
        return float(np.max(self.planes @ y + self.heights))

    def gradient(self, y: Any) -> Any:
        return self.planes[int(np.argmax(self.planes @ y + self.heights))]

    def point(self, y: Any) -> Any:
        return SimpleNamespace(is_fine=True, note="", x=y)

    def tried(self, y: Any) -> Any:
        return self.point(y)

    def goal_at(self, found: Any, y: Any) -> float:
        return self.goal(y) if found.is_fine else np.inf

    def values_at(self, found: Any, y: Any, block: Any) -> Any:
        return self.values(found.x * 0.0 + y, block)

    def lifted(self, y: Any, found: Any) -> Any:
        return y.copy() if found.is_fine else y

    def values(self, y: Any, block: Any) -> Any:
        return np.zeros(len(block.rows) * len(y))

    def slopes(self, y: Any, block: Any) -> Any:
        return np.zeros((len(block.rows), len(y)))


@pytest.mark.parametrize("seed", range(40))
def test_the_certificate_holds_at_the_least_one_alone(seed: int) -> None:
    peaks: Any = Peaks(seed)
    assert is_optimal(around(peaks, peaks.best), peaks.least)
    rng, wrong = np.random.default_rng(seed), 0
    for _ in range(20):
        y = np.clip(peaks.best + 0.1 * rng.standard_normal(peaks.own), 0.0, 1.0)
        if is_optimal(around(peaks, y), peaks.goal(y)):
            # it may be as good
            wrong += peaks.goal(y) > peaks.least + 2e-3
    assert wrong == 0


@pytest.mark.parametrize("seed", range(40))
def test_the_way_out_leads_to_the_least_one(seed: int) -> None:
    peaks: Any = Peaks(seed)
    begin = np.clip(peaks.best + 0.02 * np.random.default_rng(seed).standard_normal(peaks.own), 0.0, 1.0)
    y = left_behind(peaks, begin)
    assert peaks.goal(y) <= peaks.least + 1e-3
    assert is_optimal(around(peaks, y), peaks.goal(y))


class Walled(Peaks):
    """One plane, and an event that is lost beyond a wall: a limit has room before it and is broken at once behind."""

    def __init__(self, seed: int) -> None:
        super().__init__(seed)
        rng = np.random.default_rng(seed)
        self.normal = rng.uniform(0.2, 1.0, self.own)
        self.normal /= np.linalg.norm(self.normal)
        self.rows = [Row(0, 0, 1.0, 1.0, 1.0, 0)]
        self.planes, self.heights = rng.uniform(0.1, 3.0) * self.normal[None], np.ones(1)
        # on the side where it still happens
        self.best = 0.5 * np.ones(self.own)
        self.end = float(self.normal @ self.best) - 1e-6

    def _inside(self, y: Any) -> float:
        return float(self.normal @ y) - self.end

    def values(self, y: Any, block: Any) -> Any:
        inside = self._inside(y)
        return np.full(len(block.rows), 0.02 + 0.1 * np.sqrt(inside) if inside > 0.0 else -0.03)

    def slopes(self, y: Any, block: Any) -> Any:
        inside = self._inside(y)
        return np.tile(0.05 / np.sqrt(inside) * self.normal if inside > 0.0 else 0.0 * y, (len(block.rows), 1))


@pytest.mark.parametrize("seed", range(20))
def test_at_the_wall_of_an_event_a_goal_is_optimal_that_falls_across_it_alone(seed: int) -> None:
    walled: Any = Walled(seed)
    assert is_optimal(around(walled, walled.best), walled.goal(walled.best))
    if walled.own > 1:
        along = np.random.default_rng(seed).standard_normal(walled.own)
        along -= (along @ walled.normal) * walled.normal
        walled.planes = walled.planes + 0.2 * along / np.linalg.norm(along)
        assert not is_optimal(around(walled, walled.best), walled.goal(walled.best))


@pytest.mark.parametrize("seed", range(8))
def test_an_event_that_passes_an_instant_that_counts(seed: int) -> None:
    """The engine at an instant gets slower by more torque, until the clutch locks before: there the goal has a corner.

    The slope is weight - instant / ENGINE before and the weight behind.
    """
    rng = np.random.default_rng(seed)
    instant = float(rng.uniform(0.6, 1.6))
    weight = float(rng.uniform(0.1, 0.9) * instant / ENGINE)
    found = cw.calibrate(
        discs(),
        5.0,
        free={"pressure": cw.together("c1.pressure.values", factor=(0.3, 4.0))},
        minimise={cw.at("engine.speed", instant): 1.0, cw.at("c1.torque", 0.1): weight},
    )
    torque = SPEED * BOTH / instant
    assert found.solved, found.message
    assert found["pressure"] == pytest.approx(torque / (GAIN * LINING * PRESSURE), rel=1e-4)
    assert found.goal[1] == pytest.approx(SPEED * ENGINE + weight * torque, rel=1e-4)
    assert found.certificate.residual > 1e-3 or found.around == found.certificate.residual


def test_a_search_that_stops_early_is_not_solved() -> None:
    found = cw.calibrate(
        discs(),
        5.0,
        free={"pressure": cw.together("c1.pressure.values", factor=(0.3, 4.0))},
        minimise={cw.at("engine.speed", 1.0): 1.0, cw.at("c1.torque", 0.1): 1.0},
        starts=1,
    )
    beside = found.x * 1.02
    outputs = {str(number): one for number, one in enumerate(found.problem.outputs)}
    function = differentiable(
        found.problem.system, 5.0, of=outputs, by=list(found.problem.numbers), options=found.asked.options
    )
    scaled = Scaled(Evaluator(found.problem, function), beside, Samples())
    assert not is_optimal(around(scaled, scaled.start), scaled.goal(scaled.start))


def test_what_the_starts_reached_is_shown() -> None:
    found = cw.calibrate(
        discs(),
        5.0,
        free={"pressure": cw.together("c1.pressure.values", factor=(0.3, 3.0))},
        minimise=cw.at("c1.torque", 0.1),
        subject_to=[cw.limit(cw.lock("c1"), upper=1.0)],
    )
    assert len(found.outcomes) == 3
    assert len(found.spread) == 3
    assert list(found.spread) == sorted(found.spread)
    assert found.goal[1] == found.spread[0]
    assert "3 starts" in str(found)
    assert f"they reached {found.spread[0]:.6g}, " in str(found)
