"""When to shift: lines of speed over throttle, with hysteresis."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import ModelError, Problem

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox

Line = Sequence[tuple[float, float]]
Pair = tuple[str, str]
# least gap between a line up and the one back, as a share of the speed up: what sensors and a drive shaft that rings
# shake a speed by
GAP = 0.01


@dataclass(frozen=True)
class ShiftSchedule:
    """Which gear to drive in: up above one speed of the input over the throttle, down below another.

    Use it to make a `ShiftController` shift by itself. Both lines are speeds [rad/s] of the input of the gearbox over
    the throttle, 0 to 1, linear between their points and held outside. It shifts up where the input is faster than
    `up` in the gear that is in, and down where it is slower than `down`. Where a line is crossed by so much that the
    next gear is too low as well, gears are skipped if `skips` says so.

    ModelError where an upshift would fall below the line of the downshift, so that gears hunted.
    """

    ratios: Mapping[str, float]  # of the forward gears, first gear first
    up: Line
    down: Line
    skips: bool = True

    @classmethod
    def of(cls, box: Gearbox, up: Line, down: Line, *, gears: Sequence[str] = (), skips: bool = True) -> ShiftSchedule:
        """A schedule for the forward gears of a gearbox, or for some of them."""
        forward = {gear: ratio for gear, ratio in box.ratios.items() if ratio > 0 and (not gears or gear in gears)}
        ordered = dict(sorted(forward.items(), key=lambda pair: -pair[1]))
        made = cls(ordered, up, down, skips)
        found = made.problems()
        if found:
            raise ModelError(found, "schedule")
        return made

    def problems(self) -> list[Problem]:
        """Lines that make gears hunt: after an upshift the input is below the line of the downshift."""
        found, throttles = [], sorted({x for line in (self.up, self.down) for x, _ in line})
        for (lower, higher), throttle, _, down in hunting(self.ratios, throttles, self.output_speeds):
            after = self.speed_up(throttle) * self.ratios[higher] / self.ratios[lower]
            fault = (
                f"hunts at throttle {throttle:g}: the shift leaves the input at {after:.4g} rad/s, "
                f"and it goes back below {down * self.ratios[higher]:.4g} rad/s"
            )
            remedy = f"raise `up` or lower `down` there, by {GAP:.0%} of the speed at least"
            found.append(Problem(f"shift {lower} to {higher}", "", fault, remedy=remedy))
        return found

    def speed_up(self, throttle: float) -> float:
        """Speed of the input above which it shifts up [rad/s]."""
        return at(self.up, throttle)

    def speed_down(self, throttle: float) -> float:
        """Speed of the input below which it shifts down [rad/s]."""
        return at(self.down, throttle)

    def gear(self, current: str, output_speed: float, throttle: float) -> str:
        """The gear to drive in.

        Parameters: current, the gear that is in; output_speed, of the output of the gearbox [rad/s]; throttle, 0 to 1.
        """
        order = list(self.ratios)
        if current not in self.ratios:
            return current
        place, most = order.index(current), len(order) if self.skips else 1
        for _ in range(most):
            speed = output_speed * self.ratios[order[place]]
            if place + 1 < len(order) and speed > self.speed_up(throttle):
                place += 1
            elif place > 0 and speed < self.speed_down(throttle):
                place -= 1
            else:
                break
        return order[place]

    def output_speeds(self, throttle: float) -> dict[Pair, float]:
        """Speed of the output [rad/s] at which each shift to the next gear is made at a throttle, up and down."""
        order, found = list(self.ratios), dict[Pair, float]()
        for lower, higher in pairwise(order):
            found[lower, higher] = self.speed_up(throttle) / self.ratios[lower]
            found[higher, lower] = self.speed_down(throttle) / self.ratios[higher]
        return found


def hunting(
    gears: Iterable[str], pedals: Sequence[float], speeds: Callable[[float], Mapping[Pair, float]], gap: float = GAP
) -> Iterator[tuple[Pair, float, float, float]]:
    """Pairs of gears that change without end at a constant speed and pedal: docs/theory/shifts.md (23).

    Where every line down is below the line up of the same pair an upshift is followed by none down, and the other way
    round. Parameters: gears, first gear first; pedals, at which lines bend or jump; speeds, of the output at each shift
    [rad/s]; gap, the least one between both, as a share of the speed up. The worst pedal of each pair is named, with
    the speeds up and down.
    """
    for pair in pairwise(gears):
        seen = [(pedal, speeds(pedal)[pair], speeds(pedal)[pair[::-1]]) for pedal in pedals]
        pedal, up, down = max(seen, key=lambda one: one[2] - (1.0 - gap) * one[1])
        if down > (1.0 - gap) * up:
            yield pair, pedal, up, down


def at(line: Line, x: float) -> float:
    """A line of points, linear between them and held outside."""
    place = bisect_right(line, x, key=_first)
    if place == 0 or place == len(line):
        return float(line[max(place - 1, 0)][1])
    (low, first), (high, last) = line[place - 1], line[place]
    return float(first + (x - low) / (high - low) * (last - first))


def _first(point: tuple[float, float]) -> float:
    return point[0]
