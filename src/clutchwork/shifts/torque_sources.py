"""Who gives the torque that a shift asks for: motors and engine, the first one first, each within its limits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import exp, inf
from typing import TYPE_CHECKING, Protocol

from clutchwork.base import UseError, dataclass, quote
from clutchwork.base.errors import expect
from clutchwork.elements.engine import Engine
from clutchwork.shifts.lines import Line, at

if TYPE_CHECKING:
    from clutchwork.shifts.record import Measured


@dataclass(frozen=True)
class TorqueSource:
    """A motor, or an engine whose torque is given at once, that a shift asks for a part of its torque.

    Use it as one of the `sources` of `cw.shifts.drive`, the one that answers fastest first. UseError where `least` is
    above `most`.

    Parameters:
        signal: of its torque, such as "motor.command" [N m]
        least, most: of that torque, what it is driven with included [N m]
        ratio: speed of the motor over that of the input of the gearbox
        driven: torque that it gives without a request [N m], a number or a function of the pedal, 0 to 1
        power: limits of its power [W], the first one where it brakes, such as `battery.limits(charge)`: a pair, or a
        function of nothing that returns one
    """

    signal: str
    least: float
    most: float
    ratio: float = 1.0
    driven: float | Callable[[float], float] = 0.0
    power: tuple[float, float] | Callable[[], tuple[float, float]] = (-inf, inf)

    def __post_init__(self) -> None:
        """Limits that leave something between them."""
        if self.least > self.most:
            raise UseError("TorqueSource", [f"least is {self.least:g} N m, above most, {self.most:g} N m; swap them"])
        if not self.ratio:
            raise UseError("TorqueSource", ["ratio is 0: give the speed of the motor over that of the input"])

    def demand(self, pedal: float, _: float) -> float:
        """What it gives at the input without a request [N m]."""
        return self.ratio * (self.driven(pedal) if callable(self.driven) else self.driven)

    def limits(self, speed: float) -> tuple[float, float]:
        """What it can give at the input [N m] at a speed of that [rad/s]."""
        turning = abs(speed * self.ratio)
        charges, gives = self.power() if callable(self.power) else self.power
        back, forward = (gives, charges) if speed * self.ratio < 0.0 else (charges, gives)
        low = max(self.least, -abs(back) / turning) if turning else self.least
        high = min(self.most, abs(forward) / turning) if turning else self.most
        low, high = sorted((low * self.ratio, high * self.ratio))
        return low, high

    def command(self, torque: float, _: float) -> float:
        """Of its signal, so that it gives a torque at the input [N m]."""
        return torque / self.ratio


@dataclass(frozen=True)
class EngineSource:
    """A `cw.Engine` at the input of a gearbox, whose throttle gives the torque that a shift asks for.

    Use it as the last one of the `sources` of `cw.shifts.drive` where engine and input turn together, as in a
    dual-clutch gearbox. UseError for curves without points.

    Parameters:
        signal: of the throttle, such as "burning.throttle"
        full_load, motoring: torque [N m] over speed [rad/s] at full and at closed throttle
        lag: of the throttle [s], which is led: docs/theory/shifts.md (17)
    """

    signal: str
    full_load: Line
    motoring: Line = ((0.0, 0.0),)
    lag: float = 0.0

    def __post_init__(self) -> None:
        """Curves that are there."""
        if not len(self.full_load) or not len(self.motoring):
            raise UseError("EngineSource", ["full_load and motoring need points (speed, torque)"])

    @classmethod
    def of(cls, engine: Engine) -> EngineSource:
        """That of an engine of the driveline; UseError for one with a torque map."""
        remedy = "give the cw.Engine of the driveline, or cw.shifts.EngineSource(signal, full_load)"
        expect("cw.shifts.EngineSource.of", "engine", engine, Engine, remedy)
        if engine.full_load is None:
            raise UseError("EngineSource.of", [f"{quote(engine.name)} has a torque map: give full_load and motoring"])
        return cls(f"{engine.name}.throttle", engine.full_load, engine.motoring or ((0.0, 0.0),), engine.lag)

    def demand(self, pedal: float, speed: float) -> float:
        """What it gives at a throttle [N m]."""
        low, high = self.limits(speed)
        return low + min(1.0, max(0.0, pedal)) * (high - low)

    def limits(self, speed: float) -> tuple[float, float]:
        """What it gives at closed and at full throttle [N m]."""
        return at(self.motoring, speed), at(self.full_load, speed)

    def command(self, torque: float, speed: float) -> float:
        """Throttle at which it gives a torque [N m]."""
        low, high = self.limits(speed)
        return min(1.0, max(0.0, (torque - low) / (high - low))) if high > low else 0.0


Source = TorqueSource | EngineSource


class TorqueRequest(Protocol):
    """What a controller asks for."""

    @property
    def torque_factor(self) -> float:
        """Factor of the torque of an engine beside the sources."""

    @property
    def blip(self) -> float:
        """Throttle on top of that of the driver, of such an engine."""

    def torque_change(self, now: Measured, /) -> float:
        """Torque at the input on top of what the driver asks for [N m]."""


class TorqueShare:
    """Shares the torque that a controller asks for among sources, and leads those that lag."""

    def __init__(self, sources: Sequence[Source]) -> None:
        """Of a run that begins."""
        self.sources = sources
        # what lags by signal, and what it was asked for last
        self._lagging: dict[str, float] = {}
        self._asked: dict[str, float] = {}

    def limits(self, pedal: float, speed: float) -> tuple[float, float, float]:
        """What the driver asks for at the input, the least and the most that all give there [N m]."""
        demand = sum(source.demand(pedal, speed) for source in self.sources)
        ends = [source.limits(speed) for source in self.sources]
        return demand, sum(low for low, _ in ends), sum(high for _, high in ends)

    def signals(
        self, control: TorqueRequest, now: Measured, pedal: float, passed: float, period: float
    ) -> tuple[dict[str, float], float]:
        """Values by signal, and the throttle that is left for an engine beside the sources, 0 to 1.

        The request is a change of the torque at the input, negative for a reduction: `control.torque_change`.
        Parameters: passed, time since the last call, period, to the next one [s].
        """
        wanted, made, speed = control.torque_change(now), dict[str, float](), now.input_speed
        left = wanted
        for source in self.sources:
            usual, (low, high) = source.demand(pedal, speed), source.limits(speed)
            given = min(max(usual + left, low), high)
            left -= given - usual
            command = source.command(given, speed)
            made[source.signal] = self._led(source, command, passed, period) if wanted else command
            self._pass(source, made[source.signal], passed)
        # without sources, and where nothing is known of the torque, all of it is the engine's
        share = left / wanted if wanted and self.sources else 1.0
        return made, min(1.0, pedal * (1.0 + share * (control.torque_factor - 1.0)) + control.blip)

    def _pass(self, source: Source, command: float, passed: float) -> None:
        if isinstance(source, EngineSource) and source.lag:
            last = self._lagging.get(source.signal, command)
            asked = self._asked.get(source.signal, command)
            self._lagging[source.signal] = last + (asked - last) * (1.0 - exp(-passed / source.lag))
            self._asked[source.signal] = command

    def _led(self, source: Source, command: float, passed: float, period: float) -> float:
        """What to ask for, so that it is there a period later: equation (17)."""
        if not isinstance(source, EngineSource) or not source.lag or source.signal not in self._lagging:
            return command
        last, asked, lag = self._lagging[source.signal], self._asked[source.signal], source.lag
        here = last + (asked - last) * (1.0 - exp(-passed / lag))
        return min(1.0, max(0.0, here + (command - here) / (1.0 - exp(-max(period, 0.5 * lag) / lag))))
