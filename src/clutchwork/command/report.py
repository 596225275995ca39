"""What the command line reports about a run or a model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict
from functools import reduce
from typing import TYPE_CHECKING, Any

from clutchwork.base import columns, counted
from clutchwork.base.quote import LONGEST, shortened
from clutchwork.base.shell import paragraphs, width
from clutchwork.hints.registry import of_model
from clutchwork.model.changes import all_names, targets_of
from clutchwork.results.channels import channels
from clutchwork.results.gears import named_closed
from clutchwork.results.overview import number, sizes
from clutchwork.results.ratios import Gears, Phase, follows_from, gears, head_of

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.hints.hint import Hint, Hints
    from clutchwork.results.events import Events
    from clutchwork.run.trajectory import Trajectory

MOST_LINES = 40
SHARES = "how they share is a convention"
# signals whose last value is reported
FINAL = (".speed", ".temperature")


def run_text(run: Trajectory, phases: Sequence[Phase], shafts: tuple[str, str] | None) -> str:
    """Events, gears, energy and effort of a run."""
    if not len(run):
        return "nothing was computed"
    parts = [event_text(run.events)]
    if phases and shafts is not None:
        why = follows_from(run.system)
        parts.append(phase_text(run.system, phases, shafts, why))
        parts += change_text(phases, shafts, why)
    parts += [str(run.gears(table.name)) for table in run.system.gearboxes]
    parts += dependent_text(run)
    if run.options.work:
        parts.append(str(run.energy))
    parts.append(effort_text(run))
    parts += hint_text(run.hints)
    return "\n\n".join(parts)


def event_text(events: Events) -> str:
    """The events, the first ones when there are many."""
    text = str(events[:MOST_LINES])
    return text + (f"\n... and {len(events) - MOST_LINES} more" if len(events) > MOST_LINES else "")


def phase_text(system: System, phases: Sequence[Phase], shafts: tuple[str, str], why: str) -> str:
    """Which contacts were locked when, and the ratio that they gave.

    Parameters: why, what the ratio follows from.
    """
    head = ("from s", "to s", "locked", f"{shafts[0]}/{shafts[1]} {why}", "at the end")
    lines = [
        (f"{p.begin:.6f}", f"{p.end:.6f}", named_closed(system, p.closed), number(p.kinematic), number(p.measured))
        for p in phases[:MOST_LINES]
    ]
    return columns([head, *lines], right={0, 1, 3, 4})


def change_text(phases: Sequence[Phase], shafts: tuple[str, str], why: str) -> list[str]:
    """The ratio of the first and of the last gear, when there are two."""
    known = [phase for phase in phases if phase.kinematic is not None and math.isfinite(phase.kinematic)]
    if len(known) < 2:
        return []
    gears, seen = ([number(getattr(known[k], name)) for k in (0, -1)] for name in ("kinematic", "measured"))
    ratio = f"ratio {shafts[0]}/{shafts[1]}"
    return [f"{ratio} before and after: {' -> '.join(seen)} at the ends of the phases, {' -> '.join(gears)} {why}"]


def dependent_text(run: Trajectory) -> list[str]:
    """When the shares of locked contacts in their load were a convention."""
    if not run.dependent:
        return []
    found = run.dependent[:MOST_LINES]
    lines = [f"{phase.begin:.6f} to {phase.end:.6f} s: {' '.join(phase.contacts)}" for phase in found]
    return [f"locked contacts that depend on each other; {SHARES}:\n" + "\n".join(lines)]


def hint_text(hints: Hints) -> list[str]:
    """What may not be meant; nothing where there is none."""
    return ["\n".join(["hints", *(f"  {hint}" for hint in hints[:MOST_LINES])])] if hints else []


def effort_text(run: Trajectory) -> str:
    """Steps and time that the run took."""
    s = run.statistics
    return (
        f"{run.time[-1] - run.options.t_start:g} s computed in {1e3 * s['core_seconds']:.3f} ms"
        f" ({1e3 * s['seconds']:.1f} ms with all signals at {counted(len(run), 'instants')}),"
        f" {counted(int(s.get('steps', 0)), 'steps')}, {s.get('rejected', 0):g} rejected,"
        f" {counted(len(run.events), 'events')}"
    )


def run_data(
    run: Trajectory, phases: Sequence[Phase], shafts: tuple[str, str] | None, names: Sequence[str] = ()
) -> dict[str, Any]:
    """The same as plain data for JSON, and the named signals over time."""
    data = {
        "status": run.status,
        "message": run.message,
        "warnings": list(run.system.warnings),
        "time_s": float(run.time[-1]) if len(run) else 0.0,
        "events": [asdict(event) for event in run.events],
        "ratio_of": list(shafts) if shafts else None,
        "phases": [asdict(phase) for phase in phases],
        "gears": {table.name: [asdict(one) for one in run.gears(table.name)] for table in run.system.gearboxes},
        "dependent": [asdict(phase) for phase in run.dependent] if len(run) else [],
        "energy": run.energy.to_dict() if run.options.work and len(run) else None,
        "final": {name: float(run[name][-1]) for name in run.names if name.endswith(FINAL) and len(run)},
        "statistics": dict(run.statistics),
        "hints": [_hint_data(hint) for hint in run.hints],
    }
    if not names:
        return data
    signals = {name: {"unit": run.units[name], "values": run[name].tolist()} for name in names}
    return data | {"time": {"unit": "s", "values": run.time.tolist()}, "signals": signals}


def model_text(system: System, shafts: tuple[str, str] | None) -> str:
    """Size of a model, the ratios that its contacts can give, and which of these depend on each other."""
    has = ", ".join(counted(count, name) for name, count in sizes(system).items() if count)
    parts = [f"{system.name}: no mistakes", paragraphs(has, width())]
    if system.dependent:
        sets = [f"  {' '.join(names)}" for names in system.dependent]
        head = f"depend on each other when locked together; {SHARES}:"
        parts.append("\n".join([head, *_first(sets)]))
    # hints tell of redundant gears
    parts += [paragraphs(note, width()) for note in system.notes if "redundant" not in note]
    advice = hint_text(of_model(system))
    if shafts is None:
        return "\n\n".join([*parts, *advice])
    found = gears(system, shafts)
    lines = [(named_closed(system, closed), number(value)) for closed, value in found.ratios]
    if lines:
        table = columns([("closed", head_of(system, shafts)), *lines], right={1}).split("\n")
        parts.append("\n".join([table[0], *_first(table[1:])]))
    if found.untried is not None:
        parts.append(f"not tried: {found.untried} or more contacts closed at once, there are too many combinations")
    return "\n\n".join([*parts, *advice])


def _first(lines: Sequence[str]) -> list[str]:
    """The first ones of many lines."""
    more = len(lines) - MOST_LINES
    return [*lines] if more <= 0 else [*lines[:MOST_LINES], f"... and {more} more, which --json lists"]


def changeable_values(system: System) -> dict[str, Any]:
    """What `System.changed` may change, and its value: a number, a word, the type of a law or signal, or None."""
    model = system.source
    targets, _ = targets_of(model, all_names(model)) if model is not None else ({}, [])
    return {name: _plain(reduce(getattr, aim.path, aim.owner)) for name, aim in targets.items()}


def _plain(value: Any) -> Any:
    """A value in short, as a model file says it."""
    if value is None or isinstance(value, bool | int | float | str):
        return value
    kind, name = getattr(value, "kind", ""), getattr(value, "name", "")
    return name or kind or shortened(str(value), LONGEST)


def in_words(value: Any) -> str:
    """One of these values for reading."""
    if value is None or isinstance(value, bool):
        return "none" if value is None else str(value).lower()
    return f"{value:.12g}" if isinstance(value, int | float) else str(value)


def signal_units(system: System) -> dict[str, str]:
    """All signals of a run with their units."""
    integrated = [bool(system.settings.get(name, True)) for name in ("angles", "work")]
    return {name: channel.unit for name, channel in channels(system, *integrated).items()}


def model_data(system: System, shafts: tuple[str, str] | None) -> dict[str, Any]:
    """The same as plain data for JSON."""
    found = gears(system, shafts) if shafts else Gears((), None)
    return {
        "warnings": list(system.warnings),
        "sizes": sizes(system),
        "ratio_of": list(shafts) if shafts else None,
        "gears": [{"closed": list(closed), "ratio": value} for closed, value in found.ratios],
        "gears_untried_from": found.untried,
        "dependent": [list(names) for names in system.dependent],
        "notes": list(system.notes),
        "hints": [_hint_data(hint) for hint in of_model(system)],
    }


def _hint_data(hint: Hint) -> dict[str, Any]:
    return hint.to_dict() | {"numbers": _finite(dict(hint.numbers))}


def _finite(data: dict[str, Any]) -> dict[str, Any]:
    """JSON has no infinity."""
    return {name: None if isinstance(x, float) and not math.isfinite(x) else x for name, x in data.items()}
