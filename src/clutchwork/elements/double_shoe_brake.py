"""Drum brake with two shoes."""

from __future__ import annotations

from math import cos, pi, sin
from numbers import Real
from typing import Any

from clutchwork.declare import Law, Node, Role, SignalLike, choice, component, param, port, signal
from clutchwork.elements.bases.contacts import Contact
from clutchwork.laws.bases.tables import Found


@component(Role.CONTACT, hooks=("gain",))
class DoubleShoeBrake(Contact):
    """Two long hinged shoes inside a drum, both with the same actuating force.

    A leading shoe is pressed on by the friction on it, a trailing one pushed off. With the hinge of each shoe at its
    own end, a simplex brake has one leading and one trailing shoe in both directions; a duplex brake has two leading
    ones in forward slip, two trailing ones in backward slip. Use it for drum brakes of vehicles and hoists.

    Source: R. G. Budynas, J. K. Nisbett, Shigley's Mechanical Engineering Design, internal expanding rim clutches and
    brakes: pressure as the sine of the angle from the hinge.
    """

    shaft: Node = port("drum: slip is its speed relative to the base")
    base: Node | None = port("member that takes the reaction", default=None)
    radius: float = param("m", "radius of the drum", above=0.0, example=0.15)
    hinge: float = param("m", "distance of the hinges from the axis", above=0.0, example=0.12)
    arm: float = param("m", "lever of the actuating force about the hinge", above=0.0, example=0.2)
    start: float = param("rad", "angle from the hinge to the start of the lining", at_least=0.0, below=pi, example=0.2)
    end: float = param("rad", "angle from the hinge to its end", above=0.0, at_most=pi, example=2.2)
    leading: str = choice(
        "which shoes lead: one in both directions, or both in forward slip",
        choices=("simplex", "duplex"),
        default="simplex",
    )
    force: SignalLike = signal("N", "actuating force on each shoe; below zero counts as zero", presses=True)

    def problems(self) -> Found:
        if self.end > self.start:
            return []
        return [("end", f"is {self.end:g} rad, not above the start {self.start:g} rad", "give it behind the start")]

    def law_problems(self) -> Found:
        """A coefficient with which a leading shoe needs no force."""
        limit, largest = self.locking_coefficient(), largest_coefficient(self.friction)
        if largest < limit:
            return []
        fault = f"has the coefficient {largest:g}, at which a leading shoe locks up by itself: it must be < {limit:g}"
        return [("friction", fault, "lower it, or move the hinge outwards")]

    def locking_coefficient(self) -> float:
        """Coefficient from which on a leading shoe needs no force."""
        a, b = self.start, self.end
        normal = (b - a) / 2 - (sin(2 * b) - sin(2 * a)) / 4
        along = self.radius * (cos(a) - cos(b)) - self.hinge / 2 * (sin(b) ** 2 - sin(a) ** 2)
        return self.hinge * normal / along if along > 0 else float("inf")


def largest_coefficient(friction: Law) -> float:
    """Largest static coefficient that a law names, over all temperatures; 0 where it names none."""
    named: Any = friction.kinetic if friction.static is None else friction.static
    if named is None or isinstance(named, Real):
        return float(named or 0.0)
    return max(float(item if isinstance(item, Real) else item[1]) for item in named)
