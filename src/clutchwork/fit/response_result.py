"""What a fit of a driveline to measured signals found."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import counted, dataclass
from clutchwork.fit.estimates import ParameterEstimates
from clutchwork.fit.fitted_record import FittedRecord
from clutchwork.fit.response_picture import picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from clutchwork.run.trajectory import Trajectory


@dataclass(frozen=True, eq=False, kw_only=True)
class ResponseFit(ParameterEstimates):
    """Fitted numbers of a driveline with their intervals, and how well its runs describe the samples."""

    values: Mapping[str, Any]  # fitted values of all records by name, as `System.changed` takes them
    records: tuple[FittedRecord, ...]
    rms: Mapping[str, float]  # of the residuals, by signal, in its unit
    alike: Mapping[str, float]  # correlation of neighbouring residuals by signal, where it is not chance

    @property
    def run(self) -> Trajectory:
        """The run with the fitted values; of several records that of the first one."""
        return self.records[0].run

    @property
    def notes(self) -> str:
        """What to know about the values, one line each."""
        lines = [
            f"neighbouring residuals of {name} are correlated ({alike:.2f}): the driveline lacks an effect or the"
            " samples were filtered; the intervals are widened for it"
            for name, alike in self.alike.items()
        ]
        return "\n".join([*self.remarks, *lines])

    def plot(self, path: str | Path | None = None) -> Figure:
        """Measured and fitted signals of each record over time; written to `path` when given. Needs matplotlib."""
        return picture(self.records, path)

    def data(self) -> dict[str, Any]:
        """All of it but the samples and the runs, for JSON."""
        own = {"records": [one.label for one in self.records], "samples": self._samples, "rms": dict(self.rms)}
        return own | super().data()

    @property
    def _samples(self) -> int:
        return sum(len(one.times) for record in self.records for one in record.traces)

    @property
    def _head(self) -> str:
        several = f"{counted(len(self.records), 'records')}, " if len(self.records) > 1 else ""
        return f"{several}{self._samples} samples, r2 {self.r2:.6g}"
