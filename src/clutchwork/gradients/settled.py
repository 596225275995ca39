"""What is in doubt at a point is settled by derivatives beside it: docs/theory/gradients.md (17)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import field
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.gradients.bends import spread
from clutchwork.gradients.doubts import Doubt
from clutchwork.gradients.lines import LEAST, Line
from clutchwork.gradients.task import GradientTask

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
# lines of a run beside the point by all numbers or, where a number is given, by that one alone; None without a run
Beside = Callable[[Array, "int | None"], "Sequence[Line] | None"]

# how far beside a point derivatives are looked at, of the size of a number
STEP = 1e-6
# derivatives that differ by less are one, of their size or that of the value over that of the number, and of the
# relative tolerance of the runs
ALIKE, BY_TOLERANCE = 1e-6, 100.0
# nearer by, of that step; derivatives at both that differ by less are a line over the step, of their size
NEARER, NEARLY = 0.1, 1e-2
# by how much both sides of a curve through the point may differ there, of what is alike at them
CURVED = 1e-4
# a number of no known size is no larger than so many of its unit: what it does up to there is looked at
LARGEST = 1e6
# values that differ by more on both sides jump, of their size, and beside what their derivatives say
JUMP, FURTHER, NOISE = 1e-3, 10.0, 1e-9
# so many numbers in doubt are first looked at together, in so many directions
TOGETHER, DIRECTIONS = 3, 2
SIDES = {"left": -1.0, "right": 1.0}
# derivatives from both sides that are told of one reason
SHOWN = 3


@dataclass(frozen=True, eq=False)
class Settling:
    """Derivatives of the lines of a run from both sides.

    They start as those of the run at the point, and become those beside it where they are in doubt.
    """

    task: GradientTask
    x: Array
    sizes: Array  # of the numbers
    unsized: Mask  # numbers at zero beside which nothing says how large they are
    lines: Sequence[Line]
    both: dict[str, Array]  # left and right
    why: NDArray[np.object_] = field(repr=False)  # of each derivative: why it is in doubt
    one_way: Mask  # numbers that are in doubt for kinks alone that do not depend on the others
    closed: Mask  # numbers beside which there is no value
    steps: Array  # of each derivative: how far beside the point it is looked at

    @classmethod
    def of(cls, task: GradientTask, x: Array, sizes: Array, lines: Sequence[Line], doubts: Sequence[Doubt]) -> Settling:
        """Those of a run."""
        why, one_way = np.full((len(lines), len(x)), "", dtype=object), np.ones(len(x), dtype=bool)
        steps, closed = np.zeros(why.shape), np.zeros(len(x), dtype=bool)
        # what concerns few numbers says more about them than what may concern all
        order = [(-int(one.numbers.sum()), one.one_way, -place) for place, one in enumerate(doubts)]
        for doubt in (doubts[-place] for _, _, place in sorted(order)):
            why[np.ix_(doubt.lines, doubt.numbers)] = doubt.why
            one_way &= doubt.one_way | ~doubt.numbers
            closed |= doubt.numbers & doubt.is_closed
            far = np.maximum(doubt.width * STEP * sizes, doubt.least)
            steps = np.maximum(steps, np.where(doubt.lines[:, None] & doubt.numbers, far, 0.0))
        # what is not in doubt itself goes as far as others do
        steps = np.where(steps > 0.0, steps, np.maximum(steps.max(axis=0, initial=0.0), STEP * sizes))
        why[[bool(line.none) for line in lines]] = ""
        unsized = np.array([one.unsized for one in task.parameters], dtype=bool) & (np.abs(x) < sizes)
        both = {side: _taken(lines, side, why.shape) for side in SIDES}
        return cls(task, x, sizes, unsized, lines, both, why, one_way, closed, steps)

    # ------------------------------------------------------------------------------------------------------- beside it

    def settle(self, beside: Beside) -> None:
        """Find what is in doubt from runs beside the point: no value is looked at farther away for another one."""
        far, which = np.unique(self.steps, axis=0, return_inverse=True)
        for place, steps in enumerate(far):
            self._settle_lines(which.ravel() == place, steps, beside)

    def _settle_lines(self, lines: Mask, steps: Array, beside: Beside) -> None:
        """The same for some lines that are looked at in the same distance."""
        others = ~self.one_way
        if len(numbers := self._open(lines, self.one_way)) and not self._settle(
            lines, numbers, steps, lambda x: beside(x, None)
        ):
            others[:] = True
        if len(self._open(lines, others)) >= TOGETHER:
            self.why[lines[:, None] & self._alike_together(steps, beside)] = ""
        for number in self._open(lines, others).tolist():
            self._settle(lines, np.array([number]), steps, partial(_alone, beside, number, len(self.x)))

    def _open(self, lines: Mask, among: Mask) -> NDArray[np.intp]:
        """Numbers with derivatives of some lines in doubt."""
        return np.flatnonzero(np.any(self.why[lines] != "", axis=0) & among & ~self.closed)

    def _alike_together(self, steps: Array, beside: Beside) -> Mask:
        """Which derivatives are the same on both sides of the point, in directions that move all numbers."""
        alike, chance = np.ones(self.why.shape, dtype=bool), np.random.default_rng(0)
        for _ in range(DIRECTIONS):
            way = steps * chance.uniform(0.5, 1.0, len(self.x)) * chance.choice([-1.0, 1.0], len(self.x))
            way[self.closed] = 0.0
            for sign in SIDES.values():
                found = beside(self.x + sign * way, None)
                if found is None:
                    return np.zeros_like(alike)
                alike &= ~self._jumps(found, np.abs(way), *(_taken(found, side, alike.shape) for side in SIDES))[
                    :, None
                ]
                for side, own in self.both.items():
                    alike &= self._is_one(own, _taken(found, side, alike.shape))
        return alike

    def _settle(
        self,
        lines: Mask,
        numbers: NDArray[np.intp],
        steps: Array,
        beside: Callable[[Array], Sequence[Line] | None],
    ) -> bool:
        """Derivatives by numbers from both sides; where they agree, and with those at the point, these stay.

        False where there is no run on any side.
        """
        open_ = (self.why[:, numbers] != "") & lines[:, None]
        own = np.array([one[:, numbers] for one in self.both.values()])
        there, is_run = self._beside(numbers, beside, steps)
        same = self._is_same(own, there[is_run], numbers)
        if np.any(open_ & ~same):
            # what is more than the derivatives at the point: the limits of those beside it
            nearer, is_run = self._beside(numbers, beside, NEARER * steps)
            if is_run.all():
                same |= self._goes_on(own, there, nearer, numbers)
            limits = (nearer - NEARER * there) / (1.0 - NEARER)
            nearly = np.abs(nearer - there) <= NEARLY * np.maximum(np.abs(nearer), np.abs(there))
            # one that falls with the distance itself, as that of a square at zero, ends there
            falls = np.abs(nearer - NEARER * there) <= NEARLY * NEARER * np.abs(there)
            nearly, limits = nearly | falls, np.where(falls, 0.0, limits)
            nearly |= np.array([self._is_one(*both, numbers) for both in zip(there, nearer, strict=True)])
            # what is neither the same nor a line has another kink nearby, up to which alone it would hold
            there = np.where(nearly, limits, np.nan)
            same |= self._is_same(own, there[is_run], numbers)
        agree, mean, new = self._is_one(there[0], there[1], numbers), 0.5 * there.sum(axis=0), open_ & ~same
        for one, beside_it in zip(self.both.values(), there, strict=True):
            one[:, numbers] = np.where(new, np.where(agree, mean, beside_it), one[:, numbers])
        self.why[:, numbers] = np.where(open_ & (agree | same), "", self.why[:, numbers])
        return bool(is_run.any())

    def _is_same(self, own: Array, there: Array, numbers: NDArray[np.intp]) -> Mask:
        """Whether derivatives beside the point are those at it: from both sides, or from the only one."""
        if not len(there):
            return np.zeros(own.shape[1:], dtype=bool)
        found: Mask = np.logical_and.reduce([self._is_one(one, other, numbers) for one in own for other in there])
        return found

    def _goes_on(self, own: Array, there: Array, nearer: Array, numbers: NDArray[np.intp]) -> Mask:
        """Whether derivatives at the point are those of one curve through both sides, which may be far from a line.

        What is alike on both sides is that at the point and a square of the distance; what is not goes with it.
        """
        far, near = there.mean(axis=0), nearer.mean(axis=0)
        middle = (near - NEARER**2 * far) / (1.0 - NEARER**2)
        jump = (np.diff(nearer, axis=0)[0] - NEARER * np.diff(there, axis=0)[0]) / (1.0 - NEARER)
        is_middle = np.logical_and.reduce([self._is_one(middle, one, numbers) for one in own])
        found: Mask = is_middle & (np.abs(jump) <= CURVED * np.abs(middle))
        return found

    def _beside(
        self, numbers: NDArray[np.intp], beside: Callable[[Array], Sequence[Line] | None], steps: Array
    ) -> tuple[Array, Mask]:
        """Derivatives by numbers on both sides of the point, NaN where a value jumps, and where there is a run."""
        shape = len(self.lines), len(self.x)
        made, is_run = np.full((len(SIDES), shape[0], len(numbers)), np.nan), np.zeros(len(SIDES), dtype=bool)
        step = np.where(np.isin(np.arange(len(self.x)), numbers), steps, 0.0)
        for place, (side, sign) in enumerate(SIDES.items()):
            found = beside(self.x + sign * step)
            if found is not None:
                whole, is_run[place] = _taken(found, side, shape)[:, numbers], True
                made[place] = np.where(self._jumps(found, step[numbers], whole)[:, None], np.nan, whole)
        return made, is_run

    def _jumps(self, found: Sequence[Line], step: Array, *derivatives: Array) -> Mask:
        """Values that are others beside the point than derivatives say."""
        here, there = (np.array([line.value for line in lines]) for lines in (self.lines, found))
        further = FURTHER * np.max([np.abs(own) @ step for own in derivatives], axis=0)
        allowed = JUMP * np.maximum(self._line_sizes, np.abs(there)) + np.nan_to_num(further) + NOISE
        jumps: Mask = ~(np.abs(there - here) <= allowed)
        return jumps

    @cached_property
    def _line_sizes(self) -> Array:
        return np.array([max(abs(line.value), line.size) for line in self.lines])

    def _is_one(self, one: Array, other: Array, numbers: NDArray[np.intp] | slice = slice(None)) -> Mask:
        """Derivatives by numbers, equal to the tolerance of the runs."""
        allowed, larger = ALIKE + BY_TOLERANCE * self.task.options.rtol, np.fmax(np.abs(one), np.abs(other))
        values = self._line_sizes[:, None] * self._shares(larger, numbers)
        found: Mask = np.abs(one - other) <= allowed * np.maximum(larger, values)
        return found

    def _shares(self, derivatives: Array, numbers: NDArray[np.intp] | slice) -> Array:
        """What numbers change by, of their size, for one of their unit.

        One of no known size has that by which it changes any value that is not zero by all of itself.
        """
        known = self._line_sizes > LEAST
        effects = np.nan_to_num(derivatives[known] / self._line_sizes[known, None]).max(axis=0, initial=0.0)
        found: Array = np.where(self.unsized[numbers], np.clip(effects, 1.0 / LARGEST, 1.0), 1.0) / self.sizes[numbers]
        return found

    # ------------------------------------------------------------------------------------------------------- the result

    def matrix(self) -> Array:
        """Derivatives: those of both sides where they agree, else those of the side that is asked for, or NaN."""
        left, right = self.both["left"], self.both["right"]
        agree = self._is_one(left, right) & (self.why == "")
        chosen = np.full(left.shape, np.nan) if self.task.side is None else self.both[self.task.side]
        return np.where(agree, np.where(left == right, left, 0.5 * (left + right)), chosen)

    def problems(self, matrix: Array) -> Iterator[str]:
        """Why derivatives are missing, each reason once."""
        missing, reasons = np.isnan(matrix), dict[str, list[tuple[int, int]]]()
        for place in zip(*(axis.tolist() for axis in np.nonzero(missing)), strict=True):
            line = self.lines[place[0]]
            reasons.setdefault(line.none or self.why[place] or line.several, []).append(place)
        for why, places in reasons.items():
            sides = "".join(self._sides(*place) for place in places[:SHOWN])
            yield f"{why}{sides}{'' if missing.all() else self._where(places)}"

    def _sides(self, line: int, number: int) -> str:
        """What one-sided derivatives there are instead."""
        known = {side: float(own[line, number]) for side, own in self.both.items()}
        there = [f'side="{side}" gives {value:.6g}' for side, value in known.items() if np.isfinite(value)]
        what = f"d {self.lines[line].name} / d {self.task.parameters[number].name}"
        return f"; of {what} {', '.join(there)}" if there else ""

    def _where(self, places: Sequence[tuple[int, int]]) -> str:
        line, number = places[0]
        more = f" and {len(places) - 1} more" if len(places) > 1 else ""
        return f" (no d {self.lines[line].name} / d {self.task.parameters[number].name}{more})"


def _taken(lines: Sequence[Line], side: str, shape: tuple[int, ...]) -> Array:
    return np.array([getattr(line, side) for line in lines], dtype=float).reshape(shape)


def _alone(beside: Beside, number: int, count: int, x: Array) -> list[Line] | None:
    """Lines of a run beside the point by one number, those by the others not known."""
    found, kept = beside(x, number), np.arange(count) == number
    if found is None:
        return None
    nan = float("nan")
    return [one._replace(left=spread(one.left, kept, nan), right=spread(one.right, kept, nan)) for one in found]
