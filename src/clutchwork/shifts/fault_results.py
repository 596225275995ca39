"""What faults of shift elements do to a vehicle, and their table."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan
from pathlib import Path

from clutchwork.base import columns, dataclass
from clutchwork.base.paths import fitting
from clutchwork.base.writing import put

HEADS = (
    *("gear", "element", "fault", "makes", "verdict", "deceleration m/s2", "power W", "energy J"),
    *("burns", "speed at the end m/s", "ends in"),
)


@dataclass(frozen=True)
class Fault:
    """One element that is stuck closed or missing in a gear, and what kinematics make of it.

    `makes` is what the closed elements are then: "gear" with its `ratio`, "neutral", "input held", "output held" or
    "tie-up". Elements that are stuck give way by slipping, so a simulation shows what a car then does.
    """

    gear: str
    element: str
    fault: str
    makes: str
    ratio: float | None


@dataclass(frozen=True)
class FaultResult:
    """What a vehicle did with a fault.

    Parameters:
        fault: which one
        verdict: "none", "drive lost", "other gear", "slips", "decelerates" or "locks the output", where the output
        of the gearbox stands for 0.1 s, whatever the vehicle does; "not simulated" where
        no signal makes the fault, with NaN for numbers: a freewheel that does not hold, a dog clutch that does not
        open
        deceleration: largest of the vehicle after the fault, low-passed at 10 Hz [m/s2]
        power: largest heat rate of one element [W], that of `burns`
        energy: heat that this element made [J]
        burns: the element that was heated most, empty where none slipped
        speed: of the vehicle at the end [m/s]
        ends_in: gear that was in at the end, empty where none was
    """

    fault: Fault
    verdict: str
    deceleration: float
    power: float
    energy: float
    burns: str
    speed: float
    ends_in: str


@dataclass(frozen=True)
class FaultTable:
    """All single faults of a gearbox in a vehicle; print it to read it."""

    results: tuple[FaultResult, ...]

    def __iter__(self) -> Iterator[FaultResult]:
        return iter(self.results)

    def __len__(self) -> int:
        return len(self.results)

    def of(self, verdict: str) -> tuple[FaultResult, ...]:
        """Those with a verdict."""
        return tuple(one for one in self.results if one.verdict == verdict)

    @property
    def lines(self) -> list[list[str]]:
        """Its cells, a head first."""
        return [list(HEADS), *map(_line, self.results)]

    def to_csv(self, path: str | Path) -> None:
        """Write it for a spreadsheet."""
        text = "\n".join(",".join(line) for line in self.lines)
        put(fitting("table.to_csv", path, "faults.csv", (".csv",)), text + "\n")

    def __str__(self) -> str:
        return columns(self.lines, right=(5, 6, 7, 9))


def _line(one: FaultResult) -> list[str]:
    fault = one.fault
    makes = fault.makes if fault.ratio is None else f"{fault.makes} {fault.ratio:.3f}"
    values = ((one.deceleration, 2), (one.power, 0), (one.energy, 0), (one.speed, 2))
    *numbers, speed = ("-" if isnan(value) else f"{value:.{digits}f}" for value, digits in values)
    end = [one.burns or "-", speed, one.ends_in or "-"]
    return [fault.gear, fault.element, fault.fault, makes, one.verdict, *numbers, *end]
