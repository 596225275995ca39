"""Extremes of signals over a run, and how they change: docs/theory/gradients.md (12), (18), (19)."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

from clutchwork.gradients import several_steps
from clutchwork.gradients.functional import Functional
from clutchwork.gradients.held_torques import add_held, is_torn, torque_at_limit
from clutchwork.gradients.instants import add_shift, add_turn, missed
from clutchwork.gradients.primal import SAME, SMOOTH, Primal
from clutchwork.gradients.sides import Sides, jumps, of_bend
from clutchwork.gradients.signals import add_signal, signal_at
from clutchwork.gradients.steps import Steps
from clutchwork.sweeps.outputs import Extreme
from clutchwork.sweeps.parts import PARTS

Array = NDArray[np.float64]
Places = NDArray[np.intp]

NOWHERE = np.zeros(0, dtype=np.intp)

# two extremes are one where they differ by less, of the largest size of the signal
EQUAL = 1e-9
# of what equal ones may differ by: round-off
LEVEL = 1e-3
# what a dense output may miss at a top that several steps do not fit, of its last coefficient
TOP_MISSES = 0.01
# from so many steps in a row on they are looked at as one hill
HILL = 3
# by how much they may rise the wrong way, of what is allowed and of what they rise in all
ROUGH = 0.05
# so many of those that are equal are looked at
MOST_EQUAL = 16
SIGNS = {"maximum": (1.0,), "minimum": (-1.0,), "peak": (1.0, -1.0)}
# places in a step at which polynomials are sampled
WIDTH = 1 / 16
PLACES = np.vander(np.arange(17) * WIDTH, PARTS + 1, increasing=True)


class Located(NamedTuple):
    """Where an extreme is: its value, its step, the place in it, and its sign in the output."""

    value: float
    step: int
    share: float
    sign: float
    rough: float = 0.0  # last coefficient of the polynomial over the length of the step, of which slopes are off
    is_flat: bool = False  # all of the step is as large
    is_level: bool = False  # except for round-off
    # whether all values from the begin of the step to it, and from it to the end, are as large
    holds: tuple[bool, bool] = (False, False)

    @property
    def begins(self) -> int | None:
        """The step that begins there; None inside of a step."""
        return self.step + int(self.share == 1.0) if self.share in (0.0, 1.0) else None

    def time(self, steps: Steps) -> float:
        """Its instant [s]."""
        return float(steps.begin[self.step] + self.share * steps.length[self.step])


def candidates(one: Extreme, steps: Steps, values: Array) -> list[Located]:
    """The extreme, and those that are as large, those inside of steps first.

    Parameters: values of the signal, a line for the rows of each step.
    """
    found, allowed = list[Located](), _allowed(values)
    sides = list(_near(one, steps, values))
    best = max((side.best for side in sides), default=0.0)
    for sign, coefficients, near, tops, _, bound in sides:
        for step in near.tolist() if bound >= best - allowed else ():
            own, is_top = sign * coefficients[step], step in tops
            rough = float(abs(own[-1]) / steps.length[step])
            some = [_at_bend(top, steps, values) for top in _in_step(step, own, PLACES @ own, sign, allowed, is_top)]
            found += [top._replace(rough=rough) for top in some]
    least = max((one.value for one in found), default=0.0) - allowed
    return sorted((one for one in found if one.value >= least), key=lambda one: one.share in (0.0, 1.0))


def reaching(one: Extreme, steps: Steps, values: Array, missed: Array) -> Places:
    """Steps that may reach the extreme, or do so with what their polynomials may miss."""
    coefficients, sides = np.einsum("nki,ni->nk", steps.basis, values), list(_near(one, steps, values))
    best = max((side.best for side in sides), default=0.0)
    most = [(side.sign * (coefficients @ PLACES.T)).max(axis=1) + missed for side in sides]
    near = [np.union1d(side.near, np.flatnonzero(own >= best)) for side, own in zip(sides, most, strict=True)]
    return np.unique(np.concatenate([NOWHERE, *near]))


def _allowed(values: Array) -> float:
    return EQUAL * float(np.abs(values).max(initial=0.0))


class CandidateSteps(NamedTuple):
    """Steps that may reach the extreme of one sign."""

    sign: float
    coefficients: Array  # of the polynomials of all steps
    near: Places
    tops: Places  # those of them that have the top of short ones
    best: float  # the largest sample
    bound: float  # which no value exceeds


def _near(one: Extreme, steps: Steps, values: Array) -> Iterator[CandidateSteps]:
    """For each sign of the output the steps that may reach its largest value."""
    coefficients = np.einsum("nki,ni->nk", steps.basis, values)
    samples = coefficients @ PLACES.T
    # between samples a polynomial rises by less than an eighth of its second difference
    rise = np.abs(np.diff(samples, 2)).max(axis=1, initial=0.0) / 8
    for sign in SIGNS[one.kind]:
        signed, allowed = sign * samples, _allowed(values)
        upper = signed.max(axis=1)
        while True:
            best = float(upper.max(initial=-np.inf))
            near = np.flatnonzero(upper + rise >= best - allowed)
            above = _above_plateaus(steps, near, sign * values, signed, allowed)
            if not len(above):
                break
            upper[above] = -np.inf
        near, tops = _without_hillsides(near, sign * coefficients, signed, allowed)
        if len(near) > MOST_EQUAL:
            first = near[np.argsort(-upper[near], kind="stable")][:MOST_EQUAL]
            # of a plateau its ends are among those that are looked at
            level = near[signed[near].min(axis=1) >= best - LEVEL * allowed]
            ends = level if len(level) else near
            near = np.unique([*first, ends[0], ends[-1]])
        yield CandidateSteps(sign, coefficients, near, tops, best, float((upper + rise).max(initial=-np.inf)))


def _above_plateaus(steps: Steps, near: Places, values: Array, samples: Array, allowed: float) -> Places:
    """Those beside a plateau whose polynomials are above it, while their rows are not: that is from a bend inside."""
    found = [NOWHERE]
    for side in (-1, 1):
        own = near[(near + side >= 0) & (near + side < len(steps))]
        own = own[~steps.jumps[np.maximum(own, own + side)]]
        other, top = samples[own + side], samples[own].max(axis=1, initial=-np.inf)
        high, rows = other.max(axis=1, initial=-np.inf), values[own].max(axis=1, initial=-np.inf)
        level = np.abs(other - high[:, None]).max(axis=1, initial=0.0) <= LEVEL * allowed
        found.append(own[level & (rows <= high + LEVEL * allowed) & (top > high + allowed)])
    return np.concatenate(found)


def _without_hillsides(near: Places, coefficients: Array, samples: Array, allowed: float) -> tuple[Places, Places]:
    """Without steps in a row that are nearly as large, but rise to a top and fall behind it; and those that have it.

    Such steps are short ones, of stiff motion.
    """
    tops = [NOWHERE]
    for chain in np.split(near, np.flatnonzero(np.diff(near) > 1) + 1):
        rises = np.ptp(samples[chain], axis=1)
        if len(chain) < HILL or rises.min() <= LEVEL * allowed or rises.min() > allowed:
            continue
        ends = np.column_stack([coefficients[chain, 0], coefficients[chain].sum(axis=1)]).ravel()
        top, slack = int(np.argmax(ends)), ROUGH * min(allowed, float(np.ptp(ends)))
        if np.all(np.diff(ends[: top + 1]) >= -slack) and np.all(np.diff(ends[top:]) <= slack):
            tops.append(chain[max(0, (top - 1) // 2) : (top + 1) // 2 + 1])
            near = np.union1d(np.setdiff1d(near, chain), tops[-1])
    return near, np.concatenate(tops)


def _in_step(
    step: int, coefficients: Array, samples: Array, sign: float, allowed: float, is_top: bool
) -> list[Located]:
    """The largest value of a polynomial, and where it is: at an end, where its slope is zero, or everywhere.

    Parameters: is_top, whether it has one place however little it rises.
    """
    if (rise := float(np.ptp(samples))) <= allowed and not is_top:
        level = rise <= LEVEL * allowed
        return [Located(float(samples[end]), step, float(-end), sign, is_flat=True, is_level=level) for end in (0, -1)]
    return [_top(step, coefficients, samples, sign, allowed)]


def _top(step: int, coefficients: Array, samples: Array, sign: float, allowed: float) -> Located:
    """The largest value of a polynomial that is not the same everywhere."""
    best = int(np.argmax(samples))
    share, slope = best / (len(samples) - 1), coefficients[1:] * np.arange(1, len(coefficients))
    bend = slope[1:] * np.arange(1, len(slope))
    low, high = max(share - WIDTH, 0.0), min(share + WIDTH, 1.0)
    for _ in range(8):
        curved = float(polyval(share, bend))
        share = min(max(share - float(polyval(share, slope)) / curved, low), high) if curved else share
    value = float(polyval(share, coefficients))
    # at an end it still rises, or there is no better place inside
    if value <= samples[best]:
        return Located(float(samples[best]), step, best * WIDTH, sign)
    low_enough = samples < value - allowed
    before, behind = low_enough[: int(share / WIDTH) + 1], low_enough[int(share / WIDTH) + 1 :]
    return Located(value, step, share, sign, holds=(not before.any(), not behind.any()))


def apart(primal: Primal, found: list[Located]) -> list[Located]:
    """Without those that are another side of one extreme: at one instant, or on steps that go on smoothly.

    Of both sides of an instant that one stays whose polynomial is the smoother one, of a plateau and what leads to it
    the plateau. At a knot that does not move both stay: a number may make the signal jump there.
    """
    kept, kinds, stays = list[Located](), primal.between[0], np.r_[primal.stays, False]
    for one in sorted(_without_slopes(found, kinds), key=lambda one: (one.begins is not None, one.rough)):
        near = [other for other in kept if abs(other.step - one.step) <= 1 and other.sign == one.sign]
        if (one.is_flat and all(other.is_flat for other in near)) or all(
            other.step != one.step
            and kinds[max(other.step, one.step)] != SMOOTH
            and (one.begins is None or other.begins != one.begins or stays[one.begins])
            for other in near
        ):
            kept.append(one)
    return kept


def _without_slopes(found: list[Located], kinds: Places) -> list[Located]:
    """Without those that lead to a plateau, which a law or a signal makes from one instant on."""
    left = [one for one in found if not one.is_level]
    ends = {(one.sign, one.step, way, True) for one in found if one.is_level for way in (-1, 1)}
    while True:
        gone = [one for one in left if any(_leads_to(one, end, kinds) for end in ends)]
        if not gone:
            return [one for one in found if one.is_level or one in left]
        # from there on all that is joined to them where they are as large
        ends |= {(one.sign, one.step, way, False) for one in gone for way in (-1, 1) if _reaches(one, way)}
        left = [one for one in left if one not in gone]


def _leads_to(one: Located, end: tuple[float, int, int, bool], kinds: Places) -> bool:
    """Whether it is as large up to a step beside it, on one side of that: of a plateau, or what was joined to one."""
    sign, step, way, is_level = end
    if one.sign != sign or one.step - step != way or (is_level and kinds[max(one.step, step)] == SMOOTH):
        return False
    return _reaches(one, -way)


def _reaches(one: Located, way: int) -> bool:
    """Whether it is as large up to an end of its step: -1, where that begins, or 1."""
    place = int(way > 0)
    return one.is_flat or one.share == place or one.holds[place]


def value(one: Extreme, found: list[Located]) -> float:
    """The extreme itself."""
    return float("nan") if not found else -found[0].value if one.kind == "minimum" else found[0].value


def further(one: Extreme, value: float, other: float) -> float:
    """The value that is more of an extreme; NaN is none."""
    is_further = other < value if one.kind == "minimum" else other > value
    return other if is_further or np.isnan(value) else value


def kinks(primal: Primal, found: list[Located]) -> tuple[float, ...]:
    """Instants of extremes at which knots meet or move at an end of the run [s]; and that end where a signal jumps.

    There it has a value behind the end that is one of the run as soon as the knot comes before it.
    """
    there, jumps = {one.begins for one in found}, primal.grazes[primal.grazes[:, 1] < 0, 0]
    return tuple(
        time
        for time, place in primal.meets
        if place in there or (place == len(primal.steps) and np.any(np.abs(jumps - time) <= SAME * (1.0 + abs(time))))
    )


def add_extreme(primal: Primal, one: Extreme, found: Located, into: Functional) -> list[tuple[Functional, float]]:
    """How an extreme changes: the signal at its instant, and that instant where it is that of an event.

    Returns what moves with an error, that instant, the last coefficient or the slope of a top, and by how much each
    counts.
    """
    steps, sign = primal.steps, 1.0 if one.kind == "minimum" else found.sign
    end, place = found.begins, (found.step, found.share)
    if end is None and not found.is_flat:
        place = several_steps.top(primal, partial(_rows_of, primal, one), *place)
    whole = [(place[0], sign * steps.at(*place))]
    inside = end is None or end == len(steps) or (end == 0 and primal.between[0][0] == SMOOTH)
    if not inside and primal.between[0][end] == SMOOTH and not found.is_level:
        whole = of_bend(primal, one.signal, int(end or 0), sign) or whole
    held = torque_at_limit(primal, one.signal, found.step) if not inside and found.share == 1.0 else None
    if held is not None:
        add_held(primal, held, found.step, sign, into)
        return []
    for step, weights in whole:
        add_signal(primal, one.signal, steps.rows[step], weights, into)
    lost = [] if end is not None or found.is_flat else [_misplaced(primal, one, *place)]
    if lost and place == (found.step, found.share):
        moves, (first, last) = primal.functional(), steps.around(found.step, 0) or (found.step, found.step)
        # of a part of a step that of the whole one, which has its error
        longer = float((steps.end[last] - steps.begin[first]) / steps.length[found.step]) ** PARTS
        add_signal(primal, one.signal, steps.rows[found.step], longer * steps.basis[found.step, PARTS], moves)
        return [*lost, (moves, TOP_MISSES)]
    if not inside:
        slopes = steps.left_slope if found.share == 0.0 else steps.right_slope
        values = signal_at(primal, one.signal, steps.rows[found.step])
        rate = float(slopes[found.step] @ values)
        if primal.between[0][end] != SMOOTH:
            add_shift(primal, int(end or 0), sign * rate, into)
            moves = primal.functional()
            add_shift(primal, int(end or 0), 1.0, moves)
            # in a short step the slope has what rows are off by, too
            off = primal.rtol * float(np.abs(values).max()) / float(steps.length[found.step])
            return [(moves, abs(rate) * missed(primal, found.step, at_end=found.share == 1.0) + off)]
        if jumps(primal, one.signal, int(end or 0)):
            add_turn(primal, one.signal, int(end or 0), sign * rate, into)
    return lost


def _misplaced(primal: Primal, one: Extreme, step: int, share: float) -> tuple[Functional, float]:
    """The slope at a top, and how far errors of rows at the tolerance of the run move it [s]."""
    steps, moves, powers = primal.steps, primal.functional(), np.arange(1, PARTS + 1)
    values, coefficients = signal_at(primal, one.signal, steps.rows[step]), steps.basis[step]
    slope = (powers * share ** (powers - 1)) @ coefficients[1:] / steps.length[step]
    bend = (powers[1:] * powers[:-1] * share ** (powers[1:] - 2)) @ coefficients[2:] / steps.length[step] ** 2
    add_signal(primal, one.signal, steps.rows[step], slope, moves)
    # parts of one step have its errors together
    first, last = steps.around(step, 0) or (step, step)
    error = primal.rtol * float(np.abs(values).max()) / float(steps.end[last] - steps.begin[first])
    return moves, error / max(abs(float(bend @ values)), 1e-291)


def is_lost(primal: Primal, one: Extreme, found: Located) -> bool:
    """Whether an extreme is where its signal jumps without an event, which says nothing of how that instant moves."""
    end = found.begins
    if end is None or not is_torn(primal, end) or not jumps(primal, one.signal, end):
        return False
    return found.share == 0.0 or torque_at_limit(primal, one.signal, found.step) is None


def _rows_of(primal: Primal, one: Extreme, first: int, last: int) -> Array:
    """Its signal in all rows from a first to a last step."""
    return signal_at(primal, one.signal, primal.steps.rows[first : last + 1].ravel())


def _at_bend(top: Located, steps: Steps, values: Array) -> Located:
    """The same with the value at which both sides meet, where it is at a bend."""
    end = top.begins
    if end is None or not 0 < end < len(steps) or steps.jumps[end]:
        return top
    sides = Sides.of(steps, end, *values[end - 1 : end + 1])
    away = sides.meeting
    return top if not away else top._replace(value=top.sign * (sides.before + away * sides.rise))
