"""Controller of a dual-clutch gearbox: preselection, launch, torque handover and speed. docs/theory/shifts.md."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import cos, pi
from typing import TYPE_CHECKING

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import UseError, near
from clutchwork.base.quote import quote
from clutchwork.shifts.preselect import Halves, expected
from clutchwork.shifts.schedule import ShiftSchedule

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.run.trajectory import Trajectory
    from clutchwork.shifts.plant import Plant
    from clutchwork.stepping.simulator import Simulator

# sleeves further in are engaged, further out free
IN, OUT = 0.9, 0.4
# slip that counts as none [rad/s], the longest that a clutch may take for the rest [s], its least capacity then [N m]
LOCKED, CLOSING, LEAST = 0.05, 0.15, 15.0
# s, time constant of the acceleration that it sees
FILTER = 0.05


@dataclass(frozen=True)
class DualClutchSettings:
    """What a dual-clutch controller is calibrated with.

    Parameters: full_pressure [Pa], of a clutch that is closed; launch_speed [rad/s], of the engine while it launches;
    launch_gain [N m s/rad], torque of the clutch for each rad/s above that; handover [s], in which torque goes from one
    clutch to the other; speed_time [s], the least in which the engine changes its speed; least_torque and most_torque
    [N m], of the engine while it does; sync_slip [rad/s], at which speeds are the same; speed_gain [N m s/rad], torque
    of the engine for each rad/s that it is off its course; hold, capacity of the clutch that lets go over the torque;
    close, that of the one that has come until it locks; cone, share of the force of a synchroniser while a gear waits;
    period [s], from one call to the next.
    """

    full_pressure: float = 1e6
    launch_speed: float = 150.0
    launch_gain: float = 3.0
    handover: float = 0.15
    speed_time: float = 0.2
    least_torque: float = -30.0
    most_torque: float = 400.0
    sync_slip: float = 1.5
    speed_gain: float = 2.0
    hold: float = 1.1
    close: float = 1.2
    cone: float = 0.4
    period: float = 0.01


@dataclass(frozen=True)
class DualClutchShift:
    """A shift that was made.

    Parameters: before and after, its gears; begin, when it was asked for, exchange, when clutches began, end, when the
    clutch that came was locked [s]; torque that was asked of the engine [N m]; preselected, whether the gear waited on
    its shaft when it was asked for.
    """

    before: str
    after: str
    begin: float
    exchange: float
    end: float
    torque: float
    preselected: bool


class DualClutch:
    """Drives a dual-clutch gearbox: one gear transmits, the next one is preselected on the other shaft.

    Use it for launches and shifts under power of a `cw.Transmission` whose gears are one of two clutches and one
    synchroniser each. Where the clutch that comes slips the way of the torque it takes the torque over first, and the
    engine changes its speed then, by its own torque; else the engine changes its speed on the clutch that goes, and
    torque is handed over then. Gears of one clutch are reached through one of the other.

    Parameters: box; plant, of `cw.shifts.plant_of`; prefix, name of the Transmission; gear, at the start; schedule,
    which gear to drive in, without one `request` asks for gears; settings; launch, whether it begins with the clutch
    open and drives off. It launches once, and keeps its clutch closed down to rest: begin another one to drive off
    again, or backward.
    """

    def __init__(
        self,
        box: Gearbox,
        plant: Plant,
        *,
        gear: str,
        prefix: str = "gearbox",
        schedule: ShiftSchedule | None = None,
        settings: DualClutchSettings | None = None,
        launch: bool = False,
    ) -> None:
        """A controller at the start of a run."""
        self.layout = Halves.of(box)
        if gear not in self.layout.clutch:
            known = list(self.layout.clutch)
            raise UseError(
                "cw.shifts.DualClutch", [f"gear is {quote(gear)}{near(gear, known, f'choose from {known}')}"]
            )
        if schedule is not None and not isinstance(schedule, ShiftSchedule):
            raise UseError("cw.shifts.DualClutch", [f"schedule is {quote(schedule)}: give a cw.shifts.ShiftSchedule"])
        self.box, self.plant, self.prefix, self.schedule = box, plant, prefix, schedule
        self.settings = settings or DualClutchSettings()
        self.gear, self.target, self.waiting = gear, "", ""
        self.phase = "launch" if launch else "drive"
        self.records: list[DualClutchShift] = []
        self.torque = 0.0  # N m, what the engine is asked for
        self.inertia = plant.inertias[box.input]
        self._asked = gear
        self._since = self._begun = self._exchange = 0.0
        self._start = 0.0
        self._ready = False
        self._sleeves = dict.fromkeys(self.layout.sleeve.values(), 0.0)
        self._sleeves[self.layout.sleeve[gear]] = 1.0
        self._capacity = dict.fromkeys(self.layout.clutch.values(), 0.0)
        self._before: tuple[float, float] | None = None  # time and speed of the output at the last step
        self._gains = self._held = 0.0  # acceleration of the output, filtered; the same before a shift [rad/s2]
        self._order: list[str] = []

    @property
    def shifting(self) -> bool:
        """Whether clutches or speeds change."""
        return self.phase != "drive"

    @property
    def readings(self) -> list[str]:
        """Signals that it reads."""
        ends = [self.box.input, self.box.output, *dict.fromkeys(self.layout.shaft.values())]
        sleeves = [self._sleeve_signal(name) for name in self._sleeves]
        return [*(f"{self.prefix}.{member}.speed" for member in ends), *sleeves]

    def _sleeve_signal(self, name: str) -> str:
        inner = ".forward_dog" if self.box.element(name).kind == "synchroniser" else ""
        return f"{self.prefix}.{name}{inner}.sleeve"

    def request(self, gear: str) -> None:
        """Ask for a gear; it is driven in as soon as it can be."""
        if gear not in self.layout.clutch:
            known = list(self.layout.clutch)
            raise UseError(
                "control.request", [f"{quote(gear)} is not a gear{near(gear, known, f'choose from {known}')}"]
            )
        if self.layout.ratios[gear] * self.layout.ratios[self.gear] < 0.0:
            why = f"{self.gear} to {gear} turns the drive around"
            raise UseError("control.request", [f"{why}: come to rest and begin a DualClutch in it, with launch=True"])
        self._asked = gear

    def step(self, time: float, now: Mapping[str, float], torque: float, throttle: float = 0.0) -> dict[str, float]:
        """Commands of clutches and sleeves at a time [s]; `torque` then is what the engine is asked for [N m].

        Parameters: now, values of `readings`; torque, what the driver asks of the engine [N m].
        """
        speeds = {member: now[f"{self.prefix}.{member}.speed"] for member in self._members()}
        sleeves = {name: now[self._sleeve_signal(name)] for name in self._sleeves}
        output = speeds[self.box.output]
        if self.schedule is not None and self.phase == "drive":
            self._asked = self.schedule.gear(self.gear, output, throttle)
        self.torque = torque
        self._observe(time, output)
        {"launch": self._launch, "drive": self._drive}.get(self.phase, self._shift)(time, speeds, sleeves, torque)
        self._preselect(sleeves, output, throttle)
        return self._commands()

    def _observe(self, time: float, output: float) -> None:
        """Acceleration of the output, through a filter."""
        if self._before is not None and time > self._before[0]:
            passed = time - self._before[0]
            share = min(1.0, passed / FILTER)
            self._gains += share * ((output - self._before[1]) / passed - self._gains)
        self._before = (time, output)

    def _through(self, gear: str, torque: float, gains: float | None = None) -> float:
        """What a gear carries where the engine keeps pace with its shaft [N m]; gains, acceleration of the output."""
        gains = self._gains if gains is None else gains
        return abs(torque - self.inertia * self.layout.ratios[gear] * gains)

    def _members(self) -> list[str]:
        return [self.box.input, self.box.output, *dict.fromkeys(self.layout.shaft.values())]

    def _launch(self, _: float, speeds: Mapping[str, float], sleeves: Mapping[str, float], torque: float) -> None:
        """The engine is held at its speed by the torque of the clutch, until its shaft is as fast."""
        if sleeves[self.layout.sleeve[self.gear]] < IN:
            return
        engine, shaft = speeds[self.box.input], speeds[self.layout.shaft[self.gear]]
        clutch, sign = self.layout.clutch[self.gear], 1.0 if self.layout.ratios[self.gear] > 0 else -1.0
        wanted = max(self.settings.launch_speed, shaft)
        self._capacity[clutch] = max(0.0, torque + self.settings.launch_gain * (engine - wanted))
        if engine - shaft < self.settings.sync_slip and sign * speeds[self.box.output] > 0.0:
            self.phase = "drive"

    def _drive(self, time: float, _: Mapping[str, float], sleeves: Mapping[str, float], __: float) -> None:
        """One clutch is closed; a gear that is asked for is taken once it waits on its shaft."""
        self._capacity = dict.fromkeys(self._capacity, 0.0) | {self.layout.clutch[self.gear]: float("inf")}
        route = self.layout.route(self.gear, self._asked)
        if not route:
            self.target = ""
            return
        if self.target != route[0]:
            self.target, self._begun = route[0], time
            self._ready = sleeves[self.layout.sleeve[self.target]] > IN
        if sleeves[self.layout.sleeve[self.target]] > IN:
            self.phase, self._exchange = "begin", time

    def _shift(self, time: float, speeds: Mapping[str, float], _: Mapping[str, float], torque: float) -> None:
        """Torque handover and speed, in the order that the torque asks for."""
        engine, shaft = speeds[self.box.input], speeds[self.layout.shaft[self.target]]
        if self.phase == "begin":
            first, self._held = torque * (engine - shaft) >= 0.0, self._gains
            self._order = ["handover", "speed"] if first else ["speed", "handover"]
            self._next(time, engine - shaft)
        if self.phase == "handover":
            self._handover(time, engine - shaft, torque)
        elif self.phase == "speed":
            self._speed(time, engine, shaft, torque)
        elif self.phase == "close":
            self._close(time, engine - shaft, torque)

    def _next(self, time: float, slip: float) -> None:
        """The next phase, or the end of the shift."""
        self._since, self._start = time, slip
        if self._order:
            self.phase = self._order.pop(0)
            return
        if self.phase != "close":
            self.phase = "close"
            return
        record = DualClutchShift(self.gear, self.target, self._begun, self._exchange, time, self.torque, self._ready)
        self.records.append(record)
        self.gear, self.target, self.phase = self.target, "", "drive"
        self._capacity = dict.fromkeys(self._capacity, 0.0) | {self.layout.clutch[self.gear]: float("inf")}

    def _handover(self, time: float, slip: float, torque: float) -> None:
        share = min(1.0, (time - self._since) / self.settings.handover)
        # torque and acceleration of the output go with the ratio
        gains = self._held * self.layout.ratios[self.target] / self.layout.ratios[self.gear] if self._order else None
        self._capacity[self.layout.clutch[self.target]] = share * self._through(self.target, torque, gains)
        if gains is not None:
            # the engine still keeps pace with the shaft of the gear that goes
            pace = self.layout.ratios[self.gear] - self.layout.ratios[self.target]
            self.torque = min(torque + share * self.inertia * pace * gains, max(torque, self.settings.most_torque))
        # one that is still to hold has some more than the torque
        hold = self.settings.hold if self._order else 1.0
        self._capacity[self.layout.clutch[self.gear]] = (1.0 - share) * hold * self._through(self.gear, torque)
        if share >= 1.0:
            self._next(time, slip)

    def _speed(self, time: float, engine: float, shaft: float, torque: float) -> None:
        """The engine changes its speed by its own torque, beside the clutch that carries that of the driver."""
        with_ = self.settings
        carries = self.gear if self._order else self.target
        other = self.target if self._order else self.gear
        self._capacity[self.layout.clutch[carries]] = self._through(carries, torque)
        self._capacity[self.layout.clutch[other]] = 0.0
        # on the clutch that goes it ends a little beyond, so that the one that comes slips the way of the torque
        beyond = (with_.sync_slip if torque >= 0.0 else -with_.sync_slip) if self._order else 0.0
        spare = max(20.0, (torque - with_.least_torque) if self._start > 0.0 else (with_.most_torque - torque))
        duration = max(with_.speed_time, 2.0 * self.inertia * abs(self._start - beyond) / spare)
        # a course of the slip at the clutch that comes, level at both ends; a torque holds for a period
        x, ahead = (min(1.0, (time + after - self._since) / duration) for after in (0.0, with_.period))
        now, then = (self._start + (beyond - self._start) * (s - _sine(2.0 * pi * s) / (2.0 * pi)) for s in (x, ahead))
        slope = (then - now) / with_.period
        # the shaft that carries and the one that comes gain speed by their ratios
        gains = (self.layout.ratios[other] - self.layout.ratios[carries]) * self._gains if self._order else 0.0
        asked = torque + self.inertia * (slope + gains) + with_.speed_gain * (now - (engine - shaft))
        self.torque = min(max(asked, with_.least_torque), with_.most_torque)
        beside = engine - shaft - beyond
        # the clutch that comes must not slip against the torque
        if x >= 1.0 and abs(beside) < (0.5 if self._order else 1.0) * with_.sync_slip:
            self._next(time, engine - shaft)

    def _close(self, time: float, slip: float, torque: float) -> None:
        """The clutch that has come takes what slip is left, with a little more than the torque."""
        capacity = self.settings.close * self._through(self.target, torque)
        self._capacity[self.layout.clutch[self.target]] = max(LEAST, capacity)
        self._capacity[self.layout.clutch[self.gear]] = 0.0
        if abs(slip) < LOCKED or time - self._since > CLOSING:
            self._next(time, slip)

    def _preselect(self, sleeves: Mapping[str, float], output: float, throttle: float) -> None:
        """Engage the gear that comes next on the shaft whose clutch is open, once the others there are out."""
        if self.target:
            self.waiting = self.target
        elif self.schedule is not None:
            self.waiting = expected(self.layout, self.schedule, self.gear, output, throttle)
        if self.phase not in ("drive", "launch") or not self.waiting:
            return
        clutch = self.layout.clutch[self.waiting]
        if clutch == self.layout.clutch[self.gear]:
            return
        wanted = self.layout.sleeve[self.waiting]
        others = [self.layout.sleeve[gear] for gear in self.layout.on(clutch) if gear != self.waiting]
        self._sleeves.update(dict.fromkeys(others, 0.0))
        if all(sleeves[name] < OUT for name in others):
            self._sleeves[wanted] = 1.0

    def _commands(self) -> dict[str, float]:
        made = {}
        for name, capacity in self._capacity.items():
            pressure = self.plant.touch[name] + capacity / self.plant.capacity[name] if capacity > 0.0 else 0.0
            made[f"{self.prefix}.{name}.pressure"] = min(self.settings.full_pressure, pressure)
        for name, command in self._sleeves.items():
            if self.box.element(name).kind == "synchroniser":
                made[f"{self.prefix}.{name}.forward_dog.command"] = command
                made[f"{self.prefix}.{name}.forward_cone.normal_force"] = self.settings.cone * command
            else:
                made[f"{self.prefix}.{name}.command"] = command
        return made


def _sine(x: float) -> float:
    return cos(x - pi / 2.0)


def drive_dual_clutch(
    sim: Simulator,
    control: DualClutch,
    until: float,
    *,
    torque: Callable[[float], float],
    engine: str,
    throttle: Callable[[float], float] = lambda _: 0.5,
    period: float = 0.01,
    resting: float = 0.05,
) -> Trajectory:
    """Run a driveline with a dual-clutch gearbox under its controller, up to a time [s]; the trajectory up to there.

    Parameters: torque, that the driver asks of the engine over time [N m]; engine, signal of that torque, which the
    controller changes while it shifts; throttle, over time, for the schedule; period, from one call of the controller
    to the next while it shifts or launches [s]; resting, the same between shifts.
    """
    names = control.readings
    set_: dict[str, float] = {}
    while sim.time < until - 1e-9:
        now = dict(zip(names, sim[names].tolist(), strict=True))
        wanted = control.step(sim.time, now, float(torque(sim.time)), float(throttle(sim.time)))
        wanted[engine] = control.torque
        changed = {name: value for name, value in wanted.items() if set_.get(name) != value}
        if changed:
            sim.set(changed)
            set_ |= changed
        sim.advance(min(period if control.shifting else resting, until - sim.time))
    return sim.run
