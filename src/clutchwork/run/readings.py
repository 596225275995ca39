"""What a controller sees of a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from clutchwork.results.channels import Channels


class Readings(Mapping[str, Any]):
    """All signals at one instant by name, each evaluated when it is read."""

    def __init__(self, channels: Channels, row: NDArray[np.float64]) -> None:
        self._channels = channels
        self._row = np.asarray(row).reshape(1, -1)

    def __getitem__(self, name: str) -> Any:
        return self._channels[name].evaluate(self._row)[0].item()

    def __iter__(self) -> Iterator[str]:
        return iter(self._channels)

    def __len__(self) -> int:
        return len(self._channels)
