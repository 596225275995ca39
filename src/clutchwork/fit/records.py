"""Fit numbers of a driveline to several measured records at once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from clutchwork.assembly.system import System
from clutchwork.base import ModelError, counted, quote
from clutchwork.base.arrays import Array
from clutchwork.declare.calls import explained
from clutchwork.fit.descent import Descent
from clutchwork.fit.driven import Driven, driven
from clutchwork.fit.engine import Solution
from clutchwork.fit.failure import FitError, described_by_nothing, refuse
from clutchwork.fit.fitted_record import FittedRecord
from clutchwork.fit.intervals import estimate
from clutchwork.fit.losses import WIDTH, Penalty
from clutchwork.fit.misfit import is_worse, patterns
from clutchwork.fit.numbers import Numbers, faults, numbers
from clutchwork.fit.record import Record
from clutchwork.fit.record_readings import RecordReadings
from clutchwork.fit.response_result import ResponseFit
from clutchwork.fit.traces import label
from clutchwork.fit.unknown import Pair
from clutchwork.gradients.parameters import changes, parameters
from clutchwork.run.simulation import Assembles

# sums of squares that differ by less, of themselves, are those of one solution
SAME = 1e-3
# how far is looked whether better values are refused, of the scale of a code
BESIDE = 1e-3


@explained("fit_records", records="[record]", free="['c1.gain', 'engine.inertia']")
def fit_records(
    model: Assembles | System,
    records: Sequence[Record] | Record,
    free: Sequence[str] | str,
    *,
    own: Sequence[str] | str = (),
    bounds: Mapping[str, Pair] | None = None,
    confidence: float = 0.95,
    starts: int = 1,
    loss: str = "linear",
    loss_width: float = WIDTH,
) -> ResponseFit:
    """Bounded least squares of measured records over numbers of a driveline; see docs/guide/fit.md.

    Parameters: model, a Driveline or a System with the start values; records, one or several; free, names of numbers
    that all records have in common, as in `cw.differentiable`: "c1.gain", "engine.speed", "c1.friction.kinetic",
    "c1.pressure.values" for all ordinates of a table, "c1.pressure.times[3]" for the time of its third knot; own, names
    of numbers that each record has for itself, such as initial values; bounds, {name: (lower, upper)}, by default those
    of the declaration, and a factor of 1000 either way for numbers that stay above zero; confidence of the intervals;
    starts, searches from other start values too, up to a factor e away, of which the best one counts; loss, "linear"
    for least squares, "soft_l1", "huber" or "cauchy" for samples that are off, in which residuals count less from
    loss_width deviations of the noise of their signal on.

    Derivatives are those of `cw.differentiable`, exact through locking and breaking away. Numbers that the samples do
    not determine are not an error: the result reports them. FitError reports all that is wrong with the input, and a
    fit that is worse than the means of the samples.
    """
    listed = [records] if isinstance(records, Record) else list(records)
    names, owned = _names(free), _names(own)
    problems = list(_faults(listed, names, owned, confidence, starts))
    penalty = _penalty(loss, loss_width, problems)
    system = model if isinstance(model, System) else model.assemble()
    found = driven(system, [one for one in listed if isinstance(one, Record)], problems)
    if problems:
        said = {one.quantity for one in problems}
        problems += faults(system, [name for name in dict.fromkeys([*names, *owned]) if name not in said], bounds or {})
    refuse(problems)
    descent = Descent(found, numbers(found, names, owned, bounds or {}), penalty)
    return _solved(descent, RecordReadings(system, listed, descent), confidence, starts)


def _names(given: Sequence[str] | str) -> list[str]:
    """One or several, each once."""
    return [given] if isinstance(given, str) else list(dict.fromkeys(given))


def _penalty(kind: str, width: float, problems: list[FitError]) -> Penalty:
    """The loss that is asked for, or least squares where something is wrong with it."""
    try:
        return Penalty(kind, width)
    except FitError as error:
        problems.append(error)
        return Penalty()


def _faults(records: list[Any], free: list[Any], own: list[Any], confidence: float, starts: int) -> Iterator[FitError]:
    """What is wrong with a call, without a look at the driveline."""
    if not records:
        yield FitError("records", "are empty", "give at least one Record")
    if not (free or own):
        yield FitError("free", "is empty", "give at least one name")
    if not 0.0 < confidence < 1.0:
        yield FitError("confidence", f"is {confidence!r}", "give a number between 0 and 1, such as 0.95")
    if not (isinstance(starts, int) and starts > 0):
        yield FitError("starts", f"is {starts!r}", "give a whole number of at least 1")
    for number, record in enumerate(records):
        if isinstance(record, Record):
            yield from _taken(record, label(record, number), free, own)
        else:
            yield FitError("records", f"hold {quote(record)}", "give each as a Record(time, measured)")


def _taken(record: Record, of: str, free: Sequence[str], own: Sequence[str]) -> Iterator[FitError]:
    """Numbers that are free, and given by a record too."""
    for name in map(str, [*free, *own]):
        stem = next((one for one in record.inputs if name == one or name.startswith(f"{one}.")), "")
        if stem:
            yield FitError(name, f"is free, and {of} drives {stem}", "take it out of free, or out of inputs")
        elif name in record.start and name not in own:
            remedy = f"give own=[{name!r}], or take it out of start"
            yield FitError(name, f"is free, and {of} sets it", remedy)


def _solved(descent: Descent, readings: RecordReadings, confidence: float, starts: int) -> ResponseFit:
    records, searched, ended = descent.records, descent.numbers, descent.best(starts)
    best = ended[0]
    what = estimate(descent, best.u, confidence)
    r2, odd = _share(descent, best), _doubts(descent, what.felt)
    worse = is_worse(r2, len(np.concatenate(descent.measured)))

    def r2_of(others: Sequence[Driven]) -> float:
        beside = Descent(others, searched, descent.loss)
        return _share(beside, beside.best(1)[0])

    hints = readings.fitted(1.0 - r2, r2_of) if worse or odd else readings.noted()
    doubts = [*hints, *odd] if worse else [*odd, *(hints if odd else ())]
    values = searched.values(best.u)
    followed = tuple(_followed(record, searched, values[searched.places(k)]) for k, record in enumerate(records))
    notes = [*(note for record in records for note in record.notes), *(hints if not doubts else ())]
    found = ResponseFit(
        parameters=what.parameters(descent, best.u),
        values=_changes(records[0], searched.by[: searched.shared], values[: searched.shared]),
        records=followed,
        rms=_rms(followed),
        r2=r2,
        confidence=confidence,
        converged=best.converged,
        correlation=what.correlation,
        alike={name: value for name, value in what.alike.items() if value},
        doubts=tuple(doubts),
        remarks=(*notes, *_remarks(descent, ended, starts)),
    )
    if worse:
        raise described_by_nothing(r2, [*doubts, *notes], found)
    return found


def _changes(record: Driven, names: Sequence[str], values: Array) -> dict[str, object]:
    """Values as `System.changed` takes them: entries of a table in the whole table."""
    return changes(record.system, parameters(record.system, names), values) if len(names) else {}


def _followed(record: Driven, searched: Numbers, values: Array) -> FittedRecord:
    made = _changes(record, searched.by, values)
    return FittedRecord(record.label, record.traces, record.run(made), made)


def _rms(records: Sequence[FittedRecord]) -> dict[str, float]:
    rows = dict[str, list[Array]]()
    for record in records:
        for one in record.traces:
            rows.setdefault(one.signal, []).append(record.residuals(one))
    return {name: float(np.sqrt(np.mean(np.concatenate(of) ** 2))) for name, of in rows.items()}


def _doubts(descent: Descent, felt: Array) -> list[str]:
    """Patterns over time that are left in a signal, against its variation in all records."""
    made, values = list[str](), np.concatenate(descent.measured) / np.concatenate(descent.weights)
    for name, places in descent.signals.items():
        size = float(np.std(values[np.concatenate(places)]))
        rows = {f"time of {name}{of}": felt[own] for of, own in zip(_labels(descent, name), places, strict=True)}
        made += patterns(rows, size)
    return made


def _labels(descent: Descent, signal: str) -> list[str]:
    """Names of the records of a signal, for messages."""
    several = len(descent.records) > 1
    return [
        f" ({record.label})" if several else ""
        for record in descent.records
        for one in record.traces
        if one.signal == signal
    ]


def _share(descent: Descent, best: Solution) -> float:
    """Share of the variation of the samples that the runs describe."""
    values, weights = (np.concatenate(rows) for rows in (descent.measured, descent.weights))
    scales = np.ones(len(values)) if descent.within is None else descent.within
    variation = list[float]()
    for places in descent.signals.values():
        own = np.concatenate(places)
        middle = np.median(values[own]) if descent.within is not None else np.mean(values[own])
        variation.append(float(np.sum(descent.loss.costs((values[own] - middle) / weights[own], scales[own]))))
    return 1.0 - best.squares / sum(variation) if sum(variation) > 0.0 else float("nan")


def _remarks(descent: Descent, ended: Sequence[Solution], starts: int) -> list[str]:
    """How the search went."""
    made = []
    if descent.fallen:
        count = f"at {len(descent.fallen)} of {descent.points} points of the search"
        made.append(f"{count} derivatives are differences of runs: {descent.fallen[0]}")
    if starts > 1:
        alike = sum(one.squares <= ended[0].squares * (1.0 + SAME) for one in ended)
        made.append(f"{alike} of {counted(starts, 'starts')} end at these values")
    return made + _held(descent, ended[0].u)


def _held(descent: Descent, u: Array) -> list[str]:
    """Whether the driveline refuses values beside the solution, so that the search could not go on."""
    step = -np.linalg.lstsq(descent.jacobian(u), descent.residuals(u), rcond=1e-6)[0]
    longest = float(np.max(np.abs(step / descent.numbers.scales)))
    beside = np.clip(u + BESIDE * step / max(longest, BESIDE), descent.lower, descent.upper)
    values = descent.numbers.values(beside)
    for number, function in enumerate(descent.functions):
        try:
            function(values[descent.numbers.places(number)])
        except ModelError as error:
            return [f"the driveline refuses better values: {error.problems[0]}"]
    return []
