"""Angle, speed and acceleration between two shafts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from clutchwork.declare import Component, Node, Role, component, port


@component(Role.SENSOR)
class MotionSensor(Component):
    """Angle, speed and acceleration of one shaft against another, as signals of the run: follower - base.

    Use it for the twist of a whole line, the slip between shafts that nothing joins, or a relative angle that a file,
    an exported model or a fit needs by name. It has no effect on the motion or the steps. At an event the signal has
    both limits; the acceleration after it is the right one. The angle starts as the difference of the angles at the
    start.
    """

    reports: ClassVar[Mapping[str, str]] = {
        "angle": "of the follower against the base",
        "position": "of the follower against the base",
        "speed": "its rate: speed of the follower over that of the base",
        "acceleration": "the rate of that",
    }

    base: Node | None = port("side that motion is measured from", default=None)
    follower: Node = port("side whose motion counts positive")
