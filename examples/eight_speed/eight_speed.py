"""An eight-speed automatic in a car, up to eighth gear and back to rest.

python examples/eight_speed/eight_speed.py [FOLDER]
"""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from eight_speed_model import FINAL_DRIVE, RADIUS, TURBINE, car

import clutchwork as cw

BOX = "zf-8hp70"
T_END = 75.0  # s
# throttle and share of the brakes over time: a launch, up to eighth gear, coast, and a stop
PEDAL = ((0.0, 0.0), (0.5, 0.0), (1.0, 0.5), (34.0, 0.5), (34.3, 0.0))
BRAKE = ((0.0, 0.5), (0.4, 0.5), (0.6, 0.0), (36.0, 0.0), (37.0, 0.22), (55.0, 0.22), (60.0, 0.5))
# rad/s of the turbine over the throttle
UP = ((0.0, 160.0), (0.3, 220.0), (1.0, 600.0))
DOWN = ((0.0, 95.0), (0.3, 120.0), (1.0, 320.0))
FULL = 1.0e6  # Pa


def over(time: float, points: tuple[tuple[float, float], ...]) -> float:
    """A table at a time [s]."""
    return float(np.interp(time, *zip(*points, strict=True)))


class LockUp:
    """The lock-up clutch: closed between shifts from second gear on, open while the engine is slow."""

    def __init__(self, control: cw.shifts.ShiftController) -> None:
        self.control, self.pressure = control, 0.0

    def __call__(self, time: float, sim: cw.Simulator) -> dict[str, float]:
        """Pressure of the clutch [Pa], and of the brakes, at a time [s]."""
        engine, turbine = sim["engine.speed"], sim["turbine.speed"]
        slow = engine < 100.0 or (self.pressure == 0.0 and turbine < 0.85 * engine)
        wanted = self.control.gear not in ("1", "R", "N") and not self.control.shifting and not slow
        # softly while it slips
        step = (2e4 if abs(engine - turbine) > 1.0 else 4e5) if wanted else -1e6
        self.pressure = min(FULL, max(0.0, self.pressure + step))
        return {"lock_up.pressure": self.pressure, "brakes.normal_force": over(time, BRAKE)}


def drive(name: str = BOX, t_end: float = T_END, **options: float) -> tuple[cw.Trajectory, cw.shifts.ShiftController]:
    """From rest through all gears and back, under the controller."""
    box = cw.Gearbox.load(name)
    system = car(box, "1").assemble()
    schedule = cw.shifts.ShiftMap.two_lines(box, UP, DOWN, skips=False)
    control = cw.shifts.ShiftController(box, cw.shifts.plant_of(system, box), schedule=schedule, gear="1")
    sim = cw.Simulator(system, rtol=1e-6, **options)
    sensed = cw.shifts.Sensed(torque=TURBINE, throttle="combustion.throttle")
    run = cw.shifts.drive(
        sim, control, t_end, sensed=sensed, throttle=lambda time: over(time, PEDAL), also=LockUp(control)
    )
    return run, control


def quality(run: cw.Trajectory, box: cw.Gearbox) -> list[cw.shifts.ShiftQuality]:
    """What every shift was like."""
    return cw.shifts.qualities(run, box, torque="half_shafts.torque", acceleration="car.acceleration")


def check(run: cw.Trajectory, control: cw.shifts.ShiftController, found: list[cw.shifts.ShiftQuality]) -> None:
    """All gears up, all gears down, at rest in the end, nothing lost."""
    gears = [gear for gear, ratio in control.box.ratios.items() if ratio > 0.0]
    wanted = [*pairwise(gears), *pairwise(gears[::-1])]
    assert [(one.shift.before, one.shift.after) for one in found] == wanted
    assert all(record.end is not None for record in control.records)
    assert abs(run["car.speed"][-1]) < 1e-6
    assert abs(run.energy.residual) < 1e-6 * run.energy.turnover
    # the element that closes does the work of an upshift under power
    for one in found:
        assert one.shift.time < 1.0
        assert max(one.slip_energy.values()) < 2e4


def pictures(run: cw.Trajectory, box: cw.Gearbox, found: list[cw.shifts.ShiftQuality], folder: Path) -> None:
    """The drive with its jerk, one upshift closely, all shifts beside each other."""
    run.plot(
        "car.speed", ["engine.speed", "turbine.speed"], "half_shafts.torque", "car.acceleration",
        units={"car.speed": "km/h", "*.speed": "rpm"}, events=False, path=folder / "drive.png",
    )  # fmt: skip
    jerk_trace(run, folder / "jerk.png")
    second = next(one for one in found if one.shift.before == "2" and one.shift.after == "3")
    cw.shifts.picture(run, box, second, folder / "shift_2_3.png", more=["half_shafts.torque"])
    cw.shifts.overview(found, folder / "shifts.png")


def jerk_trace(run: cw.Trajectory, path: Path) -> None:
    """Speed and jerk of the car over the whole drive."""
    from matplotlib.figure import Figure

    step = 2e-3
    part = run.at(np.arange(0.0, float(run.time[-1]), step))
    figure = Figure(figsize=(9.0, 4.5), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    upper.plot(part.time, 3.6 * part["car.speed"], color="#35557F")
    upper.set_ylabel("car [km/h]")
    lower.plot(part.time, cw.shifts.jerk(part["car.speed"], step), color="#B5651D", linewidth=0.8)
    lower.set_ylabel("jerk over 0.05 s [m/s3]")
    lower.set_xlabel("time [s]")
    figure.savefig(path, dpi=120)


def faults(gears: tuple[str, ...] = ()) -> cw.shifts.FaultTable:
    """Every element stuck closed or missing, in every gear, while the car drives with a fifth of the throttle."""
    box = cw.Gearbox.load(BOX)

    def in_gear(gear: str) -> cw.Driveline:
        # the turbine turns with 180 rad/s
        speed = 180.0 / box.ratios[gear] / FINAL_DRIVE * RADIUS
        return car(box, gear, speed, throttle=0.2)

    return cw.shifts.fault_table(in_gear, box, vehicle="car", gears=gears, rtol=1e-6)


if __name__ == "__main__":
    run, control = drive()
    out = Path(sys.argv[1] if len(sys.argv) > 1 else "out/eight_speed")
    out.mkdir(parents=True, exist_ok=True)
    shifts = quality(run, control.box)
    print(cw.shifts.table(shifts))
    core = run.statistics["core_seconds"]
    print(f"\n{T_END:g} s took {core:.3f} s in the core: {T_END / core:.0f} times faster than the car\n")
    check(run, control, shifts)
    pictures(run, control.box, shifts, out)
    table = faults()
    table.to_csv(out / "faults.csv")
    print(table)
