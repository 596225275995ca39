"""MDF of version 3 and 4, as INCA, CANape and others write it: groups of channels, each with its own times."""

from __future__ import annotations

import gc
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO

from clutchwork.base.extras import need
from clutchwork.signals.bases.measured.other_units import own_unit
from clutchwork.signals.bases.measured.series import CLOCKS, Array, Clock, Series, numbers

MASTERS = (2, 3)
TIME = 1


@contextmanager
def opened(path: Path) -> Iterator[list[Series]]:
    """The channels of a file."""
    asammdf = need("asammdf", "exchange", "an MDF file")
    # a file that is given as a stream is never changed
    with path.open("rb") as stream, _made(asammdf, stream) as file:
        labels = _labels(file)
        yield [series for number in range(len(file.groups)) for series in _of_group(file, number, labels[number])]


def _made(asammdf: Any, stream: BinaryIO) -> Any:
    """The file; ValueError if it is damaged; partial objects are discarded silently."""
    told = sys.unraisablehook
    sys.unraisablehook = _say_nothing
    try:
        with suppress(Exception):
            return asammdf.MDF(stream)
        gc.collect()
    finally:
        sys.unraisablehook = told
    raise ValueError("it is damaged")


def _say_nothing(_: object) -> None:
    """Errors while an incomplete object is destroyed are ignored."""


def _labels(file: Any) -> list[str]:
    """What each group is called: by the name of its acquisition or its comment, by its number where that is not one."""
    names = [_named(group.channel_group) for group in file.groups]
    count = Counter(names)
    return [name if name and count[name] == 1 else str(number) for number, name in enumerate(names)]


def _named(group: Any) -> str:
    name = getattr(group, "acq_name", "") or getattr(group, "comment", "") or ""
    return str(name).strip()


def _of_group(file: Any, number: int, label: str) -> Iterator[Series]:
    master = file.masters_db.get(number, -1)
    for place, channel in enumerate(file.groups[number].channels):
        if place != master:
            yield _series(file, (number, place), label, channel)


def _series(file: Any, at: tuple[int, int], label: str, channel: Any) -> Series:
    got: dict[str, Any] = {}

    def signal() -> Any:
        if "signal" not in got:
            got["signal"] = file.get(group=at[0], index=at[1], ignore_invalidation_bits=True)
        return got["signal"]

    def invalid() -> Array | None:
        bits = signal().invalidation_bits
        return None if bits is None else getattr(bits, "invalidation_bits", bits)

    def clock(wanted: str) -> Clock | None:
        return _clock(file, at[0], wanted, signal)

    def values() -> Array:
        samples = signal().samples
        return samples if samples.dtype.kind not in "iufb" else numbers(samples)

    name = str(channel.name)
    # INCA and CANape add the device behind a backslash
    aliases = (name.partition("\\")[0],) if "\\" in name else ()
    unit = str(file.get_channel_unit(group=at[0], index=at[1]) or "")
    samples = int(file.groups[at[0]].channel_group.cycles_nr)
    return Series(
        name,
        own_unit(unit),
        samples,
        values,
        clock,
        group=label,
        aliases=aliases,
        is_text=_is_text(channel),
        invalid=invalid,
    )


def _is_text(channel: Any) -> bool:
    """Whether its values are words: strings, or numbers that are turned into some."""
    conversion = getattr(channel, "conversion", None)
    return getattr(channel, "data_type", 0) in _STRINGS or (
        conversion is not None and any(key.startswith("text_") for key in dir(conversion))
    )


# of the block of a channel in version 4; strings of version 3 have another one, and show when they are read
_STRINGS = (6, 8, 9)


def _clock(file: Any, group: int, wanted: str, signal: Any) -> Clock | None:
    channels, master = file.groups[group].channels, file.masters_db.get(group, -1)
    if wanted in (CLOCKS[0], channels[master].name if master >= 0 else CLOCKS[0]):
        if master < 0 or getattr(channels[master], "sync_type", TIME) not in (0, TIME):
            return None
        unit = own_unit(str(file.get_channel_unit(group=group, index=master) or "")) if master >= 0 else ""
        return Clock(str(channels[master].name), unit or "s", numbers(signal().timestamps))
    places = [place for place, channel in enumerate(channels) if channel.name == wanted]
    if len(places) != 1:
        return None
    made = file.get(group=group, index=places[0], ignore_invalidation_bits=True)
    return Clock(wanted, own_unit(str(made.unit or "")), numbers(made.samples))
