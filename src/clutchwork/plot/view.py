"""What part of a run a picture shows, and which events it marks."""

from __future__ import annotations

import math
from collections.abc import Mapping
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import UseError, dataclass, quote
from clutchwork.declare.quantity import QuantityError, in_si
from clutchwork.results.events import Event, Events

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded

# instants of a zoom, beside the events in it
FINE = 1600
# more marks would hide the curves
MOST_MARKS = 30
# beside a single instant, of the time or in s
ROOM = 1e-3
AFTER = {"locked": "locks", "open": "opens", "forward": "slips forward", "backward": "slips backward"}


@dataclass(frozen=True, eq=False)
class View:
    """Runs over a stretch of time, and what happened in it."""

    runs: Mapping[str, Recorded]
    begin: float  # s
    end: float  # s
    marks: tuple[tuple[str, Event], ...]  # label of the run, event


def viewed(runs: Mapping[str, Recorded], zoom: Any, events: Any, call: str) -> View:
    """The runs in a window of time, computed anew there, with the events that are wanted."""
    empty = [label for label, run in runs.items() if not len(run)]
    if empty:
        raise UseError(call, [f"{_of(empty[0])}no instant was computed, so there is nothing to draw"])
    begin = min(float(run.time[0]) for run in runs.values())
    end = max(float(run.time[-1]) for run in runs.values())
    if zoom is not None:
        begin, end = _window(zoom, begin, end, call)
        runs = {label: finely(run, begin, end) for label, run in runs.items()}
    marks = [
        (label, event)
        for label, run in runs.items()
        for event in _wanted(run, events, call)
        if begin <= event.time <= end
    ]
    if begin == end:
        # one instant alone has room on both sides
        begin, end = begin - ROOM * max(1.0, abs(begin)), end + ROOM * max(1.0, abs(end))
    crowded = events is True and len({event.time for _, event in marks}) > MOST_MARKS
    return View(runs, begin, end, () if crowded else tuple(marks))


def _of(label: str) -> str:
    return f"run {quote(label)}: " if label else ""


def _window(zoom: Any, begin: float, end: float, call: str) -> tuple[float, float]:
    try:
        ends = tuple(in_si(t, "s") for t in zoom)
    except (TypeError, QuantityError):
        ends = ()
    if len(ends) != 2 or not all(isinstance(t, Real) and math.isfinite(t) for t in ends):
        raise UseError(call, [f"zoom is {quote(zoom)}: give two times in s, such as zoom=({begin:g}, {end:g})"])
    left, right = float(ends[0]), float(ends[1])
    if not begin <= left < right <= end:
        bounds = f"they must rise and lie between {begin:g} and {end:g} s, which the run covers"
        raise UseError(call, [f"zoom is from {left:g} to {right:g} s: {bounds}"])
    return left, right


def finely(run: Recorded, left: float, right: float) -> Recorded:
    """A run at many instants of a window [s], both limits at each event; one that stopped early as it is."""
    if not run.finished:
        return run
    last = float(run.time[-1])
    inside = [event.time for event in run.events if left <= event.time <= min(right, last)]
    grid = np.linspace(min(left, last), min(right, last), FINE + 1)
    return run.at(np.concatenate([grid, inside, inside]))


def _wanted(run: Recorded, events: Any, call: str) -> list[Event]:
    """The events that are asked for: of all contacts, of some, those that are given, or none."""
    if events is True:
        return list(run.events.changes())
    if events is False or events is None:
        return []
    given = [events] if isinstance(events, str | Event) else events
    if isinstance(given, Events) or (
        isinstance(given, list | tuple) and all(isinstance(e, str | Event) for e in given)
    ):
        chosen = [list(run.events.of(one).changes()) if isinstance(one, str) else [one] for one in given]
        return sorted((event for part in chosen for event in part), key=lambda event: event.time)
    remedy = "give True, False, names of contacts, or events such as run.events.of('c1')"
    raise UseError(call, [f"events is {quote(events)}: {remedy}"])


def happened(event: Event) -> str:
    """An event in words: "c1 locks"."""
    does = "breaks away" if event.before == "locked" else AFTER.get(event.after, event.after)
    return f"{event.element} {does}".strip()
