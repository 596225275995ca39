"""Common base of tables of friction coefficients: interpolation, and checks of their points."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import inf

from clutchwork.declare import Law, Points, choice, family

# points that each interpolation needs along every axis
FEWEST = {"linear": 2, "smooth": 3}

Found = list[tuple[str, str, str]]


def beyond_the_ends() -> str:
    """How a table of coefficients continues beyond its ends."""
    chosen: str = choice(
        "beyond the ends: continued by the slope there until it falls to zero, kept at the nearest value, or the run"
        " ends with an error",
        choices=("linear", "nearest", "error"),
        default="nearest",
    )
    return chosen


@family
class Tabulated(Law):
    """A law whose coefficients are tables.

    Smooth is the monotone cubic of F. N. Fritsch, R. E. Carlson 1980, doi:10.1137/0717021: continuous with its slope,
    and never outside of the two points beside it.
    """

    interpolation: str = choice(
        "between the points: straight lines, or smooth with a continuous slope and without overshoot",
        choices=("linear", "smooth"),
        default="linear",
    )
    extrapolation: str = beyond_the_ends()


def few_points(field: str, count: int, interpolation: str) -> Found:
    """Fewer points along an axis than the interpolation needs."""
    fewest = FEWEST[interpolation]
    if count >= fewest:
        return []
    fault = f"has {count} points, {interpolation} interpolation needs at least {fewest}"
    return [(field, fault, "give more points" if fewest == 2 else 'give more points, or interpolation "linear"')]


def not_positive(field: str, values: Sequence[float], unit: str, places: Sequence[float]) -> Found:
    """A coefficient that is not above zero."""
    for value, place in zip(values, places, strict=True):
        if not value > 0.0:
            return [(field, f"is {value:g} at {place:g} {unit}, must be > 0", "give coefficients above zero")]
    return []


def crossing(static: Sequence[float], kinetic: Sequence[float], unit: str, places: Sequence[float]) -> Found:
    """Static coefficients that are not above their kinetic one."""
    return [
        (
            "static",
            f"is {own:g} at {place:g} {unit}, not above the kinetic coefficient {other:g}",
            f"raise it above {other:g}, or lower the kinetic one",
        )
        for own, other, place in zip(static, kinetic, places, strict=True)
        if not own > other
    ]


def slip_axis(field: str, first: float, unit: str) -> Found:
    """A table over the slip that does not start at zero slip, where every engagement ends."""
    if first == 0.0:
        return []
    fault = f"starts at {first:g} {unit}, must start at 0"
    return [(field, fault, "give the coefficient at vanishing slip; negative slip mirrors positive")]


# beyond this slip [rad/s] and this temperature [K] nobody continues a table
FASTEST, HOTTEST = 1e4, 2000.0
KEEP = 'give points up to there, or extrapolation "nearest" or "error"'


def continued(field: str, tables: Sequence[Points], unit: str, extrapolation: str, interpolation: str) -> Found:
    """The first places where tables that are continued linearly fall to zero, over the slip or the temperature."""
    if extrapolation != "linear" or few_points(field, min(map(len, tables)), interpolation):
        return []
    smooth = interpolation == "smooth"
    upper = min(vanishing(points, smooth) for points in tables)
    ends = [upper] if upper <= (HOTTEST if unit == "K" else FASTEST) else []
    if unit == "K":
        # the same from the other end
        lower = max(-vanishing([(-x, y) for x, y in reversed(points)], smooth) for points in tables)
        ends += [lower] if lower >= 0.0 else []
    fault = "falls to zero at {:g} {} when it is extrapolated linearly; beyond that the contact transmits nothing"
    return [(field, fault.format(end, unit), KEEP) for end in ends]


def vanishing(points: Points, smooth: bool) -> float:
    """Where a table that is continued by its last slope falls to zero; infinite where it never does."""
    (x, y), secants = points[-1], [(b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(points)]
    slope = secants[-1]
    if smooth:
        width, before = points[-1][0] - points[-2][0], points[-2][0] - points[-3][0]
        slope = end_slope(secants[-1], secants[-2], width, before)
    return x - y / slope if slope < 0.0 else inf


def end_slope(near: float, following: float, width: float, next_width: float) -> float:
    """Slope of a smooth table at an end, docs/theory/clutches.md."""
    slope = ((2.0 * width + next_width) * near - width * following) / (width + next_width)
    if slope * near <= 0.0:
        return 0.0
    return 3.0 * near if near * following <= 0.0 and abs(slope) > abs(3.0 * near) else slope
