"""A number of a page that its reader turns: its values, and the words of the System that each of them changes."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass

Numbers = NDArray[np.float64]
Words = NDArray[np.uint64]
Bytes = Callable[[Any], bytes]


@dataclass(frozen=True, eq=False)
class Slider:
    """A number, or several that are turned together, its values, and the words of each of them."""

    name: str  # as it was asked for
    names: tuple[str, ...]
    unit: str
    doc: str
    starts: tuple[float, ...]  # of each name
    ends: tuple[float, float]
    values: Numbers
    places: NDArray[np.int64]  # words that change
    words: Words  # of each value
    direct: bool  # every word is the number itself, so that it may have any value between

    @property
    def start(self) -> float:
        """Where it stands at first; numbers with different starts keep them until the slider is turned."""
        return start_of(self.starts)

    def changes(self, value: float) -> dict[str, float]:
        """What `System.changed` takes for a value."""
        return {} if value == self.start else dict.fromkeys(self.names, value)

    def turned(self, words: Words, value: float) -> None:
        """Put a value of it into the words of a System, as a page does."""
        if value != self.start:
            words[self.places] = self.words[self.values.tolist().index(value)]

    def plain(self) -> dict[str, Any]:
        """As a page has it."""
        made: dict[str, Any] = {"name": self.name, "names": list(self.names), "unit": self.unit, "doc": self.doc}
        made |= {"start": self.start, "starts": sorted(set(self.starts)), "values": self.values.tolist()}
        made |= {"places": self.places.tolist(), "direct": self.direct}
        return made if self.direct else made | {"words": packed(self.words)}


def packed(words: Words) -> str:
    """Words as letters."""
    return b64encode(words.astype("<u8").tobytes()).decode()


def start_of(starts: Sequence[float]) -> float:
    """The start of all numbers of a slider, or the middle of what they start from."""
    return starts[0] if len(set(starts)) == 1 else sum(starts) / len(starts)
