"""Checks of declared values, field by field: types, bounds, curves, signals, friction laws."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING
from functools import cache
from numbers import Real
from typing import Any

from clutchwork.base import Problem, near, quote
from clutchwork.declare.expected_value import wanted
from clutchwork.declare.node import Component, Domain, Law, Node, Signal, ThermalNode, is_reference
from clutchwork.declare.quantity import has_unit, within
from clutchwork.declare.schema import Inputs, Role, Spec, inputs, specs
from clutchwork.declare.to_si import settled
from clutchwork.declare.units import has_comma, split
from clutchwork.declare.wording import kinds_of, say
from clutchwork.model.numbers import At as At
from clutchwork.model.numbers import as_float, curve_problems, instead, is_right, list_problems
from clutchwork.model.numbers import number_problems as number_problems
from clutchwork.model.pools import coefficients
from clutchwork.signals.bases.extremes import Reached, extremes


class Broken:
    """Stands for a value whose mistake has been reported already."""


BROKEN = Broken()


def object_problems(thing: Any, at: At, *, sound: bool = False) -> Iterator[Problem]:
    """All mistakes of a declared object: an element, a law or a signal.

    Parameters: sound, whether its values are right, so that only rules between them are looked at.
    """
    sound = sound or is_sound(thing)
    found = [] if sound else list(value_problems(type(thing), vars(thing), at))
    yield from found
    if not found and not sound:
        mark_sound(thing)
    # rules between fields only make sense once each field does; what is wrong inside a law is its own affair
    if not found or all(problem.quantity.startswith(_inside(thing, at)) for problem in found):
        try:
            for name, message, remedy in thing.problems():
                yield at.inner(name).problem(message, remedy=remedy)
        except ArithmeticError:
            yield at.problem(
                "has values too large or too small to compute with", remedy="correct the values of unusual magnitude"
            )


def _inside(thing: Any, at: At) -> tuple[str, ...]:
    """How the places of values inside of its laws begin."""
    return tuple(f"{at.inner(item.name).quantity}." for item, _ in specs(type(thing), "law"))


# types whose values never change
PLAIN = frozenset((float, int, bool, str, type(None), Node))
# in the dictionary of a frozen object, beside what `memoize` keeps: its values are right, and stay so
SOUND = "_values_are_right"


def is_sound(thing: Any) -> bool:
    """Whether the values of a declared object were found right before."""
    return SOUND in vars(thing)


def mark_sound(thing: Any) -> None:
    """Remember that the values of a declared object are right; not of one with lists, which may change."""
    values = vars(thing)
    if all(_stays(value) for value in values.values() if type(value) not in PLAIN):
        values[SOUND] = True


def _stays(value: Any) -> bool:
    if isinstance(value, Law | Signal) and is_sound(value):
        return True
    try:
        hash(value)
    except TypeError:
        return False
    return True


def value_problems(cls: type, values: Mapping[str, Any], at: At) -> Iterator[Problem]:
    """Mistakes of the values for the fields of a declaration, some of which may be missing."""
    for name, default, spec, plain in _fields(cls):
        value = values.get(name, default)
        kind = type(value)
        if (kind is plain and (kind is Node or is_right(value, spec))) or (value is None and spec.optional):
            continue
        if value is BROKEN:
            continue
        if spec.unit == "*":
            place = At(at.path, at.inner(name).quantity, at.unit, units=at.units)
        else:
            if spec.units and (has_unit(value) or isinstance(value, Signal)):
                spec = settled(name, spec, cls, values)
            place = at.inner(name, spec.unit)
        if value is MISSING:
            yield place.problem("is missing", remedy=f"give {wanted(spec, place.unit)}: {spec.doc}")
        else:
            yield from CHECKS[spec.what](value, spec, place)
    yield from _choice_problems(cls, values, at)


@cache
def _fields(cls: Any) -> tuple[tuple[str, Any, Spec, type | None], ...]:
    """The fields of a declaration: name, default, spec, and the type of a value that mostly needs no further look."""
    return tuple((item.name, item.default, spec, _plain(spec)) for item, spec in specs(cls))


def _plain(spec: Spec) -> type | None:
    if spec.what == "port":
        return None if spec.domain else Node
    return float if spec.what in NUMBERS and not (spec.choices or spec.flag) else None


def _choice_problems(cls: type, values: Mapping[str, Any], at: At) -> Iterator[Problem]:
    """Signals that can be given in one of several ways: exactly one, or none where there is a default."""
    for names, spec in _choices(cls):
        given = [name for name in names if values.get(name) is not None]
        if len(given) > 1:
            yield at.inner(given[1]).problem(
                f"cannot be given together with {given[0]!r}", remedy="give only one of them"
            )
        if not given and spec.otherwise is None:
            choice = " or ".join(names)
            yield at.inner(names[0]).problem("is missing", remedy=f"give {choice}: {spec.doc}{within(spec.unit)}")


@cache
def _choices(cls: Any) -> Inputs:
    """The inputs that can be given in several ways."""
    return tuple((names, spec) for names, spec in inputs(cls) if len(names) > 1)


def _param(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if spec.choices:
        if not isinstance(value, str) or value not in spec.choices:
            message = "is an unknown choice" + near(value, spec.choices)
            yield at.problem(message, value=quote(value), remedy=f"choose one of {', '.join(spec.choices)}")
    elif not spec.flag:
        yield from number_problems(value, spec, at)
    elif not isinstance(value, bool) and value not in (0, 1):
        yield at.problem("must be true or false", value=quote(value), remedy=spec.doc)


def _port(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if not isinstance(value, Node):
        in_python = "pass the object returned by d.shaft(...), d.mass(...) or d.housing"
        remedy = say("give the name of one", in_python)
        yield at.problem("must be a shaft, a mass or the housing", value=quote(value), remedy=remedy)
    elif spec.domain and not value.fixed and value.domain is not Domain(spec.domain):
        wanted = "a shaft" if spec.domain == "rotation" else "a mass"
        yield at.problem(f"must be {wanted}", value=quote(value.name), remedy=f"{spec.doc} is in {spec.domain}")


def _thermal(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if not isinstance(value, ThermalNode):
        in_python = f"pass the object returned by d.thermal(...) or d.ambient(...): {spec.doc}"
        remedy = say(f"give the name of one: {spec.doc}", in_python)
        yield at.problem("must be a thermal node or an ambient", value=_shown(value), remedy=remedy)


def _shown(value: Any) -> str:
    return quote(value.name if isinstance(value, Node | Component) else value)


def signal_problems(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    """Mistakes of what drives an input: a number, a signal or a reference."""
    if isinstance(value, Signal):
        found = list(object_problems(value, At(at.path, at.quantity, at.unit, at.scale, spec.units)))
        yield from found
        for name, message, remedy in () if found else value.unit_problems((at.unit, *spec.units)):
            yield at.inner(name).problem(message, remedy=remedy)
        reached = () if found or not (spec.bound or spec.presses) else tuple(extremes(value))
        yield from _beyond_bounds(reached, spec, at) if spec.bound else ()
        asked = spec.presses and not found and not _grows(value)
        yield from _never_presses((load for _, load in reached), at) if asked else ()
    elif (isinstance(value, Real) and not isinstance(value, bool)) or _is_measured(value):
        found = list(number_problems(value, spec, at))
        yield from found
        yield from _never_presses((as_float(value),), at) if spec.presses and not found else ()
    # whether a reference leads to something of that unit is checked where the driveline is known
    elif not is_reference(value):
        remedy = f"give one of {kinds_of(Role.SIGNAL)}"
        if isinstance(value, list | tuple) and value and all(isinstance(pair, list | tuple) for pair in value):
            remedy = say('write {type = "table", points = [[time, value], ...]}', "wrap it: cw.Table([...])")
        if callable(value):
            remedy = "a function is a controller: give cw.Sampled(function, period), with the period in s"
        yield at.problem(f"must be a number{within(at.unit)} or a signal", value=quote(value), remedy=remedy)


def _grows(signal: Signal) -> bool:
    """Whether the last piece of a signal rises or falls without end."""
    pieces = signal.segments()
    return bool(pieces) and signal.repeats() == 0.0 and any(pieces[-1][2:5])


def _never_presses(loads: Iterable[float], at: At) -> Iterator[Problem]:
    """A load that is below zero and never above: a signal may dip below zero by an offset."""
    found = list(loads)
    least, most = min(found, default=0.0), max(found, default=0.0)
    if least < 0.0 >= most:
        size = f"{least:g}" if least == most else f"{least:g} to {most:g}"
        message, remedy = "never presses the contact: a negative load counts as zero", "give zero or a positive value"
        yield at.problem(message, f"{size} {at.unit}".removesuffix(" 1"), remedy)


def _is_measured(value: Any) -> bool:
    """Whether a value is a number with a unit, or meant as one."""
    return has_unit(value) and (not isinstance(value, str) or split(value) is not None or has_comma(value))


def _beyond_bounds(found: Sequence[Reached], spec: Spec, at: At) -> Iterator[Problem]:
    """The first extreme of a signal that is out of bounds by more than the round-off of its pieces."""
    slack = 1e-14 * max((abs(value) for _, value in found), default=0.0)
    for time, value in found:
        ends = (end for end in (spec.at_least, spec.at_most) if end is not None and abs(value - end) <= slack)
        if not spec.allows(next(ends, value)):
            given = f"{value:g} {at.unit}".removesuffix(" 1")
            message = f"must be {spec.bound} {at.unit}".removesuffix(" 1")
            yield at.problem(message, value=f"{given} at {time:g} s", remedy=instead(value, spec))
            return


def _law(value: Any, _: Spec, at: At) -> Iterator[Problem]:
    if not isinstance(value, Law):
        remedy = f"give one of {kinds_of(Role.LAW)}"
        yield at.problem("must be a friction law", value=quote(value), remedy=remedy)
        return
    yield from law_problems(value, at)


def law_problems(law: Law, at: At, sound: bool = False) -> Iterator[Problem]:
    """All mistakes of a friction law.

    Parameters: sound, whether its values are right, so that only rules between them are looked at.
    """
    found = list(object_problems(law, at, sound=sound))
    yield from found or (_peak(law, at) if law.sticks else ())


def _peak(law: Law, at: At) -> Iterator[Problem]:
    """A kinetic coefficient above the static one has no motion that follows from it."""
    static: Any = law.static
    kinetic = law.sliding()
    # a law over the temperature compares its tables itself
    if static is not None and not isinstance(static, Real):
        return
    if kinetic is None and inputs(type(law)):
        return
    if static is None or kinetic is None:
        kinetic, static = coefficients(law, 0.0)
    # equal values may differ by round-off
    if kinetic > static * (1 + 1e-12):
        message = f"is below the kinetic coefficient at vanishing slip, {kinetic:g}"
        yield at.inner("static").problem(message, value=f"{static:g}", remedy=f"raise it to at least {kinetic:g}")


def _text(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if not (value is None and spec.optional) and (not isinstance(value, str) or not value):
        written = f"write {quote(str(value))}: " if isinstance(value, int) and not isinstance(value, bool) else ""
        yield at.problem("must be a string", value=quote(value), remedy=f"{written}{spec.doc}")


def _formula(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    """The law says what is wrong with one."""
    if value is None and not spec.optional:
        yield at.problem("is missing", remedy=f"give an expression: {spec.doc}")


def _function(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if not callable(value):
        yield at.problem("must be a Python function", value=quote(value), remedy=spec.doc)


def _named(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    if not isinstance(value, Mapping):
        yield at.problem(f"must be a table of numbers{within(at.unit)} by name", quote(value), 'write {"S1": 0.02}')
        return
    for name, number in value.items():
        yield from number_problems(number, spec, at.inner(str(name), at.unit))


def _tables(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    """What is inside of the tables is looked at by what they describe."""
    if not isinstance(value, Mapping):
        yield at.problem("must be a table", quote(value), f"give a table by name: {spec.doc}")
        return
    for name, table in value.items():
        if not isinstance(table, Mapping):
            remedy = say("write its fields below a head of its own", 'write its fields, as in {"pressure": 1e6}')
            yield at.inner(str(name)).problem("must be a table", quote(table), remedy)


def _data(value: Any, spec: Spec, at: At) -> Iterator[Problem]:
    """Mistakes of it are reported by its reader."""
    if value is None or value == "":
        yield at.problem("is missing", quote(value), spec.doc)


# what may be a plain number
NUMBERS = ("param", "option", "signal", "alternative")
CHECKS: dict[str, Callable[[Any, Spec, At], Iterator[Problem]]] = {
    "param": _param,
    "option": _param,
    "port": _port,
    "thermal": _thermal,
    "curve": curve_problems,
    "numbers": list_problems,
    "signal": signal_problems,
    "alternative": signal_problems,
    "law": _law,
    "text": _text,
    "formula": _formula,
    "function": _function,
    "named": _named,
    "elements": _tables,
    "data": _data,
}
