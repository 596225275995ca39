"""Ratios that are given as a number or by numbers of teeth."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from clutchwork.declare import Found, exact


def ratio_problems(gear: Any, name: str, teeth: Sequence[str]) -> Found:
    """A ratio that is given twice, or not at all."""
    given = [getattr(gear, tooth) for tooth in teeth]
    named = " and ".join(f"`{tooth}`" for tooth in teeth)
    if getattr(gear, name) is None and None in given:
        return [(name, "is missing", f"give `{name}`, or {named}")]
    if getattr(gear, name) is not None and any(tooth is not None for tooth in given):
        return [(name, "is given twice, as a number and by teeth", "give only one of the two")]
    return []


def ring_problems(planetary: Any) -> Found:
    """The same for a ring over a sun, which has fewer teeth."""
    sun, ring = planetary.teeth_sun, planetary.teeth_ring
    found = ratio_problems(planetary, "ratio", ("teeth_sun", "teeth_ring"))
    if not found and sun is not None and ring is not None and ring <= sun:
        return [("teeth_ring", f"is {ring:g}, not above teeth_sun = {sun:g}", "a ring has more teeth than its sun")]
    return found


def ratio_of(number: float | None, over: float | None, under: float | None) -> Fraction:
    """A ratio as a fraction: the number, else that of the teeth."""
    return exact(number) if number is not None else exact(over or 0) / exact(under or 1)
