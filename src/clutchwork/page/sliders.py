"""Numbers that the reader of a page turns: which words of the System each of them is, or changes."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Sequence
from itertools import combinations
from math import inf, isfinite
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError, UseError
from clutchwork.declare.schema import Spec
from clutchwork.model.changes import Target, field_of, in_si, named, target, targets_of, unit_of

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

STOPS, MOST_USUAL = 41, 3
Words = NDArray[np.uint64]
Bytes = Callable[[Any], bytes]


@dataclass(frozen=True, eq=False)
class Slider:
    """A number, its values, and the words of each of them."""

    name: str
    unit: str
    doc: str
    start: float
    values: NDArray[np.float64]
    places: NDArray[np.int64]  # words that change
    words: Words  # of each value
    direct: bool  # every word is the number itself, so that it may have any value between

    def plain(self) -> dict[str, Any]:
        """As a page has it."""
        made: dict[str, Any] = {"name": self.name, "unit": self.unit, "doc": self.doc, "start": self.start}
        made |= {"values": self.values.tolist(), "places": self.places.tolist(), "direct": self.direct}
        return made if self.direct else made | {"words": b64encode(self.words.astype("<u8").tobytes()).decode()}


def sliders(system: System, wanted: Sequence[str] | None, dragged: Sequence[str], bytes_of: Bytes) -> list[Slider]:
    """The sliders of a page; UseError names all that cannot be one.

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
    problems += _shared(found)
    if problems:
        raise UseError("page", problems)
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
        if not _shared([*found, one]):
            found.append(one)
    return found


def _slider(system: System, asked: str, bytes_of: Bytes) -> Slider:
    name, _, span = asked.partition("=")
    name = name.strip()
    aim = _aim(system, name)
    value, spec = field_of(aim)
    if spec.flag or spec.choices or spec.whole or spec.fixed or isinstance(value, bool) or not isinstance(value, Real):
        raise ValueError(f"{name} is {value!r}, not a number that a slider can turn")
    start = float(value)
    low, high = _span(aim, name, span, start, spec)
    values = np.unique(np.append(np.linspace(low, high, STOPS), start if low <= start <= high else low))
    places, words, kept = _words(system, name, values, bytes_of)
    if not len(places):
        raise ValueError(f"{name} changes nothing in this driveline between {low:g} and {high:g} {unit_of(aim)}")
    direct = bool(np.all(words.view(np.float64) == kept[:, None]))
    return Slider(name, unit_of(aim), spec.doc, start, kept, places, words, direct)


def _aim(system: System, name: str) -> Target:
    if system.source is None:
        raise ValueError("the driveline of this System is not known; make the page from a model")
    aim = target(named(system.source), name)
    if aim is None:
        _, (problem, *_) = targets_of(system.source, [name])
        raise ValueError(str(problem))
    return aim


def _span(aim: Target, name: str, text: str, start: float, spec: Spec) -> tuple[float, float]:
    """Ends of a slider: those that are given, or half and twice the value within what is allowed."""
    if text:
        ends = [_number(aim, part) for part in text.split(":")]
        if len(ends) != 2 or not ends[0] < ends[1] or not all(map(isfinite, ends)):
            raise ValueError(f"{name}: {text!r} are not two ends; write {name}=2e-4:8e-4, the lower end first")
        return ends[0], ends[1]
    if not start:
        raise ValueError(f"{name} is 0: give the ends of its slider, {name}=0:10")
    low, high = sorted((0.5 * start, 2.0 * start))
    least = max(-inf if bound is None else bound for bound in (spec.at_least, spec.above))
    most = min(inf if bound is None else bound for bound in (spec.at_most, spec.below))
    return max(low, least), min(high, most)


def _number(aim: Target, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float(in_si(aim, text.strip()))


def _words(
    system: System, name: str, values: Any, bytes_of: Bytes
) -> tuple[NDArray[np.int64], Words, NDArray[np.float64]]:
    """Words that any value changes, and what each value makes of them; values that are refused are left out."""
    lines, kept = list[Words](), list[float]()
    refused = ""
    own = np.frombuffer(bytes_of(system), dtype=np.uint64)
    for value in values.tolist():
        try:
            data = bytes_of(system.changed({name: value}))
        except ModelError as error:
            refused = str(error)
            continue
        if len(data) == own.nbytes:
            lines.append(np.frombuffer(data, dtype=np.uint64))
            kept.append(value)
    if len(kept) < 2:
        raise ValueError(f"{name} cannot be turned: {refused or 'its values make other drivelines'}")
    whole = np.array(lines)
    places = np.flatnonzero((whole != own).any(axis=0))
    return places, np.ascontiguousarray(whole[:, places]), np.array(kept)


def _shared(found: Sequence[Slider]) -> list[str]:
    """Sliders whose words are the same, of which only one can be turned."""
    return [
        f"slider: {one.name} and {other.name} change the same numbers of the driveline; give one of them"
        for one, other in combinations(found, 2)
        if set(one.places.tolist()) & set(other.places.tolist())
    ]
