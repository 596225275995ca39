"""Common base of rigid stops."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Law, family
from clutchwork.elements.bases.heating import Heating
from clutchwork.laws.coulomb import Coulomb


@family
class Stop(Heating):
    """A contact that exists only at the ends of a travel; `initial_states` is its position at the start."""

    # it has no load, so its coefficient does not matter
    friction: ClassVar[Law] = Coulomb(static=0.1, kinetic=0.1)  # type: ignore[misc]
    tolerance: ClassVar[float] = 0.0

    def is_open(self) -> bool:
        """Whether its position at the start may follow from what moves a mass."""
        return False

    def rests(self) -> bool:
        """Whether it is at an end at the start."""
        raise NotImplementedError
