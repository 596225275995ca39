"""Signals of many runs at one instant of each, by name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.results.channels import Channels, channels
from clutchwork.results.forms import is_of_structure

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options


class ManyReadings(Mapping[str, Any]):
    """Signals by name, each an array with a number of every run.

    Where a run cannot go on there is NaN, and "" as the state of a contact.
    """

    def __init__(
        self, rows: NDArray[np.float64], failed: NDArray[np.bool_], systems: Sequence[System], options: Options
    ) -> None:
        """Parameters: rows, one of each run; failed, whether it cannot go on; systems, that of each."""
        self._rows, self._failed, self._systems, self._options = rows, failed, systems, options

    def _channels(self, system: System) -> Channels:
        return channels(system, self._options.angles, self._options.work)

    def __getitem__(self, name: str) -> Any:
        form = self._channels(self._systems[0])[name].evaluate
        values = np.asarray(form(self._rows) if self._is_alike(name, form) else self._each(name))
        if not self._failed.any():
            return values
        return np.where(self._failed, "" if values.dtype.kind == "U" else np.nan, values)

    def _is_alike(self, name: str, form: Any) -> bool:
        """Whether a signal follows from the rows of all in the same way."""
        return is_of_structure(name, form) or all(system is self._systems[0] for system in self._systems)

    def _each(self, name: str) -> NDArray[Any]:
        """A signal of each kind of System among them."""
        numbers = np.array([id(system) for system in self._systems])
        kinds = {id(system): system for system in self._systems}
        values = np.empty(len(self._rows))
        for number, system in kinds.items():
            mine = numbers == number
            values[mine] = self._channels(system)[name].evaluate(self._rows[mine])
        return values

    def __iter__(self) -> Iterator[str]:
        return iter(self._channels(self._systems[0]))

    def __len__(self) -> int:
        return len(self._channels(self._systems[0]))

    def __contains__(self, name: object) -> bool:
        return name in self._channels(self._systems[0])
