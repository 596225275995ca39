"""The first lines of a sweep, for the terminal and for notebooks."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from clutchwork.base import columns, counted, html

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

MOST_SHOWN = 12


class Shown(NamedTuple):
    """What is shown of a sweep."""

    title: str
    variants: int
    columns: Mapping[str, NDArray[np.generic]]
    units: Mapping[str, str]
    notes: Sequence[str]

    def text(self) -> str:
        """How the variants ended, and the first ones."""
        heads, cells = self._table("{} [{}]")
        table = columns([heads, *cells], right=range(len(heads) - 1))
        return "\n".join([self.title, "", table, *self._below()])

    def page(self) -> str:
        """The same for a notebook."""
        heads, cells = self._table("{}, {}")
        table = html.table(heads, cells, right=range(len(heads) - 1))
        return html.page(html.heading(self.title.strip("<>")), table, *map(html.paragraph, self._below()))

    def _below(self) -> list[str]:
        more = self.variants - MOST_SHOWN
        return [f"... and {counted(more, 'more variants')}", *self.notes] if more > 0 else [*self.notes]

    def _table(self, head: str) -> tuple[list[str], list[list[str]]]:
        heads = [head.format(name, self.units[name]) if name in self.units else name for name in self.columns]
        lines = zip(*(column[:MOST_SHOWN].tolist() for column in self.columns.values()), strict=True)
        return heads, [[f"{cell:.6g}" if isinstance(cell, float) else str(cell) for cell in line] for line in lines]
