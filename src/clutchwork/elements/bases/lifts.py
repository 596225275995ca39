"""Lifts of cams: periodic splines with two continuous derivatives. docs/theory/varying-ratios.md (16)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import pi
from typing import Any

from clutchwork.declare import Found

Pairs = list[tuple[float, float]]

TURN = 2.0 * pi
# three would have two pieces that know nothing of each other
FEWEST = 4
# of a table: round-off of numbers that were written with some ten digits
SLACK = 1e-9


def lift_problems(lift: Sequence[tuple[float, float]]) -> Found:
    """What makes a table no lift over one revolution, as (quantity, what is wrong, remedy)."""
    (first, low), (last, high) = lift[0], lift[-1]
    if len(lift) < FEWEST:
        return [("lift", f"has {len(lift)} points, must have at least {FEWEST}", "give points all around the cam")]
    if abs(last - first - TURN) > SLACK * TURN:
        fault = f"runs from {first:g} rad to {last:g} rad, must cover one revolution of {TURN:.10g} rad"
        return [("lift", fault, "let it end where it starts, one revolution later")]
    if abs(high - low) > SLACK * height(lift):
        fault = f"ends at {high:g} m and starts at {low:g} m: it does not close"
        return [("lift", fault, "let it end with the lift that it starts with")]
    return []


def height(lift: Sequence[tuple[float, float]]) -> float:
    """From the lowest to the highest point [m]."""
    heights = [y for _, y in lift]
    return float(max(heights) - min(heights))


def closed(lift: Sequence[Any]) -> Pairs:
    """The points of a lift; its end is its start, one revolution later."""
    points = [(float(x), float(y)) for x, y in lift]
    return [*points[:-1], (points[0][0] + TURN, points[0][1])]


def curvatures(points: Pairs) -> list[float]:
    """Second derivative of the periodic spline at each of its points [m/rad2]."""
    widths = [b[0] - a[0] for a, b in pairwise(points)]
    secants = [(b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(points)]
    before, middle = (
        [widths[-1], *widths[:-1]],
        [2.0 * (a + b) for a, b in zip([widths[-1], *widths], widths, strict=False)],
    )
    wanted = [6.0 * (b - a) for a, b in zip([secants[-1], *secants], secants, strict=False)]
    found = _cyclic(before, middle, widths, wanted)
    return [*found, found[0]]


def _cyclic(lower: list[float], middle: list[float], upper: list[float], wanted: list[float]) -> list[float]:
    """Solution of lower x(i-1) + middle x(i) + upper x(i+1) = wanted around a circle, by Sherman and Morrison."""
    corner = -middle[0]
    inner = [middle[0] - corner, *middle[1:]]
    inner[-1] -= upper[-1] * lower[0] / corner
    x = _tridiagonal(lower, inner, upper, wanted)
    z = _tridiagonal(lower, inner, upper, [corner, *[0.0] * (len(middle) - 2), upper[-1]])
    share = (x[0] + lower[0] * x[-1] / corner) / (1.0 + z[0] + lower[0] * z[-1] / corner)
    return [a - share * b for a, b in zip(x, z, strict=True)]


def _tridiagonal(lower: list[float], middle: list[float], upper: list[float], wanted: list[float]) -> list[float]:
    """The same on a line; the first of the lower and the last of the upper numbers do not count."""
    pivots, right = middle[:1], wanted[:1]
    for i in range(1, len(middle)):
        share = lower[i] / pivots[-1]
        pivots.append(middle[i] - share * upper[i - 1])
        right.append(wanted[i] - share * right[-1])
    found = [right[-1] / pivots[-1]]
    for i in reversed(range(len(middle) - 1)):
        found.append((right[i] - upper[i] * found[-1]) / pivots[i])
    return found[::-1]


def slope_at(points: Pairs, curvature: Sequence[float], angle: float) -> float:
    """Derivative of a lift at an angle of its table, or of the revolution before it [m/rad].

    From the nearer end of its piece: an angle a little before zero is known better than one a little before 2 pi.
    """
    back = TURN if angle < points[0][0] else 0.0
    k = max(i for i, (x, _) in enumerate(points[:-1]) if i == 0 or x - back <= angle)
    near, far = angle - (points[k][0] - back), angle - (points[k + 1][0] - back)
    bend = (curvature[k + 1] - curvature[k]) / (2.0 * (points[k + 1][0] - points[k][0]))
    if near <= -far:
        return slope_of(points, curvature, k, 0) + near * (curvature[k] + near * bend)
    return slope_of(points, curvature, k, 1) + far * (curvature[k + 1] + far * bend)


def slope_of(points: Pairs, curvature: Sequence[float], k: int, end: int) -> float:
    """Derivative at the start, 0, or the end, 1, of piece k [m/rad]."""
    (x0, y0), (x1, y1) = points[k : k + 2]
    secant, width = (y1 - y0) / (x1 - x0), x1 - x0
    near, far = curvature[k + end], curvature[k + 1 - end]
    return secant + (2 * end - 1) * width * (2.0 * near + far) / 6.0
