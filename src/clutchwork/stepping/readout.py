"""Signals of a run at the present time, by name, looked up once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.results.channels import Channels, channels
from clutchwork.results.forms import LOCKED, Dot, Form, RowEntry, Slip

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options


class Readout(Mapping[str, Any]):
    """All signals by name, over one row that its owner keeps up to date."""

    def __init__(self, system: System, options: Options, row_size: int) -> None:
        self.rows: NDArray[np.float64] = np.empty((1, row_size))
        self._system, self._options = system, options
        self._known: dict[str, Callable[[], Any]] = {}

    @property
    def channels(self) -> Channels:
        """Unit and evaluation of every signal."""
        return channels(self._system, self._options.angles, self._options.work)

    def __getitem__(self, name: str) -> Any:
        found = self._known.get(name)
        if found is None:
            found = self._known[name] = self._reader(self.channels[name].evaluate)
        return found()

    def _reader(self, form: Form) -> Callable[[], Any]:
        """Of one row without arrays, to the bit what the form makes of many."""
        rows = self.rows
        if isinstance(form, RowEntry):
            return partial(rows.item, 0, form.index)
        if isinstance(form, Dot):
            return partial(_dot, rows.item, tuple(zip(form.used.tolist(), form.factors.tolist(), strict=True)))
        if isinstance(form, Slip):
            mode, rate = partial(rows.item, 0, form.mode), self._reader(form.rate)
            return lambda: 0.0 if mode() == LOCKED else rate()
        return lambda: form(rows)[0].item()

    def __iter__(self) -> Iterator[str]:
        return iter(self.channels)

    def __len__(self) -> int:
        return len(self.channels)

    def __contains__(self, name: object) -> bool:
        return name in self.channels


def _dot(item: Callable[[int, int], float], terms: tuple[tuple[int, float], ...]) -> float:
    made = None
    for index, factor in terms:
        made = factor * item(0, index) if made is None else made + factor * item(0, index)
    return 0.0 if made is None else made
