"""A calibration in samples of production that the search has not seen, run by a sweep."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError, columns, dataclass, quote
from clutchwork.base.arrays import Array
from clutchwork.calibration.evaluate import Evaluator
from clutchwork.calibration.scatter import drawn
from clutchwork.gradients.differentiable import differentiable

if TYPE_CHECKING:
    from clutchwork.calibration.limits import Settled
    from clutchwork.calibration.record import CalibrationRecord

# a limit counts as held where it is passed by less, in shares of its bound
ALLOWED = 1e-6


@dataclass(frozen=True, eq=False)
class Verified:
    """Goal and limits in samples of production."""

    scatter: tuple[str, ...]  # what scatters
    samples: Array  # shape (samples, scatter)
    goals: Array
    limits: tuple[Settled, ...]
    worst: tuple[Array, ...]  # of each limit, in each sample, the value that is furthest out
    broken: NDArray[np.bool_]  # shape (samples, limits)

    @property
    def holds(self) -> bool:
        """Whether all limits hold in all samples."""
        return not bool(np.any(self.broken))

    @property
    def yields(self) -> float:
        """Share of the samples in which all limits hold."""
        return float(np.mean(~np.any(self.broken, axis=1)))

    def __str__(self) -> str:
        count = len(self.samples)
        good = int(count - np.count_nonzero(np.any(self.broken, axis=1)))
        lines = [["limit", "from", "to", "least", "largest", "broken in"]]
        for number, (limit, values) in enumerate(zip(self.limits, self.worst, strict=True)):
            ends = [f"{one:.6g}" if np.isfinite(one) else "" for one in (limit.lower, limit.upper)]
            seen = [f"{one:.6g}" for one in (np.min(values), np.max(values))]
            lines.append([limit.name, *ends, *seen, str(int(np.count_nonzero(self.broken[:, number])))])
        goal = f"goal {np.min(self.goals):.6g} ... {np.max(self.goals):.6g}"
        return f"all limits hold in {good} of {count} samples, {goal}\n\n{columns(lines, right=(1, 2, 3, 4, 5))}"


def verify(found: CalibrationRecord, count: int, seed: int, threads: int | None) -> Verified:
    """Samples that are drawn anew."""
    problem = found.problem
    if not problem.scatter:
        raise UseError(
            "verify", ["nothing scatters in this calibration; give scatter={name: (low, high)} to calibrate"]
        )
    if not isinstance(count, int) or isinstance(count, bool) or count < 1:
        raise UseError("verify", [f"samples is {quote(count)}: give a whole number of at least 1"])
    samples = drawn(problem.scatter, count, seed)
    outputs = {str(number): one for number, one in enumerate(problem.outputs)}
    function = differentiable(
        problem.system, problem.span.end, of=outputs, by=list(problem.numbers), threads=threads,
        options=found.asked.options,
    )  # fmt: skip
    evaluator = Evaluator(problem, function)
    values = evaluator.values(found.x, samples)
    worst, broken = list[Array](), np.zeros((count, len(problem.limits)), dtype=bool)
    for number, (limit, part) in enumerate(zip(problem.limits, evaluator.parts[1:], strict=True)):
        own = values[:, part]
        room = ALLOWED * max(abs(one) for one in (limit.lower, limit.upper) if np.isfinite(one))
        # what is missing is not held
        broken[:, number] = ~np.all((own <= limit.upper + room) & (own >= limit.lower - room), axis=1)
        out = np.maximum(own - limit.upper, limit.lower - own)
        worst.append(own[np.arange(count), np.argmax(out, axis=1)])
    goals = np.max(values[:, evaluator.parts[0]], axis=1)
    named = tuple(one.name for one in problem.scatter)
    return Verified(named, np.array(samples), goals, problem.limits, tuple(worst), broken)
