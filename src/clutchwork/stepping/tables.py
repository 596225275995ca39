"""Tables that signals follow from the present time on, as segments for the core."""

from __future__ import annotations

from typing import TYPE_CHECKING

from clutchwork.base.errors import Problem
from clutchwork.declare.node import Segment
from clutchwork.declare.schema import specs
from clutchwork.declare.to_si import TargetUnit, field_in_si
from clutchwork.model.fields import signal_problems
from clutchwork.model.numbers import At
from clutchwork.run.input_schedule import Act
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.stepping.signals import Settable

Found = tuple[Act, list[Problem]]


def tabled(system: System, name: str, signal: Settable, table: Table, time: float) -> Found:
    """The act that lets a signal follow a table from a time [s] on, and what is wrong with it."""
    spec = next(spec for item, spec in specs(Table) if item.name == "points")
    made = Table(field_in_si(table.points, spec, TargetUnit(signal.unit, signal.spec.units)))
    found = list(signal_problems(made, signal.spec, At(signal.path, signal.quantity, signal.unit)))
    if not found:
        # as it is now, whatever becomes of a list
        made = Table(tuple((float(at), float(value)) for at, value in made.points))
    pieces = () if found else ahead(made, time)
    found = found or [bad for number in signal.numbers if (bad := _refused(system, name, number, len(pieces)))]
    return Act("segments", name, made, tuple((number, pieces) for number in signal.numbers)), found[:1]


def ahead(table: Table, time: float) -> tuple[Segment, ...]:
    """Pieces of a table from the one at a time [s] on."""
    pieces = table.segments()
    past = sum(piece.start <= time for piece in pieces[1:])
    return pieces[past:]


def _refused(system: System, name: str, number: int, wanted: int) -> Problem | None:
    """Why the core cannot take so many segments for a signal."""
    room, period = int(system.arrays["input_count"][number]), float(system.arrays["input_period"][number])
    if room == 0:
        return Problem(name, "", "is set by a controller and has no room for a table", remedy="set it to a number")
    if period > 0.0:
        remedy = "set it to a number, or give the model a cw.Table"
        return Problem(name, "", f"repeats every {period:g} s, which a table does not", remedy=remedy)
    if wanted > room:
        message = f"has room for {room} segments, as many as it has in the model"
        remedy = "give the model a table with more points, or set one with fewer"
        return Problem(name, "", message, f"{wanted} segments ahead", remedy)
    return None
