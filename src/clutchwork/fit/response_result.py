"""What a fit of a driveline to measured signals found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import counted, dataclass
from clutchwork.base.paths import fitting
from clutchwork.fit.estimates import ParameterEstimates
from clutchwork.fit.fitted_record import FittedRecord
from clutchwork.plot.chosen import PICTURES
from clutchwork.plot.figure import figure_of
from clutchwork.plot.style import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from clutchwork.fit.traces import Trace
    from clutchwork.run.trajectory import Trajectory


MEASURED, FITTED = COLOURS[0], COLOURS[1]
HEIGHT, LEAST = 45.0, 60.0  # mm, of a row and of all
# records beside each other
MOST_BESIDE = 4


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


def picture(records: Sequence[FittedRecord], path: str | Path | None = None) -> Figure:
    """A row for each signal, a column for each record, further ones below; written to `path` when given."""
    beside = min(len(records), MOST_BESIDE)
    blocks = [records[first : first + beside] for first in range(0, len(records), beside)]
    rows = [(block, name) for block in blocks for name in _signals(block)]
    with figure_of(max(HEIGHT * len(rows), LEAST)) as figure:
        grid = figure.add_gridspec(len(rows), beside)
        for row, (block, name) in enumerate(rows):
            for column, record in enumerate(block):
                for one in (trace for trace in record.traces if trace.signal == name):
                    axes = figure.add_subplot(grid[row, column])
                    _panel(axes, record, one)
                    axes.set_title(record.label if len(records) > 1 else "", loc="left")
        figure.axes[0].legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=2, borderaxespad=0.0)
        if path is not None:
            figure.savefig(fitting("plot", path, "fit.png", PICTURES))
    return figure


def _signals(records: Sequence[FittedRecord]) -> list[str]:
    return list(dict.fromkeys(one.signal for record in records for one in record.traces))


def _panel(axes: Axes, record: FittedRecord, one: Trace) -> None:
    """Measured samples as points, the fitted run as a line."""
    axes.plot(one.times, one.values, ".", color=MEASURED, markersize=2.5, label="measured")
    axes.plot(one.times, one.values + record.residuals(one), color=FITTED, linewidth=0.9, label="fitted")
    axes.set_xlabel("time, s")
    axes.set_ylabel(f"{one.signal}, {one.unit}")
