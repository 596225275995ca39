"""A whole car: launch, all upshifts, coast-down: python examples/car/whole_car.py [FOLDER]."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from shifting import BRAKE, PEDAL, Transmission
from whole_car_model import GEARS, RATIOS, Inputs, whole_car

import clutchwork as cw

T_END = 60.0


def drive(t_end: float = T_END, **options: float) -> tuple[cw.Trajectory, Transmission]:
    """The car from rest under the control of its gearbox."""
    box = Transmission()
    inputs = Inputs(cw.Table(PEDAL), cw.Table(BRAKE), box.pressure)
    sim = cw.Simulator(whole_car(lambda _: inputs), **options)
    while sim.time < t_end - 1e-9:
        wanted = box.step(sim.time, sim)
        if sim.held.keys() - wanted.keys() >= {"combustion.throttle"}:
            sim.release("combustion.throttle")
        if wanted:
            sim.set(wanted)
        sim.advance(min(box.wait, t_end - sim.time))
    return sim.run, box


def phases(box: Transmission) -> dict[str, tuple[float, float]]:
    """Begin and end of what is looked at [s]."""
    begin, end, _ = box.shifts[1]
    return {"launch": (0.5, box.shifts[0][0]), "shift": (begin, end), "coast": (27.0, T_END)}


def summary(run: cw.Trajectory, box: Transmission) -> str:
    """Shifts, and how fast it was."""
    lines = [f"{begin:6.2f} s  to gear {gear} in {1e3 * (end - begin):4.0f} ms" for begin, end, gear in box.shifts]
    v = run["car.speed"]
    lines.append(f"100 km/h after {np.interp(100 / 3.6, v[: v.argmax()], run.time[: v.argmax()]):.2f} s")
    lines.append(f"{3.6 * v.max():.0f} km/h at most, {3.6 * v[-1]:.0f} km/h at the end")
    seconds = run.statistics["core_seconds"]
    lines.append(f"core: {1e3 * seconds:.0f} ms, {run.time[-1] / seconds:.0f} times faster than the car")
    return "\n".join(lines)


def check(run: cw.Trajectory, box: Transmission) -> None:
    """What the example claims."""
    assert run.finished, run.message
    assert abs(run.energy.residual) < 1e-8 * run.energy.turnover
    assert [gear for _, _, gear in box.shifts] == [2, 3, 4, 5, 6]
    # in every gear the ratio is that of the teeth, in the middle between two shifts
    ends = [*(begin for begin, _, _ in box.shifts[1:]), 26.0]
    at = run.at([0.5 * (begin + end) for (begin, _, _), end in zip(box.shifts, ends, strict=True)])
    for number, (_, _, gear) in enumerate(box.shifts):
        assert abs(at["w1.speed"][number] / at["w8.speed"][number] / RATIOS[gear] - 1.0) < 1e-3
        assert all(at[f"{name}.state"][number] == "locked" for name in GEARS[gear])
    assert run["lock_up.state"][-1] == "locked"
    assert run["car.position"].min() > -0.01
    # what is lost in each phase is what was found element by element
    for begin, end in phases(box).values():
        losses = run.losses(begin, end)
        assert abs(losses.balance.residual) < 1e-8 * run.energy.turnover
        missed = [line.taken - line.given - line.stored - line.heat for line in losses.lines]
        assert max(map(abs, missed)) < 1e-8 * run.energy.turnover


def pictures(run: cw.Trajectory, box: Transmission, folder: Path) -> None:
    """Speeds, pressures and torques; where the energy of each phase went."""
    run.plot(
        ["engine.speed", "w1.speed"], "car.speed", ["left_shaft.torque", "right_shaft.torque"],
        ["F1.pressure", "F2.pressure", "F3.pressure", "F4.pressure", "F6.pressure", "lock_up.pressure"],
        units={"car.speed": "km/h", "engine.speed": "rpm", "w1.speed": "rpm"}, events=False, path=folder / "drive.png",
    )  # fmt: skip
    begin, end, _ = box.shifts[1]
    run.plot(
        ["engine.speed", "w1.speed"], ["F1.slip", "F2.slip", "F4.slip", "F6.slip"],
        ["F1.torque", "F2.torque", "F4.torque", "F6.torque"], ["left_shaft.torque", "right_shaft.torque"],
        zoom=(begin - 0.1, end + 0.4), path=folder / "shift.png",
    )  # fmt: skip
    for name, (first, last) in phases(box).items():
        run.sankey(folder / f"sankey_{name}.svg", start=first, end=last)


if __name__ == "__main__":
    made, control = drive()
    print(summary(made, control))
    out = Path(sys.argv[1] if len(sys.argv) > 1 else "out/car")
    out.mkdir(parents=True, exist_ok=True)
    pictures(made, control, out)
    for phase, (first, last) in phases(control).items():
        print(f"\n{phase}\n{made.losses(first, last)}")
    check(made, control)
