"""Derivatives of random models of everything against differences of runs at a tight tolerance.

A difference counts where those of either side agree; a derivative that is none there and says nothing is wrong, and a
refusal of one is without a cause.

    PYTHONPATH=tests python -m support.any_model.gradients --models 300 --seed 0 --numbers 7
"""

from __future__ import annotations

import argparse
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import clutchwork as cw
from clutchwork.gradients.exact import Exact
from clutchwork.gradients.finite_differences import weights
from support import by_differences, free_numbers, gradient_cases
from support.any_model import agree, judge, model
from support.by_differences import TIGHT

Array = NDArray[np.float64]
# of a number, or of its scale; the widest that both sides agree at counts
WIDTHS = (3e-4, 3e-5, 3e-6)
# of the scale of a value, for a number that changes by all of its own
ALLOWED = 1e-6
SIDES = {"left": (0, -1, -2, -3, -4), "right": (0, 1, 2, 3, 4)}


@dataclass
class Tally:
    """What became of the pairs of values and numbers."""

    compared: int = 0
    doubtful: int = 0
    wrong: list[str] = field(default_factory=list)
    # refused though both sides agree
    refused: list[str] = field(default_factory=list)
    # refused where they do not, or where differences say nothing
    rightly: int = 0


def checked(made: model.Plain, seed: int, count: int) -> Tally:
    """Derivatives of a model by some of its numbers."""
    tally, rng = Tally(), np.random.default_rng([seed, 76])
    t_end = made["simulation"]["t_end"]
    run = agree.run(made, rtol=1e-8, atol=1e-10, t_start=0.0)
    if run.status != "done" or judge.explodes(run):
        return tally
    wanted = gradient_cases.outputs(run, rng)
    scales = by_differences.scales(run, wanted)
    system = model.driveline(made).assemble()
    for one in free_numbers.some(system, rng, count):
        for output, scale in zip(wanted.values(), scales, strict=True):
            _pair(tally, system, t_end, one, output, float(scale))
    return tally


def _pair(tally: Tally, system: cw.System, t_end: float, one: Any, output: Any, scale: float) -> None:
    """One derivative against its differences."""
    refusal, exact = "", np.nan
    function = cw.differentiable(system, t_end, of=output, by=one.name, rtol=1e-10, atol=1e-12, t_start=0.0)
    try:
        found = function.gradient()
        exact, refusal = float(found.matrix[0, 0]), "; ".join(found.notes)
    except cw.NoGradient as none:
        refusal = "; ".join(none.problems)
    size = max(abs(one.start), one.scale if one.places else 0.0) or 1.0
    best, slope = np.inf, np.nan
    tight = Exact(replace(function.task, options=function.task.options.changed(TIGHT)))
    for width in WIDTHS:
        step = min(width * size, one.reach / 8)
        left, right = (_slope(tight, function.x0, step, places) for places in SIDES.values())
        # of what a bound forbids, or an event that is not there, none is known
        if abs(left - right) * size / scale < best:
            best, slope = abs(left - right) * size / scale, 0.5 * (left + right)
    # both sides apart: a kink, an event in between, or too steep for these widths
    if not best < 0.1 * ALLOWED:
        tally.doubtful += 1
        tally.rightly += bool(refusal)
        return
    tally.compared += 1
    missed = abs(slope - exact) * size / scale
    words = f"d {function.of[0]} / d {one.name}: {exact:.8g} for {slope:.8g}, {missed:.1e} of scale"
    if np.isnan(exact):
        tally.refused.append(f"{words}: {refusal[:160]}")
    elif not missed < ALLOWED and not refusal:
        tally.wrong.append(words)


def _slope(runs: Exact, x0: Array, step: float, places: tuple[int, ...]) -> float:
    points = x0[None] + step * np.array(places)[:, None]
    try:
        return float((weights(places, len(places)) @ runs.values(points))[0] / step)
    except cw.ModelError:
        return np.nan


def campaign(first: int, models: int, count: int) -> Iterator[tuple[int, Tally]]:
    """The models of many seeds."""
    for seed in range(first, first + models):
        try:
            yield seed, checked(model.model(seed), seed, count)
        except cw.ClutchworkError as error:
            yield seed, Tally(wrong=[f"{type(error).__name__}: {str(error)[:200]}"])


def arguments(about: str | None) -> argparse.Namespace:
    """What the command line asks of a comparison of derivatives."""
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--models", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--numbers", type=int, default=5, help="numbers of each model")
    warnings.simplefilter("ignore")
    return parser.parse_args()


def main() -> None:
    """Run it."""
    given = arguments(__doc__)
    total: Counter[str] = Counter()
    reasons: dict[str, list[int]] = defaultdict(list)
    for seed, tally in campaign(given.seed, given.models, given.numbers):
        total += Counter(
            compared=tally.compared,
            doubtful=tally.doubtful,
            wrong=len(tally.wrong),
            refused=len(tally.refused),
            rightly=tally.rightly,
        )
        for words in tally.wrong:
            print(f"seed {seed} WRONG {words}", flush=True)
        for words in tally.refused:
            reasons[words.rpartition(": ")[2][:60]].append(seed)
    print(dict(total))
    for words, seeds in sorted(reasons.items(), key=lambda item: -len(item[1])):
        print(f"{len(seeds):5d} refused, first seed {seeds[0]}: {words}")


if __name__ == "__main__":
    main()
