"""What a shift controller knows, and what it writes down."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf

from clutchwork.shifts.exchange import Exchange
from clutchwork.shifts.handover import Handover

NEUTRAL = "N"


@dataclass(frozen=True)
class Measured:
    """What the controller knows at one instant.

    Parameters:
        input_speed: of the gearbox [rad/s]
        output_speed: of the gearbox [rad/s]
        input_torque: at the input of the gearbox, what a shift asks for included [N m]
        throttle: of the driver, 0 to 1
        slips: of elements [rad/s], those of a shift that goes on at least
        sleeves: position of dog clutches, 0 out, 1 in
        oil: temperature of the oil [K], for the inhibits of a `ShiftMap`
        grade: of the road, above 0 uphill [rad], for the same
        charge: of the battery, for a `HybridController`; none: the one that is aimed at
        demand: torque at the input that the driver asks for [N m], for a dual-clutch gearbox; none: `input_torque`
        least, most: torque that engine and motors can give there at present [N m], for the same
    """

    input_speed: float
    output_speed: float
    input_torque: float
    throttle: float
    slips: Mapping[str, float]
    sleeves: Mapping[str, float] = field(default_factory=dict)
    oil: float = 353.15
    grade: float = 0.0
    charge: float | None = None
    demand: float | None = None
    least: float = -inf
    most: float = inf


@dataclass(frozen=True)
class Finding:
    """Why a shift was harsh: the instant [s], the cause in words and numbers, the settings that cure it."""

    time: float
    cause: str
    cure: str

    def __str__(self) -> str:
        return f"{self.time:.3f} s: {self.cause}; {self.cure}"


@dataclass
class ShiftRecord:
    """One shift as it was commanded.

    Parameters:
        before: gear that was in
        after: gear that was asked for
        begin: instant of the command [s]
        power_on: whether the engine drove then
        exchanges: of elements, one after the other; a `Handover` has several that open and close together
        phases: instants [s] at which the states of the controller began
        end: instant at which the controller was done [s]; none: the shift is still going on
        problem: why the gear was not reached, empty where it was
        diagnosis: why it was harsh, as its controller saw it: elements that gripped too late or too early, a shift that
        was closed with slip; `cw.shifts.diagnose` sees more in a run
    """

    before: str
    after: str
    begin: float
    power_on: bool
    exchanges: tuple[Exchange | Handover, ...] = ()
    phases: list[tuple[float, str]] = field(default_factory=list)
    end: float | None = None
    problem: str = ""
    diagnosis: tuple[Finding, ...] = ()

    @property
    def reached(self) -> bool:
        """Whether the gear is in: the controller is done and has seen that its elements do not slip."""
        return self.end is not None and not self.problem

    @property
    def kind(self) -> str:
        """Such as "power-on upshift", "garage shift", "power-off double downshift"."""
        if not self.exchanges or not self.exchanges[0].before or NEUTRAL in (self.before, self.after):
            return "garage shift"
        up = abs(self.exchanges[-1].after) < abs(self.exchanges[0].before)
        power = "power-on" if self.power_on else "power-off"
        count = sum(len(one.on) if isinstance(one, Handover) else 1 for one in self.exchanges)
        many = " double" if count > 1 else ""
        return f"{power}{many} {'upshift' if up else 'downshift'}"
