"""Extremes of signals over a run, and how they change: docs/theory/gradients.md (12)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

from clutchwork.gradients.functional import Functional
from clutchwork.gradients.instants import add_shift
from clutchwork.gradients.primal import SMOOTH, Primal
from clutchwork.gradients.signals import add_signal, signal_at
from clutchwork.gradients.steps import Steps
from clutchwork.sweeps.outputs import Extreme
from clutchwork.sweeps.parts import PARTS

Array = NDArray[np.float64]

# two extremes are one where they differ by less, of the largest size of the signal
EQUAL = 1e-9
# so many of those that are equal are looked at
MOST_EQUAL = 16
# places in a step at which polynomials are sampled
WIDTH = 1 / 16
PLACES = np.vander(np.arange(17) * WIDTH, PARTS + 1, increasing=True)


class Found(NamedTuple):
    """Where an extreme is: its value, its step, the place in it, and its sign in what is asked for."""

    value: float
    step: int
    share: float
    sign: float

    @property
    def begins(self) -> int | None:
        """The step that begins there; None inside of a step."""
        return self.step + int(self.share == 1.0) if self.share in (0.0, 1.0) else None

    def time(self, steps: Steps) -> float:
        """Its instant [s]."""
        return float(steps.begin[self.step] + self.share * steps.length[self.step])


def candidates(one: Extreme, steps: Steps, values: Array) -> list[Found]:
    """The extreme, and those that are as large, those inside of steps first.

    Parameters: values of the signal, a line for the rows of each step.
    """
    found, allowed = list[Found](), EQUAL * float(np.abs(values).max(initial=0.0))
    coefficients = np.einsum("nki,ni->nk", steps.basis, values)
    for sign in {"maximum": (1.0,), "minimum": (-1.0,), "peak": (1.0, -1.0)}[one.kind]:
        upper = sign * coefficients @ PLACES.T
        # between samples a polynomial rises by less than an eighth of its second difference
        top = upper.max(axis=1) + np.abs(np.diff(upper, 2)).max(axis=1, initial=0.0) / 8
        least = upper.max(initial=-np.inf) - allowed
        near = np.flatnonzero(top >= least)
        near = near[np.argsort(-upper[near].max(axis=1), kind="stable")][:MOST_EQUAL]
        found += [_in_step(int(step), sign * coefficients[step], upper[step], sign) for step in near]
    least = max((one.value for one in found), default=0.0) - allowed
    return sorted((one for one in found if one.value >= least), key=lambda one: one.share in (0.0, 1.0))


def _in_step(step: int, coefficients: Array, samples: Array, sign: float) -> Found:
    """The largest value of a polynomial, and where it is: at an end, or where its slope is zero."""
    if np.ptp(samples) <= 1e-14 * np.abs(samples).max():
        return Found(float(samples[0]), step, 0.5, sign)
    best = int(np.argmax(samples))
    share, slope = best / (len(samples) - 1), coefficients[1:] * np.arange(1, len(coefficients))
    bend = slope[1:] * np.arange(1, len(slope))
    low, high = max(share - WIDTH, 0.0), min(share + WIDTH, 1.0)
    for _ in range(8):
        curved = float(polyval(share, bend))
        share = min(max(share - float(polyval(share, slope)) / curved, low), high) if curved else share
    value = float(polyval(share, coefficients))
    # at an end it still rises, or there is no better place inside
    return (
        Found(value, step, share, sign)
        if value > samples[best]
        else Found(float(samples[best]), step, best * WIDTH, sign)
    )


def apart(primal: Primal, found: list[Found]) -> list[Found]:
    """Without those that are another side of one extreme: on steps that follow each other smoothly."""
    kept, kinds = list[Found](), primal.between[0]
    for one in found:
        near = (other for other in kept if abs(other.step - one.step) <= 1)
        if all(other.step != one.step and kinds[max(other.step, one.step)] != SMOOTH for other in near):
            kept.append(one)
    return kept


def value(one: Extreme, found: list[Found]) -> float:
    """The extreme itself."""
    return float("nan") if not found else -found[0].value if one.kind == "minimum" else found[0].value


def kinks(primal: Primal, found: list[Found]) -> tuple[float, ...]:
    """Instants of extremes at which knots meet [s], but for the ends of the run, which stay."""
    there = {one.begins for one in found} - {0, len(primal.steps), None}
    return tuple(time for time, place in primal.meets if place in there)


def add_extreme(primal: Primal, one: Extreme, found: Found, into: Functional) -> None:
    """How an extreme changes: the signal at its instant, and that instant where it is that of an event."""
    steps, sign = primal.steps, 1.0 if one.kind == "minimum" else found.sign
    weights = sign * steps.at(found.step, found.share)
    add_signal(primal, one.signal, steps.rows[found.step], weights, into)
    end = found.begins
    if end is None or not 0 < end < len(steps) or primal.between[0][end] == SMOOTH:
        return
    slopes = steps.left_slope if found.share == 0.0 else steps.right_slope
    rate = float(slopes[found.step] @ signal_at(primal, one.signal, steps.rows[found.step]))
    add_shift(primal, end, sign * rate, into)
