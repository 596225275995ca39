"""Cam that its follower cannot leave."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi, remainder
from typing import ClassVar

from clutchwork.declare import (
    Component,
    Found,
    Node,
    Points,
    Role,
    State,
    Way,
    Work,
    component,
    curve,
    numbers,
    option,
    port,
)
from clutchwork.elements.bases.lifts import TURN, closed, height, lift_problems, slope_at, slope_of
from clutchwork.elements.bases.ratios import Rates, angle_of, beyond_rounding

# a rise and a fall, and the second derivative of the spline through them
RISE = ((0.0, 0.0), (0.5 * pi, 0.01), (pi, 0.02), (1.5 * pi, 0.01), (2.0 * pi, 0.0))
BEND = (0.12 / pi**2, 0.0, -0.12 / pi**2, 0.0, 0.12 / pi**2)


@component(
    Role.TORQUE,
    states=(State("angle", "rad", "angle in the table of the lift, which starts again after a revolution", turn=TURN),),
    hooks=("ratio", "margin", "cross", "turns", "settle"),
    ways=(
        Way("mass", "surface of the cam along the guide", domain="translation"),
        Way("shaft", "cam shaft relative to the support", domain="rotation"),
    ),
)
class CamProfile(Component):
    """Cam without mass that also pulls, as a groove does: speed of the mass = derivative of the lift times speed.

    Use it as the surface inside of a `Cam`, which only pushes, or for a cam with a groove. The lift is a spline with
    two continuous derivatives; `curvature` is its second one at each point, which a `Cam` finds by itself.

    Equations: docs/theory/varying-ratios.md.
    """

    work: ClassVar[Work] = Work(0)

    shaft: Node = port("cam shaft", domain="rotation")
    mass: Node = port("mass on a straight guide, positive as the lift", domain="translation")
    support: Node | None = port("member that carries the shaft and takes the reaction", default=None, domain="rotation")
    lift: Points = curve("rad", "m", "lift over the angle of the cam, one revolution that closes", example=RISE)
    curvature: Sequence[float] = numbers("m/rad2", "second derivative of the lift at each point", example=BEND)
    phase: float = option("rad", "angle of the cam where the angle of the shaft is 0", default=0.0)

    def problems(self) -> Found:
        found = lift_problems(self.lift)
        if found:
            return found
        if len(self.curvature) != len(self.lift):
            fault = f"has {len(self.curvature)} values for {len(self.lift)} points of the lift"
            return [("curvature", fault, "give one for each point")]
        points, last = closed(self.lift), len(self.lift) - 2
        # the slope must be the same on both sides of a point
        for k in range(last + 1):
            before, after = (
                slope_of(points, self.curvature, k, 1),
                slope_of(points, self.curvature, (k + 1) % (last + 1), 0),
            )
            if abs(after - before) > 1e-6 * height(self.lift):
                fault = f"lets the slope of the lift jump from {before:g} m/rad to {after:g} m/rad at point {k + 2}"
                return [("curvature", fault, "give that of the periodic spline through the points, as a Cam has it")]
        return []

    def directions(self) -> Mapping[str, Rates]:
        """The speed of the surface and that of the shaft."""
        return {"mass": {"mass": 1}, "shaft": {"shaft": 1, "support": -1}}

    def initial_states(self) -> tuple[float, ...]:
        """Angle in the table at the start [rad]."""
        first = float(self.lift[0][0])
        return (first + (self._start_angle() - first) % TURN,)

    def _start_angle(self) -> float:
        return angle_of(self.shaft) - angle_of(self.support) + self.phase

    def start_ratio(self) -> float:
        """Speed of the surface over that of the shaft at the start [m]."""
        first = float(self.lift[0][0])
        angle = first + remainder(self._start_angle() - first, TURN)
        slope = slope_at(closed(self.lift), self.curvature, angle)
        return beyond_rounding(slope, height(self.lift))
