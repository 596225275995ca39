"""Evaluation of signals in Python, and their exact response to a low pass."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb, exp, pi, sin

from clutchwork.node import Segment, Signal


@dataclass(frozen=True)
class Filtered(Signal):
    """A signal that has passed a low pass."""

    pieces: tuple[Segment, ...]

    def segments(self) -> tuple[Segment, ...]:
        """Exact pieces of the response."""
        return self.pieces


def value(signal: Signal, time: float) -> float:
    """Value of a signal at a time [s]; of one that is set from outside: 0."""
    pieces, period = signal.segments(), signal.repeats()
    if not pieces:
        return 0.0
    first = pieces[0].start
    if period > 0.0 and time < first:
        return piece_value(pieces[-1], pieces[-1].start)
    if period > 0.0:
        time = first + (time - first) % period
    piece = next((piece for piece in reversed(pieces) if piece.start <= time), pieces[0])
    return piece_value(piece, time)


def piece_value(piece: Segment, time: float) -> float:
    """Value of one piece at a time [s]."""
    s = time - piece.start
    smooth = piece.c0 + s * (piece.c1 + s * (piece.c2 + s * piece.c3))
    return smooth + (
        piece.amplitude * exp(-piece.decay * s) * sin(piece.omega * s + piece.phase) if piece.amplitude else 0
    )


def low_pass(signal: Signal, cutoff: float) -> Filtered:
    """Exact response of dy/dt = 2 pi cutoff (signal - y), y(0) = signal(0).

    ValueError for signals whose response is no sum of a polynomial and one exponential: sines, pulses, functions.
    """
    pieces = signal.segments()
    if not pieces or signal.repeats() > 0.0 or any(piece.amplitude for piece in pieces):
        raise ValueError("only constants, steps, ramps, tables and columns can pass the filter exactly")
    rate, made = 2 * pi * cutoff, list[Segment]()
    state = value(signal, 0.0)
    for piece, end in zip(pieces, [*(piece.start for piece in pieces[1:]), None], strict=True):
        if end is not None and end <= 0.0:
            continue
        piece = _moved(piece, 0.0) if piece.start < 0.0 or not made else piece
        made.append(_filtered(piece, rate, state))
        state = piece_value(made[-1], end) if end is not None else state
    return Filtered(tuple(made))


def _moved(piece: Segment, start: float) -> Segment:
    """The same polynomial written about another start; one that begins later is held constant before."""
    if piece.start > start:
        return Segment(start, piece.c0)
    s, c = start - piece.start, piece[1:5]
    moved = [sum(c[j] * comb(j, i) * s ** (j - i) for j in range(i, 4)) for i in range(4)]
    return Segment(start, *moved)


def _filtered(piece: Segment, rate: float, state: float) -> Segment:
    """Particular solution u - u'/rate + u''/rate^2 - u'''/rate^3 plus what is left of the state, decaying."""
    steady = list(piece[1:5])
    derivative = steady
    for order in (1, 2, 3):
        derivative = [(k + 1) * c for k, c in enumerate(derivative[1:])]
        for k, c in enumerate(derivative):
            steady[k] += (-1) ** order * c / rate**order
    c0, c1, c2, c3 = steady
    return Segment(piece.start, c0, c1, c2, c3, amplitude=state - c0, phase=pi / 2, decay=rate)
