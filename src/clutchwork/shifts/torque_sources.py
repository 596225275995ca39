"""Who gives the torque that a shift asks for: motors first, what is left by the throttle of the engine."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from clutchwork.base.classes import dataclass
from clutchwork.base.errors import UseError

if TYPE_CHECKING:
    from clutchwork.shifts.controller import ShiftController
    from clutchwork.shifts.record import Measured


@dataclass(frozen=True)
class TorqueSource:
    """A motor that gives a part of the torque which a shift asks for, beside what it is driven with.

    Use it as one of the `sources` of `cw.shifts.drive`, the one that answers fastest first. UseError where `least` is
    above `most`.

    Parameters:
        signal: of its torque, such as "motor.torque" [N m]
        least, most: of that torque, what it is driven with included [N m]
        ratio: speed of the motor over that of the input of the gearbox
        driven: torque that it gives without a request [N m]
    """

    signal: str
    least: float
    most: float
    ratio: float = 1.0
    driven: float = 0.0

    def __post_init__(self) -> None:
        """Limits that leave something between them."""
        if self.least > self.most:
            raise UseError("TorqueSource", [f"least is {self.least:g} N m, above most, {self.most:g} N m; swap them"])
        if not self.ratio:
            raise UseError("TorqueSource", ["ratio is 0: give the speed of the motor over that of the input"])

    def gives(self, wanted: float) -> tuple[float, float]:
        """Torque of its signal [N m], and what of a change at the input [N m] is left for others."""
        torque = min(self.most, max(self.least, self.driven + wanted / self.ratio))
        return torque, wanted - (torque - self.driven) * self.ratio


def shared(
    control: ShiftController, now: Measured, sources: Sequence[TorqueSource], pedal: float
) -> tuple[dict[str, float], float]:
    """Torques of the sources by signal [N m], and the throttle that is left for the engine, 0 to 1.

    What is asked for is a change of the torque at the input, below zero a reduction: `control.torque_change`.
    """
    wanted, signals = control.torque_change(now), dict[str, float]()
    left = wanted
    for source in sources:
        signals[source.signal], left = source.gives(left)
    # without motors, and where nothing is known of the torque, all of it is the engine's
    share = left / wanted if wanted and sources else 1.0
    return signals, min(1.0, pedal * (1.0 + share * (control.torque_factor - 1.0)) + control.blip)
