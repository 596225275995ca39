"""Torque and power through a rigid connection of two shafts."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import ClassVar

from clutchwork.declare import Component, Node, Role, component, port


@component(Role.GEAR)
class TorqueSensor(Component):
    """Rigid connection of two shafts that gives torque, speed, power and energy through it as signals of the run.

    Use it where a rigid line is to be cut open: between gearbox and propeller shaft, in one branch of a gear set.
    Torque is that on the follower, power that which flows from base to follower, energy its integral since the start,
    impulses included. Both shafts turn as one; the torque is the reaction of the rigid line, which includes what
    accelerates the inertias behind it. Springs, clutches and gears already have a torque signal.
    """

    reports: ClassVar[Mapping[str, str]] = {
        "torque": "on the follower, from the base",
        "speed": "of both",
        "power": "that goes from base to follower",
        "energy": "that has gone from base to follower since the start",
    }

    base: Node = port("side that power comes from where it counts positive")
    follower: Node = port("side that power goes to")

    def rows(self) -> list[dict[str, Fraction]]:
        """Both turn as one."""
        return [{"base": Fraction(-1), "follower": Fraction(1)}]
