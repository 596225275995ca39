"""Sliders of which two go together, as they change the same words or are refused at some of their ends: all pairs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations, product
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError, UseError
from clutchwork.page.sliders import Bytes, Numbers, Slider, Words, packed, shared

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

# of each of the two
STOPS = 17


@dataclass(frozen=True, eq=False)
class Pair:
    """Two sliders, and the words of all pairs of their values: those of the first value of the first one first."""

    sliders: tuple[int, int]
    places: NDArray[np.int64]
    words: Words
    refused: dict[int, str]  # why a pair has no driveline

    def plain(self) -> dict[str, Any]:
        """As a page has it."""
        refused = {str(line): why for line, why in self.refused.items()}
        return {
            "sliders": list(self.sliders),
            "places": self.places.tolist(),
            "words": packed(self.words),
            "refused": refused,
        }


def paired(system: System, turned: Sequence[Slider], bytes_of: Bytes) -> tuple[list[Slider], list[Pair]]:
    """The sliders, with stops of their pairs, and the pairs; UseError where more than two go together."""
    groups = list(_groups(system, turned))
    wide = [group for group in groups if len(group) > 2]
    if wide:
        raise UseError("page", [_too_many([turned[number].name for number in group]) for group in wide])
    made, pairs = list(turned), list[Pair]()
    for first, second in groups:
        made[first], made[second] = _coarse(turned[first]), _coarse(turned[second])
        pairs.append(_pair(system, made, (first, second), bytes_of))
    return made, pairs


def _too_many(names: Sequence[str]) -> str:
    told = f"{', '.join(names[:-1])} and {names[-1]}"
    return f"slider: {told} depend on each other in this driveline, and a page has at most two such; give two of them"


def _groups(system: System, turned: Sequence[Slider]) -> Iterator[list[int]]:
    """Numbers of the sliders that go together, of two and more."""
    group = list(range(len(turned)))
    for first, second in combinations(range(len(turned)), 2):
        one, other = turned[first], turned[second]
        if group[first] != group[second] and (shared(one, other) or _refused(system, one, other)):
            old, new = group[second], group[first]
            group = [new if number == old else number for number in group]
    for number in sorted(set(group)):
        members = [place for place, own in enumerate(group) if own == number]
        if len(members) > 1:
            yield members


def _refused(system: System, one: Slider, other: Slider) -> bool:
    """Whether there is no driveline at some of their ends, as with a static coefficient below the kinetic one."""
    return any(_made(system, one, other, *at)[1] for at in product(one.ends, other.ends))


def _made(system: System, one: Slider, other: Slider, first: float, second: float) -> tuple[System | None, str]:
    """The System at two values, or why there is none."""
    try:
        return system.changed(one.changes(first) | other.changes(second)), ""
    except ModelError as error:
        return None, str(error).strip().splitlines()[-1].strip()


def _coarse(slider: Slider) -> Slider:
    """A slider with the stops of a pair, whose words the pair has."""
    # the start is there wherever it is: the other slider is turned from it
    values: Numbers = np.unique(np.append(np.linspace(*slider.ends, STOPS), slider.start))
    places, words = np.zeros(0, dtype=np.int64), np.zeros((len(values), 0), dtype=np.uint64)
    return replace(slider, values=values, places=places, words=words, direct=False)


def _pair(system: System, turned: Sequence[Slider], which: tuple[int, int], bytes_of: Bytes) -> Pair:
    one, other = turned[which[0]], turned[which[1]]
    own = np.frombuffer(bytes_of(system), dtype=np.uint64)
    lines, refused = list[Words](), dict[int, str]()
    for line, at in enumerate(product(one.values.tolist(), other.values.tolist())):
        made, why = _made(system, one, other, *at)
        data = own if made is None else np.frombuffer(bytes_of(made), dtype=np.uint64)
        if why or len(data) != len(own):
            data, refused[line] = own, why or "these values make another driveline, which a page cannot become"
        lines.append(data)
    if len(refused) > len(lines) - 2:
        names = f"{one.name} and {other.name}"
        raise UseError("page", [f"slider: {names} cannot be turned together: {next(iter(refused.values()))}"])
    whole = np.array(lines)
    places = np.flatnonzero((whole != own).any(axis=0))
    return Pair(which, places, np.ascontiguousarray(whole[:, places]), refused)
