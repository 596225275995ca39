"""Rigid gear whose ratio varies."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from clutchwork.declare import Component, Found, Node, Role, SignalLike, Way, Work, component, port, signal
from clutchwork.elements.bases.ratios import Rates, at_start, ratio_problems


@component(
    Role.TORQUE,
    hooks=("ratio",),
    ways=(Way("input", "input relative to the support"), Way("output", "output relative to the support")),
)
class VariableGear(Component):
    """Speed of the input = ratio times speed of the output, both relative to the support; the ratio is a signal.

    Use it as the gear inside of a `VariableRatio`, which can slip too. Power is transmitted without loss; momentum is
    not conserved, because the rate of the ratio accelerates both sides. A jump of the ratio is the limit of a fast
    change.
    """

    work: ClassVar[Work] = Work(0)

    input: Node = port("shaft whose speed is ratio times that of the output")
    output: Node = port("other shaft")
    support: Node | None = port("member that carries the gear and takes the reaction", default=None)
    ratio: SignalLike = signal("1", "speed of the input over speed of the output", example=2.0)

    def problems(self) -> Found:
        return ratio_problems(self.ratio)

    def directions(self) -> Mapping[str, Rates]:
        """Both rates relative to the support."""
        return {"input": {"input": 1, "support": -1}, "output": {"output": 1, "support": -1}}

    def start_ratio(self) -> float:
        """Ratio at the start."""
        return at_start(self.ratio)
