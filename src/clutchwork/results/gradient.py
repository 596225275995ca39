"""Derivatives of what a run gives by its numbers, labelled, and why there is none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field
from typing import Any

import numpy as np

from clutchwork.base import ClutchworkError, UnknownName, columns, counted, dataclass, html, listed, near, quote
from clutchwork.base.arrays import Array
from clutchwork.base.extras import need
from clutchwork.declare.calls import explained_methods

# columns of a table for the terminal, and of one for a notebook
MOST_SHOWN = 6


class NoGradient(ClutchworkError, ValueError):  # noqa: N818, it is what there is
    """No derivative exists: all reasons at once in `problems`, each with time, element and remedy."""

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join([f"no gradient: {counted(len(self.problems), 'problems')}", *self._lines()]))

    def _lines(self) -> Iterator[str]:
        return (f"  {problem}" for problem in self.problems)

    def __reduce__(self) -> tuple[type, tuple[Sequence[str]]]:
        return type(self), (self.problems,)


@explained_methods("gradient")
@dataclass(frozen=True, eq=False, repr=False)
class Gradient:
    """Derivatives of values of a run by numbers of its driveline, in SI.

    `g["lock(c1)", "c1.gain"]` is one of them, `g["lock(c1)"]` all of one value, `g.matrix` all, a line for each value
    in `g.of` and a column for each number in `g.by`. `g.values` holds the values themselves, `g.x` the numbers;
    `g.notes` says where the gradient barely exists, such as for a slip that passes zero very slowly. A derivative that
    does not exist is NaN, and `g.problems` says why.
    """

    of: tuple[str, ...]
    by: tuple[str, ...]
    values: Array  # of the run
    x: Array  # the numbers by which it is differentiated
    matrix: Array  # derivatives
    of_units: tuple[str, ...] = field(repr=False)
    by_units: tuple[str, ...] = field(repr=False)
    notes: tuple[str, ...] = ()
    problems: tuple[str, ...] = ()  # why derivatives are missing

    def __getitem__(self, key: str | tuple[str, str]) -> Any:
        """A derivative by the names of value and number, or all derivatives of a value; UnknownName, a KeyError."""
        of, by = key if isinstance(key, tuple) else (key, None)
        line = self.matrix[_place(of, self.of, "value")]
        return line if by is None else float(line[_place(by, self.by, "number")])

    def unit(self, of: str, by: str) -> str:
        """The unit of a derivative."""
        return quotient(self.of_units[_place(of, self.of, "value")], self.by_units[_place(by, self.by, "number")])

    @property
    def relative(self) -> Array:
        """The same in percent of the value for each percent of the number; NaN where a value is zero."""
        with np.errstate(divide="ignore", invalid="ignore"):
            found: Array = self.matrix * self.x / self.values[:, None]
        return np.where(np.isfinite(found), found, np.nan)

    def to_pandas(self) -> Any:
        """A pandas DataFrame, a line for each value and a column for each number; `attrs` hold units. Needs pandas."""
        frame = need("pandas", "tables", "a table").DataFrame(self.matrix, index=self.of, columns=self.by)
        frame.attrs["units"] = {of: {by: self.unit(of, by) for by in self.by} for of in self.of}
        return frame

    def __repr__(self) -> str:
        """A table to read, turned where there are few values and many numbers."""
        head, lines = self._table()
        said = [columns([head, *lines], right=set(range(1, len(head)))), *self._said()]
        return "\n".join(said)

    def _said(self) -> Iterator[str]:
        yield from (f"note: {note}" for note in self.notes)
        yield from (f"NaN: {problem}" for problem in self.problems)

    def _table(self) -> tuple[list[str], list[list[str]]]:
        """Head and lines: a line for each number, a column for each value."""
        of, left = self.of[:MOST_SHOWN], len(self.of) - MOST_SHOWN
        more = [f"and {left} more"] if left > 0 else []
        head = [
            "by",
            "",
            *(f"{name} [{unit}]" if unit else name for name, unit in zip(of, self.of_units, strict=False)),
        ]
        values = ["", "", *(f"{value:.6g}" for value in self.values[: len(of)])]
        lines = [
            [name, f"[{per}]" if (per := quotient("1", unit)) != "1" else "", *(f"{d:.6g}" for d in line[: len(of)])]
            for name, unit, line in zip(self.by, self.by_units, self.matrix.T, strict=True)
        ]
        return [*head, *more], [[*line, *([""] if more else [])] for line in [values, *lines]]

    def _repr_html_(self) -> str:
        head, lines = self._table()
        return html.page(
            html.table(head, lines, right=set(range(2, len(head)))), *(html.paragraph(said) for said in self._said())
        )


def _place(name: object, known: Sequence[str], what: str) -> int:
    if isinstance(name, str) and name in known:
        return known.index(name)
    raise UnknownName(f"no {what} {quote(name)}{near(name, known, f'there are {listed(known)}')}")


def quotient(unit: str, by: str) -> str:
    """The unit of a derivative: "s/(N m)"."""
    if by in ("", "1"):
        return unit
    if unit in ("", "1") and "/" in by:
        below, above = by.split("/", 1)
        return quotient(above.strip("()"), below)
    upper = f"({unit})" if "/" in unit else unit or "1"
    return f"{upper}/({by})" if " " in by or "/" in by else f"{upper}/{by}"
