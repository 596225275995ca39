"""Samples of one record, checked and in SI."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import dataclass, near, quote
from clutchwork.base.arrays import Array
from clutchwork.declare.quantity import QuantityError, scale_to_si
from clutchwork.fit.failure import FitError, numbers_of, rising
from clutchwork.results.forms import Mode

if TYPE_CHECKING:
    from clutchwork.fit.record import Record
    from clutchwork.results.channels import Channel


@dataclass(frozen=True, eq=False)
class Trace:
    """A measured signal."""

    signal: str
    unit: str
    times: Array  # s
    values: Array
    deviation: Array | None  # of the noise of each sample; None: it counts by the size of the signal


def label(record: Record, number: int) -> str:
    """What a record is called."""
    return record.name or f"record {number + 1}"


def traces(record: Record, known: Mapping[str, Channel], of: str) -> Iterator[Trace | FitError]:
    """The measured signals of a record, or what is wrong with them.

    Parameters: known, all signals of the driveline; of, how a message begins where there are several records.
    """
    if not record.measured:
        yield FitError(f"{of}measured", "is empty", "give at least one name")
    for name in [*record.deviation, *record.units]:
        if name not in record.measured and name not in record.inputs:
            told = f"is given for {quote(name)}, which is not measured{near(name, record.measured)}"
            yield FitError(f"{of}deviation" if name in record.deviation else f"{of}units", told, "take it out")
    for name, given in record.measured.items():
        channel = known.get(name)
        if channel is None:
            told = f"has no signal {quote(name)}{near(name, known)}"
            yield FitError(f"{of}measured", told, 'give the name of one, "load.speed"')
        elif isinstance(channel.evaluate, Mode):
            yield FitError(f"{of}measured", f"{quote(name)} has words, no numbers", "take a speed, a torque or a slip")
        else:
            yield from _trace(record, name, given, channel.unit, of)


def _trace(record: Record, name: str, given: Any, unit: str, of: str) -> Iterator[Trace | FitError]:
    try:
        times, values = row(record, name, given, unit, of)
        deviation = _deviation(record, name, values, unit, of)
    except FitError as error:
        yield error
        return
    yield Trace(name, unit, times, values, deviation)
    if times[0] < 0.0:
        told = f"begins at {times[0]:g} s, and the run at 0 s"
        yield FitError(f"{of}{_of_time(given, name)}", told, "count time from the begin, such as by window=")


def row(record: Record, name: str, given: Any, unit: str, of: str) -> tuple[Array, Array]:
    """Times and values in SI of samples over the time of a record or over their own; FitError where they are none.

    Parameters: unit of SI of what they are samples of.
    """
    is_pair = isinstance(given, tuple) and len(given) == 2 and np.ndim(given[0]) == np.ndim(given[1]) == 1
    time, values = given if is_pair else (record.time, given)
    times, found = numbers_of(f"{of}{_of_time(given, name)}", time), numbers_of(f"{of}{name}", values)
    falls = np.flatnonzero(~(np.diff(times) > 0.0)) + 1
    if len(times) < 2 or len(falls):
        where = f" at sample {falls[0]}, {times[falls[0]]:g} s" if len(falls) else ""
        remedy = f"sort the samples by time{rising({name: found})}" if len(falls) else "give at least two instants [s]"
        raise FitError(f"{of}{_of_time(given, name)}", f"does not rise{where}", remedy)
    if not np.all(np.isfinite(times)):
        told = f"is from {times[0]:g} to {times[-1]:g} s"
        raise FitError(f"{of}{_of_time(given, name)}", told, "give finite instants [s]")
    if len(found) != len(times):
        raise FitError(f"{of}{name}", f"has {len(found)} samples for {len(times)} instants", "give one number for each")
    bad = np.flatnonzero(~np.isfinite(found))
    if len(bad):
        remedy = "remove samples that were not measured"
        raise FitError(f"{of}{name}", f"is {found[bad[0]]} at sample {bad[0]}, {times[bad[0]]:g} s", remedy)
    return times, in_si(record, name, found, unit, of)


def in_si(record: Record, name: str, given: Any, unit: str, of: str) -> Any:
    """Numbers in SI, by the unit that a record gives for them."""
    if name not in record.units:
        return given
    try:
        scale = scale_to_si(record.units[name], unit)
    except QuantityError as error:
        raise FitError(f"{of}{name}", f"{error.message}: {error.value}", error.remedy) from None
    return given * scale.factor + scale.zero


def _of_time(given: Any, name: str) -> str:
    return f"time of {name}" if isinstance(given, tuple) else "time"


def _deviation(record: Record, name: str, values: Array, unit: str, of: str) -> Array | None:
    """Standard deviation of each sample, in SI as it was given."""
    if name not in record.deviation:
        return None
    given = record.deviation[name]
    found = np.full(len(values), given, dtype=float) if np.ndim(given) == 0 and not isinstance(given, str) else None
    found = numbers_of(f"{of}deviation of {name}", given) if found is None else found
    if len(found) != len(values) or not np.all((found > 0.0) & (found < np.inf)):
        told = f"of {name} is {quote(given)}"
        raise FitError(f"{of}deviation", told, f"give a number above zero in [{unit}], or one for each sample")
    return found
