"""Signals of a run at the present time, by name, looked up once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.results.channels import Channels, channels
from clutchwork.results.forms import RowEntry

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
            found = self._known[name] = self._reader(name)
        return found()

    def _reader(self, name: str) -> Callable[[], Any]:
        form, rows = self.channels[name].evaluate, self.rows
        if isinstance(form, RowEntry):
            return partial(rows.item, 0, form.index)
        return lambda: form(rows)[0].item()

    def __iter__(self) -> Iterator[str]:
        return iter(self.channels)

    def __len__(self) -> int:
        return len(self.channels)

    def __contains__(self, name: object) -> bool:
        return name in self.channels
