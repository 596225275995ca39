"""Goal, limits and their gradients at values of the unknowns, for one sample of production or several."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import ModelError, dataclass
from clutchwork.base.arrays import Array
from clutchwork.calibration.moves import Moves
from clutchwork.calibration.terms import TermData, length
from clutchwork.results.gradient import NoGradient

if TYPE_CHECKING:
    from clutchwork.calibration.limits import WeightedSum
    from clutchwork.calibration.problem import CalibrationProblem

# solvers ask for values and gradients of a few points in turn
REMEMBERED = 8
# of differences where there is no gradient, in shares of the bounds: wider than what grazes
WIDE = 1e-5


@dataclass(frozen=True)
class Evaluation:
    """Goal and limits at values of the unknowns, one after another, and their derivatives by the unknowns."""

    x: Array
    values: Array  # shape (samples, rows)
    slopes: Array  # shape (samples, rows, unknowns)
    fault: str = ""  # why there is no value or no gradient here, empty where there is one
    note: str = ""  # why the gradient is one of differences

    @property
    def is_fine(self) -> bool:
        """Whether there is a value and a gradient of everything."""
        return not self.fault


class Evaluator:
    """Runs the model, and remembers the last few points.

    Rows are those of the goal first, then those of each limit; `parts` says which.
    """

    def __init__(self, problem: CalibrationProblem, function: Any) -> None:
        self.problem, self.function = problem, function
        self.moves = Moves(problem.unknowns, problem.numbers)
        self.spread = Moves(problem.scatter, problem.numbers)
        self.nominal = self.spread.start(problem.base)
        self.sums = (problem.goal, *(limit.what for limit in problem.limits))
        ends = np.cumsum([length(one) for one in problem.outputs]).tolist()
        place = {one: range(end - length(one), end) for one, end in zip(problem.outputs, ends, strict=True)}
        needs = [[at for one in each.needs(problem.span) for at in place[one]] for each in self.sums]
        self.wanted = [np.array(places, dtype=np.intp) for places in needs]
        self.places = {name: at for at, name in enumerate(problem.numbers)}
        self.points = OrderedDict[bytes, Evaluation]()
        self.runs = 0
        self.seen: Callable[[Evaluation], None] = _nobody
        self.last: tuple[bytes, Array] = b"", np.zeros((0, 0))

    def at(self, x: Array, samples: Sequence[Array] = ()) -> Evaluation:
        """Goal and limits with their gradients.

        Parameters: samples, what production scatters, each as the values of `Problem.scatter`; nominal by default.
        """
        chosen = list(samples) or [self.nominal]
        key = x.tobytes() + b"".join(one.tobytes() for one in chosen)
        if key not in self.points:
            self.points[key] = self._made(x, chosen)
            if len(self.points) > REMEMBERED:
                self.points.popitem(last=False)
            self.seen(self.points[key])
        self.points.move_to_end(key)
        return self.points[key]

    def values(self, x: Array, samples: Sequence[Array]) -> Array:
        """Goal and limits of many samples, without gradients, shape (samples, rows); NaN where the model is refused."""
        key = x.tobytes() + b"".join(one.tobytes() for one in samples)
        if key != self.last[0]:
            self.runs += len(samples)
            self.last = key, self._each(self._numbers(x, samples))
        return self.last[1]

    def _each(self, numbers: Array) -> Array:
        """Rows of many lines; NaN in those that the model refuses."""
        try:
            return self._plain(numbers)
        except ModelError:
            if len(numbers) == 1:
                return np.full((1, self.parts[-1].stop), np.nan)
            return np.concatenate([self._each(line[None]) for line in numbers])

    def tried(self, x: Array, samples: Sequence[Array]) -> Evaluation:
        """A point without gradients."""
        try:
            self.runs += len(samples) or 1
            values = self._plain(self._numbers(x, list(samples) or [self.nominal]))
        except ModelError as error:
            return Evaluation(x, np.zeros((0, 0)), np.zeros((0, 0, 0)), str(error))
        return Evaluation(x, values, np.zeros((0, 0, 0)), self._fault(values, values[..., None]))

    def _plain(self, numbers: Array) -> Array:
        """Rows of many lines of numbers."""
        found = np.asarray(self.function.batch(numbers)) if self.problem.outputs else np.zeros((len(numbers), 0))
        empty = np.zeros((found.shape[1], numbers.shape[1]))
        return np.array([self._rows(value, empty, own)[0] for value, own in zip(found, numbers, strict=True)])

    def _numbers(self, x: Array, samples: Sequence[Array]) -> Array:
        """The numbers of the model in each sample."""
        own = self.moves.apply(self.problem.base, x)
        return np.array([self.spread.apply(own, one) for one in samples])

    def _made(self, x: Array, samples: Sequence[Array]) -> Evaluation:
        numbers = self._numbers(x, samples)
        self.runs += len(samples)
        try:
            values, slopes, note = self._differentiated(numbers)
        except ModelError as error:
            return Evaluation(x, np.zeros((0, 0)), np.zeros((0, 0, 0)), str(error))
        by_x = self.moves.slopes(self.problem.base, x)
        found, made = list[Array](), list[Array]()
        for value, slope, own, sample in zip(values, slopes, numbers, samples, strict=True):
            rows, by_numbers = self._rows(value, slope, own)
            found.append(rows)
            smooth = bool(np.all(np.isfinite(slope)))
            exact = by_numbers @ (self.spread.passed(sample)[:, None] * by_x)
            made.append(exact if smooth else self._compared(x, sample))
            note = note or ("" if smooth else "differences of runs took the place of a gradient")
        whole, by = np.array(found), np.array(made)
        return Evaluation(x, whole, by, self._fault(whole, by), note)

    def _compared(self, x: Array, sample: Array) -> Array:
        """Derivatives of the rows where there is no gradient, as of a clutch that grazes: by runs beside it."""
        problem, step = self.problem, WIDE * (self.problem.high - self.problem.low)
        ahead, behind = np.minimum(x + step, problem.high), np.maximum(x - step, problem.low)
        sides = [np.where(np.arange(len(x)) == k, side, x) for side in (ahead, behind) for k in range(len(x))]
        numbers = np.concatenate([self._numbers(side, [sample]) for side in sides])
        try:
            rows = self._plain(numbers)
        except ModelError:
            return np.full((self.parts[-1].stop, len(x)), np.nan)
        self.runs += len(sides)
        made: Array = (rows[: len(x)] - rows[len(x) :]).T / (ahead - behind)
        return made

    def _differentiated(self, numbers: Array) -> tuple[Any, Any, str]:
        """Outputs and their derivatives by the numbers in each sample, and why there are none."""
        if not self.problem.outputs:
            return np.zeros((len(numbers), 0)), np.zeros((len(numbers), 0, numbers.shape[1])), ""
        if len(numbers) > 1:
            return *self.function.batch_jacobian(numbers), ""
        try:
            value, slope = self.function.value_and_jacobian(numbers[0])
        except NoGradient as error:
            value = self.function(numbers[0])
            return [value], [np.full((len(value), numbers.shape[1]), np.nan)], error.problems[0]
        return [value], [slope], ""

    def _rows(self, values: Array, slopes: Array, numbers: Array) -> tuple[Array, Array]:
        """Rows of the goal and of all limits."""
        found = [
            self._of(one, values[wanted], slopes[wanted], numbers)
            for one, wanted in zip(self.sums, self.wanted, strict=True)
        ]
        return np.concatenate([value for value, _ in found]), np.concatenate([slope for _, slope in found])

    def _of(self, one: WeightedSum, values: Array, slopes: Array, numbers: Array) -> tuple[Array, Array]:
        given = TermData(values, slopes, numbers, self.places, self.problem.curves, self.problem.span)
        return one.rows(given)

    @cached_property
    def parts(self) -> list[slice]:
        """Places of the goal and of each limit among the rows."""
        empty = [np.zeros(len(wanted)) for wanted in self.wanted]
        none = np.zeros(len(self.problem.numbers))
        counts = [
            len(self._of(one, values, np.zeros((len(values), len(none))), self.problem.base)[0])
            for one, values in zip(self.sums, empty, strict=True)
        ]
        ends = np.cumsum(counts).tolist()
        return [slice(end - count, end) for end, count in zip(ends, counts, strict=True)]

    def _fault(self, values: Array, slopes: Array) -> str:
        """What is missing at a point; empty where nothing is."""
        for one, part in zip(self.sums, self.parts, strict=True):
            if not np.all(np.isfinite(values[:, part])):
                return f"{one.name} has no value"
            if not np.all(np.isfinite(slopes[:, part])):
                return f"{one.name} has no gradient"
        return ""


def _nobody(point: Evaluation) -> None:
    """Nobody looks on."""
