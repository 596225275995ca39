"""Continuously variable transmission."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import ClassVar

from clutchwork.declare import Found, Node, Role, SignalLike, component, option, port, signal
from clutchwork.declare.node import Part
from clutchwork.elements.bases.contacts import Sticking
from clutchwork.elements.bases.ratios import ratio_problems
from clutchwork.elements.clutch import Clutch
from clutchwork.elements.variable_gear import VariableGear
from clutchwork.laws.coulomb import Coulomb


@component(Role.COMPOSITE)
class VariableRatio(Sticking):
    """Transmission whose ratio varies: speed of the input = ratio times speed of the output, relative to the support.

    Use it for a CVT, a toroidal drive, a hydrostatic drive without losses. The ratio is a signal, or the state of a
    process that follows a command, such as a controller's. Power is transmitted without loss; a change of the ratio
    accelerates both sides, with the signal `torque` on the input. A jump of the ratio keeps the energy, not the
    momentum. At ratio 0 the input is at rest.

    With a `capacity`, torque at the input, it slips under a larger torque, as a belt does, and grips again.

    Equations: docs/theory/varying-ratios.md.
    """

    reports: ClassVar[Mapping[str, str]] = {
        "torque": "on the input",
        "slip": "input minus ratio times output, exactly zero while it grips",
        "normal_force": "its capacity",
    }

    input: Node = port("shaft whose speed is ratio times that of the output")
    output: Node = port("other shaft")
    support: Node | None = port("member that carries it and takes the reaction", default=None)
    ratio: SignalLike = signal("1", "speed of the input over speed of the output", example=2.0)
    capacity: SignalLike | None = signal(
        "N m", "largest torque at the input, unlimited by default", default=None, units=("N",), at_least=0.0
    )
    tolerance: float = option(
        "rad/s", "slip below which it may grip; 0: at exactly zero", default=0.0, at_least=0.0, units=("m/s",), last=1
    )
    locked: bool = option("1", "grips at the start, by an impulse if necessary", default=True, flag=True, last=1)

    def problems(self) -> Found:
        return ratio_problems(self.ratio)

    def parts(self) -> Iterator[Part]:
        """The gear; with a capacity also what slips, and the shaft without inertia between them."""
        if self.capacity is None:
            yield VariableGear(self.name, input=self.input, output=self.output, support=self.support, ratio=self.ratio)
            return
        between = Node(f"{self.name}.shaft", self.input.domain)
        yield between
        yield VariableGear(
            f"{self.name}.gear", input=between, output=self.output, support=self.support, ratio=self.ratio
        )
        yield Clutch(
            self.name,
            base=between,
            follower=self.input,
            friction=Coulomb(static=1.0, kinetic=1.0),
            gain=1.0,
            normal_force=self.capacity,
            **self.sticking(),
        )
