"""A shift controller as one of a control unit: states, called every few milliseconds. docs/theory/shifts.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from clutchwork.base.errors import UseError
from clutchwork.base.quote import listed, quote
from clutchwork.shifts.actuation import Actuation
from clutchwork.shifts.choice import GearChoice
from clutchwork.shifts.course import ExchangeSequence
from clutchwork.shifts.exchange import Exchange, exchanges, ratio_of
from clutchwork.shifts.handover import Handover, handover, is_straight
from clutchwork.shifts.parallel import ParallelSequence
from clutchwork.shifts.plant import Plant
from clutchwork.shifts.record import NEUTRAL, Measured, ShiftRecord
from clutchwork.shifts.settings import ShiftSettings

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.shifts.schedule import ShiftSchedule


@dataclass
class ShiftController:
    """Shifts a gearbox: fills, hands the torque over, pulls the input to its new speed, closes.

    Use it in a loop around a `cw.Simulator`, as `cw.shifts.drive` has one, or take its commands elsewhere: `step`
    knows nothing of clutchwork's runs. It works out of the gearbox alone which elements are exchanged and what they
    carry; several exchanges follow one another through the gears between them.

    - mesh: dog clutches of the gear that stand still go in first
    - fill: the element that closes is filled; the one that opens is lowered to what it carries
    - torque: one takes over the torque from the other: first in upshifts under power and downshifts without
    - inertia: the input follows a profile to its new speed, by the one that closes where it must be pulled there, by
      the one that opens where it must be held back
    - sync: in the other shifts the torque is taken over here, at equal speeds
    - end: the element that closed is raised to full pressure, until it does not slip

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
    _left: list[Exchange | Handover] = field(default_factory=list)
    _course: ExchangeSequence | ParallelSequence | None = None
    _called: float = 0.0  # s
    _ended: float = 0.0  # s, end of the last shift

    def __post_init__(self) -> None:
        self._known(self.gear)
        self._choice = GearChoice(self.schedule, self.settings)
        self._do = Actuation(self.box, self.plant, self.prefix)
        self._do.only(self.gear, self.settings)
        self._ended = -self.pause
        if self.gear == NEUTRAL and self.settings.launch_speed and self.schedule is not None:
            self._choice.let_go = next(iter(self.schedule.ratios))

    # ------------------------------------------------------------------------------------------------ from outside

    def request(self, gear: str) -> None:
        """Ask for a gear, "N" for neutral; a shift that goes on is finished before. UseError for one it does not have.

        A shift that is still filling is called off.
        """
        self._known(gear)
        self._choice.request(gear)

    def step(self, time: float, now: Measured) -> dict[str, float]:
        """Pressures [Pa] and positions of sleeves by signal, those that change alone, at a time [s]."""
        before = dict(self._do.commands)
        period = max(0.0, time - self._called)
        self._called = time
        course = self._course
        if self._choice.stalls(self.gear, course is not None and not course.one.off, period, now):
            self._abandon(time, NEUTRAL, "let go before the engine stalled")
        elif course is not None and self._choice.wanted not in ("", self.gear):
            self._change_mind(course, time, period, now)
        if self._course is None:
            wanted = self._choice.take(self.gear, time - self._ended >= self.pause - 1e-9, now)
            if wanted:
                self._start(wanted, time, now)
        if self._course is not None:
            self._go_on(self._course, time, period, now)
        return self._do.signals(name for name, value in self._do.commands.items() if value != before[name])

    @property
    def shifting(self) -> bool:
        """Whether a shift is in progress."""
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

    def _known(self, gear: str) -> None:
        if gear != NEUTRAL and gear not in self.box.gears:
            remedy = f"choose from {listed([*self.box.gears, NEUTRAL])}"
            raise UseError("ShiftController", [f"{quote(gear)} is not a gear of {quote(self.box.name)}; {remedy}"])

    # --------------------------------------------------------------------------------------------------- the shift

    def _start(self, gear: str, time: float, now: Measured) -> None:
        before, after = self._do.closed_in(self.gear), self._do.closed_in(gear)
        self._left = list(self._plan(before, after, now.input_torque))
        self.records.append(ShiftRecord(self.gear, gear, time, now.input_torque >= 0.0, tuple(self._left)))
        self.gear, self._choice.let_go = gear, ""
        if self._left:
            self._begin(time)
        else:
            self._do.only(gear, self.settings)
            self._finish(time)

    def _plan(self, before: tuple[str, ...], after: tuple[str, ...], torque: float) -> tuple[Exchange | Handover, ...]:
        """All elements at once where statics say how, else one exchange after the other."""
        off, on = (tuple(n for n in a if n not in b) for a, b in ((before, after), (after, before)))
        ratios = ratio_of(self.box, before), ratio_of(self.box, after)
        if off and on and ratios[0] * ratios[1] > 0.0:
            kept = tuple(name for name in after if name in before)
            one = self._handover(off, on, kept)
            if one is not None and is_straight(self.box, one, torque):
                return (one,)
        way = exchanges(self.box, before, after, self.plant.inertias)
        singles = [self._alone(one) for one in way]
        known = tuple(one for one in singles if one is not None)
        return known if len(known) == len(way) else way

    def _handover(self, off: Sequence[str], on: Sequence[str], kept: Sequence[str]) -> Handover | None:
        return handover(self.box, off, on, kept, self.plant.inertias)

    def _alone(self, one: Exchange) -> Handover | None:
        """An exchange of two elements that slip, as the handover that it is."""
        if not one.off or not one.on:
            return None
        return self._handover((one.off,), (one.on,), one.kept)

    def _begin(self, time: float) -> None:
        """The next exchange."""
        one, record = self._left[0], self.records[-1]
        if isinstance(one, Handover):
            opens = tuple(name for name in self._do.kinds if name not in (*one.kept, *one.elements))
            filled = len(self._left) < len(record.exchanges)
            ahead = self._left[1].on if len(self._left) > 1 else ()
            self._course = ParallelSequence(one, self._with(record), self._do, self._handover, time, opens, filled, ahead)
            record.phases.append((time, self._course.state))
            return
        opens = tuple(name for name in self._do.kinds if name not in (*one.kept, one.off, one.on))
        opens += (one.on,) if not one.off else ()
        filled = len(self._left) < len(record.exchanges)
        ahead = self._left[1].on if len(self._left) > 1 else ""
        self._course = ExchangeSequence(one, self._with(record), self._do, time, filled, ahead, opens)
        self.records[-1].phases.append((time, "mesh"))

    def _with(self, record: ShiftRecord) -> ShiftSettings:
        """Calibration of a shift."""
        return self.chosen.get((record.before, record.after), self.chosen.get(record.kind, self.settings))

    def _go_on(self, course: ExchangeSequence | ParallelSequence, time: float, period: float, now: Measured) -> None:
        new = course.step(time, period, now)
        if new == "failed":
            self._fail(course, time, now)
        elif new == "done":
            self._left.pop(0)
            if self._left:
                self._begin(time)
            else:
                self._do.only(self.gear, self.settings)
                self._finish(time, self._do.wrong(self.gear, course.with_, now))
        elif new:
            self.records[-1].phases.append((time, new))

    def _fail(self, course: ExchangeSequence | ParallelSequence, time: float, now: Measured) -> None:
        """Back to the gear before."""
        record = self.records[-1]
        if isinstance(course, ParallelSequence):
            why = f"the input did not come to its new speed within {time - course.since:.2g} s"
            self._go_over(course, record.before, why, time, now)
        else:
            self._abandon(time, record.before, f"{course.one.on} did not engage")

    def _change_mind(
        self, course: ExchangeSequence | ParallelSequence, time: float, period: float, now: Measured
    ) -> None:
        """The driver wants another gear while a shift goes on: at once where its elements slip, or later."""
        if isinstance(course, ParallelSequence):
            wanted, self._choice.wanted = self._choice.wanted, ""
            if not self._go_over(course, wanted, f"changed to {wanted}", time, now):
                self._choice.wanted = wanted
        elif course.state in ("mesh", "fill"):
            self._call_off(time)

    def _go_over(self, course: ParallelSequence, gear: str, why: str, time: float, now: Measured) -> bool:
        """From the middle of a shift into another gear; whether it can be."""
        after, full = self._do.closed_in(gear), course.with_.full_pressure
        stuck = [name for name in after if self._do.holds(name, now, course.with_)]
        kept = tuple(name for name in after if name in stuck)
        on = tuple(name for name in after if name not in kept)
        off = tuple(n for n in self._do.kinds if n not in after and self._do.commands.get(n, 0.0) > 0.0)
        one = self._handover(off, on, kept)
        if one is None or gear not in self.box.gears:
            return False
        before = self.records[-1].before if gear != self.records[-1].before else self.records[-1].after
        self.records[-1].end, self.records[-1].problem = time, why
        self.records.append(ShiftRecord(before, gear, time, now.input_torque >= 0.0, (one,)))
        self._left, self.gear = [one], gear
        self._begin(time)
        return True

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
        self._choice.let_go = self.gear if gear == NEUTRAL else ""
        self._do.only(gear, self.settings)
        self.gear = gear
        self._finish(time, why)

    def _finish(self, time: float, problem: str = "") -> None:
        self.records[-1].end, self.records[-1].problem = time, problem
        self._course, self._ended = None, time
        self._left = []
