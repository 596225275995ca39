"""What a notebook shows of a signal: its curve over time, and its parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.plot import declared
from clutchwork.plot.curves import thinned
from clutchwork.plot.figure import figure_of
from clutchwork.plot.style import COLOURS, MILLIMETRE
from clutchwork.signals.bases.waveform import piece_value

if TYPE_CHECKING:
    from clutchwork.declare.node import Segment, Signal
    from clutchwork.plot.canvas import Picture


SIZE = (130.0, 45.0)  # mm
PERIODS, FINE = 3.0, 400
# of a table with more points only so many are drawn, none of whose peaks is lost
MOST_POINTS = 20_000


def parts(signal: Signal) -> tuple[Picture | None, list[str]]:
    """The curve and the parameters; no curve of a signal that a function sets."""
    return declared.parts(signal, lambda: None if (found := curve(signal)) is None else _picture(signal, *found))


def curve(signal: Signal) -> tuple[Array, Array] | None:
    """Times [s] and values, both limits at a jump; None where it has no values of its own."""
    points = getattr(signal, "points", None)
    if points is not None:
        return _table(np.asarray(points, dtype=float).reshape(-1, 2))
    pieces, period = list(signal.segments()), signal.repeats()
    if not pieces:
        return None
    first, end = pieces[0].start, _end(pieces, period)
    if period > 0.0:
        rounds = range(int(max(0.0, end - first) // period) + 1)
        pieces = [piece._replace(start=piece.start + number * period) for number in rounds for piece in pieces]
        # until they begin, it rests at the value with which the last piece starts
        pieces = [*([type(pieces[0])(0.0, piece_value(pieces[-1], pieces[-1].start))] if first > 0.0 else []), *pieces]
    # what begins at the end is not seen
    pieces = [piece for piece in pieces if piece.start < end] or pieces[:1]
    stops = [*(piece.start for piece in pieces[1:]), end]
    parts = [_piece(piece, max(piece.start, 0.0), min(stop, end)) for piece, stop in zip(pieces, stops, strict=True)]
    return np.concatenate([t for t, _ in parts]), np.concatenate([y for _, y in parts])


def _table(points: Array) -> tuple[Array, Array]:
    time, values = points.T
    beyond = 0.1 * (time[-1] - max(0.0, time[0])) or 1.0
    time = np.concatenate([[min(0.0, time[0])], time, [time[-1] + beyond]])
    return thinned(time, np.concatenate([values[:1], values, values[-1:]]), MOST_POINTS)


def _end(pieces: list[Segment], period: float) -> float:
    """A time by which it has shown what it does [s]."""
    if period > 0.0:
        return max(0.0, pieces[0].start) + PERIODS * period
    waves = [wave for piece in pieces for wave in piece.waves if wave[1] != 0.0]
    last = max(0.0, pieces[-1].start)
    return last + PERIODS * 2.0 * np.pi / abs(waves[0][1]) if waves else 1.2 * last or 1.0


def _piece(piece: Segment, begin: float, end: float) -> tuple[Array, Array]:
    straight = not piece.waves and piece.c2 == 0.0 and piece.c3 == 0.0
    time = np.linspace(begin, max(begin, end), 2 if straight else FINE)
    return (time, np.array([piece_value(piece, t) for t in time.tolist()])) if end >= begin else (time[:0], time[:0])


def _picture(signal: Any, time: Array, values: Array) -> Picture:
    with figure_of(SIZE[1], formulas=False, width=SIZE[0] * MILLIMETRE) as figure:
        axes = figure.subplots()
        axes.plot(time, values, color=COLOURS[0])
        axes.set_xlim(float(time[0]), float(time[-1]))
        axes.margins(y=0.1)
        axes.set_xlabel("time, s")
        unit = signal.unit() if hasattr(signal, "unit") else ""
        axes.set_ylabel(f"value, {unit}" if unit else "value, SI")
        return figure
