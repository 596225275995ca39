"""The free parameters of a friction law together, as the row of numbers that is searched for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby
from math import inf, log
from typing import Any

import numpy as np

from clutchwork.base import near
from clutchwork.base.arrays import Array
from clutchwork.declare.node import Law
from clutchwork.fit.adjustable import adjustable, default_free, fixed, kinetic, sum_is_held
from clutchwork.fit.failure import FitError
from clutchwork.fit.ordinates import ordinates, with_ordinates
from clutchwork.fit.unknown import REACH, Bounds, Unknown, below_static, unknowns_of


class Unknowns:
    """All free parameters of a law; codes are logarithms or plain numbers.

    Some parameters are tied to others:

    - a static coefficient is searched for as its excess over the kinetic one, so that it is never below it;
    - ordinates whose sum the law holds, such as shares, are searched for as ratios to the last one: one code less.
    """

    def __init__(self, law: Law, free: Sequence[str] | None, bounds: Bounds | None, *, translation: bool) -> None:
        self.law = law
        names = default_free(law) if free is None else [free] if isinstance(free, str) else list(free)
        found = [item for name in names for item in _unknowns(law, name, bounds or {}, translation)]
        _check(names, found, bounds or {})
        self.items = tuple(below_static(law, item, names) for item in found)
        # (first item, number of items, sum) of the tables whose sum is held
        self.held = [block for block in _curves(self.items) if sum_is_held(law, self.items[block[0]].field)]
        closing = {first + count - 1 for first, count, _ in self.held}
        self.searched = [place for place in range(len(self.items)) if place not in closing]

    @property
    def start(self) -> Array:
        """Codes of the start values."""
        law = self.law
        made = np.array(
            [
                max(item.start - kinetic(law, item.point), 0.0) if item.over else item.coded(item.start)
                for item in self.items
            ]
        )
        for first, count, _ in self.held:
            made[first : first + count] -= made[first + count - 1]
        return np.asarray(made[self.searched])

    @property
    def lower(self) -> Array:
        """Lower bounds of the search, as codes."""
        return self._limits([0.0 if item.over else item.coded(item.lower) for item in self.items], -log(REACH))

    @property
    def upper(self) -> Array:
        """Upper bounds of the search, as codes."""
        return self._limits([inf if item.over else item.coded(item.upper) for item in self.items], log(REACH))

    def _limits(self, codes: list[float], of_ratios: float) -> Array:
        made = np.array(codes)
        for first, count, _ in self.held:
            made[first : first + count] = of_ratios
        return np.asarray(made[self.searched])

    def codes(self, u: Array) -> Array:
        """Codes of all free parameters from those that are searched for."""
        made = np.zeros(len(self.items))
        made[self.searched] = u
        for first, count, total in self.held:
            part = slice(first, first + count)
            made[part] += log(total) - np.log(np.sum(np.exp(made[part])))
        over = [place for place, item in enumerate(self.items) if item.over]
        law = self._law(made) if over else self.law
        for place in over:
            made[place] += kinetic(law, self.items[place].point)
        return made

    def values(self, u: Array) -> list[float]:
        """Values of all free parameters."""
        return [item.decoded(code) for item, code in zip(self.items, self.codes(u).tolist(), strict=True)]

    def ends(self, u: Array) -> list[tuple[float, float]]:
        """Lowest and highest value of every free parameter, where the others have these codes."""
        law = self.law_at(u)
        # the smallest number above a bound stands for it
        lowest = [round(item.lowest, 300) for item in self.items]
        return [
            (max(low, kinetic(law, item.point)) if item.over else low, item.highest)
            for low, item in zip(lowest, self.items, strict=True)
        ]

    def law_at(self, u: Array) -> Law:
        """The law with these codes."""
        return self._law(self.codes(u))

    def _law(self, codes: Array) -> Law:
        changes: dict[str, Any] = {}
        rows: dict[str, list[float]] = {}
        for item, code in zip(self.items, codes.tolist(), strict=True):
            value = item.decoded(code)
            if item.point is None:
                changes[item.field] = value
            else:
                if item.field not in rows:
                    rows[item.field] = list(ordinates(self.law, item.field).values())
                rows[item.field][item.point] = value
        changes |= {name: with_ordinates(self.law, name, row) for name, row in rows.items()}
        return replace(self.law, **changes)


def _unknowns(law: Law, name: str, bounds: Bounds, translation: bool) -> list[Unknown]:
    known = adjustable(type(law))
    if name not in known:
        remedy = f"parameters are {', '.join(known)}{near(name, known)}"
        raise FitError("free", f"names {name!r}, which is not a fittable parameter of {type(law).__name__}", remedy)
    fault = fixed(law, name)
    if fault:
        raise FitError("free", f"names {name!r}, which this law does not let vary: {fault}", "remove it")
    spec = known[name]
    unit = spec.units[0] if translation and spec.units else spec.unit
    return unknowns_of(law, name, spec, unit, bounds)


def _check(names: list[str], found: list[Unknown], bounds: Bounds) -> None:
    if not names:
        raise FitError("free", "names no parameter", "name at least one to be fitted")
    if len(set(names)) < len(names):
        raise FitError("free", "names a parameter twice", "name each once")
    known = [*names, *(item.name for item in found)]
    for name in bounds:
        if name not in known:
            raise FitError("bounds", f"name {name!r}, which is not free", f"free it too{near(name, known)}")


def _curves(items: tuple[Unknown, ...]) -> list[tuple[int, int, float]]:
    """First item, number of items and sum of the ordinates of every table."""
    made, first = [], 0
    for _, group in groupby(items, key=lambda item: item.field):
        block = list(group)
        if block[0].point is not None and len(block) > 1:
            made.append((first, len(block), sum(item.start for item in block)))
        first += len(block)
    return made
