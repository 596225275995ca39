"""Which gear is wanted: by request, by schedule, or by an engine that would stall."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from clutchwork.shifts.record import NEUTRAL

if TYPE_CHECKING:
    from clutchwork.shifts.record import Measured
    from clutchwork.shifts.settings import ShiftSettings
    from clutchwork.shifts.shift_map import ShiftMap

# time for which the input must be too slow before it is let go [s], longer than a jerk of the driveline
SLOW = 0.1


@dataclass
class GearChoice:
    """The next gear of a `ShiftController`."""

    schedule: ShiftMap | None
    settings: ShiftSettings
    wanted: str = ""  # by request
    let_go: str = ""  # gear that was let go before the engine stalled
    _slow: float = 0.0  # s, for which the input is too slow

    def request(self, gear: str) -> None:
        """By the driver."""
        self.wanted, self.let_go = gear, ""

    def take(self, gear: str, rested: bool, now: Measured) -> str:
        """The gear to shift to from the one that is in, empty where it stays; rested: time for the schedule."""
        wanted, self.wanted = self.wanted or self._drive_off(now), ""
        slow = now.input_speed < self.settings.let_go * self.settings.launch_speed
        if gear == NEUTRAL and wanted != NEUTRAL and slow and now.throttle <= self.settings.launch_throttle:
            # it is engaged with the pedal, or the engine would stall
            self.let_go, wanted = wanted or self.let_go, ""
        if not wanted and self.schedule is not None and rested:
            wanted = self._scheduled(gear, now)
        return "" if wanted == gear else wanted

    def _scheduled(self, gear: str, now: Measured) -> str:
        return gear if self.schedule is None else self.schedule.gear(gear, now)

    def _drive_off(self, now: Measured) -> str:
        """The gear to drive off in, if the last one was released and the driver wants to go."""
        if not self.let_go or now.throttle <= self.settings.launch_throttle:
            return ""
        return self.next_gear(now)

    def next_gear(self, now: Measured) -> str:
        """The gear to drive off in, empty if none was released."""
        if self.schedule is None or self.let_go not in self.schedule.ratios:
            return self.let_go
        return self._scheduled(next(iter(self.schedule.ratios)), now)

    def stalls(self, gear: str, launches: bool, period: float, now: Measured) -> bool:
        """Whether the output holds an input that is fixed to an engine too far below its launch speed."""
        least = self.settings.let_go * self.settings.launch_speed
        slow = least > 0.0 and gear != NEUTRAL and now.input_speed < least
        # while it launches the driver decides
        if launches:
            slow = slow and now.throttle <= self.settings.launch_throttle
        self._slow = self._slow + period if slow else 0.0
        return self._slow > SLOW
