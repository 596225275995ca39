"""All shifts of a gearbox, one after the other, each from a steady drive."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import dataclass
from clutchwork.shifts.controller import ShiftController
from clutchwork.shifts.diagnosis import diagnose, explain
from clutchwork.shifts.drive import Sensed, drive
from clutchwork.shifts.metrics import ShiftQuality, qualities
from clutchwork.shifts.plant import plant_of
from clutchwork.shifts.record import ShiftRecord
from clutchwork.shifts.report import overview, table
from clutchwork.shifts.settings import ShiftSettings
from clutchwork.stepping.simulator import Simulator

if TYPE_CHECKING:
    from clutchwork.driveline.driveline import Driveline
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.run.trajectory import Trajectory


@dataclass(frozen=True)
class Surveyed:
    """One shift of a survey.

    Parameters:
        throttle: of the driver, 0 to 1
        record: what the controller did
        quality: what the shift was like; none where the run does not show the new gear
        run: the whole of it
    """

    throttle: float
    record: ShiftRecord
    quality: ShiftQuality | None
    run: Trajectory


@dataclass(frozen=True)
class Survey:
    """Shifts of a gearbox; print it for a table, go through it for (record, quality), `overview` draws it."""

    results: tuple[Surveyed, ...]

    def __iter__(self) -> Iterator[tuple[ShiftRecord, ShiftQuality | None]]:
        return ((one.record, one.quality) for one in self.results)

    def __len__(self) -> int:
        return len(self.results)

    @property
    def missed(self) -> tuple[Surveyed, ...]:
        """Those in which the gear was not reached."""
        return tuple(one for one in self.results if one.quality is None or not one.record.reached)

    def overview(self, path: str | Path) -> None:
        """Draw phases, jerk and slip energy of all shifts beside each other, as `cw.shifts.overview`."""
        found = self._found
        overview([one for one, _ in found], path, names=[name for _, name in found])

    def __str__(self) -> str:
        found = self._found
        lines = [table([one for one, _ in found], names=[name for _, name in found])]
        for one in self.missed:
            why = one.record.problem or "the run does not show that gear"
            lines.append(f"{_name(one)} did not get there: {why}")
        return "\n".join(lines)

    @property
    def _found(self) -> list[tuple[ShiftQuality, str]]:
        return [(one.quality, _name(one)) for one in self.results if one.quality is not None]


def _name(one: Surveyed) -> str:
    return f"{one.record.before}-{one.record.after} {'on' if one.record.power_on else 'off'}"


def survey(
    in_gear: Callable[[str], Driveline],
    box: Gearbox,
    shifts: Sequence[tuple[str, str]] = (),
    prefix: str = "gearbox",
    *,
    sensed: Sensed,
    throttles: Sequence[float] = (0.3, 0.0),
    settings: ShiftSettings | None = None,
    chosen: Mapping[tuple[str, str] | str, ShiftSettings] | None = None,
    at: float = 0.5,
    until: float = 3.0,
    torque: str = "",
    acceleration: str = "",
    **options: float,
) -> Survey:
    """Run shifts of a gearbox, each from a steady drive in its gear, with power and without.

    Use it to see a whole calibration at once: print what it returns, or draw its `overview`.

    Parameters: in_gear, makes the driveline that drives in a gear, with the gearbox as a `cw.Transmission` called
    `prefix`; shifts, pairs of gears, by default each forward gear to the next one and back; sensed, what the controller
    sees; throttles, of the driver; settings and chosen, as of `ShiftController`; at, the time of the request, and
    until, the end of each run [s]; torque and acceleration, as of `cw.shifts.qualities`; options of the runs.
    """
    made: list[Surveyed] = []
    systems: dict[str, Any] = {}
    for before, after in shifts or neighbours(box):
        if before not in systems:
            systems[before] = in_gear(before).assemble()
        plant = plant_of(systems[before], box, prefix)
        for throttle in throttles:
            control = ShiftController(
                box, plant, settings=settings or ShiftSettings(), chosen=chosen or {}, gear=before, prefix=prefix
            )
            sim = Simulator(systems[before], **options)  # type: ignore[arg-type]
            pedal = partial(_constant, throttle)
            drive(sim, control, at, sensed=sensed, throttle=pedal)
            control.request(after)
            run = drive(sim, control, until, sensed=sensed, throttle=pedal)
            found = qualities(run, box, prefix, torque=torque, acceleration=acceleration)
            quality = next((one for one in reversed(found) if one.shift.after == after), None)
            record = control.records[-1]
            if quality is not None:
                why = diagnose(run, box, quality, prefix, torque=torque, acceleration=acceleration)
                record = explain(record, why)
            made.append(Surveyed(throttle, record, quality, run))
    return Survey(tuple(made))


def _constant(value: float, _: float) -> float:
    return value


def neighbours(box: Gearbox) -> list[tuple[str, str]]:
    """Every forward gear to the next one, and back."""
    forward = sorted((gear for gear, ratio in box.ratios.items() if ratio > 0.0), key=lambda gear: -box.ratios[gear])
    return [pair for one in pairwise(forward) for pair in (one, one[::-1])]
