"""Residuals of the samples of all records over the codes of the free numbers, and their exact derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import ClassVar

import numpy as np

from clutchwork.base import ModelError
from clutchwork.base.arrays import Array
from clutchwork.fit.driven import Driven
from clutchwork.fit.engine import STAY, LeastSquares, Signals, Solution
from clutchwork.fit.failure import FitError, scipy
from clutchwork.fit.losses import Penalty
from clutchwork.fit.numbers import Numbers
from clutchwork.gradients.differentiable import Differentiable, made
from clutchwork.results.gradient import NoGradient
from clutchwork.sweeps.outputs import AtTimes

# relative step of difference quotients, far above the error of the runs
STEP = 1e-4
# quotients of two steps that differ by more, of their size, are those of a jump
JUMP = 0.5
# how far starts lie from the first one, of the scale of a code
SPREAD = 1.0
SEED = 14
# numbers that count as zero
SMALLEST = 1e-300


class Descent(LeastSquares):
    """Residuals of all records, each over its deviation or the size of its signal."""

    zeros: ClassVar[bool] = True

    def __init__(self, records: Sequence[Driven], numbers: Numbers, loss: Penalty | None = None) -> None:
        self.records, self.numbers, self.loss, self.exact = records, numbers, loss or Penalty(), False
        self.items, self.lower, self.upper = numbers.items, *numbers.ends()
        self.searched = range(len(numbers.items))
        self.start, self.scales = numbers.codes(), numbers.scales
        self.points, self.fallen = 0, list[str]()  # derivatives that were asked for, and why some did not exist
        # signals of all records in order, their samples by record, and what residuals are divided by
        self.traces = [one for record in records for one in record.traces]
        self.measured = [np.concatenate([one.values for one in record.traces]) for record in records]
        self.weights = self._weights()
        self.signals, first = Signals(), 0
        for one in self.traces:
            self.signals.setdefault(one.signal, []).append(np.arange(first, first + len(one.times)))
            first += len(one.times)
        counted = np.concatenate(self.measured) / np.concatenate(self.weights)
        self.size = float(np.sqrt(np.mean(counted**2))) or 1.0
        fixed = np.array([item.is_log or item.start != 0.0 for item in self.items])
        self.stay = np.where(fixed, STAY * float(np.sqrt(np.sum(counted**2))) / self.scales, 0.0)

    def _weights(self) -> list[Array]:
        """Of each record: deviations that are given, or the root mean square of the signal over all records."""
        rows = dict[str, list[Array]]()
        for one in self.traces:
            rows.setdefault(one.signal, []).append(one.values)
        sizes = {name: float(np.sqrt(np.mean(np.concatenate(of) ** 2))) or 1.0 for name, of in rows.items()}
        return [
            np.concatenate(
                [np.full(len(one.times), sizes[one.signal]) if one.deviation is None else one.deviation
                 for one in record.traces]
            )
            for record in self.records
        ]  # fmt: skip

    @cached_property
    def functions(self) -> list[Differentiable]:
        """The signals of each record at its samples, as functions of its numbers."""
        return [_function(one, self.numbers.by) for one in self.records]

    # ------------------------------------------------------------------------------------------------------- residuals

    def residuals(self, u: Array) -> Array:
        """Run minus samples over their weights; NaN where a driveline cannot be or stops early."""
        values = self.numbers.values(u)
        return np.concatenate([self._residuals(number, values) for number in range(len(self.records))])

    def _residuals(self, number: int, values: Array) -> Array:
        x = values[self.numbers.places(number)]
        try:
            found = self.functions[number](x)
        except ModelError:
            found = np.full(len(self.measured[number]), np.nan)
        return np.asarray((found - self.measured[number]) / self.weights[number])

    def jacobian(self, u: Array) -> Array:
        """Derivatives of the residuals by the codes."""
        values = self.numbers.values(u)
        rates, blocks = self.numbers.rates(values), []
        for number, function in enumerate(self.functions):
            places = self.numbers.places(number)
            block = np.zeros((len(self.measured[number]), len(u)))
            self.points += 1
            try:
                found = function.gradient(values[places])
                exact = found.matrix * rates[places] / self.weights[number][:, None]
                self.fallen += found.problems[:1]
                missing = np.isnan(exact)
                block[:, places] = np.where(missing, self.differences(number, u), exact) if missing.any() else exact
            except (NoGradient, ModelError) as why:
                self.fallen += [str(problem) for problem in why.problems[:1]]
                block[:, places] = self.differences(number, u)
            blocks.append(block)
        return np.concatenate(blocks)

    def differences(self, number: int, u: Array) -> Array:
        """The same of a record by differences of runs; zero where a sample jumps, which has no derivative.

        Quotients of a jump grow as steps become shorter.
        """
        wide, narrow = (self._quotients(number, u, step) for step in (STEP, STEP / 3.0))
        size = np.maximum(np.abs(wide), np.abs(narrow))
        return np.where(np.abs(wide - narrow) > JUMP * size, 0.0, wide)

    def _quotients(self, number: int, u: Array, relative: float) -> Array:
        """Difference quotients, central inside the bounds and one-sided at them."""
        found, here = [], self._residuals(number, self.numbers.values(u))
        for place in self.numbers.places(number):
            item, scale = self.numbers.items[place], self.numbers.scales[place]
            step = relative * max(scale, 0.0 if item.is_log else abs(float(u[place])))
            ends, codes = [], []
            for code in (min(u[place] + step, self.upper[place]), max(u[place] - step, self.lower[place])):
                moved = np.where(np.arange(len(u)) == place, code, u)
                side = self._residuals(number, self.numbers.values(moved))
                # beside what a driveline refuses one side is there
                there = bool(np.all(np.isfinite(side)))
                ends.append(side if there else here)
                codes.append(code if there else u[place])
            found.append((ends[0] - ends[1]) / ((codes[0] - codes[1]) or 1.0))
        return np.array(found).T

    # ---------------------------------------------------------------------------------------------------------- search

    def best(self, starts: int) -> list[Solution]:
        """Where the searches from several starts ended, the best one first."""
        made = [self.solve(u) for u in self._starts(starts) if np.all(np.isfinite(self.residuals(u)))]
        first, *others = sorted(made, key=lambda one: one.squares)
        return [self.settle(first), *others]

    def _starts(self, count: int) -> list[Array]:
        first = np.clip(self.numbers.codes(), self.lower, self.upper)
        self._refuse_dead(first)
        if count < 2:
            return [first]
        cube = scipy("stats.qmc").LatinHypercube(len(first), seed=SEED).random(count - 1)
        reach = SPREAD * self.numbers.scales
        low, high = np.maximum(first - reach, self.lower), np.minimum(first + reach, self.upper)
        return [first, *(low + cube * (high - low))]

    def _refuse_dead(self, u: Array) -> None:
        """Refuse start values whose runs stop early."""
        values = self.numbers.values(u)
        for number, (record, function) in enumerate(zip(self.records, self.functions, strict=True)):
            x = values[self.numbers.places(number)]
            if not np.all(np.isfinite(function(x))):
                remedy = "start with values whose run reaches the last sample"
                raise FitError(f"the run of {record.label}", "ends early with the start values", remedy)

    def ends(self, u: Array) -> list[tuple[float, float]]:  # noqa: ARG002, numbers of a driveline are not tied
        """Lowest and highest value of each number; the smallest one above zero is zero to a reader."""
        return [(0.0 if 0.0 < item.lowest < SMALLEST else item.lowest, item.highest) for item in self.items]

    def sizes(self, jacobian: Array) -> Array:
        """What changes of codes are measured in: of one that starts at zero what changes the samples by their size."""
        effects = np.sqrt(np.mean(jacobian**2, axis=0))
        zero = np.array([not item.is_log and item.start == 0.0 for item in self.items])
        return np.where(zero & (effects > 0.0), self.size / np.maximum(effects, SMALLEST), self.scales)


def _function(record: Driven, by: Sequence[str]) -> Differentiable:
    """The measured signals of a record at their instants."""
    outputs = {
        f"{one.signal} of {number}": AtTimes(one.signal, tuple(one.times.tolist()))
        for number, one in enumerate(record.traces)
    }
    return made(record.system, outputs, by, record.t_end, record.options, None)
