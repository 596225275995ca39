"""What an experiment is, and what it gives back."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias, TypeVar

from clutchwork.base import dataclass, near
from clutchwork.base.paths import fitting
from clutchwork.declare.node import Law
from clutchwork.declare.options import Options
from clutchwork.plot.chosen import PICTURES
from clutchwork.plot.figure import figure_of
from clutchwork.rig.bench import ACCURATE, Bench
from clutchwork.rig.presets import Preset, preset_of
from clutchwork.rig.table import Cell, Table, TableColumn
from clutchwork.rig.trial import NOT_REACHED, Runs, Trial, found
from clutchwork.run.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.figure import Figure


# names, instances or both; with a mapping the keys are the labels
Laws: TypeAlias = "str | Law | Iterable[str | Law] | Mapping[str, str | Law] | None"


@dataclass(frozen=True)
class Experiment:
    """One experiment; its fields are what may be changed about it. Times in s, shares of the preset's quantities."""

    name: ClassVar[str]
    title: ClassVar[str]
    usual: ClassVar[tuple[str, ...]]  # laws that are compared when none are named
    preset: ClassVar[str] = "first"
    height: ClassVar[float] = 90.0  # mm, of the picture, or of one row where laws have panels of their own
    across: ClassVar[int] = 0  # laws in one row; 0: all share the panels
    whole: ClassVar[bool] = True  # only complete runs are measured
    own_preset: ClassVar[bool] = False  # it makes no sense with presets of another domain

    def run(self, bench: Bench) -> Runs:
        """Run every case with one law."""
        raise NotImplementedError

    def columns(self, preset: Preset) -> tuple[TableColumn, ...]:
        """Headings of what `measure` returns, after the column of the law."""
        raise NotImplementedError

    def measure(self, trial: Trial) -> Sequence[float]:
        """Numbers of one law; all its runs are complete."""
        raise NotImplementedError

    def draw(self, figure: Figure, result: Result) -> None:
        """Draw the picture on an empty figure."""
        raise NotImplementedError

    def table(self, preset: Preset, trials: Mapping[str, Trial]) -> Table:
        """One line for each law, with a note where a run stopped early."""
        heads = self.columns(preset)
        lines: list[list[Cell]] = []
        for label, trial in trials.items():
            left_out = bool(trial.note) and self.whole
            numbers = [NOT_REACHED] * len(heads) if left_out else self.measure(trial)
            lines.append([label, *numbers, trial.note])
        noted = any(line[-1] for line in lines)
        columns = (TableColumn("law"), *heads, *([TableColumn("note")] if noted else []))
        return Table(columns, tuple(tuple(line if noted else line[:-1]) for line in lines))

    def perform(self, laws: Laws = None, *, preset: str | Preset | None = None, options: Options = ACCURATE) -> Result:
        """Run the experiment with some laws."""
        of = preset_of(preset if preset is not None else type(self).preset)
        benches = [Bench(label, law, of, options) for label, law in chosen(laws, of, self.usual).items()]
        trials = {bench.label: Trial(bench, self.run(bench)) for bench in benches}
        return Result(self, of, trials, self.table(of, trials))


@dataclass(frozen=True, eq=False)
class Result:
    """What an experiment gave: print it for the table, `plot` it for the picture."""

    experiment: Experiment
    preset: Preset
    trials: Mapping[str, Trial]
    table: Table

    @property
    def laws(self) -> dict[str, Law]:
        """The laws that an experiment compares, by label."""
        return {label: trial.bench.law for label, trial in self.trials.items()}

    @property
    def runs(self) -> dict[str, Runs]:
        """The trajectories by label of the law and name of the case."""
        return {label: trial.runs for label, trial in self.trials.items()}

    @property
    def complete(self) -> bool:
        """Whether all runs reached their end, except those that chatter, which are there to show that."""
        return all(run.status == "chatter" for trial in self.trials.values() for run in trial.early)

    def __getitem__(self, wanted: str | tuple[str, str]) -> Trajectory:
        """The trajectory of a law, `result["lugre"]`, or of one case of it, `result["lugre", "sliding"]`."""
        label, case = wanted if isinstance(wanted, tuple) else (wanted, None)
        trial = found(self.trials, label, "law")
        return next(iter(trial.runs.values())) if case is None else trial[case]

    @property
    def rows(self) -> int:
        """Rows of panels in the picture: one, or as many as the laws need that have panels of their own."""
        return -(-len(self.trials) // self.experiment.across) if self.experiment.across else 1

    def plot(self, path: str | Path | None = None) -> Figure:
        """Draw the picture and write it to `path` (png, svg or pdf) when given; needs matplotlib."""
        with figure_of(self.experiment.height * self.rows) as figure:
            self.experiment.draw(figure, self)
            if path is not None:
                figure.savefig(fitting("plot", path, f"{self.experiment.name}.png", PICTURES))
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


EXPERIMENTS: dict[str, type[Experiment]] = {}

E = TypeVar("E", bound=type[Experiment])


def experiment(cls: E) -> E:
    """Register an experiment under the stem of its module."""
    cls.name = cls.__module__.rpartition(".")[2]
    EXPERIMENTS[cls.name] = cls
    return cls


def runner(name: str) -> Callable[..., Result]:
    """The function that performs an experiment with some of its fields changed."""
    cls = EXPERIMENTS[name]

    def perform(
        laws: Laws = None, *, preset: str | Preset | None = None, options: Options = ACCURATE, **changes: Any
    ) -> Result:
        return made(name, changes).perform(laws, preset=preset, options=options)

    perform.__name__, perform.__qualname__, perform.__doc__ = name, name, cls.__doc__
    return perform


def made(name: str, changes: Mapping[str, Any]) -> Experiment:
    """An experiment by name with some fields changed; ValueError with a near match for unknown names."""
    if name not in EXPERIMENTS:
        rest = f"known experiments: {', '.join(EXPERIMENTS)}"
        raise ValueError(f"unknown experiment {name!r}{near(name, EXPERIMENTS, rest)}")
    known = [item.name for item in fields(EXPERIMENTS[name])]
    for field in changes:
        if field not in known:
            rest = f"known settings: {', '.join(known)}"
            raise ValueError(f"{name} has no setting {field!r}{near(field, known, rest)}")
    return EXPERIMENTS[name](**changes)


def chosen(laws: Laws, preset: Preset, usual: tuple[str, ...]) -> dict[str, Law]:
    """The laws by label.

    Parameters: laws, a name, a law, several of them, a mapping from labels to them, "all", or None for the usual
    ones. Case and underscores of names do not matter. ValueError for a name that is unknown, with a near match.
    """
    if laws is None:
        return {kind: preset.law(kind) for kind in usual if kind in preset.laws}
    if isinstance(laws, Mapping):
        return {label: _law(wanted, preset) for label, wanted in laws.items()}
    wishes = [laws] if isinstance(laws, str | Law) else list(laws)
    if wishes == ["all"]:
        wishes = [kind for kind in preset.laws if kind != "naive_sign"]
    made: dict[str, Law] = {}
    for wanted in wishes:
        law = _law(wanted, preset)
        made[_label(law, made)] = law
    if not made:
        raise ValueError("no friction law is given: name at least one, or leave the choice to the experiment")
    return made


def kind_of(name: str, preset: Preset) -> str:
    """The kind that a name means; ValueError with a near match when there is none."""
    known = {_plain(kind): kind for kind in preset.laws}
    if _plain(name) not in known:
        hint = near(name.strip().lower(), preset.laws, f"known laws: {', '.join(preset.laws)}")
        raise ValueError(f"unknown friction law {name!r}{hint}")
    return known[_plain(name)]


def _law(wanted: Any, preset: Preset) -> Law:
    if isinstance(wanted, str):
        return preset.law(kind_of(wanted, preset))
    if not isinstance(wanted, Law):
        raise TypeError(f"{wanted!r} is not a friction law: give a name or a law such as clutchwork.Coulomb(...)")
    return wanted


def _label(law: Law, taken: Mapping[str, Law]) -> str:
    kind: str = getattr(law, "kind", type(law).__name__)
    return kind if kind not in taken else f"{kind} {sum(label.startswith(kind) for label in taken) + 1}"


def _plain(name: str) -> str:
    return "".join(letter for letter in name.lower() if letter not in "_- ")
