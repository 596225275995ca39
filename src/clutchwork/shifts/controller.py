"""A shift controller as one of a control unit: states, called every few milliseconds. docs/theory/shifts.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import TYPE_CHECKING

from clutchwork.shifts.exchange import Exchange, exchanges
from clutchwork.shifts.plant import Plant
from clutchwork.shifts.settings import ShiftSettings

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.shifts.schedule import ShiftSchedule

NEUTRAL = "N"
# share of the launch speed below which the input is let go
STALLS = 0.8


@dataclass(frozen=True)
class Measured:
    """What the controller knows at one instant.

    Speeds of input and output [rad/s], torque at the input [N m], throttle 0 to 1, slip of elements [rad/s].
    """

    input_speed: float
    output_speed: float
    input_torque: float
    throttle: float
    slips: Mapping[str, float]


@dataclass
class ShiftRecord:
    """One shift as it was commanded: gears, exchanges, and the instants [s] at which its phases began."""

    before: str
    after: str
    begin: float
    power_on: bool
    exchanges: tuple[Exchange, ...] = ()
    phases: list[tuple[float, str]] = field(default_factory=list)
    end: float | None = None  # none: it is still going on

    @property
    def kind(self) -> str:
        """Such as "power-on upshift", "garage shift", "power-off skip downshift"."""
        if NEUTRAL in (self.before, self.after) or not self.exchanges or not self.exchanges[0].before:
            return "garage shift"
        up = abs(self.exchanges[-1].after) < abs(self.exchanges[0].before)
        power = "power-on" if self.power_on else "power-off"
        many = " double" if len(self.exchanges) > 1 else ""
        return f"{power}{many} {'upshift' if up else 'downshift'}"


@dataclass
class ShiftController:
    """Shifts a gearbox: fills, hands the torque over, pulls the input to its new speed, closes.

    Use it in a loop around a `cw.Simulator`, as `cw.shifts.drive` has one, or take its pressures elsewhere: `step`
    knows nothing of clutchwork's runs. It works out of the gearbox alone which elements are exchanged and what they
    carry; several exchanges follow one another through the gears between them.

    fill      the element that closes is filled; the one that opens is lowered to what it carries
    torque    one takes over the torque from the other: first in upshifts under power and downshifts without
    inertia   the input follows a profile to its new speed, by the one that closes where it must be pulled there, by
              the one that opens where it must be held back
    sync      in the other shifts the torque is taken over here, at equal speeds
    end       the element that closed is raised to full pressure

    Parameters:
        box: the gearbox
        plant: capacities and inertias of the elements and members, from `cw.shifts.plant_of`
        schedule: when to shift; none: when `request` asks for a gear
        settings: calibration
        chosen: calibration of single shifts, ("3", "4") or a kind such as "power-off upshift"
        gear: the gear that is in at the start
        prefix: path of the transmission in the driveline: signals are `<prefix>.<element>.pressure`
    """

    box: Gearbox
    plant: Plant
    schedule: ShiftSchedule | None = None
    settings: ShiftSettings = field(default_factory=ShiftSettings)
    chosen: Mapping[tuple[str, str] | str, ShiftSettings] = field(default_factory=dict)
    gear: str = NEUTRAL
    prefix: str = "gearbox"
    pause: float = 0.3  # s, from the end of a shift to the next one that the schedule asks for
    # what it remembers
    state: str = "steady"
    since: float = 0.0  # s, begin of the state
    records: list[ShiftRecord] = field(default_factory=list)
    pressures: dict[str, float] = field(default_factory=dict)
    torque_factor: float = 1.0  # of the engine
    _wanted: str = ""
    _left: list[Exchange] = field(default_factory=list)
    _slip: float = 0.0  # rad/s, what the input lacked to its new speed where the inertia phase began
    _integral: float = 0.0  # rad/s2
    _called: float = 0.0  # s

    def __post_init__(self) -> None:
        closed = self._closed(self.gear)
        full = self.settings.full_pressure
        self.pressures = {element.name: full * (element.name in closed) for element in self.box.elements}
        self.since = -self.pause

    # ------------------------------------------------------------------------------------------------ from outside

    def request(self, gear: str) -> None:
        """Ask for a gear; it is shifted to as soon as no other shift goes on."""
        self._wanted = gear

    def step(self, time: float, now: Measured) -> dict[str, float]:
        """Pressures [Pa] by signal, those that change alone, at a time [s]."""
        before = dict(self.pressures)
        period = max(0.0, time - self._called)
        self._called = time
        if self.state == "steady":
            self._decide(time, now)
        if self.state != "steady":
            getattr(self, f"_{self.state}")(time, period, now)
        return {
            f"{self.prefix}.{name}.pressure": value for name, value in self.pressures.items() if value != before[name]
        }

    @property
    def shifting(self) -> bool:
        """Whether a shift goes on."""
        return self.state != "steady"

    @property
    def commands(self) -> dict[str, float]:
        """All pressures [Pa] by signal, such as for the start of a run."""
        return {f"{self.prefix}.{name}.pressure": value for name, value in self.pressures.items()}

    # ---------------------------------------------------------------------------------------------------- deciding

    def _closed(self, gear: str) -> tuple[str, ...]:
        return self.box.closed_in(gear) if gear in self.box.gears else ()

    def _decide(self, time: float, now: Measured) -> None:
        if self.schedule is not None and time - self.since >= self.pause - 1e-9 and not self._wanted:
            wanted = self.schedule.gear(self.gear, now.output_speed, now.throttle)
            self._wanted = wanted if wanted != self.gear else self._drive_off(now)
        if self._wanted and self._wanted != self.gear:
            self._start(self._wanted, time, now)
        self._wanted = ""

    def _drive_off(self, now: Measured) -> str:
        """Where the input is fixed to an engine: neutral before it stalls, first gear when the driver wants to go."""
        if not self.settings.launch_speed or self.schedule is None:
            return ""
        if self.gear == NEUTRAL:
            return next(iter(self.schedule.ratios)) if now.throttle > self.settings.launch_throttle else ""
        return NEUTRAL if now.input_speed < STALLS * self.settings.launch_speed else ""

    def _start(self, gear: str, time: float, now: Measured) -> None:
        before, after = self._closed(self.gear), self._closed(gear)
        power = now.input_torque >= 0.0
        self._left = list(exchanges(self.box, before, after, self.plant.inertias))
        record = ShiftRecord(self.gear, gear, time, power, tuple(self._left))
        self.records.append(record)
        self.gear = gear
        if not self._left:
            self._set(dict.fromkeys(before, 0.0) | dict.fromkeys(after, self._now.full_pressure))
            self._finish(time)
            return
        self._open_others(before)
        self._enter("fill", time)

    def _open_others(self, before: Sequence[str]) -> None:
        """What neither stays nor opens under control: elements of a gear that is left from neutral on."""
        first = self._left[0]
        for name in before:
            if name not in first.kept and name != first.off:
                self.pressures[name] = 0.0
        self._set(dict.fromkeys(first.kept, self._now.full_pressure))

    def _enter(self, state: str, time: float) -> None:
        self.state, self.since = state, time
        self.records[-1].phases.append((time, state))

    @property
    def _now(self) -> ShiftSettings:
        """Calibration of the shift that goes on."""
        if not self.records:
            return self.settings
        record = self.records[-1]
        return self.chosen.get((record.before, record.after), self.chosen.get(record.kind, self.settings))

    @property
    def _exchange(self) -> Exchange:
        return self._left[0]

    # ------------------------------------------------------------------------------------------------------ phases

    def _fill(self, time: float, _: float, now: Measured) -> None:
        one, with_ = self._exchange, self._now
        share = min(1.0, (time - self.since) / max(with_.fill_time, 1e-9))
        if one.on:
            self.pressures[one.on] = self._pressure(one.on, 0.0)
        if one.off:
            held = self._pressure(one.off, with_.margin * abs(one.off_torque * now.input_torque))
            full = with_.full_pressure
            self.pressures[one.off] = min(full, held + (1.0 - share) * (full - held)) if held < full else full
        if share >= 1.0:
            self._enter("torque" if self._torque_first(now) else "inertia", time)
            self._begin_inertia(now)

    def _torque_first(self, now: Measured) -> bool:
        """Upshifts under power and downshifts without: the one that closes can take over before speeds change."""
        one = self._exchange
        if not one.off or not one.on:
            return False
        return (now.input_torque >= 0.0) == (self._direction(now) < 0.0)

    def _direction(self, now: Measured) -> float:
        """Sign of the change of the input's speed."""
        return 1.0 if self._target(now) > now.input_speed else -1.0

    def _target(self, now: Measured) -> float:
        return self._exchange.after * now.output_speed

    def _torque(self, time: float, _: float, now: Measured) -> None:
        one, with_ = self._exchange, self._now
        share = min(1.0, (time - self.since) / max(with_.torque_time, 1e-9))
        torque = abs(now.input_torque)
        self.pressures[one.on] = self._pressure(one.on, share * abs(one.on_torque) * torque)
        self.pressures[one.off] = self._pressure(one.off, (1.0 - share) * with_.margin * abs(one.off_torque) * torque)
        if share >= 1.0 or abs(now.slips[one.off]) > with_.sync_slip:
            self.pressures[one.off] = 0.0
            self._begin_inertia(now)
            self._enter("inertia", time)

    def _begin_inertia(self, now: Measured) -> None:
        self._slip, self._integral = self._target(now) - now.input_speed, 0.0

    def _inertia(self, time: float, period: float, now: Measured) -> None:
        one, with_ = self._exchange, self._now
        too_long = time - self.since > with_.longest and not with_.launch_speed
        if self._is_synchronous(one, now) or too_long:
            self._leave_inertia(one, time, now)
            return
        needed = self._needed(time - self.since, period, now)
        pulls = -needed * (1.0 if self._slip > 0.0 else -1.0)
        on, off = (abs(needed), 0.0) if pulls >= 0.0 else (0.0, abs(needed))
        if one.on:
            self.pressures[one.on] = self._pressure(one.on, on * abs(one.on_torque))
        if one.off:
            self.pressures[one.off] = self._pressure(one.off, off * abs(one.off_torque)) if off else 0.0
        self.torque_factor = self._factor(now)

    def _factor(self, now: Measured) -> float:
        """What the engine is asked for: less where the input slows down under power."""
        if now.input_torque > 0.0 and self._slip < 0.0:
            return 1.0 - self._now.reduction
        return 1.0 + self._now.increase if now.input_torque <= 0.0 and self._slip > 0.0 else 1.0

    def _is_synchronous(self, one: Exchange, now: Measured) -> bool:
        if not one.on:
            return True
        passed = one.off != "" and (self._target(now) - now.input_speed) * self._slip < 0.0
        return passed or abs(now.slips[one.on]) < self._now.sync_slip

    def _needed(self, passed: float, period: float, now: Measured) -> float:
        """Torque that the elements must take from the input so that it follows its profile: equations (5) to (7)."""
        one, with_ = self._exchange, self._now
        x = min(1.0, passed / max(with_.inertia_time, 1e-9))
        lacks, rate = 1.0 - x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x) / max(with_.inertia_time, 1e-9)
        # held back it has to come through its new speed, not only close to it
        beyond = 2.0 * with_.sync_slip * (1.0 if self._slip > 0.0 else -1.0) * (one.off != "")
        wanted = max(self._target(now) - self._slip * lacks + beyond * x, self._launch(now))
        acceleration = self._slip * rate
        if with_.closed_loop:
            error = wanted - now.input_speed
            self._integral += with_.integral * error * period
            acceleration += with_.proportional * error + self._integral
        return now.input_torque - one.inertia * acceleration

    def _launch(self, now: Measured) -> float:
        """Speed [rad/s] that the input keeps while it drives off, unless the gear is faster already."""
        return self._now.launch_speed if not self._exchange.off and now.throttle > 0.0 else -inf

    def _leave_inertia(self, one: Exchange, time: float, now: Measured) -> None:
        self.torque_factor = 1.0
        self._enter("sync", time)
        if one.off and self.pressures[one.off] == 0.0:
            self._sync(time, 0.0, now)

    def _sync(self, time: float, _: float, now: Measured) -> None:
        """At equal speeds: the one that closes up to what it carries, the other down to nothing."""
        one, with_ = self._exchange, self._now
        share = min(1.0, (time - self.since) / max(0.5 * with_.torque_time, 1e-9))
        torque = abs(now.input_torque)
        if one.on:
            least = self._pressure(one.on, with_.margin * abs(one.on_torque) * torque)
            touch = self._pressure(one.on, 0.0)
            self.pressures[one.on] = max(self.pressures[one.on], touch + share * (least - touch))
        if one.off:
            self.pressures[one.off] = (1.0 - share) * min(
                self.pressures[one.off], self._pressure(one.off, abs(one.off_torque) * torque)
            )
        if share >= 1.0:
            self._enter("end", time)

    def _end(self, time: float, period: float, _: Measured) -> None:
        one, with_ = self._exchange, self._now
        if one.off:
            self.pressures[one.off] = 0.0
        if one.on:
            rise = with_.full_pressure * period / max(with_.end_time, 1e-9)
            self.pressures[one.on] = min(with_.full_pressure, self.pressures[one.on] + rise)
        if not one.on or self.pressures[one.on] >= with_.full_pressure or len(self._left) > 1:
            self._next(time)

    def _next(self, time: float) -> None:
        done = self._left.pop(0)
        if not self._left:
            self._finish(time)
            return
        # the one that closed holds while the next exchange goes on
        if done.on:
            self.pressures[done.on] = self._now.full_pressure
        self._set(dict.fromkeys(self._exchange.kept, self._now.full_pressure))
        self._enter("fill", time)

    def _finish(self, time: float) -> None:
        self._set(dict.fromkeys(self._closed(self.gear), self._now.full_pressure))
        self.records[-1].end = time
        self.state, self.since, self.torque_factor = "steady", time, 1.0

    def _set(self, pressures: Mapping[str, float]) -> None:
        self.pressures.update(pressures)

    def _pressure(self, name: str, torque: float) -> float:
        """Pressure [Pa] at which an element that slips carries a torque [N m]."""
        if name not in self.plant.capacity:
            return self._now.full_pressure if torque else 0.0
        touch = max(self._now.fill_pressure, self.plant.touch[name])
        return min(self._now.full_pressure, touch + torque / self.plant.capacity[name])
