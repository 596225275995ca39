"""Derivatives of values of one driveline against differences of runs at a tight tolerance, and every way to get them.

Differences are those of either side, of fourth order, at several widths. Where both sides agree they know the
derivative to as much as they are apart; where each side has one of its own the value has a kink. A derivative that is
neither and says nothing is wrong, and a refusal of one that both sides agree on is without a cause.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import clutchwork as cw
from clutchwork.gradients.exact import Exact
from clutchwork.gradients.finite_differences import weights
from clutchwork.gradients.lines import lines
from clutchwork.sweeps.outputs import Extreme
from support.by_differences import TIGHT

Array = NDArray[np.float64]
INSTANT = re.compile(r" at ([-+.e0-9]+) s\b")
# runs with derivatives, and what a derivative may miss, of the scale of a value for a number that changes by all of it
TOLERANCES: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-12}
ALLOWED = 1e-6
# a squared jerk moves by jerks at bends, which are slopes of accelerations along the dense output of the steps: these
# have an order less than it, and three quarters of the digits of the run
ALLOWED_JERK = 3e-5
# of a number: differences on each side of it
WIDTHS = (3e-4, 3e-5, 3e-6)
SIDES = ((0, -1, -2, -3, -4), (0, 1, 2, 3, 4))
# of what is allowed: how far both sides may be apart to know a derivative, and how far it is not worth to look on
KNOWN, ENOUGH = 0.1, 0.01
# sizes of numbers that are zero, where one unit is not usual
ZERO = {"s": 0.1, "rad": 0.1, "m": 0.1}
# differences that are further apart still tell what misses more than so many times that
UNLIKE, MOST = 30.0, 1e-2
# two ways differ by round-off, grown by what is stiff, and by the parts of each: of a squared jerk as it misses more
BOTH_WAYS = 1e-7
# relative tolerances that a driveline is run at, and what its derivatives may miss there, of the scale of a value
LOOSE = ((1e-6, 1e-4), (1e-9, 1e-7))
# what a derivative may miss behind an event that is noted: it has half of its digits
ALLOWED_NOTED = 1e-3


@dataclass
class Tally:
    """What became of the pairs of values and numbers."""

    compared: int = 0
    # both sides differ in differences that say nothing, and where so the derivative was refused
    doubtful: int = 0
    rightly: int = 0
    wrong: list[str] = field(default_factory=list)
    # derivatives that differences know, and runs as a whole, that were refused
    refused: list[str] = field(default_factory=list)
    whole: list[str] = field(default_factory=list)
    # what misses more than others, behind an event that a note is about
    noted: list[str] = field(default_factory=list)
    # values whose derivatives were found in every way, and where forward, followed back, f(x) and sweep do not agree
    ways: int = 0
    apart: list[str] = field(default_factory=list)
    # of those compared, at each of the looser tolerances: found there, and within what is allowed
    loose: list[int] = field(default_factory=lambda: [0] * len(LOOSE))
    within: list[int] = field(default_factory=lambda: [0] * len(LOOSE))


@dataclass(frozen=True)
class Differences:
    """Derivatives of all values by one number as differences of runs say, over the scales of values and number."""

    slope: Array
    doubt: Array  # how far both sides are apart
    sides: Array  # of each side, where its own widths are nearest and of the last one, and how far they are apart there
    doubts: Array

    @property
    def bends(self) -> NDArray[np.bool_]:
        """Values with another derivative on each side."""
        apart = np.abs(np.diff(self.sides, axis=1)).min(axis=(0, 1))
        found: NDArray[np.bool_] = (self.doubts.max(axis=0) < ALLOWED) & (apart > UNLIKE * ALLOWED)
        return found


@dataclass(frozen=True)
class Pair:
    """A derivative that is judged."""

    function: Any
    found: Any
    number: int
    place: int
    scale: float  # of the value over that of the number

    @property
    def name(self) -> str:
        """What it is."""
        return f"d {self.function.of[self.place]} / d {self.function.by[self.number]}"

    @property
    def exact(self) -> float:
        """The derivative that was given."""
        return float(self.found.matrix[self.place, self.number])

    @property
    def allowed(self) -> float:
        """What it may miss."""
        return ALLOWED_JERK if self.function.of[self.place].startswith("squared_jerk") else ALLOWED

    @property
    def why(self) -> str:
        """Why there is none."""
        problems, by = self.found.problems, self.function.by[self.number]
        return next((text for text in problems if by in text), "; ".join(problems))[:200]

    @property
    def noted(self) -> bool:
        """Whether a note is about it."""
        return concerned(self.found.notes, self.function, self.function.of[self.place])

    def scaled(self, known: Differences) -> tuple[float, float, float]:
        """Its scale, and what differences say over that, and how well; what changes by far more than its own size is
        judged by its change."""
        slope, doubt = float(known.slope[self.place]), float(known.doubt[self.place])
        far = max(1.0, abs(slope)) if np.isfinite(slope) else 1.0
        return self.scale * far, slope / far, doubt / far

    def misses(self, known: Differences) -> bool:
        """Whether it is not what differences say."""
        told, slope, _ = self.scaled(known)
        return not abs(self.exact / told - slope) < self.allowed


def size(one: Any) -> float:
    """What a change of a number is compared with."""
    return max(abs(one.start), one.scale if one.places else 0.0) or ZERO.get(one.unit, 1.0)


def compared(
    tally: Tally,
    system: cw.System,
    t_end: float,
    wanted: dict[str, Any],
    scales: Array,
    chosen: Any,
    *,
    loose: bool = False,
) -> None:
    """Derivatives of values of a system by some of its numbers.

    Parameters: loose, whether those of looser tolerances are looked at too.
    """
    by = [one.name for one in chosen]
    try:
        function = cw.differentiable(system, t_end, of=wanted, by=by, **TOLERANCES)
    except cw.UseError as refused:
        # a formula of friction that jumps at a slip has no derivatives, which is said before any run
        if all("where no event is" in problem for problem in refused.problems):
            tally.whole += refused.problems
            return
        raise
    try:
        found = function.gradient()
    except cw.NoGradient as none:
        tally.whole += none.problems
        return
    both_ways(tally, function, found.matrix, scales, chosen)
    tight = Exact(replace(function.task, options=function.task.options.changed(TIGHT)))
    at_loose = [_at(function, rtol) for rtol, _ in LOOSE] if loose else []
    for number, one in enumerate(chosen):
        known = differences(tight, function.x0, number, one, scales)
        pairs = [Pair(function, found, number, place, scale / size(one)) for place, scale in enumerate(scales)]
        if any(pair.misses(known) for pair in pairs):
            known = differences(tight, function.x0, number, one, scales, sure=True)
        for pair in pairs:
            _judge(tally, pair, known)
            for place, matrix in enumerate(at_loose):
                _judge_loose(tally, place, pair, known, float(matrix[pair.place, pair.number]))


def both_ways(tally: Tally, function: Any, given: Array, scales: Array, chosen: tuple[Any, ...]) -> None:
    """A run that carries derivatives along, one that is followed back, f(x) and a sweep give the same.

    Parameters: given, the derivatives: of those that are refused nobody asks.
    """
    engine, x = function.engine, function.x0
    sizes = np.array([size(one) for one in chosen])
    try:
        runs, known = engine.runs, engine._asked
        point = runs.point(x)
        forward, back = runs.forward(point), runs.taped(point)
    except cw.NoGradient:
        return
    args = (function.task.outputs, function.of, known, sizes)
    values, swept = function(x), _swept(function)
    for place, (a, b, scale) in enumerate(zip(lines(forward, *args), lines(back, *args), scales, strict=True)):
        tally.ways += 1
        # what changes by far more than its own size is judged by its change
        told = np.maximum(scale / sizes, np.abs(a.left))
        missed = np.where(np.isnan(given[place]), 0.0, np.abs(a.left - b.left) / told)
        more = ALLOWED_JERK / ALLOWED if a.name.startswith("squared_jerk") else 1.0
        if np.nanmax(missed, initial=0.0) > more * BOTH_WAYS:
            tally.apart.append(f"{a.name}: forward {a.left}, back {b.left}, {np.nanmax(missed):.1e} of scale")
        for what, value in (("f(x)", values[place]), ("sweep", swept.get(place, values[place]))):
            if not abs(a.value - value) <= 1e-7 * scale + 1e-12 and not (np.isnan(a.value) and np.isnan(value)):
                tally.apart.append(f"{a.name}: gradient {a.value!r}, {what} {value!r}")


def _swept(function: Any) -> dict[int, float]:
    """Values of a sweep by their places, but extremes, which it takes from its rows and not from polynomials."""
    outputs, begin = dict(function.task.outputs), function.task.options.t_start
    found = cw.sweep(function.system, function.task.t_end, vary=[{}], outputs=outputs, t_start=begin, **TOLERANCES)
    kept = [(place, name) for place, (name, one) in enumerate(outputs.items()) if not isinstance(one, Extreme)]
    return {place: float(np.ravel(found[name])[0]) for place, name in kept}


def differences(tight: Exact, x0: Array, number: int, one: Any, scales: Array, *, sure: bool = False) -> Differences:
    """Differences of runs to both sides, at widths until they are near enough.

    Parameters: sure, whether several widths must say the same: both sides of what is odd beside a point do.
    """
    found = list[Array]()
    for width in WIDTHS:
        step = min(width * size(one), one.reach / 8)
        found.append(np.array([_slope(tight, x0, number, step, places) for places in SIDES]) * size(one) / scales)
        if not sure and np.all(np.abs(found[-1][0] - found[-1][1]) < ENOUGH * ALLOWED):
            break
    whole, values = np.array(found), np.arange(len(scales))
    steps = np.abs(np.diff(whole, axis=0))
    steps = np.where(np.isfinite(steps), steps, np.inf)
    doubts, nearest = steps.min(axis=0, initial=np.inf), whole[-1]
    if len(steps):
        nearest = np.take_along_axis(whole[1:], steps.argmin(axis=0)[None], axis=0)[0]
    apart = np.abs(whole[:, 0] - whole[:, 1])
    if sure:
        means = whole.mean(axis=1)
        changes = np.abs(np.diff(means, axis=0))
        apart = np.maximum(apart, np.concatenate([changes[:1], np.minimum(changes[:-1], changes[1:]), changes[-1:]]))
    apart = np.where(np.isfinite(apart), apart, np.inf)
    best = np.argmin(apart, axis=0)
    slopes = whole[best, :, values].mean(axis=1)
    return Differences(slopes, apart[best, values], np.array([nearest, whole[-1]]), doubts)


def _judge(tally: Tally, pair: Pair, known: Differences) -> None:
    told, slope, doubt = pair.scaled(known)
    words, missed = f"{pair.name}: {pair.exact:.8g} for", abs(pair.exact / told - slope)
    if not doubt < KNOWN * ALLOWED and not (missed > UNLIKE * doubt and doubt < MOST):
        tally.doubtful += 1
        tally.rightly += int(np.isnan(pair.exact))
        if known.bends[pair.place] and np.isfinite(pair.exact):
            left, right = known.sides[0, :, pair.place] * pair.scale
            tally.wrong.append(f"{words} {left:.8g} on the left and {right:.8g} on the right")
        return
    tally.compared += 1
    words = f"{words} {slope * told:.8g}, {missed:.1e} of scale (differences {doubt:.0e} apart)"
    if np.isnan(pair.exact):
        tally.refused.append(f"{words}: {pair.why}")
    elif not missed < pair.allowed:
        noted = missed < ALLOWED_NOTED and pair.noted
        (tally.noted if noted else tally.wrong).append(words)


def _at(function: Any, rtol: float) -> Array:
    """Derivatives at another tolerance, NaN where there are none."""
    changed = function.task.options.changed({"rtol": rtol, "atol": rtol / 100})
    try:
        found: Array = Exact(replace(function.task, options=changed)).gradient(function.x0).matrix
    except cw.NoGradient:
        return np.full((len(function.of), len(function.by)), np.nan)
    return found


def _judge_loose(tally: Tally, place: int, pair: Pair, known: Differences, derivative: float) -> None:
    told, slope, doubt = pair.scaled(known)
    if doubt < KNOWN * ALLOWED and np.isfinite(pair.exact) and np.isfinite(derivative):
        tally.loose[place] += 1
        tally.within[place] += int(abs(derivative / told - slope) < LOOSE[place][1])


def concerned(notes: tuple[str, ...], function: Any, name: str) -> bool:
    """Whether a note names an output, or is about an instant up to that of it, which nothing behind it moves."""
    if any(text.startswith(f"{name}: ") for text in notes):
        return True
    one = dict(zip(function.of, function.task.outputs.values(), strict=True)).get(name)
    if hasattr(one, "times"):
        end = max(map(float, one.times))
    elif isinstance(one, str) or not hasattr(one, "contact"):
        end = function.task.t_end
    else:
        end = float(function(function.x0)[list(function.of).index(name)])
    instants = [float(found.group(1)) for text in notes if (found := INSTANT.search(text))]
    return any(instant <= end * (1.0 + 1e-9) for instant in instants)


def _slope(runs: Exact, x0: Array, number: int, step: float, places: tuple[int, ...]) -> Array:
    points = np.tile(x0, (len(places), 1))
    points[:, number] += step * np.array(places)
    try:
        values = runs.values(points)
    except cw.ModelError:
        return np.full(len(runs.task.labels), np.nan)
    found: Array = weights(places, len(places)) @ values / step
    return found


def told(tally: Tally) -> Iterator[tuple[str, str]]:
    """What is to be looked at: what sort it is, and its words."""
    for what in ("wrong", "apart", "noted", "refused", "whole"):
        yield from ((what, words) for words in getattr(tally, what))


def summed(tallies: Iterator[Tally]) -> dict[str, int]:
    """Numbers of pairs of all sorts."""
    total = dict[str, int]()
    for one in tallies:
        counts = {"models": 1, "compared": one.compared, "doubtful": one.doubtful, "rightly": one.rightly}
        counts |= {"ways": one.ways}
        for (rtol, _), found, within in zip(LOOSE, one.loose, one.within, strict=True):
            counts |= {f"found at {rtol:g}": found, f"within at {rtol:g}": within}
        for what in ("wrong", "apart", "noted", "refused", "whole"):
            counts[what] = len(getattr(one, what))
        total = {name: total.get(name, 0) + count for name, count in counts.items()}
    return total


def stated(total: dict[str, int]) -> Iterator[str]:
    """What the numbers of pairs say, in sentences."""

    def share(part: int, whole: int) -> str:
        return f"{part} ({100.0 * part / max(whole, 1):.2f} %)"

    pairs, whole = total["compared"] + total["doubtful"], total["compared"]
    yield f"{total['models']} models, {pairs} pairs of a value and a number, {whole} of which differences know"
    yield f"wrong without a word: {share(total['wrong'], pairs)}, behind a note: {share(total['noted'], pairs)}"
    yield f"refused without a cause: {share(total['refused'], whole)}, with one: {share(total['rightly'], pairs)}"
    yield f"forward, adjoint, f(x) and sweep: {total['ways']} values, of which apart: {total['apart']}"
    for rtol, allowed in LOOSE:
        found, within = total[f"found at {rtol:g}"], total[f"within at {rtol:g}"]
        yield f"at rtol {rtol:g} within {allowed:g} of the scale: {share(within, found)} of {found}"
    yield f"models without any derivative, or given up: {total['whole']}"
