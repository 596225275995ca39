"""What is exported of a run: some signals at some instants, and where they come from."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.extras import program
from clutchwork.declare.options import OPTIONS
from clutchwork.model.settings import plain_settings
from clutchwork.results.events import Event, Events
from clutchwork.results.selection import chosen
from clutchwork.results.time_grid import at_raster
from clutchwork.results.units import Converter, converter

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded

Array = NDArray[Any]


@dataclass(frozen=True)
class ExportedSignal:
    """One signal over all instants."""

    name: str
    unit: str
    values: Array

    @property
    def is_text(self) -> bool:
        """Whether its values are words, such as "locked"."""
        return self.values.dtype.kind == "U"

    def coded(self) -> tuple[Array, list[str]]:
        """Its words as small numbers, and the word of each number."""
        words, codes = np.unique(self.values, return_inverse=True)
        return codes.astype(np.uint8), [str(word) for word in words]


@dataclass(frozen=True)
class Content:
    """Signals of a run that were chosen, at instants that were chosen."""

    run: Recorded
    names: tuple[str, ...]
    made: Converter

    @property
    def instants(self) -> ExportedSignal:
        """The time in the unit that is asked for."""
        return ExportedSignal("time", self.made.unit("time"), self.made.put(self.time, "time"))

    @property
    def time(self) -> NDArray[np.float64]:
        """Instants [s]."""
        return self.run.time

    @property
    def events(self) -> Events:
        """All events of the run."""
        return self.run.events

    def signals(self) -> Iterator[ExportedSignal]:
        """One after another; each is evaluated when it is asked for."""
        for name in self.names:
            yield ExportedSignal(name, self.made.unit(name), np.ascontiguousarray(self.made.values(self.run, name)))

    def event_columns(self) -> Iterator[ExportedSignal]:
        """Every field of every event."""
        units = self.events.units
        for item in fields(Event):
            kind = str if item.name in ("element", "before", "after", "cause") else float
            values = np.array([getattr(event, item.name) for event in self.events], dtype=kind)
            yield ExportedSignal(item.name, units.get(item.name, ""), values)

    def about(self) -> dict[str, Any]:
        """Where the signals come from, as plain data."""
        run = self.run
        return {
            "model": run.system.name,
            "program": program(),
            "status": run.status,
            "message": run.message,
            "t_end": run.t_end,
            "options": settings_of(run),
        }

    def as_text(self) -> str:
        """The same in a few lines."""
        about = self.about()
        text = [f"model: {about['model']}", f"program: {about['program']}", f"status: {about['status']}"]
        text += [about["message"]] if about["message"] else []
        return "\n".join([*text, f"t_end: {about['t_end']!r} s", f"options: {json.dumps(about['options'])}"])


def settings_of(run: Recorded) -> dict[str, Any]:
    """Options of a run by name; a long list of instants is that of the time itself."""
    return plain_settings({name: getattr(run.options, name) for name in OPTIONS if name != "times"})


def content(
    run: Recorded, names: Any = None, dt: float | None = None, times: Any = None, units: Mapping[str, str] | None = None
) -> Content:
    """Selects signals, resamples, converts units."""
    known = run.channels
    # a wrong name is reported before the run is repeated
    picked, made = chosen(names, known, known.fault), converter(run, units)
    return Content(at_raster(run, dt, times), picked, made)
