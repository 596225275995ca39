"""Which signals a picture shows: by name, by wildcard, by unit, in panels."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import UnknownName, UseError, dataclass, listed, near, quote
from clutchwork.base.paths import path_fault
from clutchwork.declare.wording import where_signals
from clutchwork.plot.panels import busy, driven
from clutchwork.plot.style import MILLIMETRE, NARROWEST, WIDTH, WIDTHS
from clutchwork.results.selection import meant

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded

PICTURES = (".png", ".svg", ".pdf")
PAGES = (".html",)
# a string with one of these is meant as a path, and cannot be written
OTHERS = (".jpg", ".jpeg", ".gif", ".tif", ".tiff", ".bmp", ".eps", ".ps", ".webp", ".htm", ".csv", ".pgf")


@dataclass(frozen=True, eq=False)
class PlotArguments:
    """What a call says of its picture, as the user gave it."""

    signals: tuple[Any, ...] = ()
    unit: Any = None
    path: Any = None
    zoom: Any = None
    events: Any = True
    measured: Any = None
    units: Any = None
    width: Any = None


@dataclass(frozen=True)
class PanelRequest:
    """What a call asks for: names and wildcards by panel, each with whether it is a panel of its own; a path."""

    groups: tuple[tuple[bool, tuple[str, ...]], ...]
    path: Path | None


def wide(width: Any, call: str) -> float:
    """The width of a picture in inch: a number in mm, or words for one of a journal."""
    if width is None:
        return WIDTH
    told = WIDTHS.get(width, width) if isinstance(width, str) else width
    if isinstance(told, bool) or not isinstance(told, int | float) or not NARROWEST <= told < math.inf:
        ways = ", ".join(map(repr, WIDTHS))
        raise UseError(call, [f"width is {quote(width)}: give {ways}, or at least {NARROWEST:g} mm"])
    return float(told) * MILLIMETRE


def asked(call: str, given: Sequence[Any], path: Any, endings: Collection[str], known: Collection[str]) -> PanelRequest:
    """Keep names of signals apart from the path of the picture.

    A string is the path where it ends as a picture does and no signal has that name; a `Path` always is. A list or
    tuple of names is a panel of its own.
    """
    wrong: list[str] = []
    paths, groups = [] if path is None else [path], list[tuple[bool, tuple[str, ...]]]()
    for one in given:
        if isinstance(one, Path) or (isinstance(one, str) and _is_path(one, known)):
            paths.append(one)
        elif isinstance(one, str):
            groups.append((False, (one,)))
        elif isinstance(one, list | tuple) and one and all(isinstance(name, str) for name in one):
            groups.append((True, tuple(one)))
        else:
            remedy = "give the name of a signal, a wildcard such as 'c1.*', or a list of names for one panel"
            wrong.append(f"{quote(one)} is not a signal; {remedy}")
    if len(paths) > 1:
        wrong.append(f"there are {len(paths)} paths: {listed(paths)}; give one")
    wrong += [fault for one in paths[:1] if (fault := _path_fault(one, endings))]
    if wrong:
        raise UseError(call, wrong)
    return PanelRequest(tuple(groups), Path(paths[0]) if paths else None)


def _is_path(word: str, known: Collection[str]) -> bool:
    return word not in known and word.lower().endswith((*PICTURES, *PAGES, *OTHERS))


def _path_fault(path: Any, endings: Collection[str]) -> str:
    if fault := path_fault(path, f"run{next(iter(endings))}"):
        return fault
    if Path(path).suffix.lower() in endings:
        return ""
    known = " or ".join(endings) if len(endings) < 3 else f"{', '.join(list(endings)[:-1])} or {list(endings)[-1]}"
    ending = Path(path).suffix
    fault = f"has the ending {ending!r}" if ending else "has no ending"
    remedy = f"write it to a path that ends in {known}"
    other = "; run.explore(...) writes pages" if ending == ".html" else ""
    return f"path {quote(str(path))} {fault}; {remedy}{other}"


def panels(runs: Mapping[str, Recorded], asked: PanelRequest, unit: Any, call: str) -> list[tuple[bool, list[str]]]:
    """Names of the signals of each panel, wildcards resolved; those that are loose are still together.

    A name that one of the runs lacks is an error, a wildcard takes what is there in any of them.
    """
    wanted = _units(runs, unit, call)
    groups = asked.groups or (((False, ("*",)),) if wanted else ())
    found, unknown = list[tuple[bool, list[str]]](), list[str]()
    for own, words in groups:
        names = list[str]()
        for word in words:
            matching, faults = _matching(runs, word)
            unknown += faults
            names += [name for name in matching if not wanted or _unit(runs, name) & wanted]
        found.append((own, _readable(names)))
    if unknown:
        raise UnknownName("\n".join(dict.fromkeys(unknown)))
    if wanted and not any(names for _, names in found):
        raise UseError(call, [f"none of these signals is in {listed(sorted(wanted))}; leave out the unit"])
    return [(own, names) for own, names in found if names]


def _matching(runs: Mapping[str, Recorded], word: str) -> tuple[list[str], list[str]]:
    """Signals that a name or a wildcard stands for, and what is wrong with it."""
    faults = {label: fault for label, run in runs.items() if (fault := _fault(run, word))}
    if not faults:
        return [word], []
    if ("*" in word or "?" in word) and len(faults) == len(runs):
        known = list(dict.fromkeys(name for run in runs.values() for name in run.channels))
        matching = meant(word, known)
        plain = word.replace("*", "").replace("?", "")
        fault = f"no signal matches {quote(word)}{near(plain, known, where_signals())}"
        return (matching, []) if matching else ([], [fault])
    return [], [f"run {quote(label)}: {fault}" if label else fault for label, fault in faults.items()]


def _fault(run: Recorded, word: str) -> str:
    """What is wrong with a name; a wildcard where it is that of an element or of a quantity."""
    try:
        run.channels[word]
    except UnknownName as error:
        for pattern in (f"{word}.*", f"*.{word}"):
            if meant(pattern, run.channels):
                return f"no signal {quote(word)}; did you mean {pattern!r}? {where_signals()}"
        return str(error)
    return ""


def _readable(names: Iterable[str]) -> list[str]:
    """Each once; a mode is the same as the state, in numbers."""
    once = list(dict.fromkeys(names))
    return [name for name in once if not (name.endswith(".mode") and f"{name[:-5]}.state" in once)]


def _unit(runs: Mapping[str, Recorded], name: str) -> set[str]:
    return {run.channels[name].unit for run in runs.values() if name in run}


def _units(runs: Mapping[str, Recorded], unit: Any, call: str) -> set[str]:
    """The units that are asked for."""
    if unit is None:
        return set()
    given = [unit] if isinstance(unit, str) else list(unit) if isinstance(unit, list | tuple | set) else [unit]
    known = list(
        dict.fromkeys(channel.unit for run in runs.values() for channel in run.channels.values() if channel.unit)
    )
    wrong = [
        f"unit {quote(one)}: no signal has it{near(one, known, f'units are {listed(known)}')}"
        for one in given
        if one not in known
    ]
    if wrong:
        raise UseError(call, wrong)
    return set(given)


def usual_groups(run: Recorded) -> tuple[tuple[bool, tuple[str, ...]], ...]:
    """The same as groups of one, each in the panel of its unit."""
    return tuple((False, (name,)) for name in usual(run))


def usual(run: Recorded) -> Iterator[str]:
    """What is shown where nothing is asked for: speeds, what presses contacts, their torques, temperatures.

    Contacts are those that carry torque, the first ones where there are many, as in the picture without names.
    """
    yield from (f"{node.name}.speed" for node in run.wiring.nodes)
    yield from (signal for group in driven(run) for signal in group.values())
    yield from (f"{contact}.torque" for contact in busy(run))
    yield from (f"{node.name}.temperature" for node in run.wiring.thermal)
