"""Signals at many instants of a run with derivatives: all rows of a signal at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from clutchwork.gradients.forms import weights
from clutchwork.gradients.primal import SAME
from clutchwork.gradients.runs import Run
from clutchwork.gradients.signals import signal_at
from clutchwork.sweeps.outputs import AtTimes, Output

Array = NDArray[np.float64]


def traces_of(outputs: Iterable[Output]) -> list[AtTimes]:
    """Those that are signals at instants."""
    return [one for one in outputs if isinstance(one, AtTimes)]


def merged(run: Run, outputs: Mapping[str, Output], measured: tuple[Array, Array]) -> tuple[Array, Array]:
    """Values and derivatives of all outputs in their order, of a forward run: signals at instants and measures."""
    values, matrices, at = list[Array](), list[Array](), 0
    for one in outputs.values():
        if isinstance(one, AtTimes):
            value, matrix = _trace(run, one)
        else:
            value, matrix = measured[0][at : at + 1], measured[1][at : at + 1]
            at += 1
        values.append(value)
        matrices.append(matrix)
    return np.concatenate(values), np.concatenate(matrices)


def _trace(run: Run, one: AtTimes) -> tuple[Array, Array]:
    primal, tangents = run.primal, run.tangents
    rows = np.searchsorted(primal.times, one.times)
    known, matrix = weights(primal.forms[one.signal], primal.rows[rows]), np.zeros((len(rows), primal.numbers))
    for column, line in zip(known.columns.tolist(), known.values.T, strict=True):
        matrix += line[:, None] * tangents[rows, column]
    if one.signal in primal.bent:
        matrix += primal.bent[one.signal][rows]
    return signal_at(primal, one.signal, rows), matrix


def at_events(run: Run, outputs: Iterable[Output]) -> Iterator[tuple[str, float]]:
    """Signals that are asked for at the instant of an event that moves, each with that instant [s]."""
    asked = [(one.signal, np.array(one.times)) for one in traces_of(outputs)]
    for number, time in enumerate(run.primal.events[:, 0].tolist()):
        met = [name for name, own in asked if np.any(np.abs(own - time) <= SAME * (1.0 + np.abs(own)))]
        moves = run.primal.functional()
        moves.add_event(number, 1.0)
        if met and np.any(run.slope(moves)):
            yield from ((f"{name} at {time:.12g} s", time) for name in met)


def at_knots(run: Run, outputs: Iterable[Output]) -> Iterator[tuple[str, float]]:
    """Signals that bend with a knot that moves and are asked for at its instant [s], each with that."""
    primal = run.primal
    for one in traces_of(outputs):
        times = np.array(one.times)
        columns = weights(primal.forms[one.signal], primal.rows[:1]).columns
        for time in times[primal.bends_at(columns, times)].tolist():
            yield f"{one.signal} at {time:.12g} s", time
