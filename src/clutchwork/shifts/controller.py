"""A shift controller as one of a control unit: states, called every few milliseconds. docs/theory/shifts.md."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from clutchwork.base.errors import UseError
from clutchwork.base.shown import listed, shown
from clutchwork.shifts.actuation import Actuation
from clutchwork.shifts.course import ENGAGED, Course
from clutchwork.shifts.exchange import Exchange, exchanges
from clutchwork.shifts.plant import Plant
from clutchwork.shifts.record import NEUTRAL, Measured, ShiftRecord
from clutchwork.shifts.settings import ShiftSettings

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.shifts.schedule import ShiftSchedule

# share of the launch speed below which the input is let go
STALLS = 0.8


@dataclass
class ShiftController:
    """Shifts a gearbox: fills, hands the torque over, pulls the input to its new speed, closes.

    Use it in a loop around a `cw.Simulator`, as `cw.shifts.drive` has one, or take its commands elsewhere: `step`
    knows nothing of clutchwork's runs. It works out of the gearbox alone which elements are exchanged and what they
    carry; several exchanges follow one another through the gears between them.

    fill      the element that closes is filled; the one that opens is lowered to what it carries
    torque    one takes over the torque from the other: first in upshifts under power and downshifts without
    inertia   the input follows a profile to its new speed, by the one that closes where it must be pulled there, by
              the one that opens where it must be held back
    sync      in the other shifts the torque is taken over here, at equal speeds
    end       the element that closed is raised to full pressure, until it does not slip

    Freewheels overrun and catch by themselves and need no command. A dog clutch opens when its torque is gone
    and closes near equal speeds, to which the engine comes where no clutch can bring the input there. A request while a
    shift goes on is kept until its end, but for the time of filling, in which the shift is called off.

    Without a converter (`launch_speed` of the settings) it lets the input go before the engine stalls, and drives off
    again where the driver wants to.

    Parameters:
        box: the gearbox
        plant: capacities and inertias of the elements and members, from `cw.shifts.plant_of`
        schedule: when to shift; none: when `request` asks for a gear
        settings: calibration
        chosen: calibration of single shifts, ("3", "4") or a kind such as "power-off upshift"
        gear: the gear that is in at the start; "N": none
        prefix: path of the transmission in the driveline: signals are `<prefix>.<element>.pressure`

    What it did is in `records`, what it asks of the engine in `torque_factor` (a factor of its torque) and `blip`
    (throttle on top of that of the driver).
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
    records: list[ShiftRecord] = field(default_factory=list)
    _wanted: str = ""
    _let_go: str = ""  # gear that was let go before the engine stalled
    _left: list[Exchange] = field(default_factory=list)
    _course: Course | None = None
    _called: float = 0.0  # s
    _ended: float = 0.0  # s, end of the last shift

    def __post_init__(self) -> None:
        self._known(self.gear)
        self._do = Actuation(self.box, self.plant, self.prefix)
        self._do.open(*self._do.kinds)
        self._do.close(self._closed(self.gear), self.settings)
        self._ended = -self.pause
        if self.gear == NEUTRAL and self.settings.launch_speed and self.schedule is not None:
            self._let_go = next(iter(self.schedule.ratios))

    # ------------------------------------------------------------------------------------------------ from outside

    def request(self, gear: str) -> None:
        """Ask for a gear, "N" for neutral; a shift that goes on is finished before. UseError for one it does not have.

        A shift that is still filling is called off.
        """
        self._known(gear)
        self._wanted, self._let_go = gear, ""

    def step(self, time: float, now: Measured) -> dict[str, float]:
        """Pressures [Pa] and positions of sleeves by signal, those that change alone, at a time [s]."""
        before = dict(self._do.commands)
        period = max(0.0, time - self._called)
        self._called = time
        if self._stalls(now):
            self._abandon(time, NEUTRAL, "let go before the engine stalled")
        if self._course is not None and self._course.state == "fill" and self._wanted not in ("", self.gear):
            self._call_off(time)
        if self._course is None:
            self._decide(time, now)
        if self._course is not None:
            self._go_on(self._course, time, period, now)
        return self._do.signals(name for name, value in self._do.commands.items() if value != before[name])

    @property
    def shifting(self) -> bool:
        """Whether a shift goes on."""
        return self._course is not None

    @property
    def state(self) -> str:
        """Of the shift that goes on: "fill", "torque", "inertia", "sync" or "end"; "steady" between shifts."""
        return "steady" if self._course is None else self._course.state

    @property
    def torque_factor(self) -> float:
        """Factor of the torque of the engine that it asks for."""
        return 1.0 if self._course is None else self._course.torque_factor

    @property
    def blip(self) -> float:
        """Throttle that it asks for on top of that of the driver, 0 to 1."""
        return 0.0 if self._course is None else self._course.blip

    @property
    def commands(self) -> dict[str, float]:
        """All pressures [Pa] and positions of sleeves by signal, such as for the start of a run."""
        return self._do.signals(self._do.commands)

    # ---------------------------------------------------------------------------------------------------- deciding

    def _known(self, gear: str) -> None:
        if gear != NEUTRAL and gear not in self.box.gears:
            remedy = f"choose from {listed([*self.box.gears, NEUTRAL])}"
            raise UseError("ShiftController", [f"{shown(gear)} is no gear of {shown(self.box.name)}; {remedy}"])

    def _closed(self, gear: str) -> tuple[str, ...]:
        return self.box.closed_in(gear) if gear in self.box.gears else ()

    def _decide(self, time: float, now: Measured) -> None:
        wanted, self._wanted = self._wanted or self._drive_off(now), ""
        if not wanted and self.schedule is not None and time - self._ended >= self.pause - 1e-9:
            wanted = self.schedule.gear(self.gear, now.output_speed, now.throttle)
        if wanted and wanted != self.gear:
            self._start(wanted, time, now)

    def _drive_off(self, now: Measured) -> str:
        """The gear to drive off in, where the last one was let go and the driver wants to go."""
        if not self._let_go or now.throttle <= self.settings.launch_throttle:
            return ""
        if self.schedule is None or self._let_go not in self.schedule.ratios:
            return self._let_go
        return self.schedule.gear(next(iter(self.schedule.ratios)), now.output_speed, now.throttle)

    def _stalls(self, now: Measured) -> bool:
        """Whether the output holds an input that is fixed to an engine below its launch speed."""
        least = STALLS * self.settings.launch_speed
        if not least or self.gear == NEUTRAL or now.input_speed >= least:
            return False
        launches = self._course is not None and not self._course.one.off
        return not launches or now.throttle <= self.settings.launch_throttle

    # --------------------------------------------------------------------------------------------------- the shift

    def _start(self, gear: str, time: float, now: Measured) -> None:
        before, after = self._closed(self.gear), self._closed(gear)
        self._left = list(exchanges(self.box, before, after, self.plant.inertias))
        self.records.append(ShiftRecord(self.gear, gear, time, now.input_torque >= 0.0, tuple(self._left)))
        self.gear, self._let_go = gear, ""
        kept = {*self._left[0].kept, self._left[0].off} if self._left else set(after)
        self._do.open(*(name for name in before if name not in kept and not self._stays_in(name, gear)))
        if self._left:
            self._begin(time)
        else:
            self._do.close(after, self.settings)
            self._finish(time)

    def _stays_in(self, name: str, gear: str) -> bool:
        """Dog clutches stay in mesh in neutral: they could not engage again while the engine turns."""
        return gear == NEUTRAL and self._do.is_dog(name)

    def _begin(self, time: float) -> None:
        """The next exchange."""
        one, with_ = self._left[0], self._with(self.records[-1])
        self._do.close(one.kept, with_)
        self._course = Course(one, with_, self._do, time, len(self._left) == 1)
        self.records[-1].phases.append((time, "fill"))

    def _with(self, record: ShiftRecord) -> ShiftSettings:
        """Calibration of a shift."""
        return self.chosen.get((record.before, record.after), self.chosen.get(record.kind, self.settings))

    def _go_on(self, course: Course, time: float, period: float, now: Measured) -> None:
        new = course.step(time, period, now)
        if new == "failed":
            self._abandon(time, self.records[-1].before, f"{course.one.on} did not engage")
        elif new == "done":
            self._left.pop(0)
            if self._left:
                self._begin(time)
            else:
                self._do.close(self._closed(self.gear), course.with_)
                self._finish(time, self._slipping(course, now))
        elif new:
            self.records[-1].phases.append((time, new))

    def _slipping(self, course: Course, now: Measured) -> str:
        """What says that the gear is not in: elements that slip, sleeves that are out."""
        closed, do = self._closed(self.gear), self._do
        slips = [name for name in closed if do.slides(name) and abs(now.slips[name]) > course.with_.sync_slip]
        out = [name for name in closed if do.is_dog(name) and now.sleeves.get(name, 1.0) < ENGAGED]
        return "; ".join(f"{listed(names)} {fault}" for names, fault in ((slips, "slips"), (out, "is out")) if names)

    def _call_off(self, time: float) -> None:
        """The driver wants another gear, and nothing was exchanged yet."""
        record = self.records[-1]
        if len(self._left) == len(record.exchanges) and record.exchanges[0].off:
            self._abandon(time, record.before, "called off")

    def _abandon(self, time: float, gear: str, why: str) -> None:
        """Not this gear, but another one at once."""
        if self._course is None:
            self.records.append(ShiftRecord(self.gear, gear, time, power_on=False))
            why = ""
        self._let_go = self.gear if gear == NEUTRAL else ""
        closed = self._closed(gear)
        self._do.open(*(name for name in self._do.kinds if name not in closed and not self._stays_in(name, gear)))
        self._do.close(closed, self.settings)
        self.gear = gear
        self._finish(time, why)

    def _finish(self, time: float, problem: str = "") -> None:
        self.records[-1].end, self.records[-1].problem = time, problem
        self._course, self._ended = None, time
        self._left = []
