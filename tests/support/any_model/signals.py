"""Values of signals at instants, from their pieces."""

from __future__ import annotations

from math import exp, sin
from typing import Any

import clutchwork as cw

# s before and behind an instant
BESIDE = 1e-12


def sides(signal: Any, time: float) -> tuple[float, float, float]:
    """Value of a signal just before an instant, at it, and just behind it."""
    if not isinstance(signal, cw.Signal):
        return float(signal), float(signal), float(signal)
    # at a knot at which it turns around both neighbours are on one side of its own value
    before, here, behind = (_value(signal, time, side * BESIDE * max(1.0, time)) for side in (-1.0, 0.0, 1.0))
    return before, here, behind


def _value(signal: cw.Signal, time: float, aside: float) -> float:
    """Value at an instant of the piece that lies a little aside: a ramp may be steep."""
    pieces, period, at = signal.segments(), signal.repeats(), time + aside
    if period and at >= pieces[0].start:
        at = pieces[0].start + (at - pieces[0].start) % period
    reached = [piece for piece in pieces if piece.start <= at]
    # before the first of pieces that repeat the last one holds
    piece, s = (reached[-1], at - reached[-1].start) if reached else (pieces[-1 if period else 0], 0.0)
    s -= aside
    waves = sum(size * exp(-decay * s) * sin(omega * s + phase) for size, omega, phase, decay in piece.waves)
    return piece.c0 + s * (piece.c1 + s * (piece.c2 + s * piece.c3)) + waves
