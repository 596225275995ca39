"""Several starts one after another or on threads, the best so far kept whatever happens."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from threading import Event
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.calibration.corners import left, left_behind
from clutchwork.calibration.evaluate import Evaluation, Evaluator
from clutchwork.calibration.linear import LinearLimits
from clutchwork.calibration.optimal import certificate
from clutchwork.calibration.outcome import FEASIBLE, OPTIMAL, Outcome
from clutchwork.calibration.rows import measure
from clutchwork.calibration.scaled import Samples, Scaled
from clutchwork.calibration.scatter import breaking, in_all, sobol, violations
from clutchwork.calibration.solving import PILOTS, SearchMethod, Solving, best_of

if TYPE_CHECKING:
    from clutchwork.calibration.memory import Checkpoint
    from clutchwork.calibration.problem import CalibrationProblem

Progress = Callable[[int], None] | None


class SearchStopped(Exception):  # noqa: N818, it is caught where it is raised
    """Another thread was interrupted."""


class MultiStartSearch:
    """All starts of a problem."""

    def __init__(
        self, problem: CalibrationProblem, function: object, way: SearchMethod, memory: Checkpoint, told: Progress
    ) -> None:
        self.problem, self.function, self.way, self.memory, self.told = problem, function, way, memory, told
        self.solving = Solving(way)
        self.found = dict[int, Outcome]()
        self.stop, self.asked = Event(), 0

    def run(self) -> None:
        """Search from every start; KeyboardInterrupt leaves what was found until then."""
        pending = [pair for pair in enumerate(self._starts()) if not self._known(pair[0])]
        if self.way.threads == 1 or len(pending) == 1:
            for number, start in pending:
                self._from(number, start)
            self._out_of_corner(pending)
            return
        with ThreadPoolExecutor(self.way.threads) as pool:
            work = [pool.submit(self._from, number, start) for number, start in pending]
            try:
                for one in work:
                    one.result()
            except BaseException:
                self.stop.set()
                raise
        self._out_of_corner(pending)

    def _out_of_corner(self, pending: Sequence[object]) -> None:
        """On from the best of all, where that is a corner that may be left."""
        best = min((one for one in self.found.values() if not one.fault), key=lambda one: one.rank, default=None)
        if not pending or best is None or best.residual <= OPTIMAL or not best.holds:
            return
        evaluator = Evaluator(self.problem, self.function)
        evaluator.runs = best.runs
        keeper = Keeper(self, evaluator, best.number, best.start)
        evaluator.seen = keeper.see
        scaled = Scaled(evaluator, best.x, self.way.samples(best.samples), best.scales)
        if scaled.first.is_fine:
            keeper.watch(scaled)
            keeper.end(scaled.to_x(left_behind(scaled, scaled.start)))

    def _known(self, number: int) -> bool:
        """Whether a file has the end of this start; one that is not solved goes on where there are more iterations."""
        before = self.memory.outcome(number)
        if before is None:
            return False
        ended = before.ended and (before.is_solved or self.way.iterations <= before.iterations)
        self.found[number] = replace(before, ended=ended)
        return ended

    def _starts(self) -> Iterator[Array]:
        """The values of the model, then the best of points that are spread over the bounds."""
        problem, way = self.problem, self.way
        yield problem.start
        if way.starts == 1:
            return
        more, evaluator = way.starts - 1, Evaluator(problem, self.function)
        shares = sobol(len(problem.unknowns), PILOTS * more, way.seed)
        flat = LinearLimits(problem)
        points = [flat.nearest(problem.low + share * flat.width) for share in shares]
        yield from best_of(evaluator, points, more)

    def _from(self, number: int, start: Array) -> None:
        evaluator = Evaluator(self.problem, self.function)
        before = self.found.get(number)
        keeper = Keeper(self, evaluator, number, start)
        evaluator.seen = keeper.see
        x, scales = (start, None) if before is None else (before.x, before.scales or None)
        if not evaluator.at(x, self._samples().chosen).is_fine:
            keeper.end(x, evaluator.at(x, self._samples().chosen).fault)
            return
        if self.way.scatter is None:
            scaled = Scaled(evaluator, x, Samples(), scales)
            keeper.watch(scaled)
            keeper.end(scaled.to_x(self.solving.solved(scaled)))
            return
        keeper.end(in_all(evaluator, self.way.scatter, x, keeper.watched(self.solving.solved), scales))

    def _samples(self) -> Samples:
        return Samples() if self.way.scatter is None else self.way.scatter.first()

    def tell(self) -> None:
        """One more point was looked at."""
        if self.stop.is_set():
            raise SearchStopped
        self.asked += 1
        if self.told is not None:
            self.told(min(self.asked, self.way.starts * self.way.iterations))


class Keeper:
    """Keeps the best point of one start."""

    def __init__(self, search: MultiStartSearch, evaluator: Evaluator, number: int, start: Array) -> None:
        self.search, self.evaluator, self.number, self.start = search, evaluator, number, start
        self.scaled: Scaled | None = None

    def watch(self, scaled: Scaled) -> None:
        """Points are judged by these limits from now on."""
        self.scaled = scaled
        self.see(scaled.first)

    def watched(self, solve: Callable[[Scaled], Array]) -> Callable[[Scaled], Array]:
        """A solver whose points are kept."""

        def solved(scaled: Scaled) -> Array:
            # more samples make limits harder: what was best before is no more
            self.search.found.pop(self.number, None)
            self.watch(scaled)
            return solve(scaled)

        return solved

    def see(self, point: Evaluation) -> None:
        """A point that the solver asked for."""
        self.search.tell()
        if self.scaled is None or not point.is_fine or len(point.values) != max(len(self.scaled.samples), 1):
            return
        made = self._outcome(point, self.scaled, False)
        before = self.search.found.get(self.number)
        if before is None or made.rank < before.rank:
            self.search.found[self.number] = made
            self.search.memory.keep(self.search.found.values())

    def end(self, x: Array, fault: str = "") -> None:
        """Where the search ended; the best point on the way where that is none."""
        if self.scaled is None or fault:
            runs = self.evaluator.runs
            none = Outcome(self.number, self.start, x, np.inf, np.inf, True, runs, fault=fault, whole=False)
            self.search.found[self.number] = none
            return
        point = self.evaluator.at(x, self.scaled.samples)
        made = self._outcome(point, self.scaled, True) if point.is_fine else None
        before = self.search.found.get(self.number)
        if made is None or (before is not None and _clearly_better(before, made)):
            made = before
        if made is not None:
            made = replace(self._everywhere(made, self.scaled), residual=_left(self.scaled, made.x))
            made = replace(made, ended=True, iterations=self.search.way.iterations)
            self.search.found[self.number] = replace(made, runs=self.evaluator.runs)
        self.search.memory.keep(self.search.found.values(), now=True)

    def _everywhere(self, made: Outcome, scaled: Scaled) -> Outcome:
        """The same, judged by all samples of production; those that break limits most are among its own."""
        if self.search.way.scatter is None:
            return made
        pool = self.search.way.scatter.pool
        values = self.evaluator.values(made.x, pool)
        violation = float(np.max(violations(self.evaluator, scaled, values)))
        worst = breaking(self.evaluator, scaled, made.x, pool)
        fine = [one for one in worst if self.evaluator.tried(made.x, [one]).is_fine]
        goal = max(scaled.judged(values), made.goal) if scaled.worst else made.goal
        return replace(made, violation=violation, goal=goal, samples=(*made.samples, *fine), whole=True)

    def _outcome(self, point: Evaluation, scaled: Scaled, ended: bool) -> Outcome:
        over = violations(self.evaluator, scaled, point.values)
        found = (point.x, scaled.judged(point.values), float(np.max(over)))
        made = Outcome(self.number, self.start, *found, ended, self.evaluator.runs, scaled.scales)
        return replace(made, samples=tuple(scaled.samples), whole=self.search.way.scatter is None)


def _left(scaled: Scaled, x: Array) -> float:
    """What is left of the gradient, in shares of the goal."""
    point = scaled.evaluator.at(x, scaled.samples)
    if not point.is_fine:
        return np.inf
    y = scaled.lifted(np.resize((x - scaled.problem.low) / scaled.width, scaled.count), point)
    proof = certificate(scaled, y)
    smooth = proof.residual / measure(scaled.goal(y))
    return smooth if smooth <= OPTIMAL or proof.violation > FEASIBLE else min(smooth, left(scaled, y))


def _clearly_better(one: Outcome, other: Outcome) -> bool:
    """Whether a point on the way is better than the last one, which has the smaller gradient."""
    if not one.holds or not other.holds:
        return one.rank < other.rank
    return one.goal < other.goal - 1e-6 * abs(other.goal)
