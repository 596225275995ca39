"""Signals that are set from outside, by name: numbers and tables, as files hold them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from clutchwork.signals.table import Table

Held = Mapping[str, float | Table]


def plain_value(value: Any) -> Any:
    """What a file holds of a value: of a table its points."""
    return [list(point) for point in value.points] if isinstance(value, Table) else value


def plain_held(held: Held) -> dict[str, Any]:
    """What a file holds of all that is set."""
    return {name: plain_value(value) for name, value in held.items()}


def value_of(data: Any) -> Any:
    """What was set, from what a file holds; ValueError or TypeError where it is neither a number nor points."""
    if not isinstance(data, list):
        return float(data)
    points = tuple((float(time), float(value)) for time, value in data)
    if not points:
        raise ValueError("a table that was set has no points")
    return Table(points)


def held_of(data: Mapping[str, Any]) -> dict[str, float | Table]:
    """All that was set, from what a file holds."""
    return {str(name): value_of(value) for name, value in data.items()}
