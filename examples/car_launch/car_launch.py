"""Launch of a car with a dry clutch that gets warm: python examples/car_launch/car_launch.py [FOLDER]."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from car import RADIUS, RATIO, Engine, Readings, car
from pictures import Panel, draw

import clutchwork as cw

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BLUE, RED, GREEN, PINK, LIGHT, ORANGE, BLACK, GREY = (
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000", "#7F7F7F",
)  # fmt: skip


def throttle(time: float, _: Readings) -> float:
    """What the driver's right foot does: 0 to 1."""
    return float(np.interp(time, [0.3, 0.8, 2.0, 2.4], [0.0, 0.56, 0.75, 0.9]))


def launch(t_end: float = 4.0) -> cw.Trajectory:
    """The car of the model file with an engine that has a throttle and keeps its idle speed."""
    engine = Engine(throttle)
    return car({"combustion": {"torque": engine.signal()}}).simulate(t_end, rtol=1e-8)


def kinetic(run: cw.Trajectory) -> np.ndarray:
    """Kinetic energy over time [J]."""
    energies = [0.5 * node.inertia * run[f"{node.name}.speed"] ** 2 for node in run.wiring.nodes]
    return np.sum(energies, axis=0)


def summary(run: cw.Trajectory) -> str:
    """What the driver and the clutch felt."""
    lock = next(event for event in run.events.of("clutch") if event.after == "locked")
    lines = [
        f"clutch locks at {lock.time:.4f} s, at {np.interp(lock.time, run.time, run['car.speed']):.2f} m/s",
        f"it makes {run['clutch.heat'][-1] / 1e3:.2f} kJ of heat, at most {-run['clutch.power'].min() / 1e3:.1f} kW",
        f"plates: {run['clutch.temperature'].max():.1f} K at most, {run['clutch.temperature'][0]:.1f} K before",
        f"engine: {run['engine.speed'].min():.1f} rad/s at least; car: {run['car.speed'][-1]:.2f} m/s at the end",
    ]
    return "\n".join(lines)


def check(run: cw.Trajectory) -> None:
    """What the example claims."""
    assert run.finished, run.message
    # the balance with the heat in all thermal nodes, over all energy that moved
    assert abs(run.energy.residual) < 1e-8 * run.energy.turnover
    held = sum(run[f"{node}.heat"][-1] for node in ("clutch.plates", "flywheel", "air"))
    assert abs(held - run["clutch.heat"][-1]) < 1e-6 * held
    # one lock-up, no stall, the car moves up the slope
    assert [event.after for event in run.events.of("clutch").changes()][-1] == "locked"
    assert run["engine.speed"].min() > 70.0
    assert run["car.position"].min() > -0.01
    # temperatures follow from the heat, and cannot rise above that of all heat in the plates
    rise = run["clutch.temperature"].max() - run["clutch.temperature"][0]
    assert 0.0 < rise < run["clutch.heat"][-1] / 1500.0


def picture(run: cw.Trajectory, path: Path) -> None:
    """Speeds, torques, power, temperatures and energy over time."""

    def curves(axes: Axes, shown: dict[str, tuple[np.ndarray, str]]) -> None:
        for label, (values, colour) in shown.items():
            # the gearbox turns with the engine once the clutch has locked, so it must not hide it
            dashes = (0, (4, 2)) if label == "gearbox" else "-"
            axes.plot(run.time, values, color=colour, linestyle=dashes, label=label)

    drive = run["combustion.torque"] + run["engine_drag.torque"]
    power = run["combustion.power"] + run["engine_drag.power"]
    work = run["combustion.work"] + run["engine_drag.work"]
    energies = {
        "kinetic energy": kinetic(run) - kinetic(run)[0],
        "up the slope": -run["slope.work"],
        "heat of the clutch": run["clutch.heat"],
        "road, air, brake": -run["rolling.work"] - run["air_drag.work"] + run["brake.heat"],
    }

    def stacked(axes: Axes) -> None:
        rows = [1e-3 * row for row in energies.values()]
        axes.stackplot(run.time, rows, labels=list(energies), colors=[LIGHT, GREEN, ORANGE, GREY], linewidth=0)
        axes.plot(run.time, 1e-3 * work, color=BLACK, label="work of the engine")

    speeds = {
        "engine": (run["engine.speed"], BLUE),
        "gearbox": (run["gearbox.speed"], RED),
        "car, at the gearbox": (run["car.speed"] / RADIUS * RATIO, GREEN),
    }
    torques = {
        "engine": (drive, BLUE),
        "clutch": (run["clutch.torque"], RED),
        "static capacity": (run["clutch.capacity"], GREY),
    }
    powers = {
        "engine": (1e-3 * power, BLUE),
        "heat of the clutch": (-1e-3 * run["clutch.power"], ORANGE),
        "half shafts to wheels": (1e-3 * run["half_shafts.torque"] * run["wheels.speed"], GREEN),
    }
    temperatures = {
        "plates": (run["clutch.temperature"], RED),
        "flywheel": (run["flywheel.temperature"], BLUE),
    }
    panels = [
        Panel("speeds", "speed, rad/s", lambda axes: curves(axes, speeds)),
        Panel("torques", "torque, N m", lambda axes: curves(axes, torques)),
        Panel("power", "power, kW", lambda axes: curves(axes, powers)),
        Panel("temperatures", "temperature, K", lambda axes: curves(axes, temperatures)),
        Panel("where the work of the engine goes", "energy, kJ", stacked),
    ]
    draw(path, run, panels, np.unique(run.events.changes().times))


def main(folder: Path) -> None:
    """Run, tell, draw."""
    run = launch()
    print(run.events)
    print(summary(run))
    print(run.energy)
    picture(run, folder / "car_launch.png")
    print(f"wrote {folder / 'car_launch.png'}")
    check(run)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/car_launch"))
