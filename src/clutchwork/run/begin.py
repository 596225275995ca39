"""Runs of the compiled core where they begin: at the start of a model, or where a state was saved."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import quote
from clutchwork.declare.core import core
from clutchwork.declare.layout import DONE, EVENTS_FULL, ROWS_FULL
from clutchwork.declare.options import Options

if TYPE_CHECKING:
    from collections.abc import Mapping

    from clutchwork.assembly.system import System
    from clutchwork.results.external_settings import Held
    from clutchwork.results.state import State

# budgets of a run count what it does itself
BUDGETS = {"max_steps": ("steps", "rejected"), "max_events": ("events",)}

# statuses after which the core is called again
AGAIN = (EVENTS_FULL, ROWS_FULL)


def new_run(data: bytes) -> Any:
    """A run of the compiled core over the bytes of a System."""
    return core().Run(data)


def begun(system: System, options: Options, start: State | None) -> Any:
    """A run with its options, at the start or at a state."""
    run = new_run(system.to_bytes())
    if start is not None:
        put(run, system, start)
    choose(run, options)
    return run


def put(run: Any, system: System, state: State) -> None:
    """Restore a run; StateError where the state is that of another model, or damaged."""
    from clutchwork.results.state import StateError

    state.fits(system)
    try:
        run.restore(state.core)
    except ValueError:
        run_time = f"the state of {quote(state.model)} at {state.time:g} s"
        raise StateError(f"{run_time} is damaged, or of another version of clutchwork: save it again") from None
    size = 8 * run.row_size
    if run.time != state.time or len(state.row) != size or len(state.left) not in (0, size):
        raise StateError(f"the state of {quote(state.model)} at {state.time:g} s is damaged: save it again")


def choose(run: Any, options: Options) -> None:
    """Give a run its options; what was done before it began does not count against its budgets."""
    before, values = run.statistics(), options.core_options()
    for name, counters in BUDGETS.items():
        values[name] += sum(before[counter] for counter in counters)
    for name, value in values.items():
        run.set_option(name, value)


def state_of(
    run: Any, system: System, outside: tuple[Held, Mapping[str, Any]], row: bytes | None = None, left: bytes = b""
) -> State:
    """The State of a run whose events were taken.

    Parameters: row, that of the present time where it is known; left, the one before what was set there.
    """
    from clutchwork.results.state import State, fingerprint

    saved = run.save()
    if row is None:
        row = np.asarray(row_of(run)).tobytes()
    held, changed = outside
    return State(run.time, system.name, fingerprint(system), saved, row, left, dict(held), dict(changed))


def row_of(run: Any) -> Any:
    """The output row at the present time, as `seen` gives it."""
    return seen(run)[0]


def seen(run: Any) -> tuple[Any, Any]:
    """The output row at the present time, and the events of what is decided for it, which the run has yet to do.

    Nothing of it stays: what was set is decided once, by what comes after, however often it was looked at.
    """
    saved = run.save()
    row, events = run.row(), run.events()
    run.restore(saved)
    return row, events


def reach(run: Any, stop: float, at: float) -> int:
    """Run on the way to a stop up to a time, without cutting the step of the solver that ends there; the status."""
    saved, count = run.save(), 0
    status, before = DONE, run.time
    while status in (DONE, *AGAIN) and run.time < at:
        before = run.time
        status = _one_step(run, stop)
        count += 1
    if run.time <= at:
        return _after_events(run, stop) if status in AGAIN else status
    # the step over it is taken again and cut
    run.restore(saved)
    for _ in range(count):
        if run.time < before:
            _one_step(run, stop)
    return advance(run, at)


def _after_events(run: Any, stop: float) -> int:
    """What happens at the present time happens, but no step is taken; the status."""
    status, now = DONE, run.time
    while run.time == now:
        saved, status = run.save(), _one_step(run, stop)
        if status not in AGAIN:
            break
    if run.time == now:
        return status
    run.restore(saved)
    return DONE


def advance(run: Any, stop: float) -> int:
    """Run to a time without output; the status."""
    times, rows = np.empty(0), np.empty((0, run.row_size))
    while True:
        status, _, raised = run.advance(stop, times, rows, 0, 0)
        run.events()
        if raised is not None:
            raise raised
        if status != EVENTS_FULL:
            return int(status)


def _one_step(run: Any, stop: float) -> int:
    times, rows = np.empty(3), np.empty((3, run.row_size))
    status, _, raised = run.advance(stop, times, rows, 0, 1)
    run.events()
    if raised is not None:
        raise raised
    return int(status)
