"""Centrifugal clutch."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from clutchwork.declare import Component, Node, Role, ThermalNode, component, param, port
from clutchwork.elements.bases.contacts import Contact
from clutchwork.elements.flyweights import Flyweights
from clutchwork.elements.plate_contact import PlateContact


class Shoes(Flyweights):
    """Weights that start where their shaft throws them."""

    def states_at(self, speed: Callable[[Node], float]) -> tuple[float, ...]:
        """Force at the start [N]."""
        turning = speed(self.speed) if isinstance(self.speed, Node) else 0.0
        return (self.mass * self.radius * (turning**2 - self.onset**2),)


@component(Role.COMPOSITE)
class CentrifugalClutch(Contact):
    """Clutch whose shoes are thrown against a drum by the speed of its base.

    The capacity is `coefficient shoes drum_radius mass radius (speed^2 - onset^2)` above the speed `onset`; the shoes
    follow the speed with a small lag. Use it for small engines, which it couples to their load only above idle speed.
    """

    base: Node = port("shaft with the shoes, whose speed closes it")
    follower: Node = port("drum: slip = follower - base")
    shoes: int = param("1", "number of shoes", default=2, above=0.0, whole=True)
    mass: float = param("kg", "mass of each shoe", above=0.0)
    radius: float = param("m", "distance of the centre of mass of a shoe from the axis", above=0.0)
    drum_radius: float = param("m", "inner radius of the drum", above=0.0)
    onset: float = param("rad/s", "speed at which the shoes leave their springs", at_least=0.0)
    lag: float = param("s", "time constant of the shoes", default=5e-3, above=0.0)

    def parts(self) -> Iterable[Component | ThermalNode]:
        """The shoes and the contact."""
        speed = self.base.speed or 0.0
        weights = Shoes(
            f"{self.name}.shoes",
            mass=self.mass,
            radius=self.radius,
            onset=self.onset,
            lag=self.lag,
            speed=self.base,
            initial_force=self.mass * self.radius * (speed**2 - self.onset**2),
        )
        yield weights
        yield PlateContact(
            self.name,
            base=self.base,
            follower=self.follower,
            friction=self.friction,
            gain=self.shoes * self.drum_radius,
            normal_force=weights,
            **self.sticking(),
        )
