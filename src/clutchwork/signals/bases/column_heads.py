"""Heads of columns in CSV files, such as `c1 [bar]`: which one a name means, and the factor of its unit to SI."""

from __future__ import annotations

import re

from clutchwork.base import dataclass
from clutchwork.declare.quantity import PLAIN, QuantityError, scale_to_si
from clutchwork.declare.units import Scale, other_zero, parse, turns

_HEAD = re.compile(r"(.*?)\s*\[(.*)\]")
# what heads write for "no unit"
BARE = ("", "-")


@dataclass(frozen=True)
class ColumnHead:
    """A column: its whole head in the file, and its unit, empty where none is given."""

    text: str
    unit: str

    def scale(self, wanted: tuple[str, ...] = ()) -> Scale:
        """What puts values into SI; QuantityError where the unit is not known or fits none of those wanted."""
        if not self.unit:
            return PLAIN
        if wanted:
            return scale_to_si(self.unit, wanted[0], wanted[1:], self.text)
        if other_zero(self.unit):
            return scale_to_si(self.unit, "K", (), self.text)
        try:
            # as in files of other formats
            return Scale(parse("rpm" if turns(self.unit) else self.unit).factor)
        except ValueError:
            remedy = "write one such as [bar], or leave it out where the values are in SI"
            try:
                return scale_to_si(self.unit, "K", (), self.text)
            except QuantityError as bad:
                raise QuantityError(bad.message, bad.value, remedy) from None


def split(head: str) -> tuple[str, str]:
    """Name and unit of a head such as `slip [rad/s]`."""
    match = _HEAD.fullmatch(head) if head.endswith("]") else None
    return (match[1], "" if match[2].strip() in BARE else match[2]) if match else (head, "")


def meant(wanted: str, known: list[str]) -> list[ColumnHead]:
    """The columns that a name may mean: the one of that very head, else those of that name.

    A name without a unit means a head with one, and a unit that is given with a name counts where the head has none.
    """
    name, unit = split(wanted)
    found = [head for head in known if head == wanted]
    found = found or [head for head in known if split(head)[0] == name and "" in (unit, split(head)[1])]
    return [ColumnHead(head, split(head)[1] or unit) for head in found]
