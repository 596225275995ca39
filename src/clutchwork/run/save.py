"""A run in one file: what was computed, how, and the model that it was computed with. Nothing in it is code."""

from __future__ import annotations

import json
import warnings
from dataclasses import astuple
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.assembly.system import PARTS
from clutchwork.assembly.wiring import wiring
from clutchwork.base import ClutchworkError, ModelError, ModelWarning, archive, counted
from clutchwork.base.extras import program
from clutchwork.declare.options import OPTIONS
from clutchwork.model.settings import plain_settings
from clutchwork.results.channels import Channels
from clutchwork.results.state import PARTS as STATE_PARTS

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.results.recorded import Recorded
    from clutchwork.results.state import State
    from clutchwork.run.input_schedule import Schedule

# raised when an older version could not read the file
FORMAT = 1
RUN_PARTS = ("run", "time", "rows", "events", "tape", *(f"start_{name}" for name in STATE_PARTS), *PARTS)
MOST_BYTES = 4_000_000_000


class RunFormatError(ClutchworkError, ValueError):
    """A run that no file can hold, or a file that holds no run of this version."""


def save(run: Recorded, path: str | Path, start: State | None, course: Schedule) -> None:
    """Write it, with where it began and what was done to it; RunFormatError where a file cannot hold it."""
    size = run.time.nbytes + run.rows.nbytes
    if size > MOST_BYTES // 2:
        raise RunFormatError(
            f"this run has {size} bytes, more than {MOST_BYTES // 2}: save run.at(...) at fewer instants"
        )
    system, controllers = _without_controllers(run)
    about = {
        "format": FORMAT,
        "program": program(),
        "system": system.name,
        "t_end": run.t_end,
        "options": plain_settings({name: getattr(run.options, name) for name in OPTIONS}),
        "status": run.status,
        "message": run.message,
        "statistics": dict(run.statistics),
        "controllers": controllers,
    }
    parts = {
        "run": json.dumps(about, default=float).encode(),
        "time": np.ascontiguousarray(run.time, dtype="<f8").tobytes(),
        "rows": np.ascontiguousarray(run.rows, dtype="<f8").tobytes(),
        "events": json.dumps([astuple(event) for event in run.events]).encode(),
    }
    # a run without its controllers is not repeated
    begin = _begin(None, None) if controllers else _begin(start, course.plain())
    archive.write(path, parts | begin | _model(system))


def _begin(start: State | None, done: dict[str, Any] | None) -> dict[str, bytes]:
    """The state that a run began at and what was done to it, empty where there is none."""
    state = start.parts() if start is not None else dict.fromkeys(STATE_PARTS, b"")
    tape = json.dumps(done, default=float).encode() if done is not None else b""
    return {"tape": tape, **{f"start_{name}": data for name, data in state.items()}}


def _model(system: System) -> dict[str, bytes]:
    """The parts of a System; one that has no names is its arrays alone."""
    return system.parts() if system.model else {"content": system.to_bytes(), "model": b"", "independent": b""}


def _without_controllers(run: Recorded) -> tuple[System, list[str]]:
    """The System with a number in place of each Python function, and the names of the inputs that these set.

    The output rows hold what controllers decided, so that every signal stays as it is.
    """
    system = run.system
    asked = [place for place, item in enumerate(system.inputs) if item.signal.sampling() is not None]
    if not asked:
        # a run that was loaded says whose controllers it lacks
        return system, list(run.lacks)
    names = [system.inputs[place].name for place in asked]
    begin = run.wiring.columns["input"].start
    first = [run.rows[0, begin + place] if len(run) else 0.0 for place in asked]
    for values in (first, [0.0] * len(asked), [1.0] * len(asked)):
        made = _changed(system, dict(zip(names, map(float, values), strict=True)))
        if made is not None and tuple(Channels(wiring(made))) == tuple(Channels(run.wiring)):
            return made, names
    told = f"{counted(len(names), 'controllers')} in Python ({', '.join(names)})"
    raise RunFormatError(f"this run has {told}, whose places in the model nothing else can take: use run.write(...)")


def _changed(system: System, values: dict[str, Any]) -> System | None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        try:
            return system.changed(values)
        except ModelError:
            return None
