"""Many runs of one driveline with other numbers, in one call."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.base.errors import ModelWarning, UseError, caller
from clutchwork.base.progress import followed
from clutchwork.base.shown import shown
from clutchwork.declare.calls import explained
from clutchwork.declare.node import Signal
from clutchwork.declare.options import Options
from clutchwork.declare.status import INTERRUPTED
from clutchwork.run.control import controllers
from clutchwork.run.effort import refuse_endless
from clutchwork.run.settings import merged
from clutchwork.run.simulation import Assembles
from clutchwork.sweeps.axes import Plan
from clutchwork.sweeps.batch import Batch, Wanted, Way
from clutchwork.sweeps.outputs import Asked, Computed, Output, asked
from clutchwork.sweeps.result import Missing, OutputWarning, Sweep, SweepInterrupted, Swept
from clutchwork.sweeps.variants import given, in_si

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields
    from clutchwork.results.trajectory import Trajectory

# options that say which rows a single run has
ROWS = ("dt", "times", "output", "points")
Told = Callable[[int, int], None]
Shown = Callable[[int], None]


@explained("sweep")
def sweep(
    model: Assembles | System,
    t_end: Number | None = None,
    *,
    vary: Any,
    outputs: Mapping[str, Asked] | Sequence[Asked] | Asked,
    threads: int | None = None,
    options: Options | None = None,
    progress: bool | Told = False,
    **changes: Unpack[OptionFields],
) -> Sweep:
    """Run a Driveline or a System with many sets of values, and keep what is asked for of each run.

    Parameters: t_end [s], or with a unit, options and their fields by name are those of `simulate`; vary, values by
    name (all combinations), a list with the values of each variant, `cw.variants` or a DataFrame; outputs, what is
    kept; threads, how many run at once, by default as many as there are cores; progress, True for a bar of tqdm, or a
    function of (variants done, variants).

    Names are those of `System.changed`; values may have units, "2 bar", and are kept in SI. An output is the name of a
    signal, for its value at the end, `cw.at`, `cw.maximum`, `cw.minimum`, `cw.peak`, `cw.integral`, `cw.lock` or
    `cw.break_away`, or a function of the Trajectory;
    a mapping gives them names.

    A variant that stops early has its status, and hurts no other; a value of a function that raises is missing, which
    is an `OutputWarning`, and `problems` of the result lists all of them. Ctrl-C ends the sweep with what is done.
    """
    if options is not None and not isinstance(options, Options):
        raise UseError("sweep", [f"options is {shown(options)}: it must be cw.Options(...)"])
    system, wanted = _system(model), asked(outputs)
    variants = given(vary) if system.source is None else in_si(given(vary), system.source)
    chosen = {**changes} if t_end is None else {**changes, "t_end": t_end}
    useless = [name for name in ROWS if name in changes]
    if useless:
        remedy = "say when in the outputs: cw.at('load.speed', [1.0, 2.0])"
        raise UseError("sweep", [f"{' and '.join(useless)} would be without effect: {remedy}"])
    end, settled = merged(system.settings, chosen, options)
    plain = settled.changed({"dt": None, "times": None})
    refuse_endless(system.inputs, plain.t_start, end, plain.max_steps)
    count = threads_of(threads)
    _refuse_clashes(wanted)
    swept = Swept(system, variants, wanted, end, plain)
    with (
        followed(progress, len(variants), "sweep", "(done, variants)", unit=" runs") as told,
        warnings.catch_warnings(),
    ):
        # a value may be rarely wanted; that of a single run is given there
        warnings.simplefilter("ignore", ModelWarning)
        return _swept(swept, count, told or _silent)


def _silent(done: int) -> None:
    """Nobody asked."""


def _refuse_clashes(wanted: Mapping[str, Output]) -> None:
    """Tables have a column of their own for the status."""
    if "status" in wanted:
        raise UseError("sweep", ["an output is called 'status', as the column that says how a run ended; rename it"])


def _system(model: Assembles | System) -> System:
    if isinstance(model, System):
        return model
    if not hasattr(model, "assemble"):
        raise UseError("sweep", [f"{shown(model)} is not a model; give a Driveline or a System"])
    return model.assemble()


def threads_of(threads: object) -> int:
    """How many runs go at once."""
    if threads is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if not isinstance(threads, int) or isinstance(threads, bool) or threads < 1:
        raise UseError("sweep", [f"threads is {shown(threads)}: give a whole number from 1 on"])
    return threads


def _swept(swept: Swept, threads: int, told: Shown) -> Sweep:
    """All variants: in the core, then those outputs that need a Trajectory, one run after another."""
    made, plan = Sweep.empty(swept), Plan.of(swept.system, swept.variants)
    wanted = Wanted.of(swept.system, swept.options, swept.outputs, swept.t_end)
    # what calls Python in a run cannot be on several threads
    alone = _sampled(swept) or not wanted.outputs
    computed = {name: one for name, one in swept.outputs.items() if alone or isinstance(one, Computed)}
    if not alone:
        raised = _in_core(made, Batch(plan, wanted, Way(swept.t_end, swept.options, threads)), told, not computed)
        if raised is not None:
            return _ended(made, raised)
    if computed:
        _one_by_one(made, plan, computed, told)
    return made


def _in_core(made: Sweep, batch: Batch, told: Shown, alone: bool) -> BaseException | None:
    """Block by block; what a signal handler or the progress raised."""
    for first in range(0, len(made), batch.length):
        last = min(first + batch.length, len(made))
        try:
            block = batch.run(first, last, partial(_later, told, first) if alone else None)
            made.take(block)
            if block.raised is not None:
                return block.raised
            if alone:
                told(last)
        except KeyboardInterrupt as stop:
            # between two calls of the core
            return stop
    return None


def _later(told: Shown, first: int, done: int) -> None:
    told(first + done)


def _one_by_one(made: Sweep, plan: Plan, outputs: Mapping[str, Output], told: Shown) -> None:
    """Trajectories, one after another."""
    for number in range(len(made)):
        try:
            run = made.run(number)
            found = {name: _of(made, number, name, one, run) for name, one in outputs.items()}
        except KeyboardInterrupt as stop:
            _ended(made, stop)
        except Exception as error:
            error.add_note(f"in variant {number} of the sweep: {shown(plan.variants[number])}")
            raise
        made.take_one(number, found, run.status)
        told(number + 1)
    if made.problems:
        one, *more = made.problems
        also = f"; {len(more)} more, which .problems lists" if more else ""
        warnings.warn(OutputWarning(f"{one}{also}; the value is missing"), stacklevel=caller())


def _of(made: Sweep, number: int, name: str, one: Output, run: Trajectory) -> Any:
    """An output of a run; one of a function that raises is missing, and the others are kept."""
    if not isinstance(one, Computed):
        return one.of(run)
    try:
        value = one.of(run)
    except Exception as error:
        made.problems.append(Missing(number, name, f"{type(error).__name__}: {error}"))
        return None
    return one.one(value)


def _sampled(swept: Swept) -> bool:
    """Whether a Python function sets a signal."""
    values = [value for one in swept.variants.varied for value in one.values]
    return bool(controllers(swept.system.inputs)) or any(
        isinstance(value, Signal) and value.sampling() is not None for value in values
    )


def _ended(made: Sweep, raised: BaseException) -> Sweep:
    """End with what is done."""
    if isinstance(raised, KeyboardInterrupt):
        done = int(np.sum(made.codes != INTERRUPTED))
        message = f"interrupted: {done} of {len(made)} variants are done; what they gave is kept in .sweep"
        raise SweepInterrupted(message, made) from None
    raise raised
