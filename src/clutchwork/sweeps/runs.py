"""The runs of a sweep: in the core, then those outputs that need a Trajectory, one run after another."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from clutchwork.base import quote
from clutchwork.declare.layout import INTERRUPTED
from clutchwork.declare.node import Signal
from clutchwork.run.control import controllers
from clutchwork.run.trajectory import Trajectory
from clutchwork.sweeps.axes import Plan
from clutchwork.sweeps.batch import Batch, CoreOutputs, RunSetup
from clutchwork.sweeps.outputs import Computed, Output
from clutchwork.sweeps.result import Missing, Sweep, SweepInterrupted, Swept

Shown = Callable[[int], None]


def run_all(swept: Swept, threads: int, told: Shown) -> Sweep:
    """The result for all variants; SweepInterrupted with what is done after Ctrl-C."""
    made, plan = Sweep.empty(swept), Plan.of(swept.system, swept.variants.plain)
    wanted = CoreOutputs.of(swept.system, swept.options, swept.outputs, swept.t_end)
    # what calls Python in a run cannot be on several threads
    alone = in_python(swept) or not wanted.outputs
    computed = {name: one for name, one in swept.outputs.items() if alone or isinstance(one, Computed)}
    if not alone:
        raised = _in_core(made, Batch(plan, wanted, RunSetup(swept.t_end, swept.options, threads)), told, not computed)
        if raised is not None:
            return ended(made, raised)
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
            ended(made, stop)
        except Exception as error:
            error.add_note(f"in variant {number} of the sweep: {quote(plan.variants[number])}")
            raise
        made.take_one(number, found, run.status)
        told(number + 1)


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


def in_python(swept: Swept) -> bool:
    """Whether a Python function sets a signal."""
    values = [value for one in swept.variants.varied for value in one.values]
    return bool(controllers(swept.system.inputs)) or any(
        isinstance(value, Signal) and value.sampling() is not None for value in values
    )


def ended(made: Sweep, raised: BaseException) -> Sweep:
    """Raise what ended the runs, Ctrl-C with what is done."""
    if isinstance(raised, KeyboardInterrupt):
        done = int(np.sum(made.codes != INTERRUPTED))
        message = f"interrupted: {done} of {len(made)} variants are done; what they gave is kept in .sweep"
        raise SweepInterrupted(message, made) from None
    raise raised
