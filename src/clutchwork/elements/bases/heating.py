"""What all elements have in common that turn work into heat."""

from __future__ import annotations

from clutchwork.declare import Component, ThermalNode, family, option, port


@family
class Heating(Component):
    """An element whose heat may go to a thermal node."""

    heat: ThermalNode | None = port("thermal node that takes its heat", default=None, domain="thermal", last=True)
    heat_share: float = option(
        "1", "share of its heat; the rest is not tracked", default=1.0, at_least=0.0, at_most=1.0, last=True
    )
