"""An exchange of teeth with the torque interrupted, synchronised by what drives at the input. docs/theory/shifts.md."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from clutchwork.shifts.actuation import FREE
from clutchwork.shifts.course import ExchangeSequence
from clutchwork.shifts.profile import share_of

if TYPE_CHECKING:
    from clutchwork.shifts.record import Measured


@dataclass
class InterruptedSequence(ExchangeSequence):
    """One exchange of dog clutches or synchronisers: unload, open, synchronise, engage, load; as in an electric axle.

    Motors and engine must be known to the controller as `sources`: they take the torque away, turn the input to its new
    speed along the profile of (5), within their limits, and give the torque back.
    """

    _change: float = 0.0  # N m

    def torque_change(self, _: Measured) -> float:
        """Torque requested at the input on top of the driver's [N m]."""
        return self._change

    def torque(self, passed: float, _: float, now: Measured) -> str:
        """Torque is removed, the sleeve disengages; then the input is free."""
        share = share_of(passed, self.with_.torque_time)
        self._change = -share * self._asked(now)
        if share < 1.0:
            return ""
        self.do.open(self.one.off)
        if passed > self.with_.longest:
            return "failed"
        return "inertia" if now.sleeves.get(self.one.off, 0.0) < FREE else ""

    def inertia(self, passed: float, period: float, now: Measured) -> str:
        """The input to its new speed by its own torque; the sleeve is commanded in near it."""
        asked = self._asked(now)
        wanted = now.input_torque - self._profile.needed(passed, period, now)
        self._change = min(max(wanted, now.least), now.most) - asked
        if abs(now.slips[self.one.on]) < self.with_.dog_slip:
            self.do.close([self.one.on], self.with_)
        if self._is_synchronous(now):
            self._change = -asked
            return "sync"
        return "failed" if passed > self.with_.longest else ""

    def sync(self, passed: float, _: float, now: Measured) -> str:
        """Torque is given back."""
        share = share_of(passed, self.with_.torque_time)
        self._change = -(1.0 - share) * self._asked(now)
        return "end" if share >= 1.0 else ""

    def _asked(self, now: Measured) -> float:
        return now.input_torque if now.demand is None else now.demand
