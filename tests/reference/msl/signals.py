"""Signals of a case: as pieces, and as clutchwork signals."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import clutchwork as cw
from clutchwork.declare.node import Segment, Signal

from .pieces import Piece, Pieces, UnsupportedError, Wave, at, product, scaled, total

Signals = Mapping[str, Any]
# a signal by its name, a plain number, or a description in place
Name = str | float | Mapping[str, Any]


@dataclass(frozen=True)
class Composed(Signal):
    """A signal of pieces that no declared signal has."""

    kind: ClassVar[str] = "composed"

    pieces: Pieces

    def segments(self) -> tuple[Segment, ...]:
        """The pieces as the core evaluates them."""
        return tuple(piece.segment() for piece in self.pieces)


def describe(signals: Signals, name: Name) -> Mapping[str, Any]:
    """The entry of a signal."""
    if isinstance(name, (int, float)):
        return {"type": "constant", "k": name}
    return signals[name] if isinstance(name, str) else name


def pieces(signals: Signals, name: Name, t_end: float) -> Pieces:
    """Any signal of CONVENTIONS.md from time 0 to t_end."""
    s = describe(signals, name)
    if s["type"] in KINDS:
        return KINDS[s["type"]](signals, s, t_end)
    raise UnsupportedError(f"signal {s['type']}")


def _constant(signals: Signals, s: Mapping[str, Any], t_end: float) -> Pieces:
    return (Piece(0.0, (float(s["k"]),)),)


def _points(points: list[tuple[float, float]]) -> Pieces:
    """Linear between points, equal times a jump, held outside."""
    made = [Piece(0.0, (points[0][1],))]
    for (t, y), (t_next, y_next) in itertools.pairwise(points):
        if t_next > t:
            made.append(Piece(t, (y, (y_next - y) / (t_next - t))))
    made.append(Piece(points[-1][0], (points[-1][1],)))
    return _from_zero(made)


def _from_zero(made: list[Piece]) -> Pieces:
    """Without what lies before time 0 or is replaced at once."""
    last = {max(piece.start, 0.0): piece for piece in made}
    return tuple(piece.moved(start) for start, piece in sorted(last.items()))


def _offset_start(s: Mapping[str, Any]) -> tuple[float, float]:
    return float(s.get("offset", 0.0)), float(s.get("start_time", 0.0))


def _step(signals: Signals, s: Mapping[str, Any], t_end: float) -> Pieces:
    offset, start = _offset_start(s)
    return _points([(start, offset), (start, offset + float(s["height"]))])


def _ramp(signals: Signals, s: Mapping[str, Any], t_end: float) -> Pieces:
    offset, start = _offset_start(s)
    return _points([(start, offset), (start + float(s["duration"]), offset + float(s["height"]))])


def _table(signals: Signals, s: Mapping[str, Any], t_end: float) -> Pieces:
    if s.get("interpolation", "linear") != "linear" or s.get("extrapolation", "hold") != "hold":
        raise UnsupportedError("a table that is not linear and held outside")
    return _points([(float(t), float(y)) for t, y in s["points"]])


def _pulse(signals: Signals, s: Mapping[str, Any], t_end: float) -> Pieces:
    offset, start = _offset_start(s)
    period = float(s["period"])
    made = [Piece(0.0, (offset,))]
    for number in range(math.ceil(max(0.0, t_end - start) / period) + 1):
        rise = start + number * period
        made += [Piece(rise, (offset + float(s["amplitude"]),)), Piece(rise + width(s), (offset,))]
    return _from_zero(made)


def width(s: Mapping[str, Any]) -> float:
    """Duration of a pulse [s]; its width is given in % of the period."""
    return float(s["period"]) * float(s["width"]) / 100.0


def _sine(signals: Signals, s: Mapping[str, Any], t_end: float) -> Pieces:
    offset, start = _offset_start(s)
    wave = Wave(
        float(s["amplitude"]),
        2.0 * math.pi * float(s["f"]),
        float(s.get("phase", 0.0)),
        float(s["damping"]) if s["type"] == "exp_sine" else 0.0,
    )
    return _from_zero([Piece(min(0.0, start), (offset,)), Piece(start, (offset,), (wave,))])


def _operands(s: Mapping[str, Any]) -> list[Name]:
    """What a signal is made of: a list `inputs`, or one key for each."""
    if "inputs" in s:
        return list(s["inputs"])
    return [value for key, value in s.items() if key not in ("type", "k")]


def _gain(signals: Signals, s: Mapping[str, Any], t_end: float) -> Pieces:
    return scaled(pieces(signals, _operands(s)[0], t_end), float(s["k"]))


def _product(signals: Signals, s: Mapping[str, Any], t_end: float) -> Pieces:
    first, *others = (pieces(signals, name, t_end) for name in _operands(s))
    for other in others:
        first = product(first, other)
    return first


def _difference(signals: Signals, s: Mapping[str, Any], t_end: float) -> Pieces:
    plus, minus = (s["plus"], s["minus"]) if "plus" in s else _operands(s)
    return total(pieces(signals, plus, t_end), scaled(pieces(signals, minus, t_end), -1.0))


def _gain_sin_atan(signals: Signals, s: Mapping[str, Any], t_end: float) -> Pieces:
    inner = pieces(signals, _operands(s)[0], t_end)
    return levels(inner, lambda y: float(s["k"]) * math.sin(math.atan(y)))


def levels(inner: Pieces, function: Any) -> Pieces:
    """A function of a signal that changes in steps only."""
    if any(piece.degree or piece.waves for piece in inner):
        raise UnsupportedError("a curved function of a signal that varies continuously")
    return tuple(Piece(piece.start, (function(piece.poly[0]),)) for piece in inner)


KINDS = {
    "constant": _constant,
    "step": _step,
    "ramp": _ramp,
    "table": _table,
    "pulse": _pulse,
    "sine": _sine,
    "exp_sine": _sine,
    "gain": _gain,
    "product": _product,
    "difference": _difference,
    "gain_sin_atan": _gain_sin_atan,
}


def signal(signals: Signals, name: Name, t_end: float, scale: float = 1.0) -> Any:
    """The clutchwork signal of that name, times scale."""
    s = describe(signals, name)
    offset, start = _offset_start(s)
    if s["type"] in ("sine", "exp_sine"):
        return cw.Sine(
            amplitude=scale * float(s["amplitude"]),
            frequency=float(s["f"]),
            phase=float(s.get("phase", 0.0)),
            damping=float(s["damping"]) if s["type"] == "exp_sine" else 0.0,
            offset=scale * offset,
            start=start,
        )
    if s["type"] == "pulse" and 0.0 < float(s["width"]) < 100.0:
        shape = {"height": scale * float(s["amplitude"]), "period": float(s["period"]), "width": width(s)}
        return cw.Pulse(**shape, offset=scale * offset, start=start)
    return as_signal(scaled(pieces(signals, name, t_end), scale), t_end)


def as_signal(made: Pieces, t_end: float) -> Any:
    """Pieces as a number, a table, or a signal of their own."""
    if any(piece.degree > 1 or piece.waves for piece in made):
        return Composed(made)
    if len(made) == 1 and made[0].degree == 0:
        return made[0].poly[0]
    points = []
    for piece, end in itertools.zip_longest(made, [p.start for p in made[1:]], fillvalue=None):
        stop = max(t_end, made[-1].start) + 1.0 if end is None else end
        points += [(piece.start, piece(piece.start)), (stop, piece(stop))]
    return cw.Table([p for i, p in enumerate(points) if i == 0 or p != points[i - 1]])


def first_value(signals: Signals, name: Name) -> float:
    """The signal at time 0."""
    return at(pieces(signals, name, 0.0), 0.0)(0.0)
