"""An output of an FMU of other people."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from clutchwork.base import FMUError, dataclass, quote


@dataclass(frozen=True)
class Output:
    """An output of an FMU, as the function of a `Sampled`."""

    fmu: Any  # whose file is loaded where somebody has one
    name: str

    def __call__(self, _time: float, _readings: Mapping[str, Any]) -> float:
        """An FMU has values in a run alone."""
        raise FMUError(f"FMU {quote(self.fmu.name)} runs in a simulation alone")

    def __repr__(self) -> str:
        return f"{self.fmu!r}[{self.name!r}]"
