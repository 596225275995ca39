"""Friction brake against the housing."""

from __future__ import annotations

from clutchwork.declare import Node, Role, component, port
from clutchwork.elements.bases.contacts import Pressed


@component(Role.CONTACT)
class Brake(Pressed):
    """Clutch whose base is the housing.

    Use it for the brakes of a gearbox and for vehicle brakes. Capacity is `gain * pressure * coefficient`; a
    pressure below zero counts as zero. Give a normal force in place of the pressure where that is known: in N
    with a gain in m, or as a share from 0 to 1 with a gain in N m.
    """

    shaft: Node = port("member that is braked: slip is its speed")
