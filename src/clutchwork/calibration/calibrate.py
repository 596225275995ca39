"""The call: what it means, and the search."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Unpack

from clutchwork.base import near, quote
from clutchwork.base.mistakes import Mistakes
from clutchwork.base.paths import path_fault, path_of
from clutchwork.base.progress import followed
from clutchwork.calibration.limits import Limit
from clutchwork.calibration.memory import Checkpoint
from clutchwork.calibration.problem import CalibrationProblem, problem, refuse_bounds
from clutchwork.calibration.record import SearchSettings
from clutchwork.calibration.result import Calibration, CalibrationInterrupted, found_by
from clutchwork.calibration.scatter import Scatter
from clutchwork.calibration.search import MultiStartSearch
from clutchwork.calibration.solving import SearchMethod
from clutchwork.calibration.terms import TimeSpan
from clutchwork.calibration.threads import one_thread
from clutchwork.declare.calls import explained
from clutchwork.declare.options import Options
from clutchwork.gradients.differentiable import differentiable
from clutchwork.run.settings import merged
from clutchwork.run.simulation import Assembles, model_of

if TYPE_CHECKING:
    from pathlib import Path

    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields

# what an optimiser makes use of must be in the runs, not in their errors
TIGHT = {"rtol": 1e-8, "atol": 1e-10}
ROBUST = ("mean", "worst")
# searches of a goal that may have several least values; each costs as much as the first
STARTS = 3


@explained("calibrate", free="{'c1.pressure.values[2:]': (0.0, 8e5)}", minimise="'c1.heat'")
def calibrate(
    model: Assembles | System,
    t_end: Number | None = None,
    *,
    free: Mapping[str, Any],
    minimise: Any,
    subject_to: Sequence[Limit] | Limit = (),
    starts: int = STARTS,
    scatter: Mapping[str, Any] | None = None,
    samples: int = 64,
    robust: str = "mean",
    threads: int = 1,
    seed: int = 0,
    tolerance: float = 1e-10,
    iterations: int = 200,
    file: str | Path | None = None,
    progress: bool | Callable[[int, int], None] = False,
    options: Options | None = None,
    **changes: Unpack[OptionFields],
) -> Calibration:
    """Find the numbers of a driveline that minimise an objective within limits, by exact gradients of its runs.

    Parameters: t_end [s], or with a unit, options and their fields by name are those of `simulate`, with rtol 1e-8
    unless it is given; free, bounds (low, high) by name, in SI or with units: names of `cw.differentiable`, a range of
    a table by "c1.pressure.values[2:]", or any name with `cw.together`; minimise, an output as `cw.sweep` takes it,
    `cw.jerk`, `cw.rms_jerk`, `cw.squared_slope`, or a sum {output: weight, ...}; one of several values is made least
    where it is largest. subject_to, limits, each a `cw.limit`; starts, from how many points to search: the
    values of the model first, then others between the bounds, by default three, each as long as one, and their goals
    are `spread`; threads, how many of these go at once.

    scatter, what differs in production, given as free is: limits then hold in all of so many samples, and in all
    corners where no more than four scatter; the goal is the mean of the first nine samples, or with robust="worst" that
    of the worst one, as it must be where the goal has several values. seed, of starts and samples; tolerance and
    iterations, of the solver; file, a path in which the result is kept: the same call continues from there, and with
    more iterations where it was not solved. progress, True for a bar of tqdm, or a function of (points looked at, the
    most there can be).

    Ctrl-C raises `CalibrationInterrupted`, a KeyboardInterrupt, whose `calibration` holds the best so far. All
    mistakes of the call are named at once, by UseError. docs/guide/calibrate.md
    """
    mistakes, given = Mistakes(), dict[str, Any](changes)
    if given.pop("solver", None) is not None:
        mistakes.found.append("solver is given, but SLSQP is the only solver: leave it out")
    system = model_of("calibrate", model, options)
    given |= {} if t_end is None else {"t_end": t_end}
    tight = {name: value for name, value in TIGHT.items() if name not in changes and options is None}
    end, chosen = merged(system.settings, {**given, **tight}, options)
    plain = chosen.changed({"dt": None, "times": None})
    counts = {"starts": starts, "samples": samples, "threads": threads, "iterations": iterations}
    mistakes.found += _faults(counts, seed, tolerance, robust, file)
    if robust == "worst" and scatter is None:
        such = "scatter={'c1.friction.kinetic': (0.09, 0.11)}"
        mistakes.found.append(f"robust is 'worst', and nothing scatters: give {such}, or leave robust out")
    wanted = mistakes.caught(
        lambda: problem(system, TimeSpan(plain.t_start, end), plain, free, minimise, subject_to, scatter), None
    )
    if wanted is not None and wanted.scatter and robust == "mean":
        mistakes.found += _no_mean(wanted)
    mistakes.refuse("calibrate")
    assert wanted is not None  # noqa: S101, what is wrong with it was refused
    refuse_bounds(wanted)
    asked = SearchSettings(plain, starts, samples, robust, threads, seed, tolerance, iterations)
    return searched(wanted, asked, None if file is None else path_of("calibrate", file, "shift.json"), progress)


def searched(
    wanted: CalibrationProblem, asked: SearchSettings, file: Path | None = None, progress: Any = False
) -> Calibration:
    """What a search finds."""
    outputs = {str(number): one for number, one in enumerate(wanted.outputs)}
    function: Any = None
    if outputs:
        function = differentiable(
            wanted.system, wanted.span.end, of=outputs, by=list(wanted.numbers), threads=asked.threads,
            options=asked.options,
        )  # fmt: skip
    spread = None
    if wanted.scatter:
        spread = Scatter.of(wanted, asked.samples, asked.seed, asked.robust == "worst")
    way = SearchMethod(asked.tolerance, asked.iterations, asked.starts, asked.threads, asked.seed, spread)
    memory = Checkpoint(file, wanted, asked.identity)
    most = asked.starts * asked.iterations
    with followed(progress, most, "calibrate", "(points, most)", unit=" points") as told, one_thread():
        search = MultiStartSearch(wanted, function, way, memory, told)
        try:
            search.run()
        except KeyboardInterrupt:
            memory.keep(search.found.values(), now=True)
            message = f"interrupted after {search.asked} points; the best so far is in .calibration"
            raise CalibrationInterrupted(message, found_by(search, asked, searched)) from None
        return found_by(search, asked, searched)


def _no_mean(wanted: CalibrationProblem) -> list[str]:
    """The largest of many values has no mean over production."""
    if not wanted.goal.is_several(wanted.span, wanted.curves):
        return []
    return [f"robust is 'mean', and {wanted.goal.name} has several values, of which the largest counts: "
            "give robust='worst', or a goal of one value such as cw.rms_jerk"]  # fmt: skip


def _faults(counts: Mapping[str, Any], seed: Any, tolerance: Any, robust: Any, file: Any) -> list[str]:
    """What is wrong with settings."""
    found = [
        f"{name} is {quote(value)}: give a whole number of at least 1"
        for name, value in counts.items()
        if not isinstance(value, int) or isinstance(value, bool) or value < 1
    ]
    if not isinstance(seed, int) or isinstance(seed, bool) or seed < 0:
        found.append(f"seed is {quote(seed)}: give a whole number of at least 0")
    if not isinstance(tolerance, float) or not 0.0 < tolerance < 1.0:
        found.append(f"tolerance is {quote(tolerance)}: give a number between 0 and 1, such as 1e-10")
    if robust not in ROBUST:
        choices = " or ".join(map(repr, ROBUST))
        found.append(f"robust is {quote(robust)}{near(robust, ROBUST, f'give {choices}')}")
    if file is not None and (
        fault := path_fault(os.fspath(file) if isinstance(file, os.PathLike) else file, "shift.json")
    ):
        found.append(f"file: {fault}")
    return found
