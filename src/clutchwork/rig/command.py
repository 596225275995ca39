"""What `clutchwork rig` does; the command line prints it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from clutchwork.errors import near
from clutchwork.rig.experiment import EXPERIMENTS, Experiment, Result, made
from clutchwork.rig.presets import PRESETS
from clutchwork.text import columns

EVERY, LIST = "all", "list"


@dataclass(frozen=True)
class Outcome:
    """One experiment that was performed, and the files that were written."""

    result: Result
    files: tuple[Path, ...]

    @property
    def text(self) -> str:
        """What is told about it."""
        return "\n".join([str(self.result), "", *(f"wrote {path}" for path in self.files), ""])

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
) -> Iterator[Outcome]:
    """Perform one experiment, or all, and write what they give.

    Parameters: laws, names separated by commas; settings, `name=value` each; out, folder for picture and table;
    signals, whether all signals of every run are written too. ValueError for what is unknown, with a near match.
    """
    chosen = [law for law in laws.split(",") if law.strip()] if laws is not None else None
    for experiment in _experiments(name, settings):
        fixed = name == EVERY and experiment.own_preset
        result = experiment.perform(chosen, preset=None if fixed else preset)
        files = result.save(out)
        yield Outcome(result, (*files, *(_signals(result, out) if signals else ())))


def listing() -> str:
    """The experiments with their settings, the laws and the presets."""
    lines = ["experiments"]
    for name, cls in EXPERIMENTS.items():
        settings = ", ".join(f"{item.name}={item.default}" for item in fields(cls))
        question = (cls.__doc__ or "").partition("\n")[0]
        lines += [f"  {name:<12}{question}", f"  {'':<12}{settings}"]
    laws = ", ".join(next(iter(PRESETS.values())).laws)
    presets = columns([("  " + preset.name, preset.title) for preset in PRESETS.values()])
    return "\n".join([*lines, "", "laws", f"  {laws}", "", "presets", presets])


def _experiments(name: str, settings: Sequence[str]) -> list[Experiment]:
    if name == EVERY:
        if settings:
            raise ValueError("settings belong to one experiment: name it in place of all")
        return [cls() for cls in EXPERIMENTS.values()]
    if name not in EXPERIMENTS:
        known = [*EXPERIMENTS, EVERY, LIST]
        raise ValueError(f"no experiment {name!r}{near(name, known)}; there are {', '.join(known)}")
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
