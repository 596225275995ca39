"""What a fit of a driveline to measured signals found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import near
from clutchwork.base.plural import counted
from clutchwork.fit.fitted_record import Followed
from clutchwork.fit.response_picture import picture
from clutchwork.fit.result import Parameter, table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from clutchwork.run.trajectory import Trajectory

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ResponseFit:
    """Fitted numbers of a driveline with their intervals, and how well its runs describe the samples."""

    parameters: tuple[Parameter, ...]
    values: Mapping[str, Any]  # fitted values of all records by name, as `System.changed` takes them
    records: tuple[Followed, ...]
    rms: Mapping[str, float]  # of the residuals, by signal, in its unit
    r2: float  # share of the variation of the samples that the runs describe
    confidence: float  # of the intervals
    converged: bool
    correlation: Array = field(repr=False)  # of the parameters, those that stay above zero by their logarithm
    alike: Mapping[str, float]  # correlation of neighbouring residuals by signal, where it is not chance
    doubts: tuple[str, ...] = ()  # why the residuals are not noise
    remarks: tuple[str, ...] = ()  # on how the search went

    @property
    def run(self) -> Trajectory:
        """The run with the fitted values; of several records that of the first one."""
        return self.records[0].run

    @property
    def undetermined(self) -> tuple[Parameter, ...]:
        """Parameters that the samples do not determine."""
        return tuple(one for one in self.parameters if not one.determined)

    @property
    def determined(self) -> bool:
        """Whether the search ended, what is left is noise, and the samples determine every parameter."""
        return self.converged and not self.doubts and not self.undetermined

    @property
    def message(self) -> str:
        """What stands in the way of using the values, one line each; empty when nothing does."""
        lines = [] if self.converged else ["the search did not converge: start closer to it or free fewer parameters"]
        return "\n".join([*lines, *self.doubts, *(str(one) for one in self.undetermined)])

    @property
    def notes(self) -> str:
        """What to know about the values, one line each."""
        lines = [
            f"neighbouring residuals of {name} are correlated ({alike:.2f}): the driveline misses something or the"
            " samples were filtered; the intervals are widened for it"
            for name, alike in self.alike.items()
        ]
        return "\n".join([*self.remarks, *lines])

    def __getitem__(self, name: str) -> Parameter:
        for one in self.parameters:
            if one.name == name:
                return one
        raise KeyError(f"no fitted parameter {name!r}{near(name, [one.name for one in self.parameters])}")

    def plot(self, path: str | Path | None = None) -> Figure:
        """Measured and fitted signals of each record over time; written to `path` when given. Needs matplotlib."""
        return picture(self.records, path)

    def data(self) -> dict[str, Any]:
        """All of it but the samples and the runs, for JSON."""
        return {
            "determined": self.determined,
            "converged": self.converged,
            "message": self.message,
            "notes": self.notes,
            "records": [one.label for one in self.records],
            "samples": self._samples,
            "rms": dict(self.rms),
            "r2": self.r2,
            "confidence": self.confidence,
            "parameters": [{**vars(one), "determined": one.determined} for one in self.parameters],
            "correlation": self.correlation.tolist(),
        }

    @property
    def _samples(self) -> int:
        return sum(len(one.times) for record in self.records for one in record.traces)

    def __str__(self) -> str:
        """A table for reading."""
        several = f"{counted(len(self.records), 'records')}, " if len(self.records) > 1 else ""
        head = f"{several}{self._samples} samples, r2 {self.r2:.6g}"
        parts = [head, table(self.parameters, self.confidence), self.message, self.notes]
        return "\n\n".join(part for part in parts if part)
