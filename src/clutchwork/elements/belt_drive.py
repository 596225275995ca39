"""Belt drive that slips at its limit."""

from __future__ import annotations

from collections.abc import Iterator
from math import asin, exp, pi, sin, tanh
from typing import Any

from clutchwork.declare import (
    HOUSING,
    Found,
    Node,
    Role,
    SignalLike,
    choice,
    component,
    flag,
    option,
    param,
    port,
    signal,
)
from clutchwork.declare.node import Domain, Part
from clutchwork.elements.bases.contacts import Sticking
from clutchwork.elements.belt_contact import BeltContact
from clutchwork.elements.gear import Gear
from clutchwork.elements.rolling_wheel import RollingWheel

# of the logarithm of the ratio of the tensions: a force that much above the tension is none of a belt
MOST_POWER = 20.0


@component(Role.COMPOSITE)
class BeltDrive(Sticking):
    """Flat or V-belt between two pulleys: a rigid ratio up to the limit of Eytelwein, then slip with that force.

    The slip is that of the circumferences, radius_follower w_follower - radius_base w_base, with a plus where the belt
    is crossed. Its force is at most 2 (preload - m v^2) tanh(mu wrap/2), with the wrap of the smaller pulley, m v^2 the
    centrifugal force at the speed of the pulley with the larger wrap: then the tensions of both strands, minus m v^2,
    have the ratio exp(mu wrap). With a `tensioner` in place of the preload one strand has a constant tension, and the
    limit differs between the two directions. When m v^2 reaches the tension the belt has no grip. With a groove mu is
    `friction_coefficient`/sin(groove_angle/2). Use it for accessory drives and machines; a toothed belt is a `Chain`.

    Its parts "base_rim" and "follower_rim" are the circumferences of the pulleys.

    Equations: docs/theory/belts.md. Source: J. A. Eytelwein, Handbuch der Statik fester Körper, Berlin 1808.
    """

    base: Node = port("shaft of one pulley, which drives where the force is positive", domain="rotation")
    follower: Node = port("shaft of the other pulley", domain="rotation")
    radius_base: float = param("m", "radius of the pulley on the base", above=0.0, example=0.06)
    radius_follower: float = param("m", "radius of the pulley on the follower", above=0.0, example=0.1)
    centre_distance: float = param("m", "distance of the axes", above=0.0, example=0.5)
    friction_coefficient: float = param("1", "coefficient of friction of belt and pulley", above=0.0)
    preload: SignalLike | None = signal(
        "N", "tension of each strand at rest", default=None, presses=True, example=400.0
    )
    tensioner: SignalLike | None = signal(
        "N", "tension of one strand, held by a tensioner", default=None, presses=True, instead_of="preload"
    )
    tensioned: str | None = choice(
        "strand of the tensioner, by what it is while the force is positive; slack by default",
        choices=("slack", "tight"),
        default=None,
    )
    crossed: bool = flag("the belt is crossed: the pulleys turn opposite ways", default=False)
    mass_per_length: float = param("kg/m", "mass of the belt over its length", default=0.0, at_least=0.0)
    groove_angle: float | None = param(
        "rad", "angle between the sides of the groove, none: flat", default=None, above=0.0, at_most=pi
    )
    tolerance: float = option(
        "m/s", "slip below which it may lock; 0: at exactly zero", default=0.0, at_least=0.0, last=1
    )
    locked: bool = option(
        "1", "without slip at the start, by an impulse if necessary", default=False, flag=True, last=1
    )

    def problems(self) -> Found:
        least = self.radius_base + self.radius_follower
        if self.tensioned is not None and self.tensioner is None:
            return [("tensioned", "needs a tensioner", "give `tensioner` in place of `preload`, or leave it out")]
        if self.centre_distance > least:
            return self._grips()
        message = f"is {self.centre_distance:g} m, not above both radii together, {least:g} m"
        return [("centre_distance", message, "set the axes farther apart")]

    def _grips(self) -> Found:
        """A groove that holds the belt as a clamp: with a tensioner the other strand would have any force."""
        power = self._power
        if self.tensioner is None or power <= MOST_POWER:
            return []
        what = f"and the wrap give tensions of both strands that are as exp({power:.3g}) to 1"
        quantity = "friction_coefficient" if self.groove_angle is None else "groove_angle"
        return [(quantity, f"{what}, more than exp({MOST_POWER:g})", "give less friction or a wider groove")]

    @property
    def _power(self) -> float:
        mu = self.friction_coefficient
        return (mu if self.groove_angle is None else mu / sin(self.groove_angle / 2.0)) * self.wrap

    @property
    def wrap(self) -> float:
        """Angle over which the belt lies on the smaller pulley [rad]."""
        if self.crossed:
            return pi + 2.0 * asin((self.radius_base + self.radius_follower) / self.centre_distance)
        return pi - 2.0 * asin(abs(self.radius_follower - self.radius_base) / self.centre_distance)

    @property
    def limits(self) -> tuple[float, float]:
        """Largest forces against forward and backward slip, over what is left of the tension."""
        power = self._power
        if self.tensioner is None:
            return 2.0 * tanh(power / 2.0), 2.0 * tanh(power / 2.0)
        # a positive force resists backward slip
        slack, tight = exp(power) - 1.0, 1.0 - exp(-power)
        return (slack, tight) if self.tensioned == "tight" else (tight, slack)

    def parts(self) -> Iterator[Part]:
        """The circumferences of both pulleys and what joins them to their shafts, and the grip between them."""
        rims = list[Node]()
        for name, shaft, radius in (
            ("base", self.base, self.radius_base),
            ("follower", self.follower, self.radius_follower),
        ):
            rims.append(HOUSING if shaft.fixed else Node(f"{self.name}.{name}_rim", Domain.TRANSLATION))
            if not shaft.fixed:
                yield rims[-1]
                yield RollingWheel(f"{self.name}.{name}_pulley", shaft=shaft, mass=rims[-1], radius=radius)
        larger = rims[1] if self.radius_follower > self.radius_base and not self.crossed else rims[0]
        if self.crossed and not rims[0].fixed:
            # the strands run the other way
            back = Node(f"{self.name}.crossing", Domain.TRANSLATION)
            yield back
            yield Gear(f"{self.name}.strands", input=rims[0], output=back, ratio=-1.0)
            rims[0] = back
        forward, backward = self.limits
        tension: Any = self.preload if self.tensioner is None else self.tensioner
        yield BeltContact(
            self.name,
            base=rims[0],
            follower=rims[1],
            forward=forward,
            backward=backward,
            mass_per_length=self.mass_per_length,
            tension=tension,
            speed=0.0 if larger.fixed else larger,
            **self.sticking(),
        )
