"""A shift controller as one of a control unit: states, called every few milliseconds. docs/theory/shifts.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

from clutchwork.base import UseError, listed, quote
from clutchwork.base.errors import expect
from clutchwork.base.frozen import Frozen
from clutchwork.declare.calls import explain
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.shifts.actuation import Actuation
from clutchwork.shifts.actuators import Learnt
from clutchwork.shifts.adaptation import adapt
from clutchwork.shifts.choice import GearChoice
from clutchwork.shifts.course import ExchangeSequence
from clutchwork.shifts.engine_led import EngineLedSequence
from clutchwork.shifts.exchange import Exchange
from clutchwork.shifts.handover import Handover, handover, is_straight
from clutchwork.shifts.interrupted import InterruptedSequence
from clutchwork.shifts.parallel import ParallelSequence
from clutchwork.shifts.plans import between_halves, plan
from clutchwork.shifts.plant import Plant
from clutchwork.shifts.preselect import Halves, expected
from clutchwork.shifts.profile import Trend
from clutchwork.shifts.record import NEUTRAL, Measured, ShiftRecord
from clutchwork.shifts.settings import ShiftSettings

if TYPE_CHECKING:
    from clutchwork.shifts.shift_map import ShiftMap

Course = ExchangeSequence | ParallelSequence | EngineLedSequence


@dataclass
class ShiftController:
    """Shifts a gearbox: fills, hands the torque over, pulls the input to its new speed, closes.

    Use it in a loop around a `cw.Simulator`, as `cw.shifts.drive` has one, or take its commands elsewhere: `step`
    knows nothing of clutchwork's runs. It works out of the gearbox alone which elements are exchanged and what they
    carry. Several open and close together, and where statics do not allow that, one after the other through gears.

    - mesh: dog clutches of the gear that stand still go in first
    - fill: the element that closes is filled; the one that opens is lowered to what it carries
    - torque: those that close take over the torque: first in upshifts under power and downshifts without
    - inertia: speeds follow profiles to the new gear, by elements that close where the input must be pulled there, by
      those that open where it must be held back
    - sync: in the other shifts the torque is taken over here, at equal speeds
    - end: the elements that closed are raised to full pressure, until they do not slip

    Freewheels overrun and catch by themselves and need no command. A dog clutch opens when its torque is gone
    and closes near equal speeds, to which the engine comes where no clutch can bring the input there. A request while a
    shift goes on is followed at once, from the speeds that are; where dog clutches or freewheels take part, or statics
    do not say how, the shift is finished before. One that does not get to its new speed within `longest` goes back.

    Between gears of teeth alone, as of an electric axle, the motor turns the input to its new speed without torque at
    the output. In a dual-clutch gearbox the next gear waits on the free shaft, two gears of one shaft are reached
    through one of the other, and the engine changes its speed by its own torque, which `torque_change` has.

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
        known: what `learnt` of another controller said, or fill times [s] alone; by default that of the plant

    What it did is in `records`, what it asks of the engine in `torque_factor` (a factor of its torque) and `blip`
    (throttle on top of that of the driver).
    """

    box: Gearbox
    plant: Plant
    schedule: ShiftMap | None = None
    settings: ShiftSettings = field(default_factory=ShiftSettings)
    chosen: Mapping[tuple[str, str] | str, ShiftSettings] = field(default_factory=dict)
    gear: str = NEUTRAL
    prefix: str = "gearbox"
    pause: float = 0.3  # s, from the end of a shift to the next one that the schedule asks for
    known: Mapping[str, Learnt | float] = field(default_factory=dict)
    always: ClassVar[bool] = False  # whether it is called as often between shifts
    # what it remembers
    records: list[ShiftRecord] = field(default_factory=list)
    _left: list[Exchange | Handover] = field(default_factory=list)
    _course: Course | None = None
    _called: float = 0.0  # s
    _seen: tuple[float, Mapping[str, float]] = field(default=(0.0, Frozen()))  # s, rad/s: slips at the last call
    _ended: float = 0.0  # s, end of the last shift

    def __post_init__(self) -> None:
        expect("ShiftController", "box", self.box, Gearbox, "give a cw.Gearbox, such as cw.Gearbox.load('zf-8hp70')")
        expect("ShiftController", "plant", self.plant, Plant, "give cw.shifts.plant_of(driveline, box)")
        self._known(self.gear)
        self._choice = GearChoice(self.schedule, self.settings)
        self._halves, self._output, self._sourced = Halves.of(self.box), Trend(), False
        rivals = self._halves.rivals if self._halves else {}
        self._do = Actuation(self.box, self.plant, self.prefix, rivals, self.settings.cone)
        self._do.only(self.gear, self.settings)
        for name, one in self._do.drivers.items():
            known = self.known.get(name, one.fill_time)
            one.fill_time, one.kiss = known if isinstance(known, tuple) else (known, one.kiss)
        self._do.start()
        self._ended = -self.pause
        if self.gear == NEUTRAL and self.settings.launch_speed and self.schedule is not None:
            self._choice.let_go = next(iter(self.schedule.ratios))

    # ------------------------------------------------------------------------------------------------ from outside

    def request(self, gear: str) -> None:
        """Ask for a gear, "N" for neutral, also while a shift goes on. UseError for one it does not have."""
        self._known(gear)
        self._choice.request(gear)

    def step(self, time: float, now: Measured) -> dict[str, float]:
        """Pressures [Pa], currents [A] and positions of sleeves by signal, those that change alone, at a time [s]."""
        period = max(0.0, time - self._called)
        self._called = time
        self._output.follow(now.output_speed, period)
        self._sourced = now.demand is not None
        course = self._course
        if self._choice.stalls(self.gear, course is not None and not course.one.off, period, now):
            self._abandon(time, NEUTRAL, "let go before the engine stalled")
        elif course is not None and self._choice.wanted not in ("", self.gear):
            self._change_mind(course, time, now)
        if self._course is None:
            wanted = self._choice.take(self.gear, time - self._ended >= self.pause - 1e-9, now)
            if wanted:
                self._start(wanted, time, now)
        if self._course is not None:
            self._go_on(self._course, time, period, now)
        if self._halves and (self._course is None or self._course.state == "inertia"):
            self._preselect(self._halves, now)
        self._seen = (time, now.slips)
        return self._do.outputs(period, shifting=self.shifting)

    @property
    def shifting(self) -> bool:
        """Whether a shift is in progress."""
        return self._course is not None

    @property
    def asks(self) -> str:
        """What it cannot do without `sources`, if anything."""
        return "the engine changes its speed by its own torque" if self._halves else ""

    @property
    def state(self) -> str:
        """Of the shift that goes on: "fill", "torque", "inertia", "sync" or "end"; "steady" between shifts."""
        return "steady" if self._course is None else self._course.state

    @property
    def torque_factor(self) -> float:
        """Factor of the torque of the engine that it asks for."""
        return 1.0 if self._course is None else self._course.torque_factor

    def torque_change(self, now: Measured) -> float:
        """Torque that it asks for at the input on top of what the driver asks for [N m], below zero a reduction."""
        return 0.0 if self._course is None else self._course.torque_change(now)

    @property
    def blip(self) -> float:
        """Throttle that it asks for on top of that of the driver, 0 to 1."""
        return 0.0 if self._course is None else self._course.blip

    @property
    def learnt(self) -> dict[str, Learnt]:
        """Fill time and kiss point of each element behind a piston, as shifts have shown: `known` of the next one."""
        return {name: Learnt(one.fill_time, one.kiss) for name, one in self._do.drivers.items()}

    @property
    def commands(self) -> dict[str, float]:
        """All commands by signal, such as for the start of a run."""
        return dict(self._do.sent)

    def _known(self, gear: str) -> None:
        if gear != NEUTRAL and gear not in self.box.gears:
            remedy = f"choose from {listed([*self.box.gears, NEUTRAL])}"
            raise UseError("ShiftController", [f"{quote(gear)} is not a gear of {quote(self.box.name)}; {remedy}"])

    # --------------------------------------------------------------------------------------------------- the shift

    def _start(self, gear: str, time: float, now: Measured) -> None:
        before, after = self._do.closed_in(self.gear), self._do.closed_in(gear)
        inertias, ratios = self.plant.inertias, self.box.ratios
        if self._halves and ratios.get(self.gear, 0.0) * ratios.get(gear, 0.0) > 0.0:
            self._left = list(between_halves(self.box, self._halves, self.gear, gear, inertias))
        else:
            self._left = list(plan(self.box, before, after, inertias, now.input_torque))
        self.records.append(ShiftRecord(self.gear, gear, time, now.input_torque >= 0.0, tuple(self._left)))
        self.gear, self._choice.let_go = gear, ""
        if self._left:
            self._begin(time)
        else:
            self._do.only(gear, self.settings)
            self._finish(time)

    def _preselect(self, halves: Halves, now: Measured) -> None:
        """Engage the gear that comes next on the shaft whose clutch is open."""
        schedule, course = self.schedule, self._course
        gear = self._choice.next_gear(now) if self.gear == NEUTRAL else self.gear
        if schedule is not None and gear in halves.clutch and (course is None or not course.one.off):
            waits = expected(halves, schedule, gear, now.output_speed, now.throttle)
            for one in (gear, waits) if self.gear == NEUTRAL else (waits,):
                self._do.engage(halves.sleeve[one], now)

    def _begin(self, time: float, rates: Mapping[str, float] | None = None) -> None:
        """The next part of the plan; rates, of slips where another shift goes over into it."""
        record, do = self.records[-1], self._do
        one, ahead = self._left[0], self._left[1] if len(self._left) > 1 else None
        with_, filled = self._with(record), len(self._left) < len(record.exchanges)
        if isinstance(one, Handover):
            opens = tuple(name for name in do.kinds if name not in (*one.kept, *one.elements))
            on = ahead.on if isinstance(ahead, Handover) else ()
            made = ParallelSequence(one, with_, do, self._handover, time, opens, filled, on)
            made.over, made.rates = bool(rates), rates or {}
            self._course = made
        elif self._halves and one.off:
            self._course = EngineLedSequence(one, with_, do, time, self._output)
        else:
            opens = tuple(name for name in do.kinds if name not in (*one.kept, one.off, one.on, *do.rivals))
            opens += (one.on,) if not one.off else ()
            teeth = self._sourced and do.is_dog(one.off) and do.is_dog(one.on)
            kind = InterruptedSequence if teeth else ExchangeSequence
            self._course = kind(one, with_, do, time, filled, ahead.on if isinstance(ahead, Exchange) else "", opens)
        record.phases.append((time, self._course.state))

    def _handover(self, off: Sequence[str], on: Sequence[str], kept: Sequence[str]) -> Handover | None:
        return handover(self.box, off, on, kept, self.plant.inertias)

    def _with(self, record: ShiftRecord) -> ShiftSettings:
        """Calibration of a shift."""
        return self.chosen.get((record.before, record.after), self.chosen.get(record.kind, self.settings))

    def _go_on(self, course: Course, time: float, period: float, now: Measured) -> None:
        new = course.step(time, period, now)
        if new == "failed":
            self._fail(course, time, now)
        elif new == "done":
            if isinstance(course, ParallelSequence):
                adapt(course)
                self.records[-1].diagnosis += course.findings()
            self._left.pop(0)
            if self._left:
                self._begin(time)
            else:
                self._do.only(self.gear, self.settings)
                self._finish(time, self._do.wrong(self.gear, course.with_, now))
        elif new:
            self.records[-1].phases.append((time, new))

    # ------------------------------------------------------------------------------------- other gears than that

    def _fail(self, course: Course, time: float, now: Measured) -> None:
        """Back to the gear before."""
        gear = self.records[-1].before
        if not isinstance(course, ParallelSequence):
            late = course.one.kept[-1] if isinstance(course, EngineLedSequence) else course.one.on
            self._abandon(time, gear, f"{late} did not engage")
            return
        why = f"the input did not come to its new speed within {time - course.since:.2g} s"
        if not self._go_over(course, gear, why, time, now):
            self._abandon(time, gear, why)

    def _change_mind(self, course: Course, time: float, now: Measured) -> None:
        """The driver wants another gear while a shift goes on: at once where statics say how, or later."""
        wanted, self._choice.wanted = self._choice.wanted, ""
        first = len(self._left) == len(self.records[-1].exchanges)
        if course.state in ("mesh", "fill") and first and course.one.off:
            # nothing was exchanged yet
            self._abandon(time, self.records[-1].before, "called off")
            if wanted != self.gear:
                self._start(wanted, time, now)
        elif not isinstance(course, ParallelSequence) or not self._go_over(
            course, wanted, f"changed to {wanted}", time, now
        ):
            self._choice.wanted = wanted

    def _go_over(self, course: ParallelSequence, gear: str, why: str, time: float, now: Measured) -> bool:
        """From the middle of a shift into another gear; whether it can be."""
        after, record = self._do.closed_in(gear), self.records[-1]
        kept = tuple(name for name in after if self._do.holds(name, now, course.with_))
        on = tuple(name for name in after if name not in kept)
        off = tuple(name for name, value in self._do.commands.items() if value > 0.0 and name not in after)
        one = self._handover(off, on, kept) if gear in self.box.gears else None
        if one is None or (gear != record.before and not self._straight(one, now)):
            return False
        record.end, record.problem = time, why
        before = record.before if gear != record.before else record.after
        self.records.append(ShiftRecord(before, gear, time, now.input_torque >= 0.0, (one,)))
        self._left, self.gear = [one], gear
        # in the torque phase the gear before still holds
        slips = any(abs(now.slips[name]) > course.with_.sync_slip for name in course.one.off)
        self._begin(time, self._rates(time, now) if slips else None)
        return True

    def _straight(self, one: Handover, now: Measured) -> bool:
        """Whether statics allow a way from the speeds that are."""
        output = now.output_speed
        begin = output and (now.input_speed / output, {name: slip / output for name, slip in now.slips.items()})
        return is_straight(self.box, one, now.input_torque, begin or None)

    def _rates(self, time: float, now: Measured) -> dict[str, float]:
        """Of slips since the last call [rad/s2]."""
        last, slips = self._seen
        return {name: (slip - slips.get(name, slip)) / max(time - last, 1e-9) for name, slip in now.slips.items()}

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


explain(ShiftController, "cw.shifts")
