"""MDF 4, what measurement tools read: a channel for each signal over the time, and the events as markers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from clutchwork.base import UseError
from clutchwork.base.extras import need
from clutchwork.exchange.content import Content, ExportedSignal

NEEDED = ("asammdf", "exchange", "an MDF file")
VERSION = "4.10"
DEFLATE = 2


def write(content: Content, path: Path) -> None:
    """A group of channels for the signals, one for the events, and a marker for each event."""
    asammdf = need(*NEEDED)
    if content.instants.unit != "s":
        raise UseError("to_mdf", ["units: the time of an MDF file is in s; leave 'time' out"])
    with asammdf.MDF(version=VERSION) as file:
        file.header.description = content.as_text()
        file.header.subject = content.run.system.name
        file.header.author = content.about()["program"]
        group = [_channel(asammdf, signal, content.time) for signal in content.signals()]
        if group:
            file.append(group, acq_name="signals", comment="signals of the run", common_timebase=True)
        times = content.events.times
        if len(times):
            events = [_channel(asammdf, column, times) for column in content.event_columns() if column.name != "time"]
            file.append(events, acq_name="events", comment="events of the run", common_timebase=True)
            file.events.extend(_markers(content))
        with path.open("wb+") as stream:
            file.save(stream, compression=DEFLATE)


def _channel(asammdf: Any, signal: ExportedSignal, times: Any) -> Any:
    """A channel; words are numbers with a conversion to text."""
    if not signal.is_text:
        return asammdf.Signal(signal.values, times, unit=signal.unit, name=signal.name)
    codes, words = signal.coded()
    conversion: dict[str, Any] = {}
    for code, word in enumerate(words):
        conversion |= {f"val_{code}": code, f"text_{code}": word}
    return asammdf.Signal(codes, times, unit=signal.unit, name=signal.name, conversion=conversion or None)


def _markers(content: Content) -> list[Any]:
    blocks = need("asammdf.blocks.v4_blocks", *NEEDED[1:])
    constants = need("asammdf.blocks.v4_constants", *NEEDED[1:])
    made = []
    for event in content.events:
        # the time of a marker is base times factor
        marker = blocks.EventBlock(
            event_type=constants.EVENT_TYPE_MARKER, sync_base=1, sync_factor=float(np.float64(event.time))
        )
        marker.name = f"{event.element}: {event.before} to {event.after}" if event.element else event.cause
        marker.comment = event.cause
        made.append(marker)
    return made
