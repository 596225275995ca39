"""Torque converter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

from clutchwork.declare import Found, Node, Role, State, Way, component, numbers, option, param, port
from clutchwork.elements.bases.heating import Heating
from clutchwork.elements.bases.hydrodynamic import at_each_ratio, falls_to_zero, one_of, ratio_problems

WAYS = (
    Way("impeller", "speed of the impeller over the support"),
    Way("turbine", "speed of the turbine over the support"),
    Way("slip", "speed of the turbine over the impeller", watched=True),
)
LAGS = (State("impeller_torque", "N m", "torque that the impeller takes up"),)


@component(Role.TORQUE, states=LAGS, hooks=("margin", "cross", "turns", "settle", "fits", "count"), ways=WAYS)
class TorqueConverter(Heating):
    """Hydrodynamic torque converter: k w^2 at the impeller, m times that at the turbine, over the speed ratio.

    Use it between engine and automatic gearbox. The stator passes the difference of the torques to the support. When
    the turbine overruns the impeller the stator freewheels, and the turbine drives the impeller with `coast_capacity`.
    A lock-up clutch is a contact in parallel; when locked it carries everything.
    """

    # the stator runs free where the oil still carries a torque of coast
    bends = True

    impeller: Node = port("wheel of the engine")
    turbine: Node = port("wheel of the gearbox")
    support: Node | None = port("member that carries the stator", default=None)
    speed_ratio: Sequence[float] = numbers(
        "1", "ratios of turbine to impeller speed, up to 1", rising="strictly", example=(0.0, 0.8, 1.0)
    )
    torque_ratio: Sequence[float] = numbers("1", "m at each speed ratio", at_least=0.0, example=(2.0, 1.0, 1.0))
    capacity: Sequence[float] | None = numbers(
        "N m s2/rad2", "k at each speed ratio", default=None, at_least=0.0, example=(2e-3, 1.5e-3, 0.0)
    )
    k_factor: Sequence[float] | None = numbers(
        "rad/s",
        "speed at which the impeller takes up 1 N m, w/sqrt(T), at each speed ratio below 1; k is its inverse square",
        default=None,
        above=0.0,
    )
    coast_capacity: Sequence[float] | None = numbers(
        "N m s2/rad2",
        "k of the turbine, at each ratio of impeller to turbine speed; as in drive by default",
        default=None,
        at_least=0.0,
    )
    lag: float = param("s", "time constant of the torque, 0: none", default=0.0, at_least=0.0, fixed=True, example=0.1)
    initial_torque: float = option("N m", "torque of the impeller at the start, where it lags", default=0.0)

    def directions(self) -> Mapping[str, Mapping[str, float]]:
        """Both wheels over the support, and the slip between them."""
        return {
            "impeller": {"impeller": 1, "support": -1},
            "turbine": {"turbine": 1, "support": -1},
            "slip": {"turbine": 1, "impeller": -1},
        }

    def own_states(self) -> tuple[State, ...]:
        """The torque, where it lags."""
        return self.states if self.lag > 0.0 else ()

    def initial_states(self) -> tuple[float, ...]:
        """Torque of the impeller at the start [N m]."""
        return (self.initial_torque,) if self.lag > 0.0 else ()

    def problems(self) -> Found:
        """Tables that do not belong together."""
        found = one_of(self, "capacity", "k_factor") or ratio_problems(self.speed_ratio, float("-inf"))
        if found:
            return found
        ratios = self.speed_ratio
        found = at_each_ratio("torque_ratio", self.torque_ratio, ratios)
        if not found and (worst := _most_power(ratios, self.torque_ratio)) is not None:
            ratio, m = worst
            fault = f"is {m:.4g} at speed ratio {ratio:.4g}, above {1.0 / ratio:.4g}: it would give power"
            found.append(("torque_ratio", fault, "give at most 1 over the speed ratio there, also between the points"))
        if self.k_factor is not None and len(self.k_factor) != len(ratios) - 1:
            count = f"has {len(self.k_factor)} values for {len(ratios) - 1} speed ratios below 1"
            found.append(("k_factor", count, "give one for each; at ratio 1, where it is infinite, k is 0"))
        for name in ("capacity", "coast_capacity"):
            values = getattr(self, name)
            if values is not None:
                found += at_each_ratio(name, values, ratios) or falls_to_zero(name, values)
        return found

    def unknown(self, rates: Mapping[str, Any]) -> tuple[Any, str, str]:
        """Where it knows no torque."""
        where = (rates["impeller"] < 0.0) & (rates["turbine"] < 0.0)
        return (
            where,
            "turns backward with both wheels, where its torque is not known and counts as none",
            ("let the engine turn forward, or take the converter out of the way by a clutch"),
        )


def _most_power(ratios: Sequence[float], multiples: Sequence[float]) -> tuple[float, float] | None:
    """The speed ratio of the largest turbine power, and m there, if that exceeds the power of the impeller."""
    places = list(zip(ratios, multiples, strict=True))
    for (x, m), (x_next, m_next) in pairwise(places.copy()):
        slope = (m_next - m) / (x_next - x)
        # ratio times m is a parabola between two points
        top = 0.5 * (x - m / slope) if slope < 0.0 else x
        if x < top < x_next:
            places.append((top, m + slope * (top - x)))
    worst = max(places, key=lambda place: place[0] * place[1])
    return worst if worst[0] * worst[1] > 1.0 + 1e-9 else None
