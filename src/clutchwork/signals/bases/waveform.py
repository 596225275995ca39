"""Evaluation of signals in Python, and their exact response to a low pass."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from itertools import chain
from math import comb, exp, pi, sin

from clutchwork.base import dataclass
from clutchwork.declare import Segment, Signal

# amplitude, omega, phase, decay
Wave = tuple[float, float, float, float]


@dataclass(frozen=True)
class Filtered(Signal):
    """A signal that has passed a low pass."""

    pieces: tuple[Segment, ...]

    def segments(self) -> tuple[Segment, ...]:
        """Exact pieces of the response."""
        return self.pieces


def value(signal: Signal, time: float) -> float:
    """Value of a signal at a time [s]; of one that is set from outside: 0."""
    return value_of(signal.segments(), signal.repeats(), time)


def value_of(pieces: Sequence[Segment], period: float, time: float) -> float:
    """The same from its pieces and its period."""
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
    if piece.amplitude == 0.0 and piece.amplitude_2 == 0.0:
        return smooth
    return smooth + sum(size * exp(-decay * s) * sin(omega * s + phase) for size, omega, phase, decay in piece.waves)


def low_pass(signal: Signal, cutoff: float) -> Filtered:
    """Exact response of dy/dt = 2 pi cutoff (signal - y), y(0) = signal(0).

    ValueError for signals whose response is not a cubic with two waves: pulses, and values from outside.
    """
    pieces, rate = signal.segments(), 2 * pi * cutoff
    if not pieces or signal.repeats() > 0.0 or not all(_passes(piece, rate) for piece in pieces):
        raise ValueError("only constants, steps, ramps, tables, columns and sines can pass the filter exactly")
    made = list[Segment]()
    state = value(signal, 0.0)
    for piece, end in zip(pieces, [*(piece.start for piece in pieces[1:]), None], strict=True):
        if end is not None and end <= 0.0:
            continue
        piece = moved(piece, 0.0) if piece.start < 0.0 or not made else piece
        made.append(_filtered(piece, rate, state))
        state = piece_value(made[-1], end) if end is not None else state
    return Filtered(tuple(made))


def _passes(piece: Segment, rate: float) -> bool:
    """One wave, which does not decay at the rate of the filter itself: that would be resonance."""
    return len(piece.waves) < 2 and all(complex(rate - decay, omega) != 0 for _, omega, _, decay in piece.waves)


def moved(piece: Segment, start: float) -> Segment:
    """The same function written about another start; one that begins later is held constant before."""
    if piece.start > start:
        return Segment(start, piece_value(piece, piece.start))
    s, c = start - piece.start, piece[1:5]
    moved = [sum(c[j] * comb(j, i) * s ** (j - i) for j in range(i, 4)) for i in range(4)]
    waves = [(size * exp(-decay * s), omega, phase + omega * s, decay) for size, omega, phase, decay in piece.waves]
    return Segment(start, *moved, *chain(*waves))


def _filtered(piece: Segment, rate: float, state: float) -> Segment:
    """Particular solution of cubic and wave, and what is left of the state, decaying.

    For a cubic u: u - u'/rate + u''/rate^2 - u'''/rate^3.
    """
    steady = list(piece[1:5])
    derivative = steady
    for order in (1, 2, 3):
        derivative = [(k + 1) * c for k, c in enumerate(derivative[1:])]
        for k, c in enumerate(derivative):
            steady[k] += (-1) ** order * c / rate**order
    waves = [_answer(wave, rate) for wave in piece.waves]
    left = state - steady[0] - sum(size * sin(phase) for size, _, phase, _ in waves)
    return Segment(piece.start, *steady, *chain(*waves, (left, 0.0, pi / 2, rate)))


def _answer(wave: Wave, rate: float) -> Wave:
    """A wave behind the filter: exp((i omega - decay) s) becomes rate/(rate + i omega - decay) times that."""
    size, omega, phase, decay = wave
    gain = rate / complex(rate - decay, omega)
    return size * abs(gain), omega, phase + cmath.phase(gain), decay
