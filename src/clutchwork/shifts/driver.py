"""Commands of a valve or piston that fills, lags and is learnt. docs/theory/shifts.md (17)."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from clutchwork.shifts.actuators import ElementActuator

# time in which a piston that is let go is empty again, over that in which it was filled
DRAIN = 3.0
# share of its torque with which an element that is filled touches, so that what is not filled yet goes on filling
TOUCH = 0.005
# what may be left of a filling
FULL = 1e-6


@dataclass
class ActuatorDriver:
    """Fills a piston fast, holds it where it touches, and follows the torque that is there."""

    of: ElementActuator
    fill_time: float  # s, as it was learnt
    kiss: float  # command at which it touches, as it was learnt
    level: float = 0.0  # of the filling, 0 to 1
    grips: bool = True  # whether it carried something since it was filled, so that nothing is left of the filling
    torque: float = 0.0  # N m, as it should be at present
    _fills: float = 0.0  # rate of the filling that was commanded, over that of the full command
    _asked: float = 0.0  # N m, the torque that was

    def command(self, torque: float, passed: float, period: float, open_: bool) -> float:
        """For the next period [s], in the unit of the signal.

        Parameters: torque that is wanted [N m]; passed, time since the last call [s]; open_, whether it is let go.
        """
        of = self.of
        self._pass(passed)
        self._fills, self._asked = 0.0, 0.0
        if open_:
            self._fills, self.grips = -1.0 / DRAIN, False
            return of.commands[0]
        if self.level < 1.0 - FULL:
            return self._fill(period)
        self._asked = min(of.most, torque)
        least = TOUCH * of.most
        self.grips |= self.torque > 2.0 * least
        return self.at(self._asked if self.grips else max(least, self._asked))

    def at(self, torque: float) -> float:
        """Command at which it carries a torque [N m] in the long run: that of the table, moved with the kiss point."""
        ends = sorted((self.of.commands[0], self.of.commands[-1]))
        return min(ends[1], max(ends[0], self.of.command(torque) + self.kiss - self.of.kiss))

    def _pass(self, passed: float) -> None:
        """What the last command did since then."""
        level = self.level + self._fills * passed / max(self.fill_time, 1e-9)
        self.level = min(1.0, max(0.0, level))
        lag = self.of.lag
        self.torque += (self._asked - self.torque) * (1.0 - exp(-passed / lag) if lag else 1.0)

    def _fill(self, period: float) -> float:
        """Full command while the piston fills; in its last part as much as is left of it."""
        of, hold = self.of, self.at(TOUCH * self.of.most)
        self._fills = min(1.0, (1.0 - self.level) * self.fill_time / period) if period else 1.0
        return hold + self._fills * (of.commands[-1] - hold)
