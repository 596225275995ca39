"""What a calibration found: values, limits, what each of them costs, and how it was found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.above import above
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ClutchworkError, UseError, near
from clutchwork.base.quote import quote
from clutchwork.calibration import words
from clutchwork.calibration.corners import left
from clutchwork.calibration.evaluate import Evaluator
from clutchwork.calibration.held import Held
from clutchwork.calibration.moves import Moves
from clutchwork.calibration.optimal import Certificate, certificate
from clutchwork.calibration.outcome import FEASIBLE, OPTIMAL, Outcome
from clutchwork.calibration.problem import changed_by
from clutchwork.calibration.scaled import Scaled
from clutchwork.declare.calls import explained_methods
from clutchwork.run.simulation import simulate

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.calibration.limits import Settled
    from clutchwork.calibration.problem import CalibrationProblem
    from clutchwork.calibration.search import MultiStartSearch
    from clutchwork.declare.options import Options
    from clutchwork.results.plot.canvas import Picture
    from clutchwork.results.trajectory import Trajectory

Array = NDArray[np.float64]


class CalibrationError(ClutchworkError, RuntimeError):
    """A calibration that found nothing: why, and what to do."""


class CalibrationInterrupted(KeyboardInterrupt):
    """Ctrl-C during a calibration; `calibration` holds the best so far, None where nothing was found yet."""

    def __init__(self, message: str, calibration: Calibration | None) -> None:
        super().__init__(message)
        self.calibration = calibration

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.calibration)


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
class Calibration:
    """What `cw.calibrate` found.

    `values` are the numbers by name, `system` the model with them. `solved` says whether all limits hold and no
    small change makes the goal less; `message` says what stands in the way. `print(found)` shows it all.
    """

    problem: CalibrationProblem = field(repr=False)
    asked: SearchSettings = field(repr=False)
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

    @property
    def message(self) -> str:
        """What stands in the way of using the values, one line each; empty when nothing does."""
        return "\n".join(words.faults(self))

    @property
    def costs(self) -> tuple[str, ...]:
        """What each active limit costs, in words."""
        return tuple(words.costs(self))

    def raise_for_status(self) -> Calibration:
        """Return itself when it is solved, else raise CalibrationError."""
        if not self.solved:
            raise CalibrationError(self.message)
        return self

    def __getitem__(self, name: str) -> float:
        """A value by name; KeyError with a near name where there is none."""
        if name not in self.values:
            raise KeyError(f"no unknown {quote(name)}{near(name, self.names)}")
        return self.values[name]

    def __str__(self) -> str:
        """What `print` shows."""
        return words.text(self)

    def __repr__(self) -> str:
        state = "solved" if self.solved else "not solved"
        return f"<Calibration {state}: {self.problem.goal.name} {self.goal[0]:.6g} -> {self.goal[1]:.6g}>"

    # -------------------------------------------------------------------------------------------------- what to do next

    def plot(self, *signals: Any, path: str | Path | None = None) -> Picture:
        """Draw signals before and after; without names those that goal and limits are about. Needs matplotlib.

        Parameters: signals, as `cw.compare` takes them; path, of a picture that is written.
        """
        made: Picture = above("calibration.plot", self, signals, path)
        return made

    def front(self, limit: str, bounds: Sequence[Any], *, progress: Any = False) -> Any:
        """The least goal for each bound of a limit, as of jerk over heat.

        Parameters: limit, its name; bounds, of its upper side, or of the lower one where it has no upper one.
        """
        return above("calibration.front", self, self.limit(limit), bounds, progress)

    def verify(self, samples: int = 1000, *, seed: int = 1, threads: int | None = None) -> Any:
        """Run production samples that the search has not seen, and say which break a limit.

        Parameters: samples, how many; seed, of the draws; threads, how many runs go at once.
        """
        return above("calibration.verify", self, samples, seed, threads)

    def limit(self, name: str) -> Settled:
        """A limit by name; UseError where there is none, or more than one."""
        known = [one.name for one in self.problem.limits]
        if name not in known:
            raise UseError("calibration", [f"no limit {quote(name)}{near(name, known, f'there are {known}')}"])
        if known.count(name) > 1:
            raise UseError("calibration", [f"{known.count(name)} limits are called {quote(name)}: give each a name="])
        return self.problem.limits[known.index(name)]


def found_by(search: MultiStartSearch, asked: SearchSettings) -> Calibration:
    """The result of a search; CalibrationError where it found nothing."""
    outcomes = tuple(search.found[number] for number in sorted(search.found))
    best = min((one for one in outcomes if not one.fault), key=lambda one: one.rank, default=None)
    problem = search.problem
    if best is None:
        scatter = "narrow the scatter, " if problem.scatter else ""
        why = next((one.fault for one in outcomes if one.fault), "it was interrupted before the first run")
        remedy = f"change the start values of the model, widen t_end, {scatter}or give starts=8"
        raise CalibrationError(f"no start could be run with a gradient: {why}; {remedy}")
    evaluator = Evaluator(problem, search.function)
    before = evaluator.values(problem.start, best.samples or [evaluator.nominal])
    size = float(np.max(np.nan_to_num(np.abs(before[:, evaluator.parts[0]]))))
    scaled = Scaled(evaluator, best.x, search.way.samples(best.samples), best.scales, size)
    proof, after = certificate(scaled, scaled.start), scaled.first
    around = left(scaled, scaled.start) if proof.residual > OPTIMAL and best.is_feasible else proof.residual
    held = tuple(
        _held(limit, before[:, part], after.values[:, part], proof, number, FEASIBLE * best.scales[number])
        for number, (limit, part) in enumerate(zip(problem.limits, evaluator.parts[1:], strict=True))
    )
    goals = scaled.judged(before), best.goal
    finished = len(outcomes) == search.way.starts and all(one.ended for one in outcomes)
    return Calibration(problem, asked, best.x, goals, held, proof, outcomes, best.samples, finished, after.note, around)


def _held(limit: Settled, before: Array, after: Array, proof: Certificate, number: int, room: float) -> Held:
    """A limit with what the search found; what is beyond its bounds by more than `room` is broken."""
    mine = [one for one in proof.active if one.row.limit == number]
    ends = [(float(np.min(one)), float(np.max(one))) for one in (before, after)]
    # docs/theory/calibration.md (4), an equation is both bounds at once
    by_lower, by_upper = (
        sum(one.multiplier for one in mine if limit.is_equal or one.row.sign == side) for side in (-1.0, 1.0)
    )
    bounds = (limit.lower, limit.upper, ends[0], ends[1])
    return Held(limit.name, limit.unit, *bounds, bool(mine), not limit.violation(after) <= room, by_lower, by_upper)


def with_limit(problem: CalibrationProblem, old: Settled, new: Settled) -> CalibrationProblem:
    """The problem with one limit in place of another."""
    return replace(problem, limits=tuple(new if one is old else one for one in problem.limits))
