"""What tables and pictures ask of a study and of indices, so that they need not know the classes that call them."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray


class RecordedStudy(Protocol):
    """A study."""

    @property
    def folder(self) -> Path:
        """Where it is."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all outputs."""

    @property
    def units(self) -> dict[str, str]:
        """Units of columns."""

    @property
    def count(self) -> int:
        """Variants that it is to have."""

    @property
    def ends(self) -> dict[str, int]:
        """How many variants ended in which way."""

    def __len__(self) -> int: ...

    def __getitem__(self, name: str) -> NDArray[Any]: ...


class Indices(Protocol):
    """Sobol indices of one output."""

    @property
    def output(self) -> str:
        """Its name."""

    @property
    def names(self) -> tuple[str, ...]:
        """What varies."""

    @property
    def first(self) -> NDArray[np.float64]:
        """Share of each name alone."""

    @property
    def total(self) -> NDArray[np.float64]:
        """Share of each name with its interactions."""

    @property
    def first_interval(self) -> NDArray[np.float64]:
        """Half width."""

    @property
    def total_interval(self) -> NDArray[np.float64]:
        """Half width."""
