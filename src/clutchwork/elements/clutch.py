"""Friction clutch between two members."""

from __future__ import annotations

from clutchwork.declare import Node, Role, component, port
from clutchwork.elements.bases.contacts import Pressed


@component(Role.CONTACT)
class Clutch(Pressed):
    """Clutch that slips, locks exactly and breaks away.

    Use it for a plate clutch between two shafts that is closed by a pressure. Capacity is
    `gain * pressure * coefficient`; a pressure below zero counts as zero. Give a normal force in place of the
    pressure where that is known: in N with a gain in m, or as a share from 0 to 1 with a gain in N m.
    """

    base: Node = port("side that the slip is measured from")
    follower: Node = port("side whose motion is positive: slip = follower - base")
