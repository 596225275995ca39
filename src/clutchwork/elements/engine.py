"""Combustion engine."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import remainder

from clutchwork.declare import (
    Component,
    Found,
    Node,
    Points,
    Role,
    SignalLike,
    component,
    curve,
    flag,
    numbers,
    option,
    param,
    port,
    signal,
)
from clutchwork.elements.bases.grids import Grid, Pairs, at_each, resampled, shape_problems, union
from clutchwork.elements.bearing_friction import BearingFriction
from clutchwork.elements.engine_torque import NO_LIMIT, EngineTorque
from clutchwork.laws.coulomb import Coulomb

# speeds [rad/s] above the stall speed over which a ripple comes in that makes the burning part negative
RIPPLE_BAND = 1.0


@component(Role.COMPOSITE)
class Engine(Component):
    """Engine by its full-load and motoring curves, or by a torque map over speed and throttle.

    Use it for any engine that drives a driveline. Its torque is `motoring + u (full_load - motoring)`, where u follows
    the throttle with `lag`; an idle control with a projected integral raises it, a limiter lowers it. Boost builds up
    with `boost_lag`; the combustion torque may ripple over the crank angle. There is no combustion below `stall_speed`
    or in reverse: an engine at rest fires if that is 0, and has to be started if it is above 0. At rest the motoring
    torque holds up to its value there. A ripple that makes the combustion torque negative fades in over 1 rad/s above
    `stall_speed`. Tables are held beyond their ends.

    Source of the curves: Simscape Driveline, Generic Engine; VehicleInterfaces.Engines.
    """

    shaft: Node = port("crankshaft, which a positive torque accelerates")
    base: Node | None = port("member that takes the reaction and that the speed is measured from", default=None)
    throttle: SignalLike = signal("1", "throttle, 0 closed, 1 open", at_least=0.0)
    full_load: Points | None = curve(
        "rad/s",
        "N m",
        "torque at full throttle over the speed",
        default=None,
        example=((0.0, 100.0), (300.0, 150.0), (500.0, 90.0)),
    )
    motoring: Points | None = curve(
        "rad/s", "N m", "torque at closed throttle over the speed, not positive; none by default", default=None
    )
    speeds: Sequence[float] | None = numbers(
        "rad/s", "speeds of the rows of a torque map", rising="strictly", at_least=0.0, default=None
    )
    throttles: Sequence[float] | None = numbers(
        "1", "throttles of the columns of a torque map, from 0", rising="strictly", at_least=0.0, default=None
    )
    torques: Sequence[Sequence[float]] | None = numbers(
        "N m", "torque map, a row over the throttles for each speed, instead of both curves", default=None, rows=True
    )
    lag: float = param("s", "time constant of the throttle, 0: it acts at once", default=0.0, at_least=0.0)
    idle_speed: float | None = param(
        "rad/s", "speed that the idle control holds, none: no control", default=None, above=0.0
    )
    idle_gain: float = param("s/rad", "throttle of the idle control over the missing speed", default=0.0, at_least=0.0)
    idle_integral: float = param("1/rad", "rate of that throttle over the missing speed", default=0.0, at_least=0.0)
    idle_limit: float = param("1", "largest throttle of the idle control", default=1.0, above=0.0)
    max_speed: float | None = param("rad/s", "speed that it is limited to, none: no limit", default=None, above=0.0)
    limit_band: float = param(
        "rad/s", "speeds below it over which the throttle closes; of a cut the hysteresis", default=10.0, above=0.0
    )
    cut: bool = flag("whether the limiter cuts all, until the speed has fallen by the band", default=False)
    naturally_aspirated: Points | None = curve(
        "rad/s", "N m", "full load without boost over the speed, none: no boost", default=None
    )
    boost_lag: float = param("s", "time constant of the boost", default=1.0, above=0.0)
    orders: Sequence[float] | None = numbers(
        "1",
        "orders of the ripple, periods in a revolution: with z cylinders of a four-stroke z/2, z, ...",
        rising="strictly",
        above=0.0,
        default=None,
    )
    amplitudes: Sequence[float] | None = numbers("1", "amplitude of each over the burning part", default=None)
    phases: Sequence[float] | None = numbers("rad", "phase of each, none: 0", default=None)
    stall_speed: float = param("rad/s", "speed below which there is no combustion", default=0.0, at_least=0.0)
    initial_throttle: float = option("1", "lagged throttle at the start", default=0.0, at_least=0.0)
    initial_idle: float = option("1", "integral of the idle control at the start", default=0.0, at_least=0.0)
    initial_boost: float = option("1", "share of the full boost at the start", default=0.0, at_least=0.0)
    initial_crank: float | None = option(
        "rad", "crank angle at the start, by default that of shaft less base", default=None
    )

    def problems(self) -> Found:
        found = self._torque_problems()
        if self.idle_speed is not None and not self.idle_gain and not self.idle_integral:
            found.append(("idle_speed", "has no control", "give idle_gain [s/rad], idle_integral [1/rad] or both"))
        if self.idle_speed is not None and self.initial_idle > self.idle_limit:
            fault = f"is {self.initial_idle:g}, above idle_limit {self.idle_limit:g}"
            found.append(("initial_idle", fault, "start at or below the limit"))
        if self.max_speed is not None and self.limit_band >= self.max_speed:
            fault = f"is {self.limit_band:g} rad/s, not below max_speed {self.max_speed:g} rad/s"
            found.append(("limit_band", fault, "give a narrower band"))
        return found + self._ripple_problems()

    def _torque_problems(self) -> Found:
        """Curves or a map, each whole."""
        parts = {name: getattr(self, name) for name in ("speeds", "throttles", "torques")}
        if self.full_load is None and self.torques is None:
            return [("full_load", "is missing", "give full_load, or torques with speeds and throttles")]
        if self.full_load is not None:
            other = [name for name, value in parts.items() if value is not None]
            found: Found = [(name, "belongs to a torque map", "give full_load or a map, not both") for name in other]
            for name in ("full_load", "motoring", "naturally_aspirated"):
                points = getattr(self, name)
                if points and points[0][0] < 0.0:
                    found.append(
                        (name, f"starts at {points[0][0]:g} rad/s", "give it from 0 on: backward it is mirrored")
                    )
            dragging = max((y for _, y in self.motoring or ()), default=0.0)
            if dragging > 0.0:
                found.append(("motoring", f"reaches {dragging:g} N m", "give values that brake, not above 0"))
            return found
        for name in ("motoring", "naturally_aspirated"):
            if getattr(self, name) is not None:
                return [(name, "belongs to full_load", "its map has all throttles; give full_load for a boost")]
        missing = [name for name, value in parts.items() if value is None]
        if missing:
            return [(missing[0], "is missing", "give speeds, throttles and torques")]
        if tuple(self.throttles or ())[:1] != (0.0,) or len(self.throttles or ()) < 2:
            return [("throttles", "must start at 0 and have two numbers", "give the closed throttle too")]
        return shape_problems("torques", self.torques, self.speeds, self.throttles)

    def _ripple_problems(self) -> Found:
        if self.orders is None:
            given = [name for name in ("amplitudes", "phases") if getattr(self, name) is not None]
            return [(name, "needs orders", "give the orders of the ripple") for name in given]
        found: Found = []
        if any(abs(remainder(order, 0.5)) > 1e-9 for order in self.orders):
            found.append(
                ("orders", "holds one that is not a multiple of 1/2", "its mean over two revolutions would not be 0")
            )
        for name, values in (("amplitudes", self.amplitudes), ("phases", self.phases)):
            if (values is None and name == "amplitudes") or (values is not None and len(values) != len(self.orders)):
                fault = f"must have as many numbers as orders, {len(self.orders)}"
                found.append((name, fault, "give one for each order"))
        return found

    @property
    def breakaway(self) -> float:
        """Torque that it holds at rest [N m]."""
        if self.torques is not None:
            return abs(resampled(self._map(), (0.0,), (0.0,))[0][0])
        return abs(at_each(self._drag(), (0.0,))[0])

    def _drag(self) -> Pairs:
        return self.motoring or ((0.0, 0.0),)

    def _map(self) -> Grid:
        return Grid(self.speeds or (), self.throttles or (), self.torques or ())

    def parts(self) -> Iterable[Component]:
        """Its torque, and what it holds at rest."""
        yield self._torque()
        if self.breakaway > 0.0:
            yield BearingFriction(
                f"{self.name}.drag",
                shaft=self.shaft,
                base=self.base,
                friction=Coulomb(static=1.0, kinetic=1.0),
                torque=self.breakaway,
            )

    def sums(self) -> tuple[str, ...]:
        """What its torque, power and work contain besides those of combustion."""
        return ("drag",) if self.breakaway > 0.0 else ()

    def _grids(self) -> tuple[tuple[float, ...], tuple[float, ...], tuple[tuple[float, ...], ...], tuple[float, ...]]:
        """Speeds, throttles, torques, and what boost adds."""
        borders = [0.0, self.stall_speed]
        if sum(map(abs, self.amplitudes or ())) > 1.0:
            borders.append(self.stall_speed + RIPPLE_BAND)
        if self.max_speed is not None and not self.cut:
            borders += [self.max_speed - self.limit_band, self.max_speed]
        if self.torques is not None:
            speeds = union(borders, self.speeds or ())
            throttles = tuple(self.throttles or ())
            return speeds, throttles, resampled(self._map(), speeds, throttles), (0.0,) * len(speeds)
        full, drag = self.full_load or (), self._drag()
        bare = self.naturally_aspirated or full
        speeds = union(borders, *([x for x, _ in points] for points in (full, drag, bare)))
        tops, lows, bares = (at_each(points, speeds) for points in (full, drag, bare))
        lack = tuple(top - without for top, without in zip(tops, bares, strict=True))
        return speeds, (0.0, 1.0), tuple(zip(lows, tops, strict=True)), lack

    def _torque(self) -> EngineTorque:
        speeds, throttles, torques, lack = self._grids()
        governed = self.idle_speed is not None
        orders = self.orders or (1.0,)
        return EngineTorque(
            self.name,
            shaft=self.shaft,
            base=self.base,
            speeds=speeds,
            throttles=throttles,
            torques=torques,
            deficit=lack,
            stall_speed=self.stall_speed,
            lag=self.lag,
            governed=governed,
            idle_speed=self.idle_speed or 1.0,
            idle_gain=self.idle_gain,
            idle_integral=self.idle_integral,
            idle_limit=self.idle_limit,
            limiter="none" if self.max_speed is None else "cut" if self.cut else "band",
            max_speed=self.max_speed or NO_LIMIT,
            limit_band=self.limit_band,
            charged=self.naturally_aspirated is not None,
            boost_lag=self.boost_lag,
            ripples=self.orders is not None,
            orders=orders,
            amplitudes=self.amplitudes or (0.0,) * len(orders),
            phases=self.phases or (0.0,) * len(orders),
            throttle=self.throttle,
            initial_opening=self.initial_throttle,
            initial_idle=self.initial_idle,
            initial_boost=self.initial_boost,
            initial_crank=self.initial_crank,
        )
