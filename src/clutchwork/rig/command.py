"""`clutchwork rig`: arguments, report and files."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import UseError, dataclass, near, shell
from clutchwork.base.shell import DONE, STOPPED

if TYPE_CHECKING:
    from clutchwork.rig.experiment import Experiment, Result

EXAMPLES = (
    ("clutchwork rig list", "experiments with their settings, laws, presets"),
    ("clutchwork rig breakaway --laws stribeck,lugre", "two laws in one experiment"),
    ("clutchwork rig stick_slip --set speed=0.05 --out out/slow", "with another setting, into a folder of your own"),
)
EVERY, LIST = "all", "list"


def add_command(subparsers: Any) -> None:
    """Add `rig` to the commands of the command line."""
    rig = shell.add_command(
        subparsers,
        "rig",
        rig_command,
        "experiments that distinguish friction laws",
        examples=EXAMPLES,
        codes="Exit code 1: a run stopped early, other than by the chatter of a law that cannot rest.",
    )
    rig.add_argument(
        "experiment", nargs="?", help="drift, stick_slip, judder ...; all; list prints experiments, laws and presets"
    )
    rig.add_argument("--laws", metavar="A,B", help="laws to compare, or all; default: those of the experiment")
    rig.add_argument("--preset", metavar="NAME", help="where the laws take their parameters from")
    rig.add_argument("--set", metavar="NAME=VALUE", action="append", default=[], help="change a setting")
    rig.add_argument("--out", type=Path, metavar="DIR", default=Path("out", "rig"), help="default: out/rig")
    rig.add_argument("--signals", action="store_true", help="also write all signals of every run")
    shell.add_json(rig)


def rig_command(asked: argparse.Namespace) -> int:
    """Perform, report, write; the exit code."""
    if asked.experiment == LIST:
        shell.tell(listing())
        return DONE
    if asked.experiment is None:
        raise UseError("rig", ["give an experiment, such as clutchwork rig drift; clutchwork rig list prints them all"])
    shell.writable([asked.out / "table.csv"])
    done, data = True, []
    for outcome in outcomes(asked.experiment, asked.laws, asked.preset, asked.set, asked.out, asked.signals):
        done &= outcome.result.complete
        data.append(outcome.data)
        if not asked.json:
            shell.tell(outcome.text)
    if asked.json:
        shell.tell_json({"experiments": data})
    return DONE if done else STOPPED


@dataclass(frozen=True)
class PerformedExperiment:
    """One experiment that was performed, and the files that were written."""

    result: Result
    files: tuple[Path, ...]

    @property
    def text(self) -> str:
        """The report."""
        return "\n".join([str(self.result), "", *shell.wrote(self.files), ""])

    @property
    def data(self) -> dict[str, Any]:
        """The same as plain data."""
        return {
            "experiment": self.result.experiment.name,
            "preset": self.result.preset.name,
            "table": self.result.table.to_dict(),
            "messages": self.result.messages,
            "files": [str(path) for path in self.files],
        }


def outcomes(
    name: str, laws: str | None, preset: str | None, settings: Sequence[str], out: Path, signals: bool
) -> Iterator[PerformedExperiment]:
    """Perform one experiment, or all, and write what they give.

    Parameters: laws, names separated by commas; settings, `name=value` each; out, folder for picture and table;
    signals, whether all signals of every run are written too. ValueError for what is unknown, with a near match.
    """
    chosen = None if laws is None else shell.parts(laws)
    for experiment in _experiments(name, settings):
        fixed = name == EVERY and experiment.own_preset
        result = experiment.perform(chosen, preset=None if fixed else preset)
        files = result.save(out)
        yield PerformedExperiment(result, (*files, *(_signals(result, out) if signals else ())))


def listing() -> str:
    """The experiments with their settings, the laws and the presets."""
    from clutchwork.base.plural import columns
    from clutchwork.rig import EXPERIMENTS, PRESETS

    lines = ["experiments"]
    for name, cls in EXPERIMENTS.items():
        settings = ", ".join(f"{item.name}={item.default}" for item in fields(cls))
        question = (cls.__doc__ or "").partition("\n")[0]
        lines += [f"  {name:<12}{question}", f"  {'':<12}{settings}"]
    laws = ", ".join(next(iter(PRESETS.values())).laws)
    presets = columns([("  " + preset.name, preset.title) for preset in PRESETS.values()])
    return "\n".join([*lines, "", "laws", f"  {laws}", "", "presets", presets])


def _experiments(name: str, settings: Sequence[str]) -> list[Experiment]:
    from clutchwork.rig import EXPERIMENTS
    from clutchwork.rig.experiment import made

    if name == EVERY:
        if settings:
            raise ValueError("settings belong to one experiment: give its name in place of all")
        return [cls() for cls in EXPERIMENTS.values()]
    if name not in EXPERIMENTS:
        known = [*EXPERIMENTS, EVERY, LIST]
        rest = f"known experiments: {', '.join(known)}"
        raise ValueError(f"unknown experiment {name!r}{near(name, known, rest)}")
    return [made(name, dict(map(_setting, settings)))]


def _setting(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        number = float(value)
    except ValueError:
        raise ValueError(f"--set {text}: write it as name=number, such as frequency=1") from None
    return name.strip(), int(number) if number.is_integer() and "." not in value else number


def _signals(result: Result, out: Path) -> Iterator[Path]:
    """Write the trajectories, one file for each law and case."""
    for label, runs in result.runs.items():
        for case, run in runs.items():
            path = out / f"{result.experiment.name}_{label}_{case}.csv".replace(" ", "_")
            run.to_csv(path)
            yield path
