"""Which gear waits on the free shaft of a dual-clutch gearbox, and the way from gear to gear."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from clutchwork.base import dataclass
from clutchwork.shifts.exchange import FRICTION, SLEEVES

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.shifts.shift_map import ShiftMap


@dataclass(frozen=True)
class Halves:
    """The two halves of a dual-clutch gearbox, by gear.

    Parameters: clutch, the clutch of each gear; sleeve, the synchroniser or dog clutch that engages it; ratios, input
    over output.
    """

    clutch: Mapping[str, str]
    sleeve: Mapping[str, str]
    ratios: Mapping[str, float]

    @classmethod
    def of(cls, box: Gearbox) -> Halves | None:
        """The halves of a gearbox; None where a gear is not one clutch and one sleeve, or clutches are not two."""
        clutch, sleeve = dict[str, str](), dict[str, str]()
        for gear in box.ratios:
            closed = [box.element(name) for name in box.closed_in(gear)]
            clutches = [one.name for one in closed if one.kind in FRICTION]
            sleeves = [one.name for one in closed if one.kind in SLEEVES]
            if len(clutches) != 1 or len(sleeves) != 1:
                return None
            clutch[gear], sleeve[gear] = clutches[0], sleeves[0]
        return cls(clutch, sleeve, box.ratios) if len({*clutch.values()}) == 2 else None

    @property
    def forward(self) -> list[str]:
        """Forward gears, the lowest first."""
        return sorted((gear for gear, ratio in self.ratios.items() if ratio > 0), key=lambda gear: -self.ratios[gear])

    @property
    def rivals(self) -> dict[str, tuple[str, ...]]:
        """By sleeve those of the same shaft, of which one is in at most."""
        on = {
            one: [self.sleeve[gear] for gear in self.clutch if self.clutch[gear] == one] for one in self.clutch.values()
        }
        return {
            name: tuple(other for other in on[self.clutch[gear]] if other != name) for gear, name in self.sleeve.items()
        }

    def route(self, gear: str, target: str) -> list[str]:
        """Gears to drive in one after another, up to the target, each on the other clutch than the one before.

        Between two gears of one clutch it is the gear of the other one that is nearest to the middle of both.
        """
        if gear == target:
            return []
        if self.clutch[gear] != self.clutch[target]:
            return [target]
        middle = abs(self.ratios[gear] * self.ratios[target]) ** 0.5
        others = [one for one in self.forward if self.clutch[one] != self.clutch[gear]]
        between = min(others, key=lambda one: max(self.ratios[one], middle) / min(self.ratios[one], middle))
        return [between, target]


def expected(layout: Halves, schedule: ShiftMap, gear: str, output_speed: float, throttle: float) -> str:
    """The gear to wait on the free shaft: the neighbour whose line is nearer, in the ratio of speeds.

    A speed that moves on without a jump passes the middle between both lines before it crosses one of them, so the gear
    that is then asked for has been chosen before.
    """
    forward = layout.forward
    if gear not in forward:
        return forward[0] if layout.clutch[forward[0]] != layout.clutch[gear] else forward[1]
    place = forward.index(gear)
    up = forward[place + 1] if place + 1 < len(forward) else None
    down = forward[place - 1] if place else None
    if up is None or down is None:
        return up or down or gear
    high, low = schedule.speed((gear, up), throttle), schedule.speed((gear, down), throttle)
    return up if output_speed > (high * low) ** 0.5 else down
