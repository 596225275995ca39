"""Elements that open and close together while a shift goes on. docs/theory/shifts.md (13) to (16)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import copysign, exp
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base.arrays import Array
from clutchwork.shifts.handover import allocation
from clutchwork.shifts.profile import Trend, share_of
from clutchwork.shifts.record import Finding

if TYPE_CHECKING:
    from clutchwork.shifts.actuation import Actuation
    from clutchwork.shifts.handover import Handover
    from clutchwork.shifts.record import Measured
    from clutchwork.shifts.settings import ShiftSettings

# share of the way by which the plan may be ahead of what turns
AHEAD = 0.06
# share of the torque at hand that a plan uses where nothing else brings the input to its new speed
AT_HAND = 0.8
# share of the step of speed that may be lacking where a shift that takes too long is closed by pressure
CLOSED_ANYHOW = 0.2
# slip from which on the direction in which an element turns counts, and not the one of the plan [rad/s]
ASTRAY = 20.0
# what a torque of those counts for that close where the others hold the input, or the other way round
LAST = 3.0
# second difference of the speed of the output from which on it is a jolt of a piston [rad/s]
JOLT = 0.25
# the same in the torque phase, where an element grips late [rad/s], and when it should grip at the latest [s]
GRIPS, SOON = 0.06, 0.02
# for which the torque phase may wait without a reason [s]
USUAL = 0.005
# share of the inertia phase in which the torque of the engine comes back
COMES_BACK = 0.4
# torque that is lacking at the input of a downshift [N m], from which on all of `blip` is asked for
WHOLE = 50.0
# torque of an element that counts as none, as a share of that of the input
NOTHING = 1e-3
# time constant of the torque of the input in the loop [s]
SMOOTH = 0.02
# part of the inertia phase in which the loop has settled and the slip is not over yet
SETTLED = (0.4, 0.95)
# part of it behind which what opens behind a piston is let go, where it carries nothing
LET_GO = 0.2


@dataclass
class Missed:
    """Means of what an element carried in the inertia phase, and of what the loop added to that [N m]."""

    torque: float = 0.0
    added: float = 0.0
    looks: int = 0

    def add(self, torque: float, added: float) -> None:
        """One more look."""
        self.looks += 1
        self.torque += (torque - self.torque) / self.looks
        self.added += (added - self.added) / self.looks


@dataclass
class ParallelSequence:
    """A `Handover` that goes on; each state is a method that returns the next one, or nothing while it lasts."""

    one: Handover
    with_: ShiftSettings
    do: Actuation
    replan: Callable[[Sequence[str], Sequence[str], Sequence[str]], Handover | None]  # of off, on and kept
    since: float  # s, begin of the state
    opens: tuple[str, ...] = ()  # what opens at once
    filled: bool = False  # whether those that close were filled in the handover before
    ahead: tuple[str, ...] = ()  # those that close in the handover that follows, if one does
    over: bool = False  # whether another shift went over into this one
    rates: Mapping[str, float] = field(default_factory=dict)  # rad/s2, of slips, where one did
    state: str = "fill"
    torque_factor: float = 1.0  # what the engine is asked for
    loaded: float = 0.0  # N m, at the input where the inertia phase began
    blip: float = 0.0  # throttle on top of that of the driver
    lacking: float = 0.0  # N m, at the input, that the engine is asked for where elements would pull it up too hard
    late: float = 0.0  # s, for which those that close were waited for in the torque phase
    jolt: float = 0.0  # rad/s, largest second difference of the speed of the output while they were filled
    left: float = 0.0  # rad/s, slip with which it was closed
    instants: dict[str, float] = field(default_factory=dict)  # s
    _now: float = 0.0  # s
    takes: tuple[str, ...] = ()  # those that took the torque over
    missed: dict[str, Missed] = field(default_factory=dict)  # of those that carried in the inertia phase
    _outputs: tuple[float, ...] = ()  # rad/s
    _kinks: list[tuple[float, float]] = field(default_factory=list)  # s, rad/s: of the output in the torque phase
    _held: dict[str, float] = field(default_factory=dict)  # Pa, of what opens, at the beginning
    _start: Array = field(default_factory=lambda: np.zeros(0))  # y where the inertia phase begins [rad/s]
    _speed: Array = field(default_factory=lambda: np.zeros(0))  # the same of its rate [rad/s2]
    _torque: float = 0.0  # N m, of the input behind a filter, in the inertia phase
    _fill_time: float = 0.0  # s
    _time: float = 0.0  # s, of the inertia phase as planned
    _passed: float = 0.0  # s, of that plan
    _pulls: bool = False  # whether those that close bring the input to its new speed alone
    _costs: dict[str, float] = field(default_factory=dict)  # rad/s
    _integral: Array = field(default_factory=lambda: np.zeros(0))
    _output: Trend = field(default_factory=Trend)

    def __post_init__(self) -> None:
        self._held = {name: self.do.commands.get(name, 0.0) for name in self.one.elements}

    def torque_change(self, _: Measured) -> float:
        """Torque requested at the input on top of the driver's [N m]."""
        return (self.torque_factor - 1.0) * self.loaded + self.lacking

    def step(self, time: float, period: float, now: Measured) -> str:
        """Do what the state asks for; the state that begins, if one does. "done": the exchange is made."""
        self._now = time
        new: str = getattr(self, self.state)(time - self.since, period, now)
        if new:
            self.state, self.since = new, time
        if new == "inertia":
            self._begin(now)
        elif new == "sync":
            self._held = {name: self.do.commands.get(name, 0.0) for name in self.one.elements}
        return new

    # ------------------------------------------------------------------------------------------------------ states

    def fill(self, passed: float, _: float, now: Measured) -> str:
        """Those that close up to where they touch, the others down to what they carry."""
        one, with_, do = self.one, self.with_, self.do
        do.open(*self.opens)
        do.close(one.kept, with_)
        if not one.on:
            return "sync"
        self._fill_time = self._fill_time or do.fill_time(one.on, with_)
        if self.over:
            # nothing holds the input meanwhile
            return "inertia"
        share = 1.0 if self.filled else share_of(passed, self._fill_time)
        # what lags is down in time
        down = max(share, share_of(passed, self._fill_time - do.settling(one.off)))
        self._watch_fill(now)
        for name in one.on:
            do.carry(name, 0.0, with_)
        for name in one.off:
            held = do.pressure(name, with_.margin * abs(one.off_torques[name] * now.input_torque), with_)
            do.commands[name] = min(self._held[name], held + (1.0 - down) * (self._held[name] - held))
        if share < 1.0:
            return ""
        taken = self._still(now)
        self.takes = tuple(name for name in one.on if abs(taken[name]) > NOTHING * abs(now.input_torque))
        return "torque" if any(abs(taken[name]) > NOTHING * abs(now.input_torque) for name in one.on) else "inertia"

    def torque(self, passed: float, period: float, now: Measured) -> str:
        """From the torques of the gear before to those that begin the inertia phase: equation (14)."""
        one, with_, do = self.one, self.with_, self.do
        if self._runs_away(now):
            # those that close are late: they go on until they grip, and the others go on holding
            self.late += period
            self.instants.setdefault("late", self._now)
            for name, torque in self._still(now).items():
                if name in one.on:
                    do.carry(name, passed / max(with_.torque_time, 1e-9) * torque, with_)
            for name in one.off:
                do.carry(name, with_.margin**2 * abs(one.off_torques[name] * now.input_torque), with_)
            if passed < with_.longest:
                return ""
        self._kinks += [(passed, self._kink(now))]
        share, taken = share_of(passed - self.late, with_.torque_time), self._still(now)
        for name in one.on:
            do.carry(name, share * taken[name], with_)
        for name in one.off:
            before = (1.0 - share) * with_.margin * one.off_torques[name] * now.input_torque
            after = -share * taken[name] * self._sign(name, now)
            do.carry(name, abs(before + after), with_)
        if share < 1.0 and all(abs(now.slips[name]) <= with_.sync_slip for name in one.off):
            return ""
        size = max(kink for _, kink in self._kinks)
        if size > GRIPS:
            # the output shows where they grip
            grips = next(at for at, kink in self._kinks if kink > 0.5 * size)
            self.late = max(self.late, grips - SOON)
        return "inertia"

    def _runs_away(self, now: Measured) -> bool:
        """Whether an element that held the gear before slips away from the new one: too little holds the input."""
        held = [name for name in self.one.off if self.one.off_torques[name]]
        slips = ((now.slips[name], self.one.offsets[name] * now.output_speed) for name in held)
        return any(slip * ahead < 0.0 and abs(slip) > self.with_.sync_slip for slip, ahead in slips)

    def inertia(self, passed: float, period: float, now: Measured) -> str:
        """All slips along their profiles at once, by those elements that pull the right way: equations (15), (16)."""
        one, with_, do = self.one, self.with_, self.do
        if self._is_synchronous(now):
            self.torque_factor, self.lacking, self.blip = 1.0, 0.0, 0.0
            return "sync"
        if passed > with_.longest:
            self.torque_factor, self.lacking, self.blip = 1.0, 0.0, 0.0
            lacks = float(np.linalg.norm(self._y(now)))
            self.left, self.instants["closed"] = lacks, self._now
            rises = float(one.input @ self._start) < 0.0
            return "failed" if rises and lacks > CLOSED_ANYHOW * float(np.linalg.norm(self._start)) else "sync"
        self._lock_early(now)
        one = self.one
        for name in self.ahead:
            do.carry(name, 0.0, with_)
        # a shift that goes over into this one leaves torques that would jump
        share = share_of(passed, with_.end_time) if self.over else 1.0
        for name, torque in self._needed(period, now).items():
            # what opens stays filled meanwhile: it may have to hold the input again
            do.carry(name, torque, with_)
            if self._lets_go(name, torque):
                do.open(name)
                continue
            do.commands[name] = share * do.commands[name] + (1.0 - share) * self._held[name]
        change = -float(one.input @ self._start)
        if now.input_torque > 0.0 and change < 0.0:
            # the engine needs its time to come back before speeds meet
            left = 1.0 - min(1.0, self._passed / self._time)
            self.torque_factor = 1.0 - with_.reduction * min(1.0, left / COMES_BACK)
        else:
            self.torque_factor = 1.0
        return ""

    def sync(self, passed: float, _: float, now: Measured) -> str:
        """At equal speeds: those that close hold what they will carry, the others go down to nothing."""
        one, with_, do = self.one, self.with_, self.do
        let_go = not any(self._held.get(name, 0.0) for name in one.off)
        share = 1.0 if let_go else share_of(passed, 0.5 * with_.torque_time)
        for name in one.on:
            least = do.pressure(name, with_.margin * abs(one.on_torques[name] * now.input_torque), with_)
            # without slip it takes what the others leave, and not all that it could
            do.commands[name] = max(do.commands[name], least)
        for name in one.off:
            do.commands[name] = min(do.commands[name], (1.0 - share) * self._held[name])
        return "end" if share >= 1.0 else ""

    def end(self, passed: float, period: float, now: Measured) -> str:
        """Those that closed up to full pressure, until they do not slip any more."""
        one, with_, do = self.one, self.with_, self.do
        do.open(*one.off)
        if self.ahead:
            return "done"
        full = with_.full_pressure
        for name in one.on:
            do.commands[name] = min(full, do.commands[name] + full * period / max(with_.end_time, 1e-9))
        if any(do.commands[name] < full for name in one.on):
            return ""
        closed = all(abs(now.slips[name]) < with_.sync_slip for name in one.on)
        return "done" if closed or passed > with_.longest else ""

    def findings(self) -> tuple[Finding, ...]:
        """What was wrong on the way, with the setting that cures it."""
        names, made = "+".join(self.one.on), list[Finding]()
        if self.jolt > JOLT:
            cause = f"{names} gripped with a jolt of {self.jolt:.2g} rad/s while filled"
            made.append(Finding(self.instants.get("jolt", 0.0), cause, "fill_time of the actuator down"))
        if self.late > USUAL:
            cause = f"{names} gripped {1e3 * self.late:.0f} ms late: the input ran away"
            made.append(Finding(self.instants.get("late", 0.0), cause, "fill_time up"))
        if "closed" in self.instants:
            cause = f"closed with {self.left:.0f} rad/s of slip after `longest`"
            made.append(
                Finding(self.instants["closed"], cause, "longest up, inertia_time up, or more torque of the engine")
            )
        return tuple(made)

    # --------------------------------------------------------------------------------------------------- what holds

    def _lock_early(self, now: Measured) -> None:
        """What comes to its new speed before the others stays there: it is closed, and the others go on without it."""
        y, one = self._y(now), self.one
        there = [name for name, slip, first in zip(one.on, y, self._start, strict=True) if slip * first <= 0.0]
        rest = tuple(name for name in one.on if name not in there)
        if not there or not rest:
            return
        left = self.replan(one.off, rest, (*one.kept, *there))
        if left is None:
            return
        chosen = [one.on.index(name) for name in rest]
        self._start, self._speed, self._integral = (part[chosen] for part in (self._start, self._speed, self._integral))
        self.one = left
        self.do.close(there, self.with_)

    def _watch_fill(self, now: Measured) -> None:
        """A piston that is filled too long grips with a jolt, which the output shows."""
        jolt = self._kink(now)
        if jolt > self.jolt:
            self.jolt, self.instants["jolt"] = jolt, self._now

    def _kink(self, now: Measured) -> float:
        """Second difference of the speed of the output [rad/s]."""
        self._outputs = (*self._outputs[-2:], now.output_speed)
        first, middle, last = self._outputs if len(self._outputs) > 2 else (0.0, 0.0, 0.0)
        return abs(last - 2.0 * middle + first)

    def _lets_go(self, name: str, torque: float) -> bool:
        """Whether an element that opens is no more wanted: one whose kiss point is taken too high would drag."""
        # those that close can pull the input to its new speed, and what opens has not held it back
        if name in self.one.off and torque > 0.0:
            self._pulls = False
        idle = self._pulls and name in self.one.off and torque == 0.0
        return idle and name in self.do.drivers and self._passed > LET_GO * self._time

    def _watch_torques(self, x: float, torques: Mapping[str, float], planned: Mapping[str, float]) -> None:
        """What the loop has to add to torques that were right if the commands were: the kiss point is elsewhere."""
        for name, torque in torques.items() if SETTLED[0] < x < SETTLED[1] else ():
            if name in self.one.on and torque > 0.0 and planned[name] > 0.0:
                self.missed.setdefault(name, Missed()).add(torque, torque - planned[name])

    def _y(self, now: Measured) -> Array:
        return np.array([now.slips[name] for name in self.one.on])

    def _sign(self, name: str, now: Measured) -> float:
        """Direction in which an element slips, or will once it does."""
        one, slip = self.one, now.slips[name]
        if abs(slip) > ASTRAY:
            return copysign(1.0, slip)
        if name in one.on:
            place = one.on.index(name)
            return copysign(1.0, self._start[place] if len(self._start) else slip)
        return copysign(1.0, one.offsets[name] * now.output_speed)

    def _taken(self, wanted: Array, now: Measured) -> tuple[dict[str, float], float]:
        """Torques of the elements that make a wanted one."""
        one = self.one
        self._costs = self._costs or self._cost(now)
        costs = {name: self._costs[name] for name in one.elements}
        pulls = {name: -self._sign(name, now) * one.rates[name] for name in one.elements}
        return allocation(wanted, pulls, costs, one.inertia)

    def _cost(self, now: Measured) -> dict[str, float]:
        """Slip of each element where it is largest, more of those that should not carry: equation (15)."""
        one, y = self.one, self._y(now)
        takes = float(one.input @ y) * now.input_torque > 0.0
        costs = {name: abs(slip) * (1.0 if takes else LAST) for name, slip in zip(one.on, y.tolist(), strict=True)}
        speed = abs(now.output_speed)
        return costs | {name: abs(one.offsets[name]) * speed * (LAST if takes else 1.0) for name in one.off}

    def _still(self, now: Measured) -> dict[str, float]:
        """Torques with which no slip changes, all elements slipping."""
        return self._taken(-self.one.input * now.input_torque, now)[0]

    def _begin(self, now: Measured) -> None:
        """The inertia phase from here."""
        one, with_ = self.one, self.with_
        self._start, self.loaded, self._torque = self._y(now), now.input_torque, now.input_torque
        self._speed = np.array([self.rates.get(name, 0.0) for name in one.on])
        self._integral, self._passed = np.zeros(len(one.on)), 0.0
        # of several that open one may be wanted later
        alone = len(one.on) == 1 == len(one.off)
        self._pulls = alone and float(one.input @ self._start) * now.input_torque > 0.0
        self._output = Trend(now.output_speed)
        change = -float(one.input @ self._start)
        time, longer = max(with_.inertia_time, 1e-9), abs(change) / max(with_.usual_step, 1e-9)
        # what the torque of the input itself brings there, or a pull of the elements that close up to a limit
        own, pull = AT_HAND * max(0.0, copysign(now.input_torque, change * now.input_torque)), with_.pull
        at_hand = max(own, pull if change > 0.0 else 0.0)
        if at_hand > 0.0 and change:
            kinetic = float(self._start @ one.inertia @ self._start) / abs(change)
            # its own torque speeds up an engine behind a converter too
            kinetic += min(1.0, own / pull) * self.do.plant.behind * abs(change)
            longer = max(longer, 1.5 * kinetic / at_hand / time)
        self._time = time * min(max(1.0, longer), max(1.0, with_.stretch))

    def _needed(self, period: float, now: Measured) -> dict[str, float]:
        """What the elements take, so that the slips follow their profiles."""
        one, with_ = self.one, self.with_
        self._output.follow(now.output_speed, period)
        lever = np.linalg.solve(one.inertia, one.coupling)
        # a drive shaft that rings shakes the slips, but not what turns with them
        y = self._y(now) + lever * (now.output_speed - self._output.value)
        x = min(1.0, self._passed / self._time)
        wanted, rate = self._profile(x)
        size = float(self._start @ self._start)
        done = 1.0 - float(self._start @ y) / size if size else 1.0
        if not with_.closed_loop or 1.0 - float(self._start @ wanted) / max(size, 1e-12) < done + AHEAD:
            self._passed += period
        error = wanted - y
        if with_.closed_loop:
            law = rate + with_.proportional * error + self._integral
        else:
            # what the plan lacks at its end is made up with its mean rate
            law = rate if x < 1.0 else -self._start / self._time
        # under power the torque at hand makes up what the slips are off their course
        asked = rate if self.loaded > 0.0 else law
        self._ask(float(self._start @ (one.inertia @ asked)), now)
        # that of a converter answers within a period to what is done here: at once it would come back as an oscillation
        self._torque += (1.0 - exp(-period / SMOOTH)) * (now.input_torque - self._torque)
        force = one.inertia @ law + one.coupling * self._output.slope - one.input * self._torque
        torques, missed = self._taken(force, now)
        if with_.closed_loop and missed <= 1e-6:
            self._integral = self._integral + with_.integral * error * period
            self._watch_torques(x, torques, self._taken(force - one.inertia @ (law - rate), now)[0])
        return torques

    def _ask(self, work: float, now: Measured) -> None:
        """Torque of the engine for a downshift in which elements would pull the input up too hard: equation (22)."""
        lever = float(self._start @ self.one.input)
        lacks = (work / lever if lever < 0.0 else 0.0) - self.with_.pull
        driver = now.input_torque if now.demand is None else now.demand
        # it needs its time to come back before speeds meet
        left = min(1.0, (1.0 - min(1.0, self._passed / self._time)) / COMES_BACK)
        self.lacking = left * max(0.0, lacks - driver)
        self.blip = left * self.with_.blip * min(1.0, max(0.0, lacks - now.input_torque) / WHOLE)

    def _profile(self, x: float) -> tuple[Array, Array]:
        """The slips that are wanted at a share of the time [rad/s], and their rate [rad/s2]: equation (16)."""
        with_, time = self.with_, self._time
        # held back they are led a little past their end, so that they come through it
        beyond = -np.sign(self._start) * min(1.0, x) * 0.5 * with_.sync_slip
        fall = 1.0 - x * x * (3.0 - 2.0 * x)
        slope = 6.0 * x * (1.0 - x) / time
        start = x * (1.0 - x) ** 2 * time
        rise = (1.0 - x) * (1.0 - 3.0 * x)
        y = self._start * fall + self._speed * start + beyond
        rate = -self._start * slope + self._speed * rise
        return y, rate

    def _is_synchronous(self, now: Measured) -> bool:
        y = self._y(now)
        return bool(np.all((np.abs(y) < self.with_.sync_slip) | (y * self._start <= 0.0)))
