"""Gearbox control: when to shift, and the pressures of the clutches; called every 10 ms while it shifts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from whole_car_model import CLUTCHES, FULL, GAIN, GEARS, HOLDS

FAST, SLOW = 0.01, 0.05  # s, from one call to the next
SHIFTING = 0.55  # share of the pedal that the engine gets while the turbine is pulled down
SLIDING = 0.12  # coefficient that pressures are worked out with
FILL, TORQUE = 0.1, 0.15  # s, lengths of these phases
LOCKS_AT, OPENS_AT = 0.85, 110.0  # speed ratio; rad/s of the engine

Readings = Mapping[str, float]


@dataclass
class Transmission:
    """Shifts up by the turbine speed, closes the lock-up clutch between shifts.

    steady    the clutches of the gear are at full pressure
    filling   those that come are filled
    torque    they take over the torque from those that go
    inertia   they pull the turbine down, with a little more than it takes, until they stick; where both halves of the
              gearbox shift, the divider goes back to its reduction once the base gearbox is half way up
    closing   up to full pressure
    """

    up: float = 430.0  # rad/s, turbine speed at which the next gear is taken
    gear: int = 1
    state: str = "steady"
    since: float = 0.0  # s, begin of the state
    locked_since: float = 1e9  # s
    pressure: dict[str, float] = field(default_factory=dict)
    shifts: list[tuple[float, float, int]] = field(default_factory=list)  # begin, end [s], gear
    coming: tuple[str, ...] = ()
    going: tuple[str, ...] = ()
    far: float = 0.0  # rad/s, slip of the base clutch that comes, where the inertia phase begins

    def __post_init__(self) -> None:
        self.pressure = {name: FULL * (name in GEARS[self.gear]) for name in CLUTCHES} | {"lock_up": 0.0}

    def step(self, time: float, readings: Readings) -> dict[str, float]:
        """What changes at a time [s]: pressures [Pa], and the throttle while it is closed for a shift."""
        before = dict(self.pressure)
        getattr(self, f"_{self.state}")(time, readings)
        self._lock_up(readings)
        changed = {f"{name}.pressure": value for name, value in self.pressure.items() if value != before[name]}
        return changed | ({"combustion.throttle": SHIFTING * pedal(time)} if self.state == "inertia" else {})

    @property
    def wait(self) -> float:
        """Time to the next call [s]: short while anything goes on."""
        busy = self.state != "steady" or 0.0 < self.pressure["lock_up"] < FULL
        return FAST if busy else SLOW

    def _enter(self, state: str, time: float) -> None:
        self.state, self.since = state, time

    def _steady(self, time: float, readings: Readings) -> None:
        if self.gear < max(GEARS) and readings["w1.speed"] > self.up and pedal(time) > 0.2:
            old, new = GEARS[self.gear], GEARS[self.gear + 1]
            self.coming = tuple(name for name in new if name not in old)
            self.going = tuple(name for name in old if name not in new)
            self.gear += 1
            self._enter("filling", time)
            self.shifts.append((time, time, self.gear))

    def _filling(self, time: float, _: Readings) -> None:
        for name in self.coming:
            self.pressure[name] = 0.02e6
        if time - self.since >= FILL - 1e-9:
            self._enter("torque", time)

    def _torque(self, time: float, readings: Readings) -> None:
        share = min(1.0, (time - self.since) / TORQUE)
        # the last is that of the base gearbox, where both shift
        self._hand_over(self.coming[-1], self.going[-1], share, readings)
        if share >= 1.0:
            self.far = abs(readings[f"{self.coming[-1]}.slip"])
            self._enter("inertia", time)

    def _hand_over(self, coming: str, going: str, share: float, readings: Readings) -> None:
        self.pressure[coming] = share * self._needed(coming, readings)
        self.pressure[going] = (1.0 - share) * 1.2 * self._needed(going, readings)

    def _inertia(self, time: float, readings: Readings) -> None:
        more, last = 1.2 + 0.8 * (time - self.since), self.coming[-1]
        self.pressure[last] = min(FULL, more * self._needed(last, readings))
        if len(self.coming) > 1:
            way = 1.0 - abs(readings[f"{last}.slip"]) / max(self.far, 1.0)
            self._hand_over(self.coming[0], self.going[0], min(1.0, max(0.0, 2.0 * way - 0.6)), readings)
        if all(abs(readings[f"{name}.slip"]) < 0.5 for name in self.coming):
            self._enter("closing", time)

    def _closing(self, time: float, _: Readings) -> None:
        for name in self.coming:
            self.pressure[name] = min(FULL, self.pressure[name] + 8e6 * FAST)
        if all(self.pressure[name] >= FULL for name in self.coming):
            self._enter("steady", time)
            self.shifts[-1] = (self.shifts[-1][0], time, self.gear)

    def _needed(self, name: str, readings: Readings) -> float:
        """Pressure at which a clutch carries the torque of the turbine [Pa]."""
        turbine = abs(readings["converter.turbine.torque"] + readings["lock_up.torque"])
        return 0.02e6 + HOLDS[name] * turbine / (GAIN[name] * SLIDING)

    def _lock_up(self, readings: Readings) -> None:
        """Closed between shifts from the second gear on, open while the engine is slow."""
        ratio = readings["w1.speed"] / max(1.0, readings["engine.speed"])
        wanted = self.gear >= 2 and self.state == "steady" and readings["engine.speed"] > OPENS_AT
        if not wanted or (ratio < LOCKS_AT and self.pressure["lock_up"] == 0.0):
            self.pressure["lock_up"] = max(0.0, self.pressure["lock_up"] - 20e6 * FAST)
            return
        self.pressure["lock_up"] = min(FULL, self.pressure["lock_up"] + 2.5e6 * FAST)


# a launch with three quarters of the throttle, until the car is coasting; held by its brake at first
PEDAL = ((0.0, 0.0), (0.6, 0.0), (1.1, 0.75), (26.0, 0.75), (26.3, 0.0))
BRAKE = ((0.0, 0.5), (0.5, 0.5), (0.8, 0.0))


def pedal(time: float) -> float:
    """Throttle that the driver wants at a time [s]."""
    return float(np.interp(time, *zip(*PEDAL, strict=True)))
