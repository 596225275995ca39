"""Several runs in one picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import UseError, near, quote
from clutchwork.declare.calls import explained
from clutchwork.plot import named
from clutchwork.plot.chosen import PICTURES, PanelRequest, asked, panels, usual, wide
from clutchwork.plot.curves import panels_of, units_of
from clutchwork.plot.measured import samples, with_samples
from clutchwork.plot.view import viewed
from clutchwork.results.recorded import Recorded

if TYPE_CHECKING:
    from clutchwork.declare.node import Number
    from clutchwork.plot.canvas import Picture

COLOURS = ("run", "signal")


@explained("compare")
def compare(
    *runs_and_signals: Any,
    labels: Sequence[str] | None = None,
    unit: str | Sequence[str] | None = None,
    path: str | Path | None = None,
    zoom: tuple[Number, Number] | None = None,
    events: Any = False,
    colour: str = "run",
    measured: Mapping[str, Any] | None = None,
    units: Mapping[str, str] | None = None,
    width: float | str | None = None,
) -> Picture:
    """Draw signals of several runs over each other: `cw.compare({"soft": a, "hard": b}, "halfshaft.torque")`.

    Parameters: runs_and_signals, a mapping from labels to runs, or the runs one after another, then signals as
    `run.plot` takes them: names, wildcards, lists of names for one panel, and the path of a picture; without any,
    speeds, loads and torques of contacts and temperatures that all runs have. labels, of runs that are not in a
    mapping, by default the names of their models, or run 1, run 2 ...; unit, path, zoom [s], events, measured, units
    and width as in `run.plot`; colour, "run" for one colour for each run and dashes for signals, or "signal" for the
    reverse.

    Models may differ. A signal that one of the runs does not have is an `UnknownName` error that names the run; a
    wildcard takes what each of them has. Needs matplotlib.
    """
    runs, rest = _runs(runs_and_signals, labels)
    if colour not in COLOURS:
        raise UseError("compare", [f"colour is {quote(colour)}: give 'run' or 'signal'{near(colour, COLOURS)}"])
    known = {name for run in runs.values() for name in run.channels}
    wanted = asked("compare", rest, path, PICTURES, known)
    extra, shown_in = samples(runs, measured, "compare"), units_of(runs, units, "compare")
    if not wanted.groups and unit is None:
        wanted = PanelRequest(_common(runs), wanted.path)
    view = viewed(runs, zoom, events, "compare")
    groups = with_samples(panels(runs, wanted, unit, "compare"), extra)
    shown = panels_of(view.runs, groups, extra, "compare", shown_in)
    return named.draw(view, shown, wanted.path, colour, wide(width, "compare"))


def _runs(given: Sequence[Any], labels: Any) -> tuple[dict[str, Recorded], list[Any]]:
    """The runs by label, and what follows them."""
    if given and isinstance(given[0], Mapping):
        if labels is not None:
            raise UseError("compare", ["labels are given twice: the keys of the mapping are labels; leave out labels="])
        runs, rest = {str(label): run for label, run in given[0].items()}, list(given[1:])
    else:
        count = next((i for i, one in enumerate(given) if not isinstance(one, Recorded)), len(given))
        listed, rest = list(given[:count]), list(given[count:])
        runs = dict(zip(_labels(listed, labels), listed, strict=True))
    wrong = [
        f"{quote(label)} is {quote(run)}, which is not a run"
        for label, run in runs.items()
        if not isinstance(run, Recorded)
    ]
    wrong += [
        f"{quote(one)} is not among the runs; give all runs before the signals"
        for one in rest
        if isinstance(one, Recorded)
    ]
    if not runs:
        wrong.append("there is no run; give what simulate returns, such as {'soft': run1, 'hard': run2}")
    if wrong:
        raise UseError("compare", wrong)
    return runs, rest


def _labels(runs: Sequence[Any], labels: Any) -> list[str]:
    """Those that are given, the names of the models where they differ, or numbers."""
    if labels is None:
        names = [run.system.name for run in runs]
        return names if len(set(names)) == len(names) else [f"run {number}" for number in range(1, len(runs) + 1)]
    given = [] if isinstance(labels, str) else [str(label) for label in labels]
    if len(given) != len(runs) or len(set(given)) != len(given):
        raise UseError("compare", [f"labels is {quote(labels)}: give {len(runs)} different strings, one for each run"])
    return given


def _common(runs: Mapping[str, Recorded]) -> tuple[tuple[bool, tuple[str, ...]], ...]:
    """What is shown where no signal is named: of the usual ones those that all runs have."""
    names = dict.fromkeys(name for run in runs.values() for name in usual(run))
    found = [name for name in names if all(name in run for run in runs.values())]
    if not found:
        raise UseError("compare", ["these runs have no signal of the same name; name the signals, or use wildcards"])
    return tuple((False, (name,)) for name in found)
