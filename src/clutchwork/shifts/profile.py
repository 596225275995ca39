"""The torque that an exchange takes from the input, so that it comes to its new speed. docs/theory/shifts.md (5, 6)."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import exp, inf
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from clutchwork.shifts.exchange import Exchange
    from clutchwork.shifts.record import Measured
    from clutchwork.shifts.settings import ShiftSettings

# time constant of a speed behind its filter [s]: a drive shaft swings faster
FILTER = 0.08
# throttle per speed that is lacking to that of a dog clutch [s/rad], and per that times time [1/rad]
BLIP, BLIP_INTEGRAL = 0.02, 0.1
# what it lacks at most where that counts [rad/s]
NEAR = 30.0


def share_of(passed: float, time: float) -> float:
    """Of a time that has passed, at most 1."""
    return min(1.0, passed / max(time, 1e-9))


@dataclass
class Trend:
    """A speed [rad/s] and its slope [rad/s2] behind a filter: equation (12)."""

    value: float = 0.0
    slope: float = 0.0

    def follow(self, value: float, period: float) -> None:
        """Take one measured value more, a period [s] after the last one."""
        share = 1.0 - exp(-period / FILTER)
        ahead = self.value + self.slope * period
        self.value = ahead + share * (value - ahead)
        self.slope += share * share / (2.0 - share) * (value - ahead) / period if period else 0.0


@dataclass
class Profile:
    """The speed of the input from where an inertia phase begins, and what the engine is asked for."""

    one: Exchange
    with_: ShiftSettings
    to_dog: bool  # whether a dog clutch closes
    slip: float = 0.0  # rad/s, what the input lacked to its new speed at the beginning
    _per: float = 0.0  # slip of the one that closes per speed that the input lacks
    _output: Trend = field(default_factory=Trend)  # of the speed of the output
    _integral: float = 0.0  # rad/s2
    _lacking: float = 0.0  # rad, integral of what it lacks to a dog clutch

    def begin(self, now: Measured) -> None:
        """From here."""
        self.slip, self._integral, self._lacking = self.lacks(now), 0.0, 0.0
        self._output = Trend(now.output_speed)
        self._per = abs(now.slips.get(self.one.on, 0.0) / self.slip) if self.slip else 0.0

    def lacks(self, now: Measured) -> float:
        """What the input lacks to its new speed [rad/s]."""
        return self.one.after * now.output_speed - now.input_speed

    def needed(self, passed: float, period: float, now: Measured) -> float:
        """Torque that the elements must take from the input [N m]."""
        one, with_ = self.one, self.with_
        time = max(with_.inertia_time, 1e-9)
        x = min(1.0, passed / time)
        rate = 6.0 * x * (1.0 - x) / time
        self._output.follow(now.output_speed, period)
        if not with_.closed_loop:
            # what the plan lacks at its end is made up with its mean rate
            return now.input_torque - one.inertia * self.slip * (rate if x < 1.0 else 1.0 / time)
        target = one.after * self._output.value
        gain, integral = with_.proportional, with_.integral
        if with_.launch_speed and not one.off:
            gain, integral = with_.launch_gain, 0.25 * with_.launch_gain**2
        wanted = target - self.slip * (1.0 - x * x * (3.0 - 2.0 * x)) + self._beyond() * x
        launch = self._launch(now)
        error = max(wanted, launch) - now.input_speed
        self._integral += integral * error * period
        # while it drives off the gear runs into the input, and not before it
        rise = one.after * self._output.slope + self.slip * rate if launch == -inf else 0.0
        return now.input_torque - one.inertia * (rise + gain * error + self._integral)

    def _beyond(self) -> float:
        """How far past its new speed [rad/s]: held back it has to come through it, and a dog clutch to find a gap."""
        most = 2.0 * self.with_.sync_slip
        if self.to_dog:
            most = min(most, 0.5 * self.with_.dog_slip / max(self._per, 1e-9))
        return most * (1.0 if self.slip > 0.0 else -1.0) * (self.one.off != "")

    def _launch(self, now: Measured) -> float:
        """Speed [rad/s] that the input keeps while it drives off, unless the gear is faster already."""
        return self.with_.launch_speed if not self.one.off and now.throttle > self.with_.launch_throttle else -inf

    def torque_factor(self, now: Measured) -> float:
        """Of the engine: less where the input slows down under power."""
        if self.to_dog and self.slip < 0.0:
            # nothing else brings the input down to a dog clutch; `blip` catches it there
            return 0.0
        if self.with_.launch_speed and not self.one.off:
            return 1.0
        if now.input_torque > 0.0 and self.slip < 0.0:
            return 1.0 - self.with_.reduction
        return 1.0

    def blip(self, period: float, now: Measured) -> float:
        """Throttle on top of that of the driver: no clutch keeps the input at the speed of a dog clutch."""
        if not self.to_dog:
            return 0.0
        lacks = self.lacks(now) + self._beyond()
        self._lacking = self._lacking + lacks * period if 0.0 < lacks < NEAR else 0.0
        return min(self.with_.blip, max(0.0, BLIP * lacks + BLIP_INTEGRAL * self._lacking))
