"""Signals of a case as clutchwork signals, scaled."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from typing import Any

import clutchwork as cw


class UnsupportedError(NotImplementedError):
    """The case needs something that clutchwork does not offer; the message is its name."""


Points = list[tuple[float, float]]


def _points(signals: Mapping[str, Any], name: str) -> Points | None:
    """A piecewise linear signal as points, None for any other."""
    s = signals[name]
    kind, offset, start = s["type"], float(s.get("offset", 0.0)), float(s.get("start_time", 0.0))
    if kind == "constant":
        return [(0.0, float(s["k"]))]
    if kind == "step":
        return [(start, offset), (start, offset + float(s["height"]))]
    if kind == "ramp":
        return [(start, offset), (start + float(s["duration"]), offset + float(s["height"]))]
    if kind == "table":
        return [(float(t), float(y)) for t, y in s["points"]]
    if kind == "gain":
        inner = _points(signals, s["input"])
        return None if inner is None else [(t, float(s["k"]) * y) for t, y in inner]
    if kind == "gain_sin_atan":
        inner = _points(signals, s["input"])
        # exact where the input is piecewise constant, which is so wherever two neighbours differ at one time only
        if inner is None or any(b[1] != a[1] and b[0] > a[0] for a, b in itertools.pairwise(inner)):
            raise UnsupportedError("signal gain_sin_atan of a varying input")
        return [(t, float(s["k"]) * math.sin(math.atan(y))) for t, y in inner]
    return None


def _thinned(points: Points) -> Points:
    """Without points that stand twice."""
    return [p for i, p in enumerate(points) if i == 0 or p != points[i - 1]]


def signal(signals: Mapping[str, Any], name: str, scale: float = 1.0) -> Any:
    """The signal of that name, times scale."""
    points = _points(signals, name)
    if points is not None:
        if len(points) == 1:
            return scale * points[0][1]
        return cw.Table([(t, scale * y) for t, y in _thinned(points)])
    s = signals[name]
    if s["type"] == "gain":
        return signal(signals, s["input"], scale * float(s["k"]))
    common = {"offset": scale * float(s.get("offset", 0.0)), "start": float(s.get("start_time", 0.0))}
    if s["type"] in ("sine", "exp_sine"):
        return cw.Sine(
            amplitude=scale * float(s["amplitude"]),
            frequency=float(s["f"]),
            phase=float(s.get("phase", 0.0)),
            damping=float(s.get("damping", 0.0)),
            **common,
        )
    if s["type"] == "pulse":
        period = float(s["period"])
        width = period * float(s["width"]) / 100.0
        return cw.Pulse(height=scale * float(s["amplitude"]), period=period, width=width, **common)
    raise UnsupportedError(f"signal {s['type']}")


def first_value(signals: Mapping[str, Any], name: str) -> float:
    """The signal at time 0."""
    points = _points(signals, name)
    if points is not None:
        at_zero = [y for t, y in points if t <= 0.0]
        return at_zero[-1] if at_zero else points[0][1]
    s = signals[name]
    if s["type"] == "gain":
        return float(s["k"]) * first_value(signals, s["input"])
    started = float(s.get("start_time", 0.0)) <= 0.0
    return float(s.get("offset", 0.0)) + started * float(s["amplitude"]) * math.sin(float(s.get("phase", 0.0)))
