"""Steps of the solver as polynomials: signals from five rows in each, their slopes, and their limits at its ends.

Rows of a plain run stand at equal parts of each step, its ends among them. Those of a run with derivatives stay inside,
because the instants of its events differ in the last digits. docs/theory/gradients.md (13)
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.sweeps.parts import PARTS, steps_of

Array = NDArray[np.float64]
Places = NDArray[np.intp]

# how far rows of a run with derivatives stay away from the ends of a step, of its length, and [s]
INSIDE, MOST_INSIDE, APART = 1e-3, 0.1, 3e-9
# steps of a run with derivatives that are left out: the instants of its events are not as exact [s]
LEAST = 1e-9
SLOPES = np.arange(1, PARTS + 1)


@dataclass(frozen=True, eq=False)
class Steps:
    """Steps in order, and where in each of them rows are known."""

    begin: Array  # s
    length: Array  # s
    share: Array  # of each step: places of its rows in it, from 0 to 1
    rows: Places  # of each step: its rows
    jumps: NDArray[np.bool_]  # whether a signal, a torque or an acceleration jumps where each begins
    whole: NDArray[np.bool_]  # whether the solver began a step there: others are parts of it

    @classmethod
    def of_parts(cls, times: Array) -> Steps:
        """From the instants of a run whose steps are cut into equal parts."""
        first = steps_of(times)
        shares = np.broadcast_to(np.arange(PARTS + 1) / PARTS, (len(first), PARTS + 1))
        rows = first[:, None] + np.arange(PARTS + 1)
        jumps = np.append(True, first[1:] - first[:-1] != PARTS)[: len(first)]
        return cls(times[first], times[first + PARTS] - times[first], shares, rows, jumps, np.ones_like(jumps))

    @property
    def is_long(self) -> NDArray[np.bool_]:
        """Which of them a run with derivatives can look into."""
        found: NDArray[np.bool_] = self.length > LEAST * (1.0 + np.abs(self.begin))
        return found

    def long(self) -> Steps:
        """Those that a run with derivatives can look into."""
        kept = np.flatnonzero(self.is_long)
        jumps, whole = (np.diff(np.cumsum(own)[kept], prepend=0) > 0 for own in (self.jumps, self.whole))
        return Steps(self.begin[kept], self.length[kept], self.share[kept], self.rows[kept], jumps, whole)

    def covering(self) -> Steps:
        """The same, each with the short ones before it, and behind it, from which nothing separates it."""
        found, ends = self.long(), self.end
        is_long = self.is_long
        # where a row of steps begins between which nothing jumps
        chain, kept = np.cumsum(self.jumps), np.flatnonzero(is_long)
        begin, end = found.begin.copy(), found.end.copy()
        for step in np.flatnonzero(~is_long).tolist():
            place = int(np.searchsorted(kept, step))
            if place < len(kept) and chain[kept[place]] == chain[step]:
                begin[place] = min(begin[place], self.begin[step])
            elif place > 0 and chain[kept[place - 1]] == chain[step]:
                end[place - 1] = ends[step]
        return Steps(begin, end - begin, found.share, found.rows, found.jumps, found.whole)

    def inside(self) -> Steps:
        """The same steps with rows that stay away from their ends; their places are not known yet."""
        away = np.clip(APART * (1.0 + np.abs(self.begin)) / self.length, INSIDE, MOST_INSIDE)
        shares = np.tile(np.arange(PARTS + 1) / PARTS, (len(self.begin), 1))
        shares[:, 0], shares[:, -1] = away, 1.0 - away
        return Steps(self.begin, self.length, shares, self.rows, self.jumps, self.whole)

    def torn_at(self, places: Mapping[int, int]) -> Steps:
        """The same where a signal jumps behind a row of some: those beside such a step reach up to it, without itself.

        Behind its last row it jumps where the next one begins.
        """
        begin, end, jumps, gone = self.begin.copy(), self.end, self.jumps.copy(), list[int]()
        for step, row in places.items():
            if row == PARTS:
                jumps[step + 1] = True
                continue
            gone.append(step)
            before, behind = self.times[step, row : row + 2].tolist()
            if step > 0 and not self.jumps[step]:
                end[step - 1] = before
            if step + 1 < len(self) and not self.jumps[step + 1]:
                begin[step + 1], jumps[step + 1] = behind, True
        kept = np.setdiff1d(np.arange(len(self)), gone)
        begin, end = begin[kept], end[kept]
        return Steps(begin, end - begin, self.share[kept], self.rows[kept], jumps[kept], self.whole[kept]).inside()

    @property
    def torn(self) -> NDArray[np.bool_]:
        """Which of them begin behind a jump that is inside of a step of the solver."""
        found: NDArray[np.bool_] = self.jumps & ~self.whole
        return found

    @property
    def room(self) -> Array:
        """How far the rows around the begin of each step are from it [s]."""
        behind = self.share[:, 0] * self.length
        before = np.r_[np.inf, (1.0 - self.share[:-1, -1]) * self.length[:-1]]
        found: Array = np.minimum(behind, before)
        return found

    def moved(self, before: Array, behind: Array) -> Steps:
        """The same steps where some instants are others [s], with rows inside of them."""
        ends = [self.begin[0], self.end[-1]]
        known, there = np.r_[ends[0], before, ends[1]], np.r_[ends[0], behind, ends[1]]
        begin, end = np.interp(self.begin, known, there), np.interp(self.end, known, there)
        return Steps(begin, np.maximum(end - begin, LEAST), self.share, self.rows, self.jumps, self.whole).inside()

    @property
    def times(self) -> Array:
        """Instants of all rows [s]."""
        return self.begin[:, None] + self.share * self.length[:, None]

    @property
    def end(self) -> Array:
        """Ends of the steps [s]."""
        return self.begin + self.length

    def on(self, grid: Array) -> Steps:
        """The same steps with the places of their rows on a grid."""
        return Steps(self.begin, self.length, self.share, np.searchsorted(grid, self.times), self.jumps, self.whole)

    def __len__(self) -> int:
        return len(self.begin)

    @cached_property
    def _unlike(self) -> tuple[Array, Places]:
        """Coefficients as in `basis` of steps whose rows stand at unlike places, and which of these each step has."""
        # the first place says where the others are
        _, which, same = np.unique(self.share[:, 0], return_index=True, return_inverse=True)
        powers = self.share[which][:, :, None] ** np.arange(PARTS + 1)
        return np.linalg.inv(powers).astype(np.float64), same

    @cached_property
    def basis(self) -> Array:
        """Of each step: coefficients of the polynomials that are one at a row and zero at the others."""
        unlike, same = self._unlike
        found: Array = unlike[same]
        return found

    @cached_property
    def left(self) -> Array:
        """Of each step: weights of its rows for the limit at its begin."""
        return self.basis[:, 0]

    @cached_property
    def right(self) -> Array:
        """Of each step: weights of its rows for the limit at its end."""
        unlike, same = self._unlike
        found: Array = unlike.sum(axis=1)[same]
        return found

    @cached_property
    def left_slope(self) -> Array:
        """Of each step: weights of its rows for the time derivative at its begin."""
        found: Array = self.basis[:, 1] / self.length[:, None]
        return found

    @cached_property
    def right_slope(self) -> Array:
        """Of each step: weights of its rows for the time derivative at its end."""
        unlike, same = self._unlike
        found: Array = np.einsum("k,nki->ni", SLOPES, unlike[:, 1:])[same] / self.length[:, None]
        return found

    @cached_property
    def squared_slope(self) -> Array:
        """Of each step: the quadratic form of its rows that is the integral of the square of the time derivative."""
        unlike, same = self._unlike
        slopes, powers = SLOPES[:, None] * unlike[:, 1:], np.arange(PARTS)
        found: Array = np.einsum("nki,kl,nlj->nij", slopes, 1.0 / (powers[:, None] + powers + 1.0), slopes)[same]
        return found / self.length[:, None, None]

    def around(self, step: int, reach: int) -> tuple[int, int] | None:
        """First and last part of the solver's step that has one in it, and of so many of its steps on each side."""
        begins = self._begins
        own = int(np.searchsorted(begins, step, side="right")) - 1
        if own < reach or own + reach + 1 >= len(begins):
            return None
        return int(begins[own - reach]), int(begins[own + reach + 1]) - 1

    @cached_property
    def _begins(self) -> Places:
        """The parts with which steps of the solver begin, and the end."""
        found: Places = np.flatnonzero(np.r_[self.whole, True])
        return found

    def at(self, step: int, share: float) -> Array:
        """Weights that interpolate the rows of a step at a share of its length."""
        found: Array = share ** np.arange(PARTS + 1) @ self.basis[step]
        return found


NO_STEPS = Steps.of_parts(np.zeros(1))
