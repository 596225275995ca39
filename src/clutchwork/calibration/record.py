"""The data of a calibration: what was asked for, what was found, and what follows from that."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field
from functools import cached_property
from typing import Any

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.base import ClutchworkError, dataclass
from clutchwork.base.arrays import Array
from clutchwork.calibration.held import Held
from clutchwork.calibration.moves import Moves
from clutchwork.calibration.optimal import Certificate
from clutchwork.calibration.outcome import OPTIMAL, Outcome
from clutchwork.calibration.problem import CalibrationProblem, changed_by
from clutchwork.declare.calls import explained_methods
from clutchwork.declare.options import Options
from clutchwork.run.simulation import simulate
from clutchwork.run.trajectory import Trajectory


class CalibrationError(ClutchworkError, RuntimeError):
    """A calibration that found nothing: why, and what to do."""


@dataclass(frozen=True)
class SearchSettings:
    """How it was searched for."""

    options: Options
    starts: int
    samples: int
    robust: str
    threads: int
    seed: int
    tolerance: float
    iterations: int

    @property
    def identity(self) -> tuple[Any, ...]:
        """What the result depends on."""
        return (self.options, self.starts, self.samples, self.robust, self.seed, self.tolerance)


@explained_methods("calibration")
@dataclass(frozen=True, eq=False, repr=False)
class CalibrationRecord:
    """What words and pictures read of a calibration; a `Calibration` is what users hold."""

    problem: CalibrationProblem = field(repr=False)
    asked: SearchSettings = field(repr=False)
    search: Callable[[CalibrationProblem, SearchSettings], Any] = field(repr=False)  # the same of another problem
    x: Array
    goal: tuple[float, float]  # with the values of the model, and with those that were found
    limits: tuple[Held, ...]
    certificate: Certificate
    outcomes: tuple[Outcome, ...]
    samples: tuple[Array, ...]  # of production that decided it
    finished: bool  # not interrupted
    corner: str = ""  # why the gradient there is one of differences, empty where it is not
    around: float = np.inf  # what is left of the gradients around it together, infinite where a neighbour is better

    # ---------------------------------------------------------------------------------------------------------- values

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the unknowns."""
        return tuple(one.name for one in self.problem.unknowns)

    @property
    def values(self) -> dict[str, float]:
        """The unknowns by name, in SI; factors and shifts of `cw.together` by the name that they were given."""
        return dict(zip(self.names, self.x.tolist(), strict=True))

    @property
    def start(self) -> dict[str, float]:
        """The same as the model has them."""
        return dict(zip(self.names, self.problem.start.tolist(), strict=True))

    @cached_property
    def changes(self) -> dict[str, Any]:
        """What `System.changed` takes."""
        return self._changes(self.x)

    @cached_property
    def system(self) -> System:
        """The model with these values."""
        return self.problem.system.changed(self.changes)

    def _changes(self, x: Array) -> dict[str, Any]:
        """Of values of the unknowns."""
        numbers = Moves(self.problem.unknowns, self.problem.numbers).apply(self.problem.base, x)
        moved = {name for one in self.problem.unknowns for name in one.numbers}
        return changed_by(self.problem, numbers, [name for name in self.problem.numbers if name in moved])

    # ------------------------------------------------------------------------------------------------------------ runs

    def run(self) -> Trajectory:
        """A run with the values that were found."""
        return simulate(self.system, self.problem.span.end, options=self.asked.options)

    def run_before(self) -> Trajectory:
        """A run with the values of the model."""
        return simulate(self.problem.system, self.problem.span.end, options=self.asked.options)

    # --------------------------------------------------------------------------------------------------------- verdict

    @property
    def feasible(self) -> bool:
        """Whether all limits hold, to a millionth of their scale, in all samples of production."""
        return self._best.is_feasible

    @property
    def whole(self) -> bool:
        """Whether all samples of production were run with these values; an interrupted search looked at a few."""
        return self._best.whole

    @property
    def _best(self) -> Outcome:
        return min(self.outcomes, key=lambda one: one.rank)

    @property
    def solved(self) -> bool:
        """Whether the search ended, all limits hold, and no small change makes the goal less."""
        return self.finished and self.feasible and min(self.certificate.residual, self.around) <= OPTIMAL

    @property
    def spread(self) -> tuple[float, ...]:
        """Goals that the starts reached where all limits hold, the least first."""
        return tuple(sorted(one.goal for one in self.outcomes if one.is_feasible))
