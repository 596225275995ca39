"""Hill starts until the clutch is too hot: python examples/hill_starts/hill_starts.py [FOLDER]."""

from __future__ import annotations

import sys
import warnings
from dataclasses import dataclass, field
from math import atan, sin
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import clutchwork as cw

sys.path.append(str(Path(__file__).resolve().parents[1] / "car_launch"))
from car import Engine, Readings, car
from pictures import Panel, draw

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LIMIT = 473.0  # K, above which the lining fades
WARM = 350.0  # K, engine and flywheel before the first start
GRADE = 0.2
SAMPLE = 0.02  # s, in which the driver acts
PERIOD = 9.0  # s from one start to the next

# what the driver does in one start: time since it began [s] over pedal [m], throttle and force of the brake [N]
PEDAL = ((0.5, 0.75, 2.6, 3.2, 5.0, 5.3), (0.12, 0.099, 0.069, 0.0, 0.0, 0.12))
THROTTLE = ((0.3, 0.8, 2.4, 4.9, 5.0), (0.0, 0.7, 0.9, 0.9, 0.0))
BRAKE = ((0.9, 1.1, 5.2, 5.4), (4500.0, 0.0, 0.0, 4500.0))


class ClutchTooHotWarning(UserWarning):
    """A clutch is above its limit; `time` [s] and `value` [K] say when and how far."""

    def __init__(self, time: float, value: float, limit: float) -> None:
        super().__init__(f"clutch at {value:.2f} K above its limit of {limit:.2f} K, {time:.2f} s: let it cool")
        self.time, self.value = time, value


@dataclass
class Driver:
    """Starts the car again and again; after a warning of the clutch stays on the brake."""

    limit: float = LIMIT
    warned: list[ClutchTooHotWarning] = field(default_factory=list)
    _begun: int = 0
    _rests: bool = False

    def throttle(self, time: float, readings: Readings) -> float:
        """Share of the torque of the engine."""
        return float(np.interp(self._since(time, readings), *THROTTLE))

    def pedal(self, time: float, readings: Readings) -> float:
        """Travel of the clutch pedal [m]."""
        return float(np.interp(self._since(time, readings), *PEDAL))

    def brake(self, time: float, readings: Readings) -> float:
        """Force on each pad of the brake [N]."""
        return float(np.interp(self._since(time, readings), *BRAKE))

    def _since(self, time: float, readings: Readings) -> float:
        """Time since this start began [s]; a start that has begun is finished, then a hot clutch rests."""
        self._watch(time, readings["clutch.temperature"])
        begun = int(time / PERIOD + 1e-9)
        if begun > self._begun:
            self._begun, self._rests = begun, bool(self.warned)
        return 0.0 if self._rests else time - begun * PERIOD

    def _watch(self, time: float, temperature: float) -> None:
        if temperature > self.limit and not self.warned:
            self.warned.append(ClutchTooHotWarning(time, temperature, self.limit))
            warnings.warn(self.warned[0], stacklevel=2)


def starts(driver: Driver, t_end: float = 110.0) -> cw.Trajectory:
    """Hill starts with the car of the other example, warm, on a slope."""
    engine = Engine(driver.throttle, period=SAMPLE)
    controllers = {
        "combustion": {"torque": engine.signal()},
        "spring": {"travel": cw.Sampled(driver.pedal, SAMPLE)},
        "brake": {"normal_force": cw.Sampled(driver.brake, SAMPLE)},
    }
    model = car(
        controllers,
        clutch={"initial_temperature": WARM},
        flywheel={"temperature": WARM},
        air={"temperature": WARM - 20.0},
        spring={"lag": SAMPLE, "initial_travel": PEDAL[1][0]},
        slope={"torque": -1300.0 * 9.81 * sin(atan(GRADE))},
    )
    return model.simulate(t_end, dt=0.05, angles=False)


@dataclass(frozen=True)
class Start:
    """One hill start."""

    lock: float  # s after the start began
    heat: float  # J
    before: float  # K, plates
    after: float  # K, plates


def table(run: cw.Trajectory) -> list[Start]:
    """Every start in which the clutch locked."""
    found = []
    for event in run.events.of("clutch"):
        if event.after != "locked":
            continue
        begun = PERIOD * (event.time // PERIOD)
        span = (run.time >= begun) & (run.time <= begun + PERIOD)
        hot, heat = run["clutch.temperature"][span], run["clutch.heat"][span]
        found.append(Start(event.time - begun, heat[-1] - heat[0], hot[0], hot.max()))
    return found


def check(run: cw.Trajectory, driver: Driver) -> None:
    """What the example claims."""
    assert run.finished, run.message
    assert abs(run.energy.residual) < 1e-7 * run.energy.turnover
    made = table(run)
    # the hotter the clutch, the longer it slips
    assert made[-1].lock > made[0].lock
    assert made[-1].heat > made[0].heat
    # one warning, at the first sample above the limit, and no start after the one in which it came
    (warned,) = driver.warned
    assert warned.value > LIMIT
    above = run.time[run["clutch.temperature"] > LIMIT]
    assert abs(above[0] - warned.time) <= 0.05 + 1e-9
    assert len(made) == warned.time // PERIOD + 1
    assert run["clutch.temperature"][-1] < LIMIT


def picture(run: cw.Trajectory, driver: Driver, path: Path) -> None:
    """Speed of the car, temperatures with the limit, heat, and the heat of each start."""

    def speeds(axes: Axes) -> None:
        axes.plot(run.time, run["engine.speed"], color="#0072B2", linewidth=0.8, label="engine")
        axes.plot(run.time, run["gearbox.speed"], color="#D55E00", linewidth=0.8, label="gearbox")

    def power(axes: Axes) -> None:
        axes.plot(run.time, -1e-3 * run["clutch.power"], color="#E69F00", label="clutch")

    def temperatures(axes: Axes) -> None:
        axes.plot(run.time, run["clutch.temperature"], color="#D55E00", label="plates")
        axes.plot(run.time, run["flywheel.temperature"], color="#0072B2", label="flywheel")
        axes.axhline(driver.limit, color="#000000", linewidth=0.8, linestyle=(0, (4, 2)), label="limit")
        for warned in driver.warned:
            axes.plot([warned.time], [warned.value], "o", color="#000000", markersize=4, label="warning")

    def heat(axes: Axes) -> None:
        nodes = {"clutch.plates": "in the plates", "flywheel": "in the flywheel", "air": "in the air"}
        rows = [1e-3 * run[f"{node}.heat"] for node in nodes]
        axes.stackplot(run.time, rows, labels=list(nodes.values()), colors=["#D55E00", "#56B4E9", "#D0D0D0"])
        axes.plot(run.time, 1e-3 * run["clutch.heat"], color="#000000", label="made by the clutch")

    panels = [
        Panel("speeds", "speed, rad/s", speeds),
        Panel("power that becomes heat", "power, kW", power),
        Panel("temperatures", "temperature, K", temperatures),
        Panel("where the heat is", "heat, kJ", heat),
    ]
    draw(path, run, panels)


def main(folder: Path) -> None:
    """Run, tell, draw."""
    driver = Driver()
    run = starts(driver)
    print("start  locks after  heat      plates")
    for number, start in enumerate(table(run), 1):
        print(
            f"{number:5d}  {start.lock:9.3f} s  {start.heat / 1e3:5.1f} kJ  {start.before:.0f} to {start.after:.0f} K"
        )
    print(run.energy)
    picture(run, driver, folder / "hill_starts.png")
    print(f"wrote {folder / 'hill_starts.png'}")
    check(run, driver)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/hill_starts"))
