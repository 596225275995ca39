"""Points in the unit cube, a part of them at a time: whatever the parts are, the points are the same."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.base.extras import need

# of random points that are drawn together
BLOCK = 4096
# shares are at least so far from 0 and 1, where a normal distribution has no value
EDGE = 2.0**-33


class Points(Protocol):
    """Points by number."""

    @property
    def count(self) -> int:
        """How many there are."""

    def rows(self, first: int, last: int) -> Array:
        """Those from first to last, a line for each."""


class LatinHypercube:
    """One point in each of as many equal slices of every axis; they are drawn all at once."""

    def __init__(self, size: int, count: int, seed: int) -> None:
        self.size, self.count, self.seed = size, count, seed

    def rows(self, first: int, last: int) -> Array:
        """Those from first to last."""
        return self._all[first:last]

    @cached_property
    def _all(self) -> Array:
        return np.asarray(_qmc().LatinHypercube(self.size, rng=self.seed).random(self.count))

    def __getstate__(self) -> dict[str, Any]:
        return {"size": self.size, "count": self.count, "seed": self.seed}


class Sobol:
    """Scrambled Sobol sequence (Owen, doi:10.1137/S0036142994277468); even, best with a power of two of points."""

    def __init__(self, size: int, count: int, seed: int) -> None:
        self.size, self.count, self.seed = size, count, seed
        self._engine: Any = None

    def rows(self, first: int, last: int) -> Array:
        """Those from first to last."""
        if self._engine is None or self._engine.num_generated > first:
            self._engine = _qmc().Sobol(self.size, rng=self.seed)
        if first > self._engine.num_generated:
            self._engine.fast_forward(first - self._engine.num_generated)
        with warnings.catch_warnings():
            # a part is seldom a power of two
            warnings.simplefilter("ignore", UserWarning)
            return np.asarray(np.clip(self._engine.random(last - first), EDGE, 1.0 - EDGE))

    def __getstate__(self) -> dict[str, Any]:
        return {"size": self.size, "count": self.count, "seed": self.seed, "_engine": None}


class Random:
    """Independent random points."""

    def __init__(self, size: int, count: int, seed: int) -> None:
        self.size, self.count, self.seed = size, count, seed

    def rows(self, first: int, last: int) -> Array:
        """Those from first to last."""
        begin = first // BLOCK
        blocks = [self._block(number) for number in range(begin, -(-last // BLOCK))]
        whole = np.concatenate(blocks) if blocks else np.zeros((0, self.size))
        return whole[first - begin * BLOCK : last - begin * BLOCK]

    def _block(self, number: int) -> Array:
        drawn = np.random.default_rng([self.seed, number]).random((BLOCK, self.size))
        return np.clip(drawn, EDGE, 1.0 - EDGE)


class Saltelli:
    """For Sobol indices: of points A and B also A with one coordinate of B (doi:10.1016/j.cpc.2009.09.018).

    The order is that of SALib: A, A with each coordinate of B, where asked for B with each of A, B.
    """

    def __init__(self, size: int, base: int, seed: int, second_order: bool) -> None:
        self.size, self.second_order = size, second_order
        self.step = 2 * size + 2 if second_order else size + 2
        self.count = base * self.step
        self.pairs = Sobol(2 * size, base, seed)

    def rows(self, first: int, last: int) -> Array:
        """Those from first to last."""
        begin, end = first // self.step, -(-last // self.step)
        pairs = self.pairs.rows(begin, end)
        a, b = pairs[:, : self.size], pairs[:, self.size :]
        made = np.repeat(a[:, np.newaxis, :], self.step, axis=1)
        for one in range(self.size):
            made[:, 1 + one, one] = b[:, one]
        if self.second_order:
            made[:, 1 + self.size : -1] = b[:, np.newaxis, :]
            for one in range(self.size):
                made[:, 1 + self.size + one, one] = a[:, one]
        made[:, -1] = b
        return made.reshape(-1, self.size)[first - begin * self.step : last - begin * self.step]


def _qmc() -> Any:
    return need("scipy.stats.qmc", "study", "a design")


METHODS: dict[str, Callable[[int, int, int], Points]] = {
    "latin": LatinHypercube,
    "sobol": Sobol,
    "random": Random,
    "saltelli": lambda size, count, seed: Saltelli(size, count, seed, False),
    "saltelli second order": lambda size, count, seed: Saltelli(size, count, seed, True),
}
