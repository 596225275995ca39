"""One line of a table of losses, and what a picture needs of the table."""

from __future__ import annotations

from typing import Protocol

from clutchwork.base.classes import dataclass


@dataclass(frozen=True)
class Loss:
    """Energies of one element or shaft over a window [J], or mean powers [W].

    `taken = given + stored + heat`, but for what the integration missed.
    """

    element: str
    kind: str  # such as "disk_clutch"; "shaft" and "mass" for those
    taken: float  # what went in, from shafts and from outside
    given: float  # what came out, to shafts and to outside
    stored: float  # change of kinetic and elastic energy
    heat: float
    share: float  # of all heat
    outside: float  # part of what went in that came from outside, negative: that went out there

    @property
    def efficiency(self) -> float:
        """What came out over what went in; not a number where nothing went in."""
        return self.given / self.taken if self.taken else float("nan")


class LossTable(Protocol):
    """A table of losses."""

    @property
    def model(self) -> str:
        """Name of the driveline."""

    @property
    def begin(self) -> float:
        """Where the window begins [s]."""

    @property
    def end(self) -> float:
        """Where it ends [s]."""

    @property
    def lines(self) -> tuple[Loss, ...]:
        """Losses of every element and shaft."""

    @property
    def joints(self) -> tuple[tuple[str, str, float], ...]:
        """(element, shaft, what the element gave to the shaft)."""

    @property
    def power(self) -> bool:
        """Whether all are mean powers."""

    @property
    def unit(self) -> str:
        """Unit of all numbers."""

    @property
    def heat(self) -> float:
        """Heat of all elements."""

    @property
    def efficiency(self) -> float:
        """Part of what came in that did not become heat."""

    @property
    def shafts(self) -> tuple[str, str] | None:
        """Shafts of drive and load."""

    def _repr_html_(self) -> str:
        """The table for a notebook."""
