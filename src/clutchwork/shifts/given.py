"""What measures of shifts are given: the gearbox of a run, and signals whose units fit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from clutchwork.base import UnknownName, UseError, listed, near, quote
from clutchwork.base.errors import expect, nearest
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.results.gears import table_of

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

# units of a torque behind the output, and of an acceleration, and such a signal
TORQUES, TORQUE = ("N m", "N"), "half_shafts.torque"
ACCELERATIONS, ACCELERATION = ("m/s2", "rad/s2"), "car.acceleration"
# signals that a message lists
MOST = 3


def prefix_of(run: Any, box: Gearbox, prefix: str) -> str:
    """Name of the Transmission of a run that a prefix means, that of the only one where it is empty.

    UnknownName, a KeyError, names `prefix=` where there is none; UseError for a gearbox by its name alone.
    """
    expect("cw.shifts", "box", box, Gearbox, "give a cw.Gearbox, such as cw.Gearbox.load('zf-8hp70')")
    try:
        return table_of(run.system, prefix).name
    except UnknownName as error:
        names = [table.name for table in run.system.gearboxes]
        remedy = f"; give prefix={names[0]!r}" if len(names) == 1 else "; give one as prefix=" if names else ""
        raise UnknownName(f"{error}{remedy}") from None


def refuse_prefix(call: str, system: System, box: Gearbox, prefix: str) -> None:
    """UseError for a prefix that is not the name of a Transmission with a gearbox."""
    inner = f".{box.input}"
    known = [node.name.removesuffix(inner) for node in system.nodes if node.name.endswith(inner)]
    if prefix not in known:
        one = nearest(prefix, known) or next(iter(known), "")
        remedy = near(prefix, known, f"give prefix={one!r}" if known else "add one to the driveline")
        raise UseError(call, [f"{quote(prefix)} is not a Transmission of {quote(box.name)}{remedy}"])


def refuse_unfit(call: str, run: Any, torque: str, acceleration: str) -> None:
    """UseError for signals whose units are not those of a torque or an acceleration; empty ones are left out."""
    problems = [
        *_faults(run.units, "torque", torque, TORQUES, TORQUE),
        *_faults(run.units, "acceleration", acceleration, ACCELERATIONS, ACCELERATION),
    ]
    if problems:
        raise UseError(call, problems)


def _faults(units: Mapping[str, str], name: str, signal: str, wanted: tuple[str, ...], such: str) -> Iterator[str]:
    if not signal:
        return
    if not isinstance(signal, str):
        yield f"{name} is {quote(signal)}: give the name of a signal, such as {such!r}"
        return
    unit = units[signal]
    if unit not in wanted:
        has = f"is in [{unit}]" if unit else "is a word and has no unit"
        fits = " or ".join(f"[{one}]" for one in wanted)
        others = [one for one, known in units.items() if known in wanted and one.endswith(f".{name}")]
        rest = f": {listed(others[:MOST])}{' ...' if len(others) > MOST else ''}" if others else f", such as {such!r}"
        yield f"{name}={signal!r} {has}; give a signal in {fits}{rest}"
