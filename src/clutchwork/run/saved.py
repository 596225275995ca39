"""Runs from files that `Trajectory.save` wrote."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from functools import partial
from math import inf
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from clutchwork.assembly.system import System, SystemFormatError
from clutchwork.assembly.wiring import wiring
from clutchwork.base import ClutchworkError, ModelWarning, archive, dataclass, listed
from clutchwork.base.arrays import Array
from clutchwork.base.extras import program
from clutchwork.base.paths import path_of
from clutchwork.base.quote import shortened
from clutchwork.base.regular import reason
from clutchwork.declare.calls import explained
from clutchwork.declare.layout import MODES, STATUSES
from clutchwork.declare.options import Options
from clutchwork.declare.wording import say
from clutchwork.results.channels import channels
from clutchwork.results.events import Event, Events, contact_domains
from clutchwork.results.state import State
from clutchwork.run.control import Control
from clutchwork.run.input_schedule import Schedule, Tape
from clutchwork.run.save import FORMAT, MOST_BYTES, RUN_PARTS, RunFormatError
from clutchwork.run.simulation import Job
from clutchwork.run.trajectory import Trajectory

# read before the rows, whose size follows from them
NAMED = tuple(name for name in RUN_PARTS if name not in ("run", "rows"))


class RepeatError(ClutchworkError, RuntimeError):
    """A run that cannot be computed again."""


@dataclass(frozen=True)
class NoRepeat:
    """Says why a run has no other instants."""

    controllers: tuple[str, ...]

    def __call__(self, _times: Any) -> NoReturn:
        """Refuse."""
        why = f"inputs were set by Python functions ({listed(self.controllers)}), which a file does not hold"
        raise RepeatError(f"this run was loaded and cannot be repeated: {why}; simulate the model again")


@explained("cw.load_run", path="'run.cwrun'")
def load_run(path: str | Path) -> Trajectory:
    """The run that `run.save(path)` wrote: signals, units, events, energy, options and status, bit for bit.

    `run.at` and `run.state` repeat it as before, also one that was stepped or began at a state, but where Python
    functions set inputs. RunFormatError where the file is damaged, no run at all, or of another version.
    """
    path_of("cw.load_run", path, "run.cwrun")
    try:
        parts = archive.ArchiveParts(path, RUN_PARTS, MOST_BYTES)
        return _made(_about(parts.probable("run"), path), parts, path)
    except RunFormatError:
        raise
    except (ValueError, TypeError, RecursionError, OSError) as error:
        why = reason(error) if isinstance(error, OSError) else shortened(str(error))
        if isinstance(error, FileNotFoundError):
            raise RunFormatError(f"{path} does not exist; check the path") from None
        by = say("clutchwork run MODEL --save FILE", "run.save")
        raise RunFormatError(f"{path}: cannot read a run: {why}; write the file with {by}") from None


def _about(data: bytes, path: str | Path) -> Mapping[str, Any]:
    about: Mapping[str, Any] = json.loads(data)
    if "format" not in about:
        raise ValueError("it does not say what it holds")
    if about["format"] > FORMAT:
        by, here = about.get("program"), program()
        raise RunFormatError(f"{path} was saved by {by} in format {about['format']}; {here} reads {FORMAT}: update it")
    missing = [key for key in ("system", "t_end", "options", "status", "message", "statistics") if key not in about]
    if missing:
        raise ValueError(f"it lacks {listed(missing)}")
    if about["status"] not in STATUSES:
        raise ValueError("its status is none that a run has")
    return about


def _made(about: Mapping[str, Any], parts: archive.ArchiveParts, path: str | Path) -> Trajectory:
    times, events, tape, head, core, row, left, *model = (parts.probable(name) for name in NAMED)
    system, options, end = _system(about, model, path), Options(**about["options"]), _end(about["t_end"])
    # one that was never stepped ends where it begins
    if not options.t_start <= end < inf:
        raise ValueError(f"t_end is {end:g} s, before it begins")
    controllers = tuple(map(str, about.get("controllers", ())))
    time = np.frombuffer(times, "<f8").astype(float)
    start = State.of_parts(head, core, row, left) if head else None
    if start is not None:
        start.fits(system)
    job = Job(system, end, options, _course(system, tape, start), start)
    return Trajectory(
        system=system,
        options=options,
        t_end=end,
        time=time,
        rows=_rows(system, parts, len(time)),
        events=_events(system, json.loads(events)),
        status=str(about["status"]),
        message=str(about["message"]),
        statistics=dict(about["statistics"]),
        repeat=NoRepeat(controllers) if controllers else job.again,
        lacks=controllers,
        capture=NoRepeat(controllers) if controllers else job.state,
        start=start,
        course=job.course,
    )


def _end(given: Any) -> float:
    """The end of a run [s]; TypeError where it is not a number."""
    if isinstance(given, bool) or not isinstance(given, int | float):
        raise TypeError("its t_end is not a number")
    return float(given)


def _course(system: System, tape: bytes, start: State | None) -> Schedule:
    """What was done to the run: the steps of one that was stepped, else what is held since the state at its begin."""
    if tape:
        return Tape.of_plain(json.loads(tape), len(system.inputs), len(system.arrays["params"]))
    held, changed = (start.held, start.changed) if start is not None else ({}, {})
    return Control((), partial(channels, system), held=held, changed=changed)


def _system(about: Mapping[str, Any], model: list[bytes], path: str | Path) -> System:
    try:
        if not model[1]:
            return System.from_bytes(model[0], str(about["system"]))
        with warnings.catch_warnings():
            # the warning was given when the run was saved
            warnings.simplefilter("ignore", ModelWarning)
            return System.of_parts(model, str(path))
    except SystemFormatError as error:
        by = f"it was saved by {about.get('program')}, this is {program()}"
        remedy = "load it with that version and export it with run.write"
        raise RunFormatError(f"{path}: its model cannot be used: {error} ({by}); {remedy}") from None


def _rows(system: System, parts: archive.ArchiveParts, count: int) -> Array:
    wires = wiring(system)
    # nothing that does not fit is unpacked
    if parts.size("rows") != 8 * count * wires.row_size:
        raise ValueError("its signals do not fit its model")
    rows = np.frombuffer(parts.read("rows"), "<f8").astype(float).reshape(count, wires.row_size)
    if not np.all(np.isin(rows[:, wires.columns["contact_mode"]], list(MODES))):
        raise ValueError("the mode of a contact is none that there is")
    return rows


def _events(system: System, lines: Any) -> Events:
    kinds: list[type] = [float if kind == "float" else str for kind in Event.__annotations__.values()]
    made = [Event(*(kind(value) for kind, value in zip(kinds, line, strict=True))) for line in lines]
    return Events(made, contact_domains(system))
