"""What a calibration found, as its user holds it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import UseError, near, quote
from clutchwork.base.arrays import Array
from clutchwork.calibration import words
from clutchwork.calibration.corners import left
from clutchwork.calibration.evaluate import Evaluator
from clutchwork.calibration.front import Front, front
from clutchwork.calibration.held import Held
from clutchwork.calibration.optimal import Certificate, certificate
from clutchwork.calibration.outcome import FEASIBLE, OPTIMAL
from clutchwork.calibration.record import CalibrationError, CalibrationRecord, SearchSettings
from clutchwork.calibration.scaled import Scaled
from clutchwork.calibration.terms import Jerk, OutputTerm, RmsJerk, SquaredSlope, TableSlope
from clutchwork.calibration.verify import Verified, verify
from clutchwork.declare.calls import explained_methods
from clutchwork.plot.compare import compare

if TYPE_CHECKING:
    from clutchwork.calibration.limits import Settled
    from clutchwork.calibration.search import MultiStartSearch
    from clutchwork.plot.canvas import Picture


MOST_PANELS = 5


class CalibrationInterrupted(KeyboardInterrupt):
    """Ctrl-C during a calibration; `calibration` holds the best so far, None where nothing was found yet."""

    def __init__(self, message: str, calibration: Calibration | None) -> None:
        super().__init__(message)
        self.calibration = calibration

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.calibration)


@explained_methods("calibration")
class Calibration(CalibrationRecord):
    """What `cw.calibrate` found.

    `values` are the numbers by name, `system` the model with them. `solved` says whether all limits hold and no small
    change lowers the objective; `message` gives any reason not to use the values. `print(found)` shows it all.
    """

    @property
    def message(self) -> str:
        """Reasons not to use the values, one line each; empty when there are none."""
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
        """Draw signals before and after; without names those of objective and limits. Needs matplotlib.

        Parameters: signals, as `cw.compare` takes them; path, of a picture that is written.
        """
        return before_and_after(self, signals, path)

    def front(self, limit: str, bounds: Sequence[Any], *, progress: Any = False) -> Front:
        """The optimum of the objective for each bound of a limit, such as jerk over heat.

        Parameters: limit, its name; bounds, of its upper side, or of the lower one where it has no upper one.
        """
        return front(self, self.limit(limit), bounds, progress)

    def verify(self, samples: int = 1000, *, seed: int = 1, threads: int | None = None) -> Verified:
        """Run production samples that the search has not seen, and report those that violate a limit.

        Parameters: samples, how many; seed, of the draws; threads, how many runs go at once.
        """
        return verify(self, samples, seed, threads)

    def limit(self, name: str) -> Settled:
        """A limit by name; UseError where there is none, or more than one."""
        known = [one.name for one in self.problem.limits]
        if name not in known:
            raise UseError("calibration", [f"no limit {quote(name)}{near(name, known, f'there are {known}')}"])
        if known.count(name) > 1:
            raise UseError("calibration", [f"{known.count(name)} limits are called {quote(name)}: give each a name="])
        return self.problem.limits[known.index(name)]


def found_by(search: MultiStartSearch, asked: SearchSettings, again: Callable[..., Any]) -> Calibration:
    """The result of a search, and what searches again; CalibrationError where it found nothing."""
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
    return Calibration(
        problem, asked, again, best.x, goals, held, proof, outcomes, best.samples, finished, after.note, around
    )  # fmt: skip


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


def before_and_after(found: CalibrationRecord, signals: Sequence[Any], path: str | Path | None) -> Picture:
    """Both runs over each other."""
    runs = {"before": found.run_before(), "after": found.run()}
    chosen = list(signals) or usual(found, set(runs["after"].names))
    return compare(runs, *chosen, path=path)


def usual(found: CalibrationRecord, known: set[str]) -> list[str]:
    """Signals that the free numbers, the goal and the limits are about."""
    return list(dict.fromkeys(name for name in _signals(found) if name in known))[:MOST_PANELS]


def _signals(found: CalibrationRecord) -> Iterator[str]:
    problem = found.problem
    for one in problem.unknowns:
        for name in one.numbers:
            yield name.partition(".values[")[0].partition(".times[")[0]
    for what in (problem.goal, *(limit.what for limit in problem.limits)):
        for term, _ in what.terms:
            yield from _of(term)


def _of(term: Any) -> Iterator[str]:
    if isinstance(term, Jerk | RmsJerk):
        yield f"{term.shaft}.acceleration"
    elif isinstance(term, TableSlope | SquaredSlope):
        yield term.stem
    elif isinstance(term, OutputTerm):
        contact = getattr(term.output, "contact", "")
        owner = contact or str(getattr(term.output, "signal", "")).rpartition(".")[0]
        yield from (f"{contact}.slip", f"{contact}.torque") if contact else (str(getattr(term.output, "signal", "")),)
        yield f"{owner}.torque"
