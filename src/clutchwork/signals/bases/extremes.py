"""Where a signal is largest and smallest, for the bounds of what it drives."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, ceil, inf, isfinite, pi, sqrt
from typing import NamedTuple

from clutchwork.declare.node import Segment, Signal
from clutchwork.signals.bases.waveform import piece_value

# what a straight piece has behind its value and slope
STRAIGHT = Segment(0.0)[3:]
# time constants after which a wave has died away, to some 1e-17 of itself
SETTLED = 40.0
# of the terms of a piece: what it misses at its end of the value with which the next one begins, or of zero
ROUND_OFF, NOTHING = 1e-13, 1e-15


class Reached(NamedTuple):
    """A value that a signal takes."""

    time: float  # s
    value: float


def extremes(signal: Signal) -> Iterator[Reached]:
    """Values of a signal at and after 0 s where one of its pieces begins, ends or turns; none of one set from outside.

    They hold the smallest and the largest value of every signal whose pieces are a cubic or one wave, except for a
    cubic without end.
    """
    pieces, period = signal.segments(), signal.repeats()
    ends = [piece.start for piece in pieces[1:]]
    ends += [pieces[0].start + period if period > 0.0 else inf] if pieces else []
    behind = [*pieces[1:], pieces[0] if period > 0.0 else None] if pieces else []
    for piece, end, after in zip(pieces, ends, behind, strict=True):
        # what repeats comes again after 0 s
        first = piece.start if period > 0.0 else max(piece.start, 0.0)
        for time in _times(piece, first, end) if end > first else ():
            value = piece_value(piece, time)
            if after is not None and time == end:
                value = _joined(piece, value, time, piece_value(after, after.start))
            if isfinite(value):
                yield Reached(time, value)


def _joined(piece: Segment, value: float, time: float, after: float) -> float:
    """The value at the end of a piece: that with which the next one begins, where it goes on without a jump."""
    size = abs(piece.c0) + abs(piece.c1) * (abs(piece.start) + abs(time))
    if abs(value - after) <= ROUND_OFF * (size + abs(after)):
        return after
    return value if abs(value) > NOTHING * size else 0.0


def _times(piece: Segment, first: float, end: float) -> Iterator[float]:
    """Both ends of a piece, of one without end where its waves have died away, and where it turns between them."""
    if piece[3:] == STRAIGHT:
        yield from (first, end if end < inf else first)
        return
    yield first
    yield from (piece.start + s for s in sorted(_turns(piece, first - piece.start)) if first < piece.start + s < end)
    yield end if end < inf else first + SETTLED / min((wave[3] for wave in piece.waves if wave[3] > 0.0), default=inf)


def _turns(piece: Segment, first: float) -> Iterator[float]:
    """Zeros of the slope of the cubic, and the two crests of each wave that follow `first`, from the start [s]."""
    b, a = 2.0 * piece.c2, 3.0 * piece.c3
    root = b * b - 4.0 * a * piece.c1
    if a != 0.0 and root >= 0.0:
        yield from ((-b - sqrt(root)) / (2.0 * a), (-b + sqrt(root)) / (2.0 * a))
    elif a == 0.0 and b != 0.0:
        yield -piece.c1 / b
    for _, omega, phase, decay in piece.waves:
        if omega != 0.0:
            crest = (atan2(omega, decay) - phase) / omega
            skipped = ceil((first - crest) * omega / pi)
            yield from (crest + (skipped + k) * pi / omega for k in range(2))
