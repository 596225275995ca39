"""The driveline of each record: with what drove it and the initial values that it began with."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError, Problem, UseError
from clutchwork.declare.node import Signal
from clutchwork.declare.options import Options
from clutchwork.fit.failure import FitError
from clutchwork.fit.traces import Trace, label, row, traces
from clutchwork.model.changes import named, target, unit_of
from clutchwork.results.channels import channels
from clutchwork.run.simulation import simulate
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.fit.record import Record
    from clutchwork.results.trajectory import Trajectory

Array = NDArray[np.float64]

# far below what a sensor resolves
RTOL, ATOL = 1e-9, 1e-11


@dataclass(frozen=True, eq=False)
class Driven:
    """A record with its System."""

    label: str
    system: System
    traces: tuple[Trace, ...]
    options: Options

    @property
    def t_end(self) -> float:
        """Time of the last sample [s]."""
        return max(float(one.times[-1]) for one in self.traces)

    def run(self, values: dict[str, Any]) -> Trajectory:
        """The run with other numbers, at the instants of all samples."""
        times = np.unique(np.concatenate([one.times for one in self.traces]))
        made = self.system.changed(values) if values else self.system
        return simulate(made, self.t_end, options=self.options.changed({"times": times})).raise_for_status()


def driven(system: System, records: Sequence[Record], problems: list[FitError]) -> list[Driven]:
    """All records that can be used; what is wrong with the others joins the problems."""
    made, labels = list[Driven](), [label(record, number) for number, record in enumerate(records)]
    for number, record in enumerate(records):
        again = labels[:number].count(labels[number])
        told = f"{labels[number]} {again + 1}" if again else labels[number]
        of = f"{told}: " if len(records) > 1 or record.name else ""
        own = _changed(system, record, of, problems)
        known = channels(own, True, True)
        found = list(traces(record, known, of))
        wrong = [one for one in found if isinstance(one, FitError)]
        fine = tuple(one for one in found if isinstance(one, Trace))
        problems += wrong
        if not wrong:
            # work is integrated where it was measured
            bare = channels(own, True, False)
            work = any(one.signal not in bare for one in fine)
            made.append(Driven(told, own, fine, Options(rtol=RTOL, atol=ATOL, work=work)))
    return made


def _changed(system: System, record: Record, of: str, problems: list[FitError]) -> System:
    """The System of a record, or that of the others where something is wrong with it."""
    changes, before = dict(record.start), len(problems)
    for name, given in record.inputs.items():
        try:
            changes[name] = _signal(system, record, name, given, of)
        except FitError as error:
            problems.append(error)
    if len(problems) > before or not changes:
        return system
    try:
        return system.changed(changes)
    except ModelError as error:
        problems += [FitError(*_told(one, of)) for one in error.problems]
    except UseError as error:
        problems += [FitError(f"{of}inputs", one, "correct it") for one in error.problems]
    return system


def _told(one: Problem, of: str) -> tuple[str, str, str]:
    where = f"{one.path} {one.quantity}".strip()
    return f"{of}{where}", f"= {one.value} {one.message}" if one.value else one.message, one.remedy or "correct it"


def _signal(system: System, record: Record, name: str, given: Any, of: str) -> Any:
    """What drives an input: samples as a table over time, anything else as it is."""
    if isinstance(given, Signal | str) or np.ndim(given) == 0:
        return given
    aim = target(named(system.source), name) if system.source else None
    times, values = row(record, name, given, unit_of(aim) if aim else "1", of)
    if times[0] < 0.0:
        now = float(np.interp(0.0, times, values))
        times, values = np.append(0.0, times[times > 0.0]), np.append(now, values[times > 0.0])
    return Table(list(zip(times.tolist(), values.tolist(), strict=True)))
