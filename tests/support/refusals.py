"""Derivatives that are refused, and which of them without cause: differences from both sides agree there."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.base.errors import ModelError
from clutchwork.gradients.differentiable import Differentiable
from clutchwork.gradients.exact import Exact

from . import by_differences, free_numbers, gradient_cases
from .gradient_cases import Case

# widths of the differences to each side, of the scale of a number
WIDTHS = (3e-4, 6e-5)
# differences that agree, of the scale of a value for a number that changes by all of its own
AGREE, APART = 1e-5, 1e-3
# derivatives that are off by more are wrong
WRONG = 1e-4


@dataclass
class Count:
    """Pairs of a value and a number: all, those that are refused, and what the differences say of these."""

    pairs: int = 0
    refused: int = 0
    without_cause: list[str] = field(default_factory=list)
    with_cause: int = 0
    compared: int = 0
    wrong: list[str] = field(default_factory=list)

    def __add__(self, other: Count) -> Count:
        return Count(
            self.pairs + other.pairs,
            self.refused + other.refused,
            self.without_cause + other.without_cause,
            self.with_cause + other.with_cause,
            self.compared + other.compared,
            self.wrong + other.wrong,
        )


def counted(case: Case, seed: int, count: int, *, all_numbers: bool = False) -> Count:
    """Refusals of a driveline by some of its numbers, which are asked for together.

    Parameters: all_numbers, whether derivatives by numbers of which nothing is refused are compared as well.
    """
    rng, (model, t_end) = np.random.default_rng(seed), case
    system = model if isinstance(model, cw.System) else model.assemble()
    run = cw.simulate(system, t_end, rtol=1e-8, atol=1e-10)
    if not run.finished:
        return Count()
    wanted = gradient_cases.outputs(run, rng)
    by = [one.name for one in free_numbers.some(system, rng, count)]
    function = cw.differentiable(system, t_end, of=wanted, by=by, rtol=1e-9, atol=1e-11)
    matrix = np.full((len(function.of), len(function.by)), np.nan)
    with suppress(cw.NoGradient):
        matrix = function.gradient().matrix
    scales = by_differences.scales(run, wanted)
    made = Count(matrix.size, int(np.isnan(matrix).sum()))
    for number in np.flatnonzero(all_numbers | np.isnan(matrix).any(axis=0)).tolist():
        found = _sides(function, number, scales)
        if found is not None:
            own = matrix[:, number] * _size(function, number) / scales
            _judge(made, function, number, own, *found)
    return made


def _judge(made: Count, function: Differentiable, number: int, own: Any, left: Any, right: Any, doubt: Any) -> None:
    for name, value, *sides, off in zip(function.of, own, left, right, doubt, strict=True):
        apart, what = abs(sides[0] - sides[1]), f"d {name} / d {function.by[number]}"
        if not (np.isfinite(apart) and off < AGREE):
            continue
        if np.isnan(value):
            made.with_cause += int(apart > APART)
            made.without_cause += [what] if apart < AGREE else []
        elif apart < AGREE:
            made.compared += 1
            missed = abs(value - 0.5 * (sides[0] + sides[1]))
            made.wrong += [f"{what}: {missed:.1e} off"] if missed > WRONG else []
        else:
            made.wrong += [f"{what}: one of two that are {apart:.1e} apart"] if apart > APART else []


def _sides(function: Differentiable, number: int, scales: Any) -> tuple[Any, Any, Any] | None:
    """Differences to both sides over the scales, and how far they can be trusted; None where a side is missing."""
    task, x = function.task, function.x0
    tight, one = Exact(replace(task, options=task.options.changed(by_differences.TIGHT))), task.parameters[number]
    size = _size(function, number)
    sides: dict[int, list[Any]] = {-1: [], 1: []}
    for sign, found in sides.items():
        for width in WIDTHS:
            points = np.tile(x, (3, 1))
            step = sign * min(width * size, one.reach / 8)
            points[:, number] += step * np.arange(3)
            try:
                values = tight.values(points)
            except ModelError:
                return None
            found.append((-1.5 * values[0] + 2.0 * values[1] - 0.5 * values[2]) / step * size / scales)
    doubt = np.max([np.abs(found[0] - found[1]) for found in sides.values()], axis=0)
    return sides[-1][1], sides[1][1], doubt


def _size(function: Differentiable, number: int) -> float:
    one, value = function.task.parameters[number], float(function.x0[number])
    return max(abs(value), one.scale if one.places else 0.0) or 1.0
