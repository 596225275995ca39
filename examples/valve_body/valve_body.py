"""Shifts of an 8HP70 through its valve body, beside those with direct pressures, and what its controller learns.

python examples/valve_body/valve_body.py          # one shift, a wrong piston that is learnt: out/valve_body/
python examples/valve_body/valve_body.py --all    # all 112 shifts between any two gears, both ways; minutes
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from itertools import permutations
from pathlib import Path
from statistics import mean

from valve_body_model import FINAL_DRIVE, RADIUS, car, hydraulic_car

import clutchwork as cw

BOX = cw.Gearbox.load("zf-8hp70")
FORWARD = [gear for gear, ratio in BOX.ratios.items() if ratio > 0.0]
SENSED = cw.shifts.Sensed(torque=("converter.turbine.torque", "lock_up.torque"), throttle="combustion.throttle")
MEASURED = {"torque": "half_shafts.torque", "acceleration": "car.acceleration"}
TURBINE = 200.0  # rad/s, at which a shift begins where the engine can follow
FASTEST, SLOWEST = 450.0, 75.0  # rad/s, of the input behind a shift


def speed(before: str, after: str) -> float:
    """Of the car [m/s] where a shift begins."""
    step = BOX.ratios[after] / BOX.ratios[before]
    turbine = min(TURBINE, FASTEST / step) if step > 1.0 else max(TURBINE, SLOWEST / step)
    return turbine / BOX.ratios[before] / FINAL_DRIVE * RADIUS


def shift(system: cw.System, pair: tuple[str, str], pedal: float, control: cw.shifts.ShiftController) -> cw.Trajectory:
    """One shift of a car that is in the gear before it."""
    sim = cw.Simulator(system, rtol=1e-6)
    cw.shifts.drive(sim, control, 0.5, sensed=SENSED, throttle=lambda _: pedal)
    control.request(pair[1])
    return cw.shifts.drive(sim, control, 2.6, sensed=SENSED, throttle=lambda _: pedal)


def quality(run: cw.Trajectory) -> cw.shifts.ShiftQuality:
    """What it was like."""
    return cw.shifts.qualities(run, BOX, **MEASURED)[-1]


def learn(count: int = 10, share: float = 1.3) -> list[tuple[float, float, float]]:
    """Fill time and kiss point of D, as shares of the right ones, and the peak jerk, over shifts 3-4 and back.

    The controller begins with a share of every fill time and kiss point. It shifts up under power and down without.
    """
    up, down = ("3", "4"), ("4", "3")
    cars = {pair: hydraulic_car(BOX, pair[0], speed(*pair)).assemble() for pair in (up, down)}
    plant = cw.shifts.plant_of(cars[up], BOX)
    right = plant.actuators["D"]
    known = {name: cw.shifts.Learnt(share * one.fill_time, share * one.kiss) for name, one in plant.actuators.items()}
    course = []
    for _ in range(count):
        for pair, pedal in ((up, 0.3), (down, 0.0)):
            control = cw.shifts.ShiftController(BOX, plant, gear=pair[0], known=known)
            run = shift(cars[pair], pair, pedal, control)
            if pair == up:
                of = known["D"]
                course.append((of.fill_time / right.fill_time, of.kiss / right.kiss, quality(run).peak_jerk))
            known = control.learnt
    return course


def compare(pairs: Sequence[tuple[str, str]]) -> dict[str, cw.shifts.Survey]:
    """Shifts with power and without: with direct pressures, and through the valve body."""
    made = {"direct": car, "valve body": hydraulic_car}
    results: dict[str, list[cw.shifts.Surveyed]] = {}
    for name, model in made.items():
        results[name] = []
        for pair in pairs:
            begin = speed(*pair)
            found = cw.shifts.survey(
                lambda gear, begin=begin, model=model: model(BOX, gear, begin),
                BOX,
                [pair],
                sensed=SENSED,
                rtol=1e-6,
                **MEASURED,
            )
            results[name] += found.results
    return {name: cw.shifts.Survey(tuple(found)) for name, found in results.items()}


def table(found: dict[str, cw.shifts.Survey]) -> str:
    """Shifts that missed their gear, and means of jerk and torque hole."""
    lines = ["             shifts  missed  mean peak jerk  mean torque hole"]
    for name, survey in found.items():
        seen = [one.quality for one in survey.results if one.quality]
        jerk, hole = mean(one.peak_jerk for one in seen), mean(one.torque_hole for one in seen)
        lines.append(f"{name:12} {len(seen):6} {len(survey.missed):7} {jerk:9.2f} m/s3 {hole:13.0f} N m")
    return "\n".join(lines)


def main(arguments: Sequence[str]) -> None:
    """One shift with its picture and what is learnt, or all shifts."""
    if "--all" in arguments:
        print(table(compare(list(permutations(FORWARD, 2)))))
        return
    folder = Path("out") / "valve_body"
    folder.mkdir(parents=True, exist_ok=True)
    pair = ("3", "4")
    system = hydraulic_car(BOX, pair[0], speed(*pair)).assemble()
    control = cw.shifts.ShiftController(BOX, cw.shifts.plant_of(system, BOX), gear=pair[0])
    run = shift(system, pair, 0.3, control)
    shown = ("body.line.pressure", "body.C_port.pressure", "body.D_port.pressure"), ("half_shafts.torque",)
    run.plot(*shown, path=folder / "shift.png")
    print(table(compare([pair])))
    for fill, kiss, jerk in learn():
        print(f"fill time {fill:.2f}  kiss point {kiss:.2f}  peak jerk {jerk:5.2f} m/s3")


if __name__ == "__main__":
    main(sys.argv[1:])
