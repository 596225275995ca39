"""Fluid coupling."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from clutchwork.declare import Found, Node, Role, Way, component, numbers, param, port
from clutchwork.elements.bases.heating import Heating
from clutchwork.elements.bases.hydrodynamic import at_each_ratio, falls_to_zero, one_of, ratio_problems

WAYS = (
    Way("slip", "speed of the follower over the base"),
    Way("base", "speed of the base over the housing", watched=True),
    Way("follower", "speed of the follower over the housing", watched=True),
)


@component(Role.TORQUE, hooks=("margin", "cross", "turns", "settle", "fits"), ways=WAYS)
class FluidCoupling(Heating):
    """Hydrodynamic coupling: the faster shaft drags the slower one with k w^2, k over the ratio of the speeds.

    Use it where oil between two wheels starts a heavy load, without a stator in between; with one it is a
    `TorqueConverter`. The torque from the fast to the slow shaft is k(slow/fast) fast^2, in all quadrants;
    the ratio counts as no less than the first point, and k falls to 0 at ratio 1.
    """

    base: Node = port("one wheel")
    follower: Node = port("the other wheel; a positive torque accelerates it")
    speed_ratio: Sequence[float] = numbers(
        "1", "ratios of the slow to the fast speed, up to 1", rising="strictly", at_least=-1.0, example=(0.0, 0.8, 1.0)
    )
    capacity: Sequence[float] | None = numbers(
        "N m s2/rad2", "k at each speed ratio", default=None, at_least=0.0, example=(2e-3, 1.5e-3, 0.0)
    )
    performance_number: Sequence[float] | None = numbers(
        "1", "lambda at each speed ratio, k = lambda density diameter^5", default=None, at_least=0.0
    )
    density: float = param("kg/m3", "of the oil, with the performance numbers", default=860.0, above=0.0)
    diameter: float = param("m", "profile diameter, with the performance numbers", default=0.0, at_least=0.0)

    def directions(self) -> Mapping[str, Mapping[str, float]]:
        """Slip, and both speeds."""
        return {"slip": {"follower": 1, "base": -1}, "base": {"base": 1}, "follower": {"follower": 1}}

    def problems(self) -> Found:
        """Tables that do not belong together."""
        found = one_of(self, "capacity", "performance_number") or ratio_problems(self.speed_ratio, -1.0)
        if found:
            return found
        if self.capacity is None and self.diameter == 0.0:
            found.append(("diameter", "is missing beside the performance numbers", "give the profile diameter"))
        name = "performance_number" if self.capacity is None else "capacity"
        values = getattr(self, name)
        return found + (at_each_ratio(name, values, self.speed_ratio) or falls_to_zero(name, values))
