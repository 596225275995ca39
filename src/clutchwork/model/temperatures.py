"""Temperatures that cannot be kelvin: 20 is meant in degrees Celsius."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from numbers import Real
from typing import Any

from clutchwork.base import Problem
from clutchwork.declare.node import Component, Law, Signal, ThermalNode
from clutchwork.declare.schema import Spec, specs
from clutchwork.declare.wording import path_of
from clutchwork.model.fields import CHECKS
from clutchwork.model.numbers import At
from clutchwork.model.thermal import NODE_FIELDS, node_kind
from clutchwork.signals.bases.waveform import piece_value

# no lining and no oil works below this [K]
COLDEST = 150.0


def temperature_advice(elements: Sequence[Component], thermal: Sequence[ThermalNode]) -> Iterator[Problem]:
    """Every temperature of a model that is too low to be one in kelvin, its tables and signals included."""
    for node in thermal:
        at = At(f'{node_kind(node)} "{node.name}"', "")
        yield from _cold(node.temperature, NODE_FIELDS[node_kind(node)]["temperature"], at.inner("temperature", "K"))
    for element in elements:
        at = At(path_of(element), "")
        yield from _inside(element, at)
        if isinstance(element.friction, Law):
            yield from _inside(element.friction, at.inner("friction"))
        yield from temperature_advice([entry.made for entry in element.entries() if entry.made is not None], ())


def _inside(thing: Any, at: At) -> Iterator[Problem]:
    cls: Any = type(thing)
    for name, spec in _warm(cls):
        value = getattr(thing, name)
        if value is not None:
            yield from _cold(value, spec, at.inner(name, spec.unit))


@cache
def _warm(cls: Any) -> tuple[tuple[str, Spec], ...]:
    """Fields that are temperatures, or tables over them."""
    return tuple((item.name, spec) for item, spec in specs(cls) if "K" in (spec.unit, spec.unit_x))


def _cold(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    # what is no number is a mistake, told elsewhere
    if any(CHECKS[spec.what](value, spec, at)):
        return
    lowest = min(_temperatures(value, spec), default=COLDEST)
    if lowest >= COLDEST:
        return
    remedy = f"temperatures are in kelvin; did you mean {lowest + 273.15:g} K ({lowest:g} degC)?"
    if isinstance(value, Real):
        yield at.problem("is implausibly low", f"{lowest:g} K", remedy)
    else:
        yield at.problem(f"reaches down to {lowest:g} K, implausibly low", remedy=remedy)


def _temperatures(value: Any, spec: Spec) -> Iterable[float]:
    """The temperatures of a number, a table or a signal; none of what another element gives."""
    if isinstance(value, Real):
        return [float(value)]
    if isinstance(value, Signal):
        return [piece_value(piece, piece.start) for piece in value.segments()]
    if spec.what == "curve":
        place = 0 if spec.unit_x == "K" else 1
        return [float(point[place]) for point in value]
    return [float(number) for number in value] if spec.what == "numbers" else []
