"""Single faults of shift elements: stuck closed or missing, classified and simulated."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base.classes import dataclass
from clutchwork.base.paths import target
from clutchwork.base.text import columns
from clutchwork.gearbox.motion import GEAR, NEUTRAL, OUTPUT_HELD, TIE_UP
from clutchwork.shifts.comfort import low_pass
from clutchwork.shifts.gears import gears_of
from clutchwork.stepping.simulator import Simulator

if TYPE_CHECKING:
    from clutchwork.face.driveline import Driveline
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.results.trajectory import Trajectory

STUCK, MISSING = "stuck closed", "missing"
STEP = 1e-3  # s
CUT_OFF = 10.0  # Hz, of decelerations
STOPPED = 0.1  # share of the first speed below which a vehicle counts as stopped
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
        verdict: "none", "drive lost", "other gear", "slips", "decelerates" or "locks the output"
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


def single_faults(box: Gearbox, gears: Sequence[str] = ()) -> Iterator[Fault]:
    """Every element of every gear: missing where it is closed, stuck closed where it is open."""
    for gear in gears or tuple(box.ratios):
        closed = box.closed_in(gear)
        for element in box.elements:
            name = element.name
            fails = name in closed
            left = tuple(one for one in closed if one != name) if fails else (*closed, name)
            made = box.combination(left)
            ratio = None if made.ratio is None else float(made.ratio)
            yield Fault(gear, name, MISSING if fails else STUCK, made.kind, ratio)


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
        target("table.to_csv", path, "faults.csv", (".csv",)).write_text(text + "\n", encoding="utf-8")

    def __str__(self) -> str:
        return columns(self.lines, right=(5, 6, 7, 9))


def _line(one: FaultResult) -> list[str]:
    fault = one.fault
    makes = fault.makes if fault.ratio is None else f"{fault.makes} {fault.ratio:.3f}"
    numbers = [f"{one.deceleration:.2f}", f"{one.power:.0f}", f"{one.energy:.0f}"]
    end = [one.burns or "-", f"{one.speed:.2f}", one.ends_in or "-"]
    return [fault.gear, fault.element, fault.fault, makes, one.verdict, *numbers, *end]


def fault_table(
    in_gear: Callable[[str], Driveline],
    box: Gearbox,
    prefix: str = "gearbox",
    *,
    vehicle: str,
    gears: Sequence[str] = (),
    pressure: float = 1e6,
    at: float = 0.3,
    until: float = 2.3,
    limit: float = 1.5,
    **options: float,
) -> FaultTable:
    """Simulate every single fault in every gear.

    Use it for the safety analysis of a gearbox: each element is stuck closed, or loses its pressure, while the vehicle
    drives in a gear.

    Parameters: in_gear, makes the driveline that drives in a gear, with the signals `<prefix>.<element>.pressure`;
    vehicle, its mass, whose speed and acceleration are looked at; pressure of an element that is stuck [Pa]; at, the
    time of the fault, and until, the end of each run [s]; limit, deceleration from which on it is dangerous [m/s2];
    options of the runs.
    """
    made: list[FaultResult] = []
    healthy: dict[str, float] = {}
    for fault in single_faults(box, gears):
        if fault.gear not in healthy:
            run = _drive(in_gear(fault.gear), {}, at, until, options)
            healthy[fault.gear] = _deceleration(run, vehicle, at)
        value = pressure if fault.fault == STUCK else 0.0
        run = _drive(in_gear(fault.gear), {f"{prefix}.{fault.element}.pressure": value}, at, until, options)
        made.append(_result(run, fault, box, prefix, vehicle, at, max(limit, healthy[fault.gear])))
    return FaultTable(tuple(made))


def _drive(
    model: Driveline, change: Mapping[str, float], at: float, until: float, options: Mapping[str, float]
) -> Trajectory:
    sim = Simulator(model, **options)  # type: ignore[arg-type]
    sim.advance(at)
    if change:
        sim.set(change)
    sim.advance(until - at)
    return sim.run


def _deceleration(run: Trajectory, vehicle: str, at: float) -> float:
    times = np.arange(at, float(run.time[-1]), STEP)
    values = run.at(times)[f"{vehicle}.acceleration"]
    forward = 1.0 if run[f"{vehicle}.speed"][0] >= 0.0 else -1.0
    return float(np.max(-forward * low_pass(values, STEP, CUT_OFF), initial=0.0))


def _result(
    run: Trajectory, fault: Fault, box: Gearbox, prefix: str, vehicle: str, at: float, limit: float
) -> FaultResult:
    later = np.asarray(run.time) >= at
    heat = {e.name: run[f"{prefix}.{e.name}.heat"][later] for e in box.elements}
    burnt = {name: float(values[-1] - values[0]) for name, values in heat.items()}
    most = max(burnt, key=burnt.__getitem__)
    slipping = run[f"{prefix}.{most}.torque"] * run[f"{prefix}.{most}.slip"]
    last = gears_of(run, box, prefix, least=0.0)
    ended = last[-1].gear if last and last[-1].end >= float(run.time[-1]) else ""
    ends_in = ended if ended in box.ratios else ""
    deceleration = _deceleration(run, vehicle, at)
    speeds = run[f"{vehicle}.speed"]
    stops = bool(abs(speeds[-1]) < STOPPED * abs(speeds[0]))
    verdict = _verdict(fault, ends_in, deceleration, limit, stops=stops)
    burns = most if burnt[most] > 1.0 else ""
    power = float(np.max(np.abs(slipping[later]), initial=0.0)) if burns else 0.0
    return FaultResult(fault, verdict, deceleration, power, burnt[most], burns, float(speeds[-1]), ends_in)


def _verdict(fault: Fault, ends_in: str, deceleration: float, limit: float, *, stops: bool) -> str:
    """What it means for who drives, the worst first."""
    if deceleration > limit:
        return "locks the output" if stops else "decelerates"
    if ends_in == fault.gear:
        return "none"
    if ends_in:
        return "other gear"
    if fault.makes == NEUTRAL:
        return "drive lost"
    return "slips" if fault.makes in (GEAR, TIE_UP, OUTPUT_HELD) else "drive lost"
