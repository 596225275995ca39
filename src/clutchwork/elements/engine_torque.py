"""Torque of a combustion engine over grids of speeds and throttles."""

from __future__ import annotations

from collections.abc import Sequence
from math import isclose
from typing import ClassVar

from clutchwork.declare import (
    Component,
    Found,
    Node,
    Role,
    SignalLike,
    State,
    choice,
    component,
    flag,
    numbers,
    option,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.grids import shape_problems
from clutchwork.elements.bases.ratios import angle_of

# rad/s, a limit that is none
NO_LIMIT = 1e9
STATES = (
    State("opening", "1", "throttle behind its lag"),
    State("idle", "1", "integral of the idle control"),
    State("boost", "1", "share of the full boost"),
    State("crank", "rad", "crank angle"),
)


@component(
    Role.TORQUE, states=STATES, hooks=("edges", "edge", "margin", "cross", "turns", "settle", "pace", "count", "fits")
)
class EngineTorque(Component):
    """Torque over speed and throttle with idle control, limiter, boost and ripple, minus what it holds at rest.

    Use it to build engines of your own; `Engine` makes its grids from curves and adds a contact with the torque at
    rest, which is left out here. All tables hold over the one grid of abs(speed), and are held beyond it.
    """

    jumps: ClassVar[bool] = True

    shaft: Node = port("crankshaft, which a positive torque accelerates")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    speeds: Sequence[float] = numbers(
        "rad/s", "grid of abs(speed), from 0", rising="strictly", at_least=0.0, example=(0.0, 3.0, 10.0)
    )
    throttles: Sequence[float] = numbers(
        "1", "grid of throttles, from 0", rising="strictly", at_least=0.0, example=(0.0, 1.0)
    )
    torques: Sequence[Sequence[float]] = numbers(
        "N m",
        "torque, a row over the throttles for each speed",
        example=((-0.5, 4.0), (-0.6, 6.0), (-1.0, 5.0)),
        rows=True,
    )
    deficit: Sequence[float] = numbers(
        "N m", "torque that full boost adds at full throttle, one for each speed", example=(0.0, 1.0, 2.0)
    )
    stall_speed: float = param(
        "rad/s", "speed below which there is no combustion, one of speeds", default=0.0, at_least=0.0
    )
    lag: float = param(
        "s", "time constant of the throttle, 0: none", default=0.0, at_least=0.0, fixed=True, example=0.1
    )
    governed: bool = flag("whether the idle speed is controlled", default=False)
    idle_speed: float = param("rad/s", "speed at idle", default=1.0, above=0.0)
    idle_gain: float = param("s/rad", "throttle over the missing speed", default=0.0, at_least=0.0)
    idle_integral: float = param("1/rad", "rate of the throttle over the missing speed", default=0.0, at_least=0.0)
    idle_limit: float = param("1", "largest throttle of the idle control", default=1.0, above=0.0)
    limiter: str = choice("how the speed is limited", choices=("none", "band", "cut"), default="none")
    max_speed: float = param(
        "rad/s",
        "speed that it is limited to; with a band one of speeds, as is where that begins",
        default=NO_LIMIT,
        above=0.0,
    )
    limit_band: float = param("rad/s", "band below it, or hysteresis of the cut", default=1.0, above=0.0)
    charged: bool = flag("whether it has boost", default=False)
    boost_lag: float = param("s", "time constant of the boost", default=1.0, above=0.0)
    ripples: bool = flag("whether its torque follows the crank angle", default=False)
    orders: Sequence[float] = numbers(
        "1", "orders of the ripple, periods in a revolution", rising="strictly", example=(2.0,)
    )
    amplitudes: Sequence[float] = numbers("1", "amplitude of each over the burning part", example=(0.5,))
    phases: Sequence[float] = numbers("rad", "phase of each", example=(0.0,))
    throttle: SignalLike = signal("1", "throttle, 0 closed, 1 open")
    initial_opening: float = option("1", "lagged throttle at the start", default=0.0, at_least=0.0)
    initial_idle: float = option("1", "integral of the idle control at the start", default=0.0, at_least=0.0)
    initial_boost: float = option("1", "boost at the start", default=0.0, at_least=0.0)
    initial_crank: float | None = option(
        "rad", "crank angle at the start, by default that of shaft less base", default=None
    )

    def problems(self) -> Found:
        rows, columns = len(self.speeds), len(self.throttles)
        found: Found = []
        for name, grid in (("speeds", self.speeds), ("throttles", self.throttles)):
            if grid[0] != 0.0:
                found.append((name, f"starts at {grid[0]:g}", "let it start at 0"))
        if columns < 2:
            found.append(("throttles", "has a single number", "give at least the closed and the open throttle"))
        found += shape_problems("torques", self.torques, self.speeds, self.throttles)
        if len(self.deficit) != rows:
            found.append(("deficit", f"has {len(self.deficit)} values for {rows} speeds", "give one for each speed"))
        for name, values in (("amplitudes", self.amplitudes), ("phases", self.phases)):
            if len(values) != len(self.orders):
                fault = f"has {len(values)} values for {len(self.orders)} orders"
                found.append((name, fault, "give one for each order"))
        # what begins between two speeds would begin at one of them
        borders = [("stall_speed", self.stall_speed)]
        if self.limiter == "band" and self.max_speed < NO_LIMIT:
            begin = max(self.max_speed - self.limit_band, 0.0)
            borders += [("limit_band", begin), ("max_speed", self.max_speed)]
        for name, x in borders:
            if not any(isclose(x, one, rel_tol=1e-12) for one in self.speeds):
                found.append((name, f"has a border at {float(x)!r} rad/s, which is none of speeds", "add it to speeds"))
        if self.governed and self.initial_idle > self.idle_limit:
            fault = f"is {self.initial_idle:g}, above idle_limit {self.idle_limit:g}"
            found.append(("initial_idle", fault, "start at or below the limit"))
        return found

    def _used(self) -> tuple[bool, ...]:
        return (self.lag > 0.0, bool(self.governed), bool(self.charged), bool(self.ripples))

    def own_states(self) -> tuple[State, ...]:
        """Those that the engine has."""
        return tuple(state for state, used in zip(self.states, self._used(), strict=True) if used)

    def initial_states(self) -> tuple[float, ...]:
        """Their values at the start."""
        crank = self.initial_crank
        if crank is None:
            crank = angle_of(self.shaft) - angle_of(self.base)
        starts = (self.initial_opening, self.initial_idle, self.initial_boost, crank)
        return tuple(float(start) for start, used in zip(starts, self._used(), strict=True) if used)
