"""Numbers that the reader of a page turns: which words of the System each of them is, or changes."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import combinations
from math import isfinite
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import UseError
from clutchwork.declare.schema import Spec, common_ends
from clutchwork.model.changes import Target, all_names, field_of, in_si, named, target, targets_of, unit_of
from clutchwork.page.slider import Bytes, Slider, Words, start_of
from clutchwork.page.together import dependent, made, words_of
from clutchwork.results.selection import meant

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

STOPS, MOST_USUAL = 41, 3


def sliders(system: System, wanted: Sequence[str] | None, dragged: Sequence[str], bytes_of: Bytes) -> list[Slider]:
    """The sliders of a page, each as if it were alone; UseError names all that cannot be one.

    Parameters: dragged, names of the tables; bytes_of, what the page has of a System.
    """
    if wanted is None:
        return usual(system, dragged, bytes_of)
    found, problems = list[Slider](), list[str]()
    for one in wanted:
        try:
            found.append(_slider(system, one, bytes_of))
        except ValueError as error:
            problems.append(f"slider: {error}")
    problems += _twice(found)
    if problems:
        raise UseError("page", problems)
    return found


def names_of(system: System, wanted: Sequence[str]) -> set[str]:
    """Numbers that sliders would turn."""
    found = set[str]()
    for one in wanted:
        with suppress(ValueError):
            found.update(_asked(system, one)[2])
    return found


def usual(system: System, dragged: Sequence[str], bytes_of: Bytes) -> list[Slider]:
    """Gains and coefficients of the contacts that are dragged, and the inertia of the last shaft."""
    owners, known = [name.rpartition(".")[0] for name in dragged], [one.name for one in system.contacts]
    contacts = [name for name in known if name in owners] or known
    names = [f"{name}.{word}" for word in ("gain", "friction.kinetic", "friction.static") for name in contacts]
    names += [f"{node.name}.{word}" for node in reversed(system.nodes) for word in ("inertia", "mass")]
    found = list[Slider]()
    for name in names:
        if len(found) == MOST_USUAL:
            break
        try:
            one = _slider(system, name, bytes_of)
        except ValueError:
            continue
        if not any(dependent(system, one, other, bytes_of) for other in found):
            found.append(one)
    return found


def _slider(system: System, asked: str, bytes_of: Bytes) -> Slider:
    name, span, names = _asked(system, asked)
    aims = [_aim(system, one) for one in names]
    unit = _unit(name, dict(zip(names, map(unit_of, aims), strict=True)))
    starts, declared = zip(*(_number_at(one, aim) for one, aim in zip(names, aims, strict=True)), strict=True)
    low, high = _span(aims[0], name, span, starts, declared)
    start = start_of(starts)
    values = np.unique(np.append(np.linspace(low, high, STOPS), start if low <= start <= high else low))
    places, words = np.zeros(0, dtype=np.int64), np.zeros((len(values), 0), dtype=np.uint64)
    bare = Slider(name, names, unit, declared[0].doc, starts, (low, high), values, places, words, False)
    slider = _with_words(system, bare, bytes_of)
    if not len(slider.places):
        raise ValueError(f"{name} changes nothing in this driveline between {low:g} and {high:g} {unit}")
    return slider if span else replace(slider, ends=(float(slider.values[0]), float(slider.values[-1])))


def _asked(system: System, asked: str) -> tuple[str, str, tuple[str, ...]]:
    """What a string stands for: its name, the ends after the last "=", empty where it has none, and the numbers."""
    if system.source is None:
        raise ValueError("the driveline of this System is not known; make the page from a model")
    known, whole = dict.fromkeys(all_names(system.source)), asked.strip()
    name, mark, span = (part.strip() for part in whole.rpartition("="))
    # names may have "=" themselves
    if not mark or all(_fitting(system, part, known) for part in _parts(system, whole, known)):
        name, span = whole, ""
    return name, span, _names(system, name, known)


def _names(system: System, name: str, known: Collection[str]) -> tuple[str, ...]:
    """Numbers that a name, a wildcard, or several of them with commas stand for."""
    found = list[str]()
    for part in _parts(system, name, known):
        fitting = _fitting(system, part, known)
        if not fitting and _is_wild(part):
            raise ValueError(f"{part!r} fits no number of this driveline; clutchwork check MODEL --names lists them")
        # what is unknown is explained with its aim
        found += fitting or [part]
    return tuple(dict.fromkeys(found))


def _parts(system: System, text: str, known: Collection[str]) -> list[str]:
    """What stands between commas; what fits with its commas is one."""
    pieces, found = text.split(","), list[str]()
    while pieces:
        joined = ((n, ",".join(pieces[:n]).strip()) for n in range(len(pieces), 0, -1))
        count, part = next(((n, one) for n, one in joined if _fitting(system, one, known)), (1, pieces[0].strip()))
        found += [part] if part else []
        pieces = pieces[count:]
    return found or [text]


def _fitting(system: System, part: str, known: Collection[str]) -> list[str]:
    """Numbers that a name or a wildcard stands for."""
    if part in known:
        return [part]
    return [one for one in meant(part, known) if _turns(system, one)] if _is_wild(part) else []


def _is_wild(part: str) -> bool:
    return "*" in part or "?" in part


def _turns(system: System, name: str) -> bool:
    try:
        _number_at(name, _aim(system, name))
    except ValueError:
        return False
    return True


def _number_at(name: str, aim: Target) -> tuple[float, Spec]:
    """The value of a number, and what is declared of it."""
    value, spec = field_of(aim)
    if spec.flag or spec.choices or spec.whole or spec.fixed or isinstance(value, bool) or not isinstance(value, Real):
        raise ValueError(f"{name} is {value!r}, not a number that a slider can turn")
    return float(value), spec


def _unit(name: str, units: dict[str, str]) -> str:
    """The unit that all numbers of a slider have."""
    if len(set(units.values())) > 1:
        told = ", ".join(f"{one} in {unit or '1'}" for one, unit in units.items())
        raise ValueError(f"{name} stands for numbers of different units, {told}; give a slider for each unit")
    return next(iter(units.values()))


def _aim(system: System, name: str) -> Target:
    source: Any = system.source
    aim = target(named(source), name)
    if aim is None:
        _, (problem, *_) = targets_of(source, [name])
        raise ValueError(str(problem))
    return aim


def _span(aim: Target, name: str, text: str, starts: Sequence[float], declared: Sequence[Spec]) -> tuple[float, float]:
    """Ends of a slider: those that are given, or half and twice the values within what is allowed."""
    if text:
        ends = [_number(aim, name, part) for part in text.split(":")]
        if len(ends) != 2 or not ends[0] < ends[1] or not all(map(isfinite, ends)):
            raise ValueError(f"{name}: {text!r} are not two ends; write {name}=2e-4:8e-4, the lower end first")
        return ends[0], ends[1]
    if not any(starts):
        raise ValueError(f"{name} is 0: give the ends of its slider, {name}=0:10")
    reach = [factor * start for start in starts for factor in (0.5, 2.0)]
    least, most = common_ends(declared)
    return max(min(reach), least), min(max(reach), most)


def _number(aim: Target, name: str, text: str) -> float:
    """An end of a slider, plain or with a unit."""
    with suppress(ValueError):
        return float(text)
    with suppress(ValueError):
        return float(in_si(aim, text.strip()))
    unit = unit_of(aim) or "1"
    raise ValueError(f"{name}: {text.strip()!r} is not an end of its slider; give two numbers in {unit}, or with units")


def _with_words(system: System, slider: Slider, bytes_of: Bytes) -> Slider:
    """Words that any value changes, and their content for each value; refused values are left out."""
    lines, kept = list[Words](), list[float]()
    refused = ""
    own = words_of(system, bytes_of)
    for value in slider.values.tolist():
        found, why = made(system, slider.changes(value))
        refused = why or refused
        if found is not None and len(data := words_of(found, bytes_of)) == len(own):
            lines.append(data)
            kept.append(value)
    if len(kept) < 2:
        raise ValueError(f"{slider.name} cannot be turned: {refused or 'its values make other drivelines'}")
    whole, values = np.array(lines), np.array(kept)
    places = np.flatnonzero((whole != own).any(axis=0))
    words = np.ascontiguousarray(whole[:, places])
    turned = values != slider.start
    direct = bool(len(places)) and bool(np.all(words[turned].view(np.float64) == values[turned, None]))
    return replace(slider, values=values, places=places, words=words, direct=direct)


def _twice(found: Sequence[Slider]) -> list[str]:
    """Numbers that two sliders would turn."""
    return [
        f"slider: {name} has two sliders, {one.name!r} and {other.name!r}; remove one of them"
        for one, other in combinations(found, 2)
        for name in one.names
        if name in other.names
    ]
