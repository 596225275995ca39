"""The first lines of a sweep, for the terminal and for notebooks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from clutchwork.base import html
from clutchwork.base.plural import columns, counted

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import numpy as np
    from numpy.typing import NDArray

MOST_SHOWN = 12


class Tabled(Protocol):
    """What is asked of a sweep."""

    @property
    def names(self) -> Sequence[str]:
        """Names of all outputs."""

    def __len__(self) -> int: ...

    def columns(self) -> Iterator[tuple[str, NDArray[np.generic]]]:
        """Columns of the table."""

    def column_units(self) -> dict[str, str]:
        """Their units."""

    def without_value(self, name: str) -> int:
        """How many variants have no value of an output."""


def text(found: Tabled) -> str:
    """How the variants ended, and the first ones."""
    heads, cells = _table(found, "{} [{}]")
    table = columns([heads, *cells], right=range(len(heads) - 1))
    return "\n".join([repr(found), "", table, *_more(found), *without_values(found)])


def page(found: Tabled) -> str:
    """The same for a notebook."""
    heads, cells = _table(found, "{}, {}")
    words = [html.paragraph(line) for line in (*_more(found), *without_values(found))]
    head = html.heading(repr(found).strip("<>"))
    return html.page(head, html.table(heads, cells, right=range(len(heads) - 1)), *words)


def without_values(found: Tabled) -> Iterator[str]:
    """A line for each output that some variants do not have, such as the lock-up of a clutch that never locks."""
    for name in found.names:
        if count := found.without_value(name):
            yield f"{name}: no value in {count} of {counted(len(found), 'variants')}"


def _more(found: Tabled) -> Iterator[str]:
    if len(found) > MOST_SHOWN:
        yield f"... and {counted(len(found) - MOST_SHOWN, 'more variants')}"


def _table(found: Tabled, head: str) -> tuple[list[str], list[list[str]]]:
    units, table = found.column_units(), dict(found.columns())
    heads = [head.format(name, units[name]) if name in units else name for name in table]
    lines = zip(*(column[:MOST_SHOWN].tolist() for column in table.values()), strict=True)
    return heads, [[_cell(cell) for cell in line] for line in lines]


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
