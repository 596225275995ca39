"""The same car on a cycle of 20 minutes, driven inside of the core: python examples/car/cycle.py [FOLDER]."""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from whole_car_model import CLUTCHES, FULL, GEARS, Inputs, whole_car

import clutchwork as cw

# speed [km/h] that is reached at a time [s], straight in between: town, country road, motorway, town
CYCLE = (
    *((0, 0), (10, 0), (18, 30), (45, 32), (53, 0), (65, 0), (77, 48), (120, 50), (132, 0), (150, 0), (164, 52)),
    *((210, 48), (222, 0), (240, 0), (252, 40), (270, 25), (285, 50), (340, 50), (352, 0), (370, 0), (392, 70)),
    *((450, 82), (500, 78), (515, 60), (540, 95), (620, 100), (660, 85), (700, 102), (740, 100), (765, 125)),
    *((860, 130), (900, 118), (940, 128), (985, 90), (1010, 80), (1040, 50), (1062, 0), (1080, 0), (1093, 45)),
    *((1130, 50), (1142, 0), (1155, 0), (1165, 30), (1185, 30), (1194, 0), (1200, 0)),
)
T_END = 1200.0
UP = (4.0, 8.0, 12.5, 17.0, 22.0)  # m/s at which the next gear is taken; back 1.5 m/s below
BACK = 1.5
LOCKED_FROM = 3  # gear


def cycle() -> cw.Table:
    """The wanted speed [m/s] over time."""
    return cw.Table([(float(time), speed / 3.6) for time, speed in CYCLE])


def gears() -> list[tuple[float, int]]:
    """When which gear is taken, from the cycle alone: the driver keeps close to it."""
    gear, made = 1, [(0.0, 1)]
    times = np.arange(0.0, T_END, 0.1)
    for time, speed in zip(times, np.interp(times, *zip(*CYCLE, strict=True)) / 3.6, strict=True):
        wanted = gear
        if gear < max(GEARS) and speed > UP[gear - 1]:
            wanted = gear + 1
        elif gear > 1 and speed < UP[gear - 2] - BACK:
            wanted = gear - 1
        if wanted != gear and time - made[-1][0] > 1.5:
            gear = wanted
            made.append((float(time), gear))
    return made


def pressures() -> dict[str, cw.Table]:
    """Pressures of the clutches over time: those that come rise while those that go fall."""
    points = {name: [(0.0, FULL * (name in GEARS[1]))] for name in CLUTCHES} | {"lock_up": [(0.0, 0.0)]}
    steps = gears()
    for (_, old), (time, new) in pairwise(steps):
        for name in GEARS[new]:
            if name not in GEARS[old]:
                points[name] += [
                    (time + 0.1, 0.0),
                    (time + 0.25, 0.25 * FULL),
                    (time + 0.7, 0.4 * FULL),
                    (time + 0.9, FULL),
                ]
        for name in GEARS[old]:
            if name not in GEARS[new]:
                points[name] += [(time, FULL), (time + 0.05, 0.3 * FULL), (time + 0.3, 0.0)]
    for (time, gear), (end, _) in pairwise([*steps, (T_END, 0)]):
        if gear >= LOCKED_FROM and end - time > 3.0:
            points["lock_up"] += [(time + 1.2, 0.0), (time + 1.8, FULL), (end - 0.2, FULL), (end - 0.05, 0.0)]
    return {name: cw.Table(made) for name, made in points.items()}


def drive(t_end: float = T_END, **options: float) -> cw.Trajectory:
    """The car on the cycle."""
    return whole_car(_driven).simulate(t_end, **options)


def _driven(car: cw.Node) -> Inputs:
    driver = cw.Driver("driver", cycle=cycle(), speed=car, gain=1.2, integral_gain=0.2)
    return Inputs(driver, (driver, "brake"), pressures(), driver)


def check(run: cw.Trajectory) -> None:
    """What the example claims."""
    assert run.finished, run.message
    assert abs(run.energy.residual) < 1e-6 * run.energy.turnover
    wanted = np.interp(run.time, *zip(*CYCLE, strict=True)) / 3.6
    # within 2 km/h most of the time, as the rules of cycles ask for
    assert np.mean(np.abs(run["car.speed"] - wanted) < 2.0 / 3.6) > 0.9


if __name__ == "__main__":
    made = drive(rtol=1e-5, dt=0.1)
    seconds = made.statistics["core_seconds"]
    print(f"{T_END:.0f} s in {seconds:.2f} s: {T_END / seconds:.0f} times faster, {made.statistics['steps']} steps")
    print(f"{made['car.position'][-1] / 1e3:.2f} km")
    print(made.losses())
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/car")
    folder.mkdir(parents=True, exist_ok=True)
    made.plot(["car.speed"], ["engine.speed", "w1.speed"], "lock_up.state", events=False, path=folder / "cycle.png")
    made.sankey(folder / "sankey_cycle.svg")
    check(made)
