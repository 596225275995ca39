"""Signals as pieces, on which sums, products, integrals and filters are exact.

With s = t - start a piece is a polynomial of s plus waves, each amplitude exp(-decay s) sin(omega s + phase). The first
piece of a signal starts at 0; what a signal was before does not matter.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import zip_longest

from clutchwork.declare.node import Segment


class UnsupportedError(NotImplementedError):
    """The case needs something that clutchwork does not offer; the message is its name."""


@dataclass(frozen=True)
class Wave:
    """amplitude exp(-decay s) sin(omega s + phase)."""

    amplitude: float
    omega: float
    phase: float
    decay: float = 0.0

    def __call__(self, s: float) -> float:
        return self.amplitude * math.exp(-self.decay * s) * math.sin(self.omega * s + self.phase)

    def through(self, gain: complex) -> Wave:
        """The same wave after a linear system that answers exp((i omega - decay) s) with `gain` times it."""
        return replace(self, amplitude=self.amplitude * abs(gain), phase=self.phase + cmath.phase(gain))

    @property
    def exponent(self) -> complex:
        """Exponent of the complex exponential whose imaginary part the wave is."""
        return complex(-self.decay, self.omega)


@dataclass(frozen=True)
class Piece:
    """A stretch of a signal."""

    start: float
    poly: tuple[float, ...]
    waves: tuple[Wave, ...] = ()

    def __call__(self, time: float) -> float:
        s = time - self.start
        return sum(c * s**k for k, c in enumerate(self.poly)) + sum(wave(s) for wave in self.waves)

    def moved(self, start: float) -> Piece:
        """The same function, written about another start."""
        by, n = start - self.start, len(self.poly)
        poly = tuple(sum(self.poly[j] * math.comb(j, i) * by ** (j - i) for j in range(i, n)) for i in range(n))
        waves = (
            replace(w, amplitude=w.amplitude * math.exp(-w.decay * by), phase=w.phase + w.omega * by)
            for w in self.waves
        )
        return Piece(start, poly, tuple(waves))

    @property
    def degree(self) -> int:
        """Degree of the polynomial, leading zeros left out."""
        return max((k for k, c in enumerate(self.poly) if c != 0.0), default=0)

    def slope(self) -> Piece:
        """Derivative over time."""
        poly = tuple(k * c for k, c in enumerate(self.poly))[1:] or (0.0,)
        return Piece(self.start, poly, tuple(w.through(w.exponent) for w in self.waves))

    def integral(self, value: float) -> Piece:
        """Antiderivative with a value at the start."""
        poly = (0.0, *(c / (k + 1) for k, c in enumerate(self.poly)))
        made = Piece(self.start, poly, tuple(w.through(1 / w.exponent) for w in self.waves))
        return Piece(self.start, (value - made(self.start), *poly[1:]), made.waves)

    def segment(self) -> Segment:
        """What the core evaluates."""
        if self.degree > 3 or len(self.waves) > 2:
            raise UnsupportedError("a signal with more than a cubic and two waves in a piece")
        cubic = (tuple(self.poly) + (0.0,) * 4)[:4]
        numbers = [x for w in self.waves for x in (w.amplitude, w.omega, w.phase, w.decay)]
        return Segment(self.start, *cubic, *numbers)


Pieces = tuple[Piece, ...]


def at(pieces: Pieces, time: float) -> Piece:
    """The piece that holds at a time; at a jump the later one."""
    return [piece for piece in pieces if piece.start <= time][-1]


def combine(a: Pieces, b: Pieces, how: Callable[[Piece, Piece], Piece]) -> Pieces:
    """Two signals, piece by piece."""
    starts = sorted({piece.start for piece in (*a, *b)})
    return tuple(how(at(a, t).moved(t), at(b, t).moved(t)) for t in starts)


def scaled(a: Pieces, factor: float) -> Pieces:
    """A signal times a number."""
    return tuple(_times(piece, Piece(piece.start, (factor,))) for piece in a)


def total(a: Pieces, b: Pieces) -> Pieces:
    """Sum."""

    def add(p: Piece, q: Piece) -> Piece:
        poly = tuple(x + y for x, y in zip_longest(p.poly, q.poly, fillvalue=0.0))
        return Piece(p.start, poly, p.waves + q.waves)

    return combine(a, b, add)


def product(a: Pieces, b: Pieces) -> Pieces:
    """Product."""
    return combine(a, b, _times)


def _times(p: Piece, q: Piece) -> Piece:
    if (p.waves and q.degree) or (q.waves and p.degree):
        raise UnsupportedError("the product of a wave and a signal that varies along a line")
    poly = [0.0] * (len(p.poly) + len(q.poly) - 1)
    for i, x in enumerate(p.poly):
        for j, y in enumerate(q.poly):
            poly[i + j] += x * y
    waves = [replace(w, amplitude=w.amplitude * q.poly[0]) for w in p.waves]
    waves += [replace(w, amplitude=w.amplitude * p.poly[0]) for w in q.waves]
    for w in p.waves:
        for v in q.waves:
            half, decay, quarter = 0.5 * w.amplitude * v.amplitude, w.decay + v.decay, 0.5 * math.pi
            waves.append(Wave(half, w.omega - v.omega, w.phase - v.phase + quarter, decay))
            waves.append(Wave(-half, w.omega + v.omega, w.phase + v.phase + quarter, decay))
    return _plain(Piece(p.start, tuple(poly), tuple(waves)))


def _plain(p: Piece) -> Piece:
    """Without waves that vanish or stand still."""
    still = [w for w in p.waves if w.exponent == 0]
    poly = (p.poly[0] + sum(w(0.0) for w in still), *p.poly[1:])
    return Piece(p.start, poly, tuple(w for w in p.waves if w.exponent != 0 and w.amplitude != 0.0))


def integral(a: Pieces, value: float) -> Pieces:
    """The integral over time from a value at time 0, continuous."""
    made: list[Piece] = []
    for piece in a:
        made.append(piece.integral(made[-1](piece.start) if made else value))
    return tuple(made)
