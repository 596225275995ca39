"""Common base of all elements that turn work into heat."""

from __future__ import annotations

from typing import ClassVar

from clutchwork.declare import Component, HeatPath, ThermalNode, Work, family, option, port


@family
class Heating(Component):
    """An element that turns work into heat, which may go to a thermal node."""

    work: ClassVar[Work] = Work.LOSS

    heat: ThermalNode | None = port("thermal node that takes its heat", default=None, domain="thermal", last=2)
    heat_share: float = option(
        "1", "share of its heat; the rest is not tracked", default=1.0, at_least=0.0, at_most=1.0, last=2
    )

    def heat_path(self) -> HeatPath | None:
        """Its thermal node, where it has one."""
        return None if self.heat is None else HeatPath(self.heat, float(self.heat_share))
