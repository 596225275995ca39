"""The driveline of each record: with what drove it and the initial values that it began with."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import ModelError, Problem, UseError, dataclass, listed
from clutchwork.declare.node import Signal
from clutchwork.declare.options import Options
from clutchwork.fit.failure import FitError
from clutchwork.fit.traces import Trace, in_si, label, row, traces
from clutchwork.model.changes import Owners, named, target, targets_of, unit_of
from clutchwork.results.channels import channels
from clutchwork.run.simulation import simulate
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.fit.record import Record
    from clutchwork.results.channels import Channel
    from clutchwork.run.trajectory import Trajectory


# far below what a sensor resolves
RTOL, ATOL = 1e-9, 1e-11
# units of test benches
USUAL = {"rad/s": "1/min", "Pa": "bar"}


@dataclass(frozen=True, eq=False)
class Driven:
    """A record with its System."""

    label: str
    system: System
    traces: tuple[Trace, ...]
    options: Options
    notes: tuple[str, ...] = ()  # on what was read

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
            options = Options(rtol=RTOL, atol=ATOL, work=work)
            made.append(Driven(told, own, fine, options, tuple(_without_unit(system, record, known, of))))
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


def _without_unit(system: System, record: Record, known: Mapping[str, Channel], of: str) -> Iterator[str]:
    """Columns of a file that were taken as SI because it says no unit."""
    heads, owners = dict[str, list[str]](), named(system.source) if system.source else Owners()
    for name, head in record.without_unit.items():
        aim = target(owners, name) if name in record.inputs else None
        unit = unit_of(aim) if aim else known[name].unit if name in known else ""
        if unit not in ("", "1"):
            heads.setdefault(unit, []).append(head)
    for unit, columns in heads.items():
        verb = "has no unit and was" if len(columns) == 1 else "have no unit and were"
        such = f"{columns[0]} [{USUAL.get(unit, unit)}]"
        yield f"{of}{listed(columns)} of the file {verb} taken as {unit}; give one with the name, such as {such!r}"


def _told(one: Problem, of: str) -> tuple[str, str, str]:
    where = f"{one.path} {one.quantity}".strip()
    return f"{of}{where}", f"= {one.value} {one.message}" if one.value else one.message, one.remedy or "correct it"


def _signal(system: System, record: Record, name: str, given: Any, of: str) -> Any:
    """What drives an input: samples as a table over time, anything else as it is."""
    if isinstance(given, Signal | str):
        return given
    aim = target(named(system.source), name) if system.source else None
    if np.ndim(given) == 0:
        return in_si(record, name, given, unit_of(aim), of) if aim and isinstance(given, Real) else given
    if system.source and aim is None:
        # whatever the unit
        _, (unknown,) = targets_of(system.source, [name])
        raise FitError(*_told(unknown, of))
    times, values = row(record, name, given, unit_of(aim) if aim else "1", of)
    if times[0] < 0.0:
        now = float(np.interp(0.0, times, values))
        times, values = np.append(0.0, times[times > 0.0]), np.append(now, values[times > 0.0])
    return Table(list(zip(times.tolist(), values.tolist(), strict=True)))
