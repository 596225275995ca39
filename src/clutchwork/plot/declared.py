"""What a notebook shows of a declaration: its curve, and a table of its parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from numbers import Real
from typing import TYPE_CHECKING, Any

from clutchwork.base import ClutchworkError, html
from clutchwork.declare.docs import described
from clutchwork.declare.schema import specs

if TYPE_CHECKING:
    from clutchwork.plot.canvas import Picture


def parts(thing: Any, draw: Callable[[], Picture | None]) -> tuple[Picture | None, list[str]]:
    """Curve and parameters; no curve without matplotlib, or where a parameter is wrong or cannot be drawn."""
    tables = [html.heading(type(thing).__name__), html.table(("parameter", "value", "unit", "meaning"), _lines(thing))]
    try:
        wrong = [html.paragraph(" ".join(problem)) for problem in thing.problems()]
        return (None if wrong else draw()), [*tables, *wrong]
    except (ImportError, ClutchworkError, ArithmeticError, ValueError, TypeError, LookupError):
        # a model that has it says why
        return None, tables


def _lines(thing: Any) -> list[tuple[str, str, str, str]]:
    lines = []
    for item, spec in specs(type(thing)):
        told = described(item, spec)
        shown = _value(getattr(thing, item.name), "points" if spec.what == "curve" else "values")
        lines.append((item.name, shown, told.unit, told.meaning))
    return lines


def _value(value: Any, members: str) -> str:
    """A number, a name of a function, or how many members a long table has."""
    if isinstance(value, Real) and not isinstance(value, bool):
        return f"{float(value):.6g}"
    if isinstance(value, Sequence) and not isinstance(value, str) and len(value) > 4:
        return f"{len(value)} {members}"
    return "none" if value is None else getattr(value, "__qualname__", "") or str(value)
