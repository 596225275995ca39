"""Tyre that rolls exactly, up to its grip."""

from __future__ import annotations

from collections.abc import Iterator

from clutchwork.declare import Law, Node, Role, SignalLike, component, law, option, param, port, signal
from clutchwork.declare.node import Domain, Part
from clutchwork.elements.bases.contacts import Contact
from clutchwork.elements.clutch import Clutch
from clutchwork.elements.rolling_wheel import RollingWheel


@component(Role.COMPOSITE)
class RollingContact(Contact):
    """Wheel that rolls without slip while the road can hold it, else slides: a clutch between rim and road.

    The slip is `v - radius (w - w_support)`, the force on the mass within `static coefficient * load` while it rolls
    and `-sign(slip) kinetic coefficient * load` while it slides. Use it for launches and braking at the limit of grip
    where the creep of a tyre does not matter: it takes one contact and no states. Brake, wheel and road may all hold at
    once. Its part "rim" is a mass without inertia at the circumference of the wheel.
    """

    shaft: Node = port("axle of the wheel", domain="rotation")
    mass: Node = port("mass that it moves", domain="translation")
    support: Node | None = port("member that carries the axle and takes the reaction", default=None, domain="rotation")
    radius: float = param("m", "rolling radius", above=0.0)
    friction: Law = law("coefficient of the grip over the slip, static coefficient while it rolls")
    load: SignalLike = signal("N", "normal force on the road", presses=True, example=4000.0)
    tolerance: float = option(
        "m/s", "slip below which it may roll; 0: at exactly zero", default=0.0, at_least=0.0, last=1
    )
    locked: bool = option("1", "rolls at the start, by an impulse if necessary", default=False, flag=True, last=1)

    def parts(self) -> Iterator[Part]:
        """The rim, which turns with the wheel, and its contact with the road."""
        rim = Node(f"{self.name}.rim", Domain.TRANSLATION)
        yield rim
        yield RollingWheel(f"{self.name}.wheel", shaft=self.shaft, mass=rim, support=self.support, radius=self.radius)
        yield Clutch(
            self.name,
            base=rim,
            follower=self.mass,
            friction=self.friction,
            gain=1.0,
            normal_force=self.load,
            **self.sticking(),
        )
