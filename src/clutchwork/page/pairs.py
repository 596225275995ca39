"""Sliders of which two go together, as they depend on each other or are refused at some of their ends: all pairs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations, product
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError, dataclass
from clutchwork.page.slider import Bytes, Numbers, Slider, Words, packed
from clutchwork.page.together import dependent, made, refused, words_of

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

# of each of the two
STOPS = 17


@dataclass(frozen=True, eq=False)
class Pair:
    """Two sliders, and the words of all pairs of their values: those of the first value of the first one first."""

    sliders: tuple[int, int]
    # their stops and starts: one is turned from the start of the other, wherever that is
    values: tuple[Numbers, Numbers]
    places: NDArray[np.int64]
    words: Words
    refused: dict[int, str]  # why a pair has no driveline

    def plain(self) -> dict[str, Any]:
        """As a page has it."""
        refused = {str(line): why for line, why in self.refused.items()}
        return {
            "sliders": list(self.sliders),
            "values": [values.tolist() for values in self.values],
            "places": self.places.tolist(),
            "words": packed(self.words),
            "refused": refused,
        }


def paired(system: System, turned: Sequence[Slider], bytes_of: Bytes) -> tuple[list[Slider], list[Pair]]:
    """The sliders, with stops of their pairs, and the pairs; UseError where more than two go together."""
    groups = list(_groups(system, turned, bytes_of))
    _refuse(turned, [group for group in groups if len(group) > 2])
    found, pairs = list(turned), list[Pair]()
    for first, second in groups:
        found[first], found[second] = _coarse(turned[first]), _coarse(turned[second])
        pairs.append(_pair(system, found, (first, second), bytes_of))
    _refuse(turned, list(_meeting(found, pairs)))
    beyond = [told for number in _alone(found, pairs) for told in _beyond(system, found[number])]
    if beyond:
        raise UseError("page", beyond)
    return found, pairs


def _alone(found: Sequence[Slider], pairs: Sequence[Pair]) -> list[int]:
    """Numbers of the sliders that are in no pair."""
    return [number for number in range(len(found)) if not any(number in pair.sliders for pair in pairs)]


def _beyond(system: System, slider: Slider) -> Iterator[str]:
    """Ends that were asked for, at which there is no driveline."""
    for end, reached in zip(slider.ends, slider.values[[0, -1]].tolist(), strict=True):
        if end != reached:
            _, why = made(system, slider.changes(end))
            yield f"slider: {slider.name} cannot reach {end:g} {slider.unit}: {why or 'that is another driveline'}"


def _refuse(turned: Sequence[Slider], groups: Sequence[Sequence[int]]) -> None:
    if groups:
        raise UseError("page", [_too_many([turned[number].name for number in group]) for group in groups])


def _too_many(names: Sequence[str]) -> str:
    told = f"{', '.join(names[:-1])} and {names[-1]}"
    return f"slider: {told} depend on each other in this driveline, and a page has at most two such; give two of them"


def _meeting(found: Sequence[Slider], pairs: Sequence[Pair]) -> Iterator[list[int]]:
    """Sliders of which a pair changes words, both turned, that others change too."""
    changed: dict[tuple[int, ...], NDArray[np.int64]] = {
        (number,): found[number].places for number in _alone(found, pairs)
    }
    changed |= {pair.sliders: pair.places for pair in pairs}
    for one, other in combinations(changed, 2):
        if np.intersect1d(changed[one], changed[other]).size:
            yield sorted([*one, *other])


def _groups(system: System, turned: Sequence[Slider], bytes_of: Bytes) -> Iterator[list[int]]:
    """Numbers of the sliders that go together, of two and more."""
    group = list(range(len(turned)))
    for first, second in combinations(range(len(turned)), 2):
        one, other = turned[first], turned[second]
        if group[first] == group[second]:
            continue
        if dependent(system, one, other, bytes_of) or refused(system, one, other):
            old, new = group[second], group[first]
            group = [new if number == old else number for number in group]
    for number in sorted(set(group)):
        members = [place for place, own in enumerate(group) if own == number]
        if len(members) > 1:
            yield members


def _coarse(slider: Slider) -> Slider:
    """A slider with the stops of a pair, whose words the pair has."""
    low, high = slider.ends
    start = slider.start if low <= slider.start <= high else low
    values: Numbers = np.unique(np.append(np.linspace(low, high, STOPS), start))
    places, words = np.zeros(0, dtype=np.int64), np.zeros((len(values), 0), dtype=np.uint64)
    return replace(slider, values=values, places=places, words=words, direct=False)


def _pair(system: System, turned: Sequence[Slider], which: tuple[int, int], bytes_of: Bytes) -> Pair:
    one, other = turned[which[0]], turned[which[1]]
    values = (np.union1d(one.values, one.start), np.union1d(other.values, other.start))
    own = words_of(system, bytes_of)
    lines, none = list[Words](), dict[int, str]()
    for line, at in enumerate(product(values[0].tolist(), values[1].tolist())):
        there, why = made(system, one.changes(at[0]) | other.changes(at[1]))
        data = own if there is None else words_of(there, bytes_of)
        if why or len(data) != len(own):
            data, none[line] = own, why or "these values make another driveline, which a page cannot become"
        lines.append(data)
    if len(none) > len(lines) - 2:
        names = f"{one.name} and {other.name}"
        raise UseError("page", [f"slider: {names} cannot be turned together: {next(iter(none.values()))}"])
    whole = np.array(lines)
    places = np.flatnonzero((whole != own).any(axis=0))
    return Pair(which, values, places, np.ascontiguousarray(whole[:, places]), none)
