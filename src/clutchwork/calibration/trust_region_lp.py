"""Steps by linear programs within a box, as large as the last step deserves: for goals and limits with corners.

The largest of many values, as a jerk is, has its least value in a corner where several of them meet, and a run has
corners where an event passes an instant that counts. K. Madsen, An algorithm for minimax solution of overdetermined
systems of non-linear equations, J. Inst. Maths Applics 16, 1975. docs/theory/calibration.md (6)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.calibration.rows import ConstraintBlock
from clutchwork.calibration.scaled import Scaled

# boxes, in shares of the bounds: the smallest one, and how they grow and get smaller
SHORTEST, WIDER, SHORTER = 1e-5, 2.0, 0.4
# shares of what a program hopes for: less than the first is no step, below the second the box gets smaller, above the
# third it grows
TAKEN, POOR, GOOD = 0.05, 0.3, 0.7
# what may be hoped for at the end, in shares of the goal, and steps in all
LITTLE, MOST_STEPS = 1e-7, 100
# so many steps that bring less than a share of the goal are the last ones
MOST_SLOW, SLOW = 8, 1e-3
# gradients for each sample that one walk may take, differences in place of them counted as one each
MOST_RUNS = 250
# what a limit that is broken by its scale costs at first, in goals, and at most
PRICE, MOST_PRICE = 10.0, 1e4
# what a step costs, in goals: what changes nothing stays where it is
IDLE = 1e-6


def walked(scaled: Scaled, y: Array, reach: float, most: int = MOST_RUNS) -> tuple[Array, float]:
    """Better scaled unknowns, and the box that the last step had."""
    price, last = PRICE, scaled.evaluator.runs + most * max(len(scaled.samples), 1)
    walk = _Walk(scaled, y, reach)
    costs = list[float]()
    for _ in range(MOST_STEPS):
        if scaled.is_enough(walk.y) or scaled.evaluator.runs >= last or _is_slow(costs):
            break
        costs.append(walk.goal + price * walk.broken)
        if walk.reach < SHORTEST or not walk.step(price):
            # it may be the price that keeps a limit broken
            if walk.broken <= LITTLE or price >= MOST_PRICE:
                break
            price, walk.reach, costs = 10.0 * price, max(walk.reach, 0.1 * reach), []
    return walk.y, walk.reach


def _is_slow(costs: list[float]) -> bool:
    return len(costs) > MOST_SLOW and costs[-1 - MOST_SLOW] - costs[-1] < SLOW * abs(costs[-1])


class _Tried(NamedTuple):
    """What a step leads to."""

    y: Array
    goal: float
    broken: float  # by how much the worst limit is broken, in shares of its scale
    values: Array  # of the rows

    def cost(self, price: float) -> float:
        """The goal, and what broken limits cost."""
        return self.goal + price * self.broken


class _Walk:
    """Where a walk is."""

    def __init__(self, scaled: Scaled, y: Array, reach: float) -> None:
        self.scaled, self.reach = scaled, reach
        self.block = ConstraintBlock(scaled.rows)
        self._take(self._tried(y))

    def _take(self, tried: _Tried) -> None:
        self.y, self.goal, self.broken = tried.y, tried.goal, tried.broken

    def _tried(self, y: Array) -> _Tried:
        """What a step leads to, without a gradient."""
        found = self.scaled.tried(y)
        y = self.scaled.lifted(y, found)
        if not found.is_fine:
            return _Tried(y, np.inf, np.inf, np.zeros(0))
        values = self.scaled.values_at(found, y, self.block)
        out = np.where(self.block.equal, np.abs(values), -values)
        matrix, ends = self.scaled.linear
        broken = max(float(np.max(one, initial=0.0)) for one in (out, matrix @ y - ends))
        return _Tried(y, self.scaled.goal_at(found, y), broken, values)

    def step(self, price: float) -> bool:
        """Try one step; False where nothing is to be hoped for."""
        here = self.goal + price * self.broken
        values, slopes = self.scaled.values(self.y, self.block), self.scaled.slopes(self.y, self.block)
        d, promised = self._program(price, values, slopes)
        hoped = here - promised
        if hoped <= LITTLE * abs(here):
            return False
        tried = self._tried(self.y + d)
        share = (here - tried.cost(price)) / hoped
        own = float(np.max(np.abs(d[: len(self.scaled.width)])))
        if share < POOR and len(tried.values):
            # once more with what was seen of the curvature
            d, _ = self._program(price, tried.values - slopes @ (tried.y - self.y), slopes)
            other = self._tried(self.y + d)
            if other.cost(price) < tried.cost(price):
                tried, share = other, (here - other.cost(price)) / hoped
        # a point without a gradient leads nowhere
        if share > TAKEN and self.scaled.point(tried.y).is_fine:
            self._take(tried)
        if share < POOR:
            self.reach = SHORTER * min(self.reach, own)
        elif share > GOOD and own > 0.99 * self.reach:
            self.reach *= WIDER
        return True

    def _program(self, price: float, values: Array, slopes: Array) -> tuple[Array, float]:
        """The best step of the linear model within the box, and what it promises."""
        scaled, y, block = self.scaled, self.y, self.block
        own, count = len(scaled.width), scaled.count
        matrix, ends = scaled.linear
        near = scaled.within(block, values, slopes, self.reach)
        equal = near & block.equal
        lines = np.vstack([-slopes[near], slopes[equal], matrix])
        room = np.concatenate([values[near], -values[equal], ends - matrix @ y])
        hard = np.concatenate([block.goal[near], np.zeros(len(room) - np.count_nonzero(near), dtype=bool)])
        gradient = scaled.gradient(y)
        # forward and backward parts, what the worst value of the goal changes by, and what limits are broken by
        cost = np.concatenate([gradient[:own] + IDLE, IDLE - gradient[:own], gradient[own:], [price]])
        table = np.hstack([lines[:, :own], -lines[:, :own], lines[:, own:], np.where(hard, 0.0, -1.0)[:, None]])
        ahead, behind = np.minimum(self.reach, 1.0 - y[:own]), np.minimum(self.reach, y[:own])
        sides = np.concatenate([ahead, behind]).clip(0.0).tolist()
        box = [*((0.0, side) for side in sides), *[(None, None)] * (count - own), (0.0, None)]
        found = need("scipy.optimize", "calibrate", "calibrate").linprog(cost, table, room, bounds=box, method="highs")
        if found.x is None:
            return np.zeros(count), np.inf
        d = np.concatenate([found.x[:own] - found.x[own : 2 * own], found.x[2 * own : -1]])
        return d, scaled.goal(y) + float(gradient @ d) + price * float(found.x[-1])
