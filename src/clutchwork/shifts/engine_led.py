"""Two clutches on one engine, which changes its speed by its own torque. docs/theory/shifts.md (19), (20)."""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, pi, sin
from typing import TYPE_CHECKING

from clutchwork.shifts.profile import share_of

if TYPE_CHECKING:
    from clutchwork.shifts.actuation import Actuation
    from clutchwork.shifts.exchange import Exchange
    from clutchwork.shifts.profile import Trend
    from clutchwork.shifts.record import Measured
    from clutchwork.shifts.settings import ShiftSettings

# slip that counts as none [rad/s], the longest that a clutch may take for the rest [s]
LOCKED, CLOSING = 0.05, 0.15
# its capacity then over its torque, and the least of that [N m]
CLOSE, LEAST = 1.2, 15.0
# rate at which what the slip is off its course is made up [1/s], far below that of the calls
CATCH_UP = 13.0
# torque with which the engine changes its speed at least [N m]
SPARE = 20.0


@dataclass
class EngineLedSequence:
    """One exchange of clutches that goes on while gears of both shafts are engaged; states as in `ExchangeSequence`.

    Where the clutch that comes slips the way of the torque it takes the torque over first, and the engine changes its
    speed then; else the engine changes its speed on the clutch that goes, and torque is handed over in "sync".
    """

    one: Exchange
    with_: ShiftSettings
    do: Actuation
    since: float  # s, begin of the state
    output: Trend  # of the speed of the output, which the controller follows
    state: str = "mesh"
    torque_factor: float = 1.0  # none: it asks for a torque
    blip: float = 0.0
    _change: float = 0.0  # N m, at the input, that is asked of the engine
    _start: float = 0.0  # rad/s, slip of the clutch that comes where the engine begins to change its speed
    _first: bool = True  # whether torque is handed over first
    _held: float = 0.0  # rad/s2, acceleration of the output before

    def torque_change(self, _: Measured) -> float:
        """Torque requested at the input on top of the driver's [N m]."""
        return self._change

    def step(self, time: float, period: float, now: Measured) -> str:
        """Do what the state asks for; the state that begins, if one does. "done": the exchange is made."""
        last, self._change = self.state, 0.0
        new: str = getattr(self, self.state)(time - self.since, period, now)
        # gear and pistons that wait already are passed by
        while new not in ("", "done", "failed"):
            self.state, self.since = new, time
            self._start = self._slip(now)
            new = getattr(self, self.state)(0.0, period, now)
        return new or (self.state if self.state != last else "")

    # ------------------------------------------------------------------------------------------------------ states

    def mesh(self, passed: float, _: float, now: Measured) -> str:
        """The gear that comes is engaged on its shaft, while the other one carries."""
        self.do.close([self.one.off], self.with_)
        waits = self.do.engage(self.one.kept[-1], now)
        return "fill" if waits else "failed" if passed > self.with_.longest else ""

    def fill(self, passed: float, _: float, now: Measured) -> str:
        """The clutch that comes up to where it touches."""
        one, do = self.one, self.do
        filled = one.on not in do.drivers or passed >= do.fill_time([one.on], self.with_)
        do.carry(one.on, 0.0, self.with_)
        self._held, self._first = self.output.slope, self._asked(now) * self._slip(now) >= 0.0
        return "" if not filled else "torque" if self._first else "inertia"

    def torque(self, passed: float, _: float, now: Measured) -> str:
        """Torque goes to the clutch that comes, while the engine still keeps pace with the shaft of the other one."""
        one, with_ = self.one, self.with_
        share, asked = share_of(passed, with_.torque_time), self._asked(now)
        # torque and acceleration of the output go with the ratio
        slope = self._held * one.after / one.before
        more = share * one.inertia * (one.before - one.after) * slope
        self._change = min(more, max(0.0, now.most - asked))
        self._carry(one.on, share * self._through(one.after, asked, slope))
        self._carry(one.off, (1.0 - share) * with_.margin * self._through(one.before, asked))
        return "inertia" if share >= 1.0 else ""

    def inertia(self, passed: float, period: float, now: Measured) -> str:
        """The engine changes its speed by its own torque, beside the clutch that carries that of the driver."""
        one, with_, asked, slip = self.one, self.with_, self._asked(now), self._slip(now)
        # on the clutch that goes it ends a little beyond, so that the one that comes slips the way of the torque
        beyond = 0.0 if self._first else copysign(with_.sync_slip, asked)
        spare = max(SPARE, asked - now.least if self._start > 0.0 else now.most - asked)
        time = max(with_.inertia_time, 2.0 * one.inertia * abs(self._start - beyond) / spare)
        # a torque holds for a period
        first, last = (self._course(share_of(at, time), beyond) for at in (passed, passed + period))
        slope = (last - first) / period if period else 0.0
        if not self._first:
            # the shaft that carries and the one that comes gain speed by their ratios
            slope += (one.after - one.before) * self.output.slope
        more = one.inertia * (slope + CATCH_UP * (first - slip))
        self._change = min(max(asked + more, now.least), now.most) - asked
        # what the engine cannot give is left to the clutch that carries
        carries, other, ratio = (one.on, one.off, one.after) if self._first else (one.off, one.on, one.before)
        through = self._through(ratio, asked)
        self._carry(carries, through + copysign(1.0, asked) * (self._change - more))
        self._carry(other, 0.0)
        # the clutch that comes must not slip against the torque; what it is filled with may hold it before
        near = abs(slip - beyond) < (1.0 if self._first else 0.5) * with_.sync_slip
        near = near or (passed >= time + CLOSING and abs(slip) < with_.sync_slip)
        return ("end" if self._first else "sync") if passed >= time and near else ""

    def sync(self, passed: float, _: float, now: Measured) -> str:
        """At equal speeds torque goes to the clutch that comes."""
        share, asked = share_of(passed, self.with_.torque_time), self._asked(now)
        self._carry(self.one.on, share * self._through(self.one.after, asked))
        self._carry(self.one.off, (1.0 - share) * self._through(self.one.before, asked))
        return "end" if share >= 1.0 else ""

    def end(self, passed: float, _: float, now: Measured) -> str:
        """The clutch that has come takes what slip is left, with a little more than the torque."""
        self._carry(self.one.on, max(LEAST, CLOSE * self._through(self.one.after, self._asked(now))))
        self._carry(self.one.off, 0.0)
        return "done" if abs(self._slip(now)) < LOCKED or passed > CLOSING else ""

    # --------------------------------------------------------------------------------------------------- what holds

    def _carry(self, name: str, torque: float) -> None:
        """A torque, and no pressure at all without one where nothing has to be filled."""
        self.do.carry(name, max(0.0, torque), self.with_)
        if torque <= 0.0 and name not in self.do.drivers:
            self.do.open(name)

    def _asked(self, now: Measured) -> float:
        """What the driver asks for at the input [N m]."""
        return now.input_torque if now.demand is None else now.demand

    def _slip(self, now: Measured) -> float:
        """Speed of the engine over that of the shaft of the clutch that comes [rad/s]."""
        return -copysign(now.slips[self.one.on], now.slips[self.one.on] * self.one.on_torque)

    def _through(self, ratio: float, torque: float, slope: float | None = None) -> float:
        """What a gear carries where the engine keeps pace with its shaft [N m]: equation (19)."""
        slope = self.output.slope if slope is None else slope
        return abs(torque - self.one.inertia * ratio * slope)

    def _course(self, x: float, beyond: float) -> float:
        """Slip of the clutch that comes, level at both ends [rad/s]: equation (20)."""
        return self._start + (beyond - self._start) * (x - sin(2.0 * pi * x) / (2.0 * pi))
