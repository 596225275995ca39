"""Speeds of prescribed motions from their positions and accelerations, as exact pieces: docs/theory/motions.md."""

from __future__ import annotations

import cmath
from collections.abc import Callable, Iterator
from itertools import chain
from math import pi, sqrt

from clutchwork.declare import Segment, Signal
from clutchwork.signals.bases.waveform import Filtered, Wave, moved, piece_value, value

# Bessel filter of second order whose amplitude is 1/sqrt(2) at the cutoff
AF, BF = 1.3617, 0.6180
# jump of a position that is round-off, over the terms of which it is made
ROUND_OFF = 1e-9


class SignalError(ValueError):
    """A signal without an exact piecewise form: what is wrong with it, and the remedy."""

    def __init__(self, message: str, remedy: str) -> None:
        super().__init__(message)
        self.message, self.remedy = message, remedy


def derivative(signal: Signal, unit: str) -> Filtered:
    """Time derivative of a signal that does not jump."""
    made, before, size = list[Segment](), None, 0.0
    for piece, end in _from_start(signal):
        here = piece_value(piece, piece.start)
        if before is not None and abs(here - before) > ROUND_OFF * max(abs(here), size):
            message = f"jumps by {here - before:g} {unit} at {piece.start:g} s, which takes an infinite speed"
            raise SignalError(message, "give it a ramp there, or a `cutoff`")
        made.append(_slope(piece))
        before, size = (None, 0.0) if end is None else (piece_value(piece, end), _terms(piece, end))
    return Filtered(tuple(made))


def _terms(piece: Segment, time: float) -> float:
    """Size of the terms that a value is the sum of."""
    lasts, sizes = time - piece.start, [piece.c0, piece.c1, piece.c2, piece.c3]
    return sum(abs(one) * lasts**power for power, one in enumerate(sizes)) + sum(abs(wave[0]) for wave in piece.waves)


def integral(signal: Signal, start: float) -> Filtered:
    """Integral over time, from a value at time zero."""
    made, state = list[Segment](), start
    for piece, end in _from_start(signal):
        if piece.c3 != 0.0:
            raise SignalError("has cubic pieces, whose integral is none", "give it as a table")
        made.append(_sum(piece, state))
        state = state if end is None else piece_value(made[-1], end)
    return Filtered(tuple(made))


def bessel(signal: Signal, cutoff: float, position: float, speed: float) -> Filtered:
    """Speed of a position with acceleration ((signal - position) w - AF speed) w/BF, w = 2 pi cutoff."""
    rate, made = 2 * pi * cutoff, list[Segment]()
    pole = rate / (2 * BF) * complex(-AF, sqrt(4 * BF - AF**2))
    for piece, end in _from_start(signal):
        answer = _answer(piece, rate)
        steady = _slope(answer)
        x, v = position - piece_value(answer, piece.start), speed - piece_value(steady, piece.start)
        # what is left of the start decays: position Im(c exp(pole s))
        c = complex((v - pole.real * x) / pole.imag, x)
        rest = _wave(c, pole)
        there = Segment(piece.start, *answer[1:5], *chain(*_fitting([*answer.waves, rest])))
        made.append(Segment(piece.start, *steady[1:5], *chain(*_fitting([*steady.waves, _wave(c * pole, pole)]))))
        if end is not None:
            position, speed = piece_value(there, end), piece_value(made[-1], end)
    return Filtered(tuple(made))


def _from_start(signal: Signal) -> Iterator[tuple[Segment, float | None]]:
    """Pieces from time zero on, each with its end; constant waves are part of the cubic."""
    pieces = signal.segments()
    if not pieces or signal.repeats() > 0.0:
        remedy = "give a table, a column, a ramp, a step or a sine"
        raise SignalError("is set from outside, or repeats: nothing exact follows from it", remedy)
    ends: list[float | None] = [*(piece.start for piece in pieces[1:]), None]
    first = True
    for piece, end in zip(pieces, ends, strict=True):
        if end is not None and end <= 0.0:
            continue
        still = [wave for wave in piece.waves if wave[1] == 0.0 and wave[3] == 0.0]
        waves = [wave for wave in piece.waves if wave not in still]
        level = piece.c0 + sum(_value(wave) for wave in still)
        plain = Segment(piece.start, level, *piece[2:5], *chain(*waves))
        yield (moved(plain, 0.0) if plain.start < 0.0 or first else plain), end
        first = False


def _value(wave: Wave) -> float:
    """A wave at its start."""
    return (wave[0] * cmath.exp(1j * wave[2])).imag


def _slope(piece: Segment) -> Segment:
    """Derivative of a piece."""
    cubic = (piece.c1, 2 * piece.c2, 3 * piece.c3, 0.0)
    return Segment(piece.start, *cubic, *chain(*(_through(wave, lambda e: e) for wave in piece.waves)))


def _sum(piece: Segment, start: float) -> Segment:
    """Integral of a piece from a value on."""
    waves = [_through(wave, lambda e: 1 / e) for wave in piece.waves]
    level = start - sum(_value(wave) for wave in waves)
    return Segment(piece.start, level, piece.c0, piece.c1 / 2, piece.c2 / 3, *chain(*waves))


def _answer(piece: Segment, rate: float) -> Segment:
    """Particular solution of BF/rate^2 x'' + AF/rate x' + x = piece."""
    cubic = list(piece[1:5])
    for k in (2, 1, 0):
        cubic[k] -= AF / rate * (k + 1) * cubic[k + 1]
        if k < 2:
            cubic[k] -= BF / rate**2 * (k + 2) * (k + 1) * cubic[k + 2]
    through = [_through(wave, lambda e: 1 / (BF * (e / rate) ** 2 + AF * e / rate + 1)) for wave in piece.waves]
    return Segment(piece.start, *cubic, *chain(*through))


def _through(wave: Wave, gain: Callable[[complex], complex]) -> Wave:
    """A wave behind a linear system, which answers exp(e s) with gain(e) exp(e s)."""
    size, omega, phase, decay = wave
    try:
        answer = gain(complex(-decay, omega))
    except ZeroDivisionError:
        raise SignalError("swings in resonance with the filter", "change `cutoff` a little") from None
    return size * abs(answer), omega, phase + cmath.phase(answer), decay


def _wave(c: complex, pole: complex) -> Wave:
    """Im(c exp(pole s))."""
    return abs(c), pole.imag, cmath.phase(c), -pole.real


def _fitting(waves: list[Wave]) -> list[Wave]:
    """The waves that are there; a piece has room for two."""
    found = [wave for wave in waves if wave[0] != 0.0]
    if len(found) > 2:
        raise SignalError("has two waves in a piece, too many behind a filter", "give it as a table")
    return found


def at_start(signal: Signal) -> float:
    """Its value at time zero."""
    return value(signal, 0.0)
