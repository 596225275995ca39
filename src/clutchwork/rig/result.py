"""What an experiment gives back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from clutchwork.errors import near
from clutchwork.node import Law
from clutchwork.rig.bench import Bench
from clutchwork.rig.presets import Preset
from clutchwork.rig.table import Table
from clutchwork.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from clutchwork.rig.experiment import Experiment

# cases of one law by name
Runs = Mapping[str, Trajectory]
NOT_REACHED = float("nan")

V = TypeVar("V")


@dataclass(frozen=True, eq=False)
class Trial:
    """One law on the bench, and what its runs gave."""

    bench: Bench
    runs: Runs

    @property
    def preset(self) -> Preset:
        """The preset of the bench."""
        return self.bench.preset

    def __getitem__(self, case: str) -> Trajectory:
        """The run of one case; KeyError with a near match for an unknown one."""
        return _get(self.runs, case, "case")

    @property
    def early(self) -> list[Trajectory]:
        """Runs that stopped before their end."""
        return [run for run in self.runs.values() if not run.finished]

    @property
    def note(self) -> str:
        """Why runs are incomplete, in a few words; empty when all are complete."""
        return f"{self.early[0].status} at {self.early[0].time[-1]:.4g} s" if self.early else ""


@dataclass(frozen=True, eq=False)
class Result:
    """What an experiment gave: print it for the table, `plot` it for the picture."""

    experiment: Experiment
    preset: Preset
    trials: Mapping[str, Trial]
    table: Table

    @property
    def laws(self) -> dict[str, Law]:
        """The laws by label."""
        return {label: trial.bench.law for label, trial in self.trials.items()}

    @property
    def runs(self) -> dict[str, Runs]:
        """The trajectories by label of the law and name of the case."""
        return {label: trial.runs for label, trial in self.trials.items()}

    @property
    def complete(self) -> bool:
        """Whether all runs reached their end, but for those that chatter: to show that is what they are there for."""
        return all(run.status == "chatter" for trial in self.trials.values() for run in trial.early)

    def __getitem__(self, wanted: str | tuple[str, str]) -> Trajectory:
        """The trajectory of a law, `result["lugre"]`, or of one case of it, `result["lugre", "sliding"]`."""
        label, case = wanted if isinstance(wanted, tuple) else (wanted, None)
        trial = _get(self.trials, label, "law")
        return next(iter(trial.runs.values())) if case is None else trial[case]

    @property
    def rows(self) -> int:
        """Rows of panels in the picture: one, or as many as the laws need that have panels of their own."""
        return -(-len(self.trials) // self.experiment.across) if self.experiment.across else 1

    def plot(self, path: str | Path | None = None) -> Figure:
        """Draw the picture and write it to `path` (png, svg or pdf) when given; needs matplotlib."""
        from clutchwork.plot.figure import figure_of

        with figure_of(self.experiment.height * self.rows) as figure:
            self.experiment.draw(figure, self)
            if path is not None:
                Path(path).parent.mkdir(parents=True, exist_ok=True)
                figure.savefig(path)
        return figure

    def save(self, folder: str | Path) -> list[Path]:
        """Write picture and table into a folder; their paths."""
        picture, table = (Path(folder, f"{self.experiment.name}.{ending}") for ending in ("png", "csv"))
        self.plot(picture)
        self.table.to_csv(table)
        return [picture, table]

    @property
    def messages(self) -> dict[str, str]:
        """What the runs that stopped early say about it, by law."""
        return {label: trial.early[0].message for label, trial in self.trials.items() if trial.early}

    def __str__(self) -> str:
        told = "\n".join(f"{label} {message}" for label, message in self.messages.items())
        return f"{self.experiment.title}; {self.preset.title}\n\n{self.table}" + (f"\n\n{told}" if told else "")

    __repr__ = __str__


def _get(mapping: Mapping[str, V], key: str, what: str) -> V:
    if key not in mapping:
        raise KeyError(f"no {what} {key!r}{near(key, mapping)}; there are {', '.join(mapping)}")
    return mapping[key]
