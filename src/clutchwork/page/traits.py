"""What a widget takes when Python sets its values or knots: known names, and the stops that its page has."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import isfinite
from numbers import Real
from typing import Any

from clutchwork.base import UseError, near, quote

Data = Sequence[Mapping[str, Any]]


def values_of(given: Mapping[str, Any], sliders: Data) -> dict[str, float]:
    """Values by name, each at the stop nearest to it where its slider has stops, as on the page; UseError."""
    known = {one["name"]: one for one in sliders}
    problems = list(
        _problems(given, known, "slider", lambda name, value: _value_fault(name, value, known[name]["unit"]))
    )
    if problems:
        raise UseError("widget.values", problems)
    return {name: _stop(known[name], float(value)) for name, value in given.items()}


def knots_of(given: Mapping[str, Any], tables: Data) -> dict[str, list[list[float]]]:
    """Knots by name; UseError for unknown names, and for values that knots cannot have."""
    known = {one["name"]: one for one in tables}
    problems = list(_problems(given, known, "table", _knots_fault))
    if problems:
        raise UseError("widget.knots", problems)
    return {name: [[float(time), float(value)] for time, value in knots] for name, knots in given.items()}


def _problems(
    given: Mapping[str, Any], known: Mapping[str, Any], what: str, fault: Callable[[str, Any], str]
) -> Iterator[str]:
    for name, value in given.items():
        if name not in known:
            there = f"there are {', '.join(map(repr, known))}" if known else f"it has no {what}s"
            yield f"{quote(name)} is no {what} of this widget{near(name, known, there)}"
        elif wrong := fault(name, value):
            yield wrong


def _value_fault(name: str, value: Any, unit: str) -> str:
    return "" if _is_number(value) else f"{name} is {quote(value)}, not a finite number in {unit or '1'}"


def _knots_fault(name: str, knots: Any) -> str:
    if isinstance(knots, list | tuple) and knots and all(map(_is_knot, knots)):
        return ""
    return f"{name} is {quote(knots)}; give knots, such as [[0.0, 0.0], [0.5, 2e5]], times in s and values in SI"


def _is_knot(knot: Any) -> bool:
    return isinstance(knot, list | tuple) and len(knot) == 2 and all(map(_is_number, knot))


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and isfinite(value)


def _stop(slider: Mapping[str, Any], value: float) -> float:
    """The value that a slider takes: of two stops as near as each other the lower one."""
    if slider["direct"] or value == slider["start"]:
        return value
    return float(min(slider["values"], key=lambda stop: abs(stop - value)))
