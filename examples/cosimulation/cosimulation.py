"""Two simulators that exchange speed and torque step by step: python examples/cosimulation/cosimulation.py [FOLDER]."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import clutchwork as cw

sys.path.append(str(Path(__file__).resolve().parents[1] / "car_launch"))
import itertools

from pictures import Panel, draw

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

T_END = 1.2
STEPS = (8e-3, 4e-3, 2e-3, 1e-3, 5e-4)  # s, from one exchange to the next
RATIO = 10.0
STIFFNESS, DAMPING = 8000.0, 120.0  # N m/rad and N m s/rad, both half shafts
WHEELS = 1300.0 * 0.3**2  # kg m2, a car of 1300 kg at wheels of 0.3 m
PRESSURE = cw.Table([(0.0, 0.0), (0.1, 0.5e5), (0.8, 2.5e5)])  # Pa
SPEEDS = ("engine.speed", "flange.speed", "wheels.speed")
TIGHT = {"rtol": 1e-9, "atol": 1e-9}


def drive(d: cw.Driveline) -> cw.Node:
    """Engine, clutch and gears, up to the flange of the half shafts."""
    engine, gearbox = d.shaft("engine", inertia=0.2, speed=150.0), d.shaft("gearbox", inertia=0.05)
    flange = d.shaft("flange")
    d.add(cw.Torque("combustion", shaft=engine, torque=120.0))
    friction = cw.Stribeck(static=0.35, kinetic=0.28, speed=10.0)
    d.add(cw.Clutch("clutch", base=engine, follower=gearbox, friction=friction, gain=4e-3, pressure=PRESSURE))
    d.add(cw.Gear("gears", input=gearbox, output=flange, ratio=RATIO))
    return flange


def vehicle(d: cw.Driveline, flange: cw.Node) -> None:
    """Half shafts and car."""
    wheels = d.shaft("wheels", inertia=WHEELS)
    d.add(cw.SpringDamper("half_shafts", base=flange, follower=wheels, stiffness=STIFFNESS, damping=DAMPING))
    d.add(cw.ResistingTorque("road", shaft=wheels, torque=150.0, speed=0.5))


def whole() -> cw.Trajectory:
    """Both in one model: what the coupled ones are compared with."""
    d = cw.Driveline("car")
    vehicle(d, drive(d))
    return d.simulate(T_END, **TIGHT)


def halves() -> tuple[cw.Simulator, cw.Simulator]:
    """One simulator with a torque at its end, one with a speed at its begin."""
    front = cw.Driveline("engine, clutch and gears")
    front.add(cw.Torque("reaction", shaft=drive(front), torque=0.0))
    back = cw.Driveline("half shafts and car")
    flange = back.shaft("flange")
    back.add(cw.PrescribedSpeed("given", shaft=flange, speed=0.0))
    vehicle(back, flange)
    return cw.Simulator(front, **TIGHT), cw.Simulator(back, **TIGHT)


class Coupled(NamedTuple):
    """What a pair of simulators did at the instants of their exchange."""

    step: float  # s
    time: NDArray[np.float64]  # s
    speeds: NDArray[np.float64]  # rad/s, one line for each of SPEEDS
    locked: float  # s, when the clutch locked


def coupled(step: float) -> Coupled:
    """Run both, each with what the other one had at the begin of the step."""
    front, back = halves()
    time, seen = [0.0], [_speeds(front, back)]
    while front.time < T_END:
        # the torque of the half shafts holds the flange back as much as it drives the wheels
        torque, speed = back["half_shafts.torque"], front["flange.speed"]
        front["reaction.torque"], back["given.speed"] = -torque, speed
        front.advance(step)
        back.advance(step)
        time.append(front.time)
        seen.append(_speeds(front, back))
    lock = next(event for event in front.events.of("clutch") if event.after == "locked")
    return Coupled(step, np.array(time), np.array(seen).T, lock.time)


def _speeds(front: cw.Simulator, back: cw.Simulator) -> list[float]:
    return [front["engine.speed"], front["flange.speed"], back["wheels.speed"]]


def error(found: Coupled, reference: cw.Trajectory) -> float:
    """Largest error of a speed at the flange [rad/s]."""
    run = reference.at(found.time)
    wanted = np.array([run["engine.speed"] / RATIO, run["flange.speed"], run["wheels.speed"]])
    got = found.speeds / np.array([[RATIO], [1.0], [1.0]])
    return float(np.max(np.abs(got - wanted)))


def check(reference: cw.Trajectory, found: list[Coupled]) -> None:
    """What the example claims: the error falls with the step, and so does that of the lock-up."""
    errors = [error(one, reference) for one in found]
    lock = next(event.time for event in reference.events.of("clutch") if event.after == "locked")
    for (coarse, fine), one in zip(itertools.pairwise(errors), found[1:], strict=True):
        # values are held over a step, so half the step is half the error, and a little less before it is small
        assert 1.6 < coarse / fine < 2.6, (one.step, coarse, fine)
    assert errors[-1] < 0.01 * float(np.max(reference["flange.speed"]))
    assert abs(found[-1].locked - lock) < 2.0 * STEPS[-1]


def picture(reference: cw.Trajectory, found: list[Coupled], path: Path) -> None:
    """Speeds of the one model and of the coupled ones, their error over time, and over the step."""
    coarse = found[0]
    colours = ("#D55E00", "#0072B2", "#009E73")

    def speeds(axes: Axes) -> None:
        for name, values, colour, scale in zip(SPEEDS, coarse.speeds, colours, (1 / RATIO, 1.0, 1.0), strict=True):
            words = name.partition(".")[0] + (" / 10" if scale != 1.0 else "")
            axes.plot(reference.time, scale * reference[name], color=colour, linewidth=0.9, label=words)
            axes.plot(coarse.time, scale * values, ".", color=colour, markersize=2.0)

    def errors(axes: Axes) -> None:
        for one, shade in zip(found, np.linspace(0.65, 0.0, len(found)), strict=True):
            wanted = reference.at(one.time)["wheels.speed"]
            axes.plot(one.time, one.speeds[2] - wanted, color=str(shade), label=f"{1e3 * one.step:g} ms")

    marks = [event.time for event in reference.events.changes()]
    panels = [
        Panel("speeds: one model (lines), exchanged every 8 ms (dots)", "speed, rad/s", speeds),
        Panel("error of the speed of the wheels", "rad/s", errors),
    ]
    draw(path, reference, panels, marks)


def main(folder: Path) -> None:
    """Run, tell, draw."""
    reference, found = whole(), [coupled(step) for step in STEPS]
    lock = next(event.time for event in reference.events.of("clutch") if event.after == "locked")
    print("exchange   largest error   lock-up")
    for one in found:
        print(f"{1e3 * one.step:5g} ms   {error(one, reference):8.4f} rad/s   {one.locked:.5f} s")
    print(f"one model                   {lock:.5f} s")
    picture(reference, found, folder / "cosimulation.png")
    print(f"wrote {folder / 'cosimulation.png'}")
    check(reference, found)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/cosimulation"))
