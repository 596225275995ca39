"""What tables of friction coefficients have in common: how they interpolate, and what is wrong with their points."""

from __future__ import annotations

from typing import TYPE_CHECKING

from clutchwork.node import Law
from clutchwork.schema import choice, family

if TYPE_CHECKING:
    from collections.abc import Sequence

# points that each interpolation needs along every axis
FEWEST = {"linear": 2, "smooth": 3}

Found = list[tuple[str, str, str]]


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
    extrapolation: str = choice(
        "beyond the ends: continued by the slope there, kept at the nearest value, or the run ends with an error",
        choices=("linear", "nearest", "error"),
        default="linear",
    )


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
            return [(field, f"is {value:g} at {place:g} {unit}, must be > 0", "every coefficient is above zero")]
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
    """A table over the slip that does not start where every engagement ends."""
    if first == 0.0:
        return []
    fault = f"starts at {first:g} {unit}, must start at 0"
    return [(field, fault, "give the coefficient at vanishing slip; negative slip mirrors positive")]
