"""Names that are asked for as inputs, outputs and parameters of an FMU, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from typing import Any

from clutchwork.base import UseError, listed, near, quote
from clutchwork.fmu.variables import LeftOut
from clutchwork.results.channels import Channel, Channels
from clutchwork.results.forms import Mode


def plain(names: Any) -> tuple[str, ...]:
    """Names from a string with commas, or from a sequence."""
    if isinstance(names, str):
        return tuple(part.strip() for part in names.split(",") if part.strip())
    if not isinstance(names, Iterable) or not all(isinstance(name, str) for name in names):
        raise UseError(
            "cw.export_fmu", [f"{quote(names)} is not a list of names: give ['c1.pressure'] or 'c1.pressure'"]
        )
    return tuple(names)


def matching(names: Iterable[str], known: Collection[str]) -> list[str]:
    """Names, each once; those with a star stand for all that they match."""
    found = list[str]()
    for name in names:
        several = [one for one in known if fnmatchcase(one, name)] if "*" in name else []
        found += several or [name]
    return list(dict.fromkeys(found))


def shown(known: Channels, name: str) -> str:
    """What results call a signal: the torque of a load and the signal that sets its size would have the same name."""
    return f"{name}_signal" if f"{name}_signal" in known else name


def is_text(channel: Channel) -> bool:
    """Whether a result is a string."""
    return isinstance(channel.evaluate, Mode) and channel.evaluate.named


def input_faults(
    names: Sequence[str], settable: Collection[str], known: Channels, numbers: Collection[str]
) -> Iterator[str]:
    """Why names cannot be inputs."""
    for name in names:
        if name in settable:
            continue
        if name in numbers:
            why = "is a number: leave it out, it is a parameter already"
        elif name in known:
            why = "is a result: leave it out, it is an output already"
        else:
            why = f"is not a signal of this driveline{near(name, settable, f'signals are {listed(settable)}')}"
        yield f"inputs: {quote(name)} {why}"


def output_faults(names: Sequence[str], known: Channels, inputs: Collection[str]) -> Iterator[str]:
    """Why names cannot be outputs."""
    for name in names:
        if name in inputs:
            yield f"outputs: {quote(name)} is an input already; leave it out"
        elif name not in known:
            yield f"outputs: {quote(name)} is not a result of this driveline{near(name, known)}"
        elif is_text(known[name]):
            yield f"outputs: {quote(name)} is a string; take {name.rpartition('.')[0]}.mode"


def parameter_faults(
    names: Sequence[str], numbers: Collection[str], left_out: Sequence[LeftOut], settable: Collection[str]
) -> Iterator[str]:
    """Why names cannot be parameters."""
    reasons = {one.name: one.why for one in left_out}
    for name in names:
        if name in numbers:
            continue
        if name in reasons:
            why = f"cannot be one: {reasons[name]}"
        elif name in settable:
            why = "is a signal: give it to inputs"
        else:
            why = f"is not a number of this driveline{near(name, numbers)}"
        yield f"parameters: {quote(name)} {why}"
