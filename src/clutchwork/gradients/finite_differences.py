"""Derivatives of smooth functions by differences of high order, with a measure of their error.

docs/theory/gradients.md (11)
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.errors import ModelError

Array = NDArray[np.float64]

# first width, over the scale of the number: rounding leaves 1e-13 of the derivative, the eighth order far less
WIDTH = 5e-3
NARROWER = 1 / 6
MOST_TRIES = 5
# what two orders may differ by, of the size of the derivative
ALLOWED = 1e-9
# and of the value over the number: weights that are solved for have more round-off than their sums
LOST = 3e-11
# of a value, and of a sum of the largest part of it
ROUND_OFF = 4e-16
# what is said where there is no value on both sides
TIED = "others tie it, so that no value beside it is allowed and there is no derivative"
CENTRAL = tuple(k for k in range(-4, 5) if k)
UPWARD = tuple(range(7))


class Difference(NamedTuple):
    """A derivative, and whether the function is a straight line as far as was looked."""

    value: Array
    straight: bool


class Bent(Exception):  # noqa: N818, it is caught where it is raised
    """A function that has no derivative: it jumps or has a kink."""


class Refused(Bent):
    """A function that has no value on both sides, up to as near as it is looked at."""


class Rebuilt(Exception):  # noqa: N818, it is caught where it is raised
    """A function is another one there."""


def slope(
    function: Callable[[float], Array], here: Array, own: float, scale: float, reach: float, noise: Array
) -> Difference:
    """The derivative of a function at 0, by differences over steps of the scale of its argument.

    Parameters: function, raises ModelError where it is not defined, so that one side is asked alone, and Rebuilt where
    it is another one; here, its value at 0; own, the size of the number that its argument changes; scale, what that is
    compared with, or 0: right beside zero steps of its own size leave round-off; reach, how far it is the same; noise,
    round-off of its values that are left of larger ones. Bent where it has no derivative, Refused where it is that for
    want of values.
    """
    size = max(own, scale) or 1.0
    try:
        return _slope(function, here, size, reach, noise)
    except Refused:
        # nearer by the round-off that start values may contradict each other by is forgiven
        raise
    except Bent:
        if own in {0.0, size}:
            raise
        return _slope(function, here, own, reach, noise)


def _slope(function: Callable[[float], Array], here: Array, scale: float, reach: float, noise: Array) -> Difference:
    width, lost = min(WIDTH * scale, reach / 5), LOST * np.abs(here) / scale
    for number in range(MOST_TRIES):
        found = _tried(function, CENTRAL, here, width, noise, lost)
        if found is None and number >= MOST_TRIES - 2:
            sides = (_tried(function, tuple(sign * k for k in UPWARD), here, width, noise, lost) for sign in (1, -1))
            # of a kink both sides would have one
            found = next(filter(None, sides), None) if not _is_defined(function, width) else None
        if found is not None:
            return found
        width *= NARROWER
    refused = [_refused(function, side) for side in (width / NARROWER, -width / NARROWER)]
    if all(refused):
        raise Refused(f"{TIED}; a little more of it: {_refused(function, WIDTH * scale) or refused[0]}")
    raise Bent(_why(function, width))


def _refused(function: Callable[[float], Array], step: float) -> str:
    """Why a function has no value there; nothing where it has one, or is another one."""
    try:
        function(step)
    except ModelError as error:
        return str(error.problems[0])
    except Rebuilt:
        pass
    return ""


def _is_defined(function: Callable[[float], Array], width: float) -> bool:
    """Whether a function has values on both sides."""
    try:
        return all(len(function(side)) for side in (-width, width))
    except ModelError:
        return False
    except Rebuilt:
        return True


def _why(function: Callable[[float], Array], width: float) -> str:
    """Why a function has no derivative: it is not defined beside, is another one there, or bends."""
    remedy = "move it, or sweep over it"
    try:
        for side in (width, -width):
            function(side)
    except ModelError as error:
        return f"there is no value beside it: {error.problems[0]}"
    except Rebuilt:
        return f"the driveline has another structure beside it; {remedy}"
    return f"the driveline jumps or has a kink here; {remedy}"


def _tried(
    function: Callable[[float], Array], places: tuple[int, ...], here: Array, width: float, noise: Array, lost: Array
) -> Difference | None:
    try:
        values = np.array([here if k == 0 else function(k * width) for k in places])
    except (ModelError, Rebuilt):
        return None
    return _fitted(places, values, here, width, noise, lost)


def _fitted(
    places: tuple[int, ...], values: Array, here: Array, width: float, noise: Array, lost: Array
) -> Difference | None:
    """The derivative from values beside one, None where two orders do not agree."""
    rises = values - here
    fine, coarse = weights(places, len(places)), weights(places, len(places) - 2)
    value = fine @ rises / width
    other = coarse @ rises / width
    size = np.abs(rises).max(axis=0) / (width * max(map(abs, places)))
    noise = np.maximum(noise, ROUND_OFF * np.abs(values).max(axis=0))
    # the mean of both sides would do for a kink
    apart = np.abs(_kink(places) @ rises / width) if places == CENTRAL else 0.0
    if np.any(np.maximum(np.abs(value - other), apart) > ALLOWED * size + 10 * noise / width + lost):
        return None
    line = np.outer(np.array(places) * width, value)
    return Difference(value, bool(np.all(np.abs(rises - line) <= 1e-12 * size * width + 10 * noise)))


@cache
def weights(places: tuple[int, ...], order: int) -> Array:
    """Weights of values at places for the derivative at 0, exact for polynomials below an order; far ones have none."""
    used = sorted(places, key=abs)[:order]
    powers = np.vander(np.array(used, dtype=float), len(used), increasing=True).T
    right = np.zeros(len(used))
    right[1] = 1.0
    shares: dict[int, Any] = dict(zip(used, np.linalg.solve(powers, right), strict=True))
    return np.array([shares.get(place, 0.0) for place in places])


@cache
def _kink(places: tuple[int, ...]) -> Array:
    """Weights of values at places on both sides for the share of |x| in what they have in common."""
    far = sorted({abs(place) for place in places})
    powers = np.array([[k, *(k ** (2 * j) for j in range(1, len(far)))] for k in far], dtype=float)
    first = np.linalg.inv(powers)[0] / 2
    return np.array([first[far.index(abs(place))] for place in places])
