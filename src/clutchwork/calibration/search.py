"""Several starts one after another or on threads, the best so far kept whatever happens."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from threading import Event
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.calibration.evaluate import Evaluator, Point
from clutchwork.calibration.linear import Linear
from clutchwork.calibration.outcome import Outcome
from clutchwork.calibration.scaled import Samples, Scaled
from clutchwork.calibration.scatter import in_all, sobol, violations
from clutchwork.calibration.solving import PILOTS, Solving, Way, best_of

if TYPE_CHECKING:
    from clutchwork.calibration.memory import Memory
    from clutchwork.calibration.problem import Problem

Array = NDArray[np.float64]


class Stopped(Exception):  # noqa: N818, it is caught where it is raised
    """Another thread was interrupted."""


class Search:
    """All starts of a problem."""

    def __init__(
        self, problem: Problem, function: object, way: Way, memory: Memory, told: Callable[[int], None] | None
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
            return
        with ThreadPoolExecutor(self.way.threads) as pool:
            work = [pool.submit(self._from, number, start) for number, start in pending]
            try:
                for one in work:
                    one.result()
            except BaseException:
                self.stop.set()
                raise

    def _known(self, number: int) -> bool:
        """Whether a file has the end of this start."""
        before = self.memory.outcome(number)
        if before is not None:
            self.found[number] = before
        return before is not None and before.ended

    def _starts(self) -> Iterator[Array]:
        """The values of the model, then the best of points that are spread over the bounds."""
        problem, way = self.problem, self.way
        yield problem.start
        if way.starts == 1:
            return
        more, evaluator = way.starts - 1, Evaluator(problem, self.function)
        shares = sobol(len(problem.unknowns), PILOTS * more, way.seed)
        flat = Linear(problem)
        points = [flat.nearest(problem.low + share * flat.width) for share in shares]
        yield from best_of(evaluator, points, more)

    def _from(self, number: int, start: Array) -> None:
        evaluator = Evaluator(self.problem, self.function)
        before = self.found.get(number)
        keeper = Keeper(self, evaluator, number, start)
        evaluator.seen = keeper.see
        x = start if before is None else before.x
        if not evaluator.at(x, self._samples().chosen).is_fine:
            keeper.end(x, self._samples(), evaluator.at(x, self._samples().chosen).fault)
            return
        if self.way.scatter is None:
            scaled = Scaled(evaluator, x, Samples(), before.scales if before else None)
            keeper.watch(scaled)
            keeper.end(scaled.to_x(self.solving.solved(scaled)), Samples())
            return
        x, samples = in_all(evaluator, self.way.scatter, x, keeper.watched(self.solving.solved))
        keeper.end(x, samples)

    def _samples(self) -> Samples:
        return Samples() if self.way.scatter is None else self.way.scatter.first()

    def tell(self) -> None:
        """One more point was looked at."""
        if self.stop.is_set():
            raise Stopped
        self.asked += 1
        if self.told is not None:
            self.told(min(self.asked, self.way.starts * self.way.iterations))


class Keeper:
    """Keeps the best point of one start."""

    def __init__(self, search: Search, evaluator: Evaluator, number: int, start: Array) -> None:
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

    def see(self, point: Point) -> None:
        """A point that the solver asked for."""
        self.search.tell()
        if self.scaled is None or not point.is_fine or len(point.values) != max(len(self.scaled.samples), 1):
            return
        made = self._outcome(point, self.scaled, False)
        before = self.search.found.get(self.number)
        if before is None or made.rank < before.rank:
            self.search.found[self.number] = made
            self.search.memory.keep(self.search.found.values())

    def end(self, x: Array, samples: Samples, fault: str = "") -> None:
        """Where the search ended; the best point on the way where that is none."""
        if self.scaled is None or fault:
            none = Outcome(self.number, self.start, x, np.inf, np.inf, True, self.evaluator.runs, fault=fault)
            self.search.found[self.number] = none
            return
        point = self.evaluator.at(x, samples.chosen)
        made = self._outcome(point, self.scaled, True) if point.is_fine else None
        before = self.search.found.get(self.number)
        if made is None or (before is not None and _clearly_better(before, made)):
            made = before
        if made is not None:
            self.search.found[self.number] = replace(made, ended=True, runs=self.evaluator.runs)
        self.search.memory.keep(self.search.found.values(), now=True)

    def _outcome(self, point: Point, scaled: Scaled, ended: bool) -> Outcome:
        over = violations(self.evaluator, scaled, point.values)
        goal = point.values[:, self.evaluator.parts[0]]
        value = float(np.max(goal)) if scaled.worst else float(np.mean(goal[: scaled.averaged]))
        runs, chosen = self.evaluator.runs, tuple(scaled.samples)
        return Outcome(self.number, self.start, point.x, value, float(np.max(over)), ended, runs, scaled.scales, chosen)


def _clearly_better(one: Outcome, other: Outcome) -> bool:
    """Whether a point on the way is better than the last one, which has the smaller gradient."""
    if not one.is_feasible or not other.is_feasible:
        return one.rank < other.rank
    return one.goal < other.goal - 1e-6 * abs(other.goal)
