"""Single faults of shift elements: stuck closed or missing, classified and simulated."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import isclose, nan
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import UseError, listed, quote
from clutchwork.gearbox.motion import GEAR, NEUTRAL, OUTPUT_HELD, TIE_UP
from clutchwork.shifts.comfort import low_pass
from clutchwork.shifts.fault_results import Fault, FaultResult, FaultTable
from clutchwork.shifts.gears import gears_of
from clutchwork.shifts.record import NEUTRAL as NEUTRAL_GEAR
from clutchwork.stepping.simulator import Simulator

if TYPE_CHECKING:
    from clutchwork.driveline.driveline import Driveline
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.run.trajectory import Trajectory

STUCK, MISSING = "stuck closed", "missing"
NOT_SIMULATED = "not simulated"
STEP = 1e-3  # s
HELD = 0.05  # s, for which a gear must be in at the end
CUT_OFF = 10.0  # Hz, of decelerations
BURNT = 1.0  # J, from which on an element counts as heated
STOPPED = 0.1  # share of the first speed of the output below which it counts as stopped
STANDS = 0.1  # s, for which it must stand: a drive shaft that rings passes zero too


def single_faults(box: Gearbox, gears: Sequence[str] = ()) -> Iterator[Fault]:
    """Every element of every gear: missing where it is closed, stuck closed where it is open.

    UseError for gears that the box does not have.
    """
    known = box.ratios
    wrong = [
        f"{quote(gear)} is not a gear of {box.name}; choose from {listed(known)}" for gear in gears if gear not in known
    ]
    if wrong:
        raise UseError("cw.shifts.fault_table", wrong)
    for gear in gears or tuple(known):
        closed = box.closed_in(gear)
        for element in box.elements:
            name = element.name
            fails = name in closed
            left = tuple(one for one in closed if one != name) if fails else (*closed, name)
            made = box.combination(left)
            ratio = None if made.ratio is None else float(made.ratio)
            yield Fault(gear, name, MISSING if fails else STUCK, made.kind, ratio)


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
    drives in a gear. A dog clutch that is missing loses its command, a freewheel that is stuck is held by the clutch
    beside it.

    Parameters: in_gear, makes the driveline that drives in a gear, with the signals `<prefix>.<element>.pressure`;
    vehicle, its mass, whose speed and acceleration are looked at; pressure of an element that is stuck [Pa]; at, the
    time of the fault, and until, the end of each run [s]; limit, deceleration from which on it is dangerous [m/s2], at
    least that of the same drive without a fault; options of the runs.
    """
    made: list[FaultResult] = []
    healthy: dict[str, float] = {}
    for fault in single_faults(box, gears):
        if fault.gear not in healthy:
            run = _drive(in_gear(fault.gear), {}, at, until, options)
            healthy[fault.gear] = _deceleration(run, vehicle, at)
        change = _change(fault, box, prefix, pressure)
        if not change:
            made.append(FaultResult(fault, NOT_SIMULATED, nan, nan, nan, "", nan, ""))
            continue
        run = _drive(in_gear(fault.gear), change, at, until, options)
        made.append(_result(run, fault, box, prefix, vehicle, at, max(limit, healthy[fault.gear])))
    return FaultTable(tuple(made))


def _change(fault: Fault, box: Gearbox, prefix: str, pressure: float) -> dict[str, float]:
    """The signal that makes a fault; none where there is none."""
    kind, name = box.element(fault.element).kind, f"{prefix}.{fault.element}"
    if kind == "dog":
        return {f"{name}.command": 0.0} if fault.fault == MISSING else {}
    if kind == "freewheel" and fault.fault == MISSING:
        return {}
    # a freewheel is stuck by the clutch beside it
    return {f"{name}.pressure": pressure if fault.fault == STUCK else 0.0}


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
    names = [e.name for e in box.elements if f"{prefix}.{e.name}.heat" in run]
    heat = {name: run[f"{prefix}.{name}.heat"][later] for name in names}
    burnt = {name: float(values[-1] - values[0]) for name, values in heat.items()}
    most = max(burnt, key=burnt.__getitem__)
    slipping = run[f"{prefix}.{most}.torque"] * run[f"{prefix}.{most}.slip"]
    last = [one for one in gears_of(run, box, prefix, least=0.0) if one.gear != NEUTRAL_GEAR][-1:]
    held = any(one.end >= float(run.time[-1]) and one.end - one.begin >= HELD for one in last)
    ends_in = last[0].gear if held else ""
    deceleration = _deceleration(run, vehicle, at)
    speeds = run[f"{vehicle}.speed"]
    stops = _stands(run, f"{prefix}.{box.output}.speed", at)
    same = fault.ratio is not None and isclose(fault.ratio, box.ratios[fault.gear])
    # the elements that are left may make the same gear without a row of their own
    ends_in = ends_in or (fault.gear if same and burnt[most] <= BURNT else "")
    verdict = _verdict(fault, ends_in, deceleration, limit, stops=stops)
    burns = most if burnt[most] > BURNT else ""
    power = float(np.max(np.abs(slipping[later]), initial=0.0)) if burns else 0.0
    return FaultResult(fault, verdict, deceleration, power, burnt[most], burns, float(speeds[-1]), ends_in)


def _stands(run: Trajectory, output: str, at: float) -> bool:
    """Whether the output of the gearbox stands after the fault, while the vehicle still moves or not any more."""
    times = np.arange(at, float(run.time[-1]), STEP)
    speed = np.abs(run.at(times)[output])
    still = speed < STOPPED * abs(float(run[output][0]))
    # a stretch without one instant at which it turns
    turns = np.flatnonzero(np.concatenate([[True], ~still, [True]]))
    return bool(np.max(np.diff(turns)) > STANDS / STEP)


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
