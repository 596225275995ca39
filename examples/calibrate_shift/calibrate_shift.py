"""Two gear shifts calibrated for least jerk.

First for nominal linings, with what more heat would buy, then for linings that scatter by 10 %.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import clutchwork as cw

EXAMPLES = Path(__file__).resolve().parents[1]
sys.path.append(str(EXAMPLES / "eight_speed"))

from eight_speed_model import FINAL_DRIVE, RADIUS, car  # noqa: E402

WINDOW = 0.05  # s, over which a jerk is felt
TURBINE = 205.0  # rad/s, where the eight-speed shifts
STIFFNESS = 1165745.0  # N m/rad, of the output shaft of the six-speed
RUNS = {"rtol": 1e-6, "atol": 1e-8}


@dataclass(frozen=True)
class Shift:
    """What is calibrated: pressures that are free, limits, and what scatters."""

    name: str
    system: cw.System
    t_end: float  # s
    clutches: tuple[str, str]  # the one that comes, the one that goes
    free: dict[str, Any]
    jerk: Any
    limits: list[Any]  # heat, duration, what the valve can do
    worst: float  # rad/s3 or m/s3, the jerk that no gearbox may have
    heats: tuple[float, ...]  # J, of the front
    shown: tuple[Any, ...]

    @property
    def linings(self) -> dict[str, Any]:
        """Linings of both clutches, each within 10 % of its nominal value."""
        return {f"lining {name}": cw.together(f"{name}.gain", factor=(0.9, 1.1)) for name in self.clutches}


def profile(times: Any, pressures: Any) -> cw.Table:
    """A table of pressures [Pa] over times [s]."""
    return cw.Table([(float(t), float(p)) for t, p in zip(times, pressures, strict=True)])


def six_speed() -> Shift:
    """The 3-4 shift of the six-speed box under load, from the moment before: F1 closes, F2 opens."""
    box = cw.Driveline.load(EXAMPLES / "six_speed" / "model.toml")
    before = cw.simulate(box, 1.9, rtol=1e-9, atol=1e-11, times=[1.9])
    start = {
        **{f"{name}.speed": float(before[f"{name}.speed"][0]) for name in ("w1", "w2", "w4", "w8")},
        "shaft.initial_twist": -float(before["shaft.torque"][0]) / STIFFNESS,
        "F1.pressure": profile([0.0, *np.linspace(0.1, 1.0, 10), 1.2], [0.0, *np.linspace(0.0, 4.5e5, 10), 2e6]),
        "F2.pressure": profile([0.0, 0.1, 0.25], [2e6, 2e6, 0.0]),
        "F2.locked": True,
        "F4.locked": True,
    }
    return Shift(
        "six_speed",
        box.assemble().changed(start),
        1.55,
        ("F1", "F2"),
        {"F1.pressure.values[3:11]": ("0 bar", "10 bar"), "F2.pressure.times[3]": (0.12, 0.4)},
        cw.jerk("w8", WINDOW, (0.0, 1.5)),
        [
            cw.limit("F1.heat", upper="100 kJ"),
            cw.limit(cw.lock("F1"), upper=1.0),
            cw.limit(cw.slope("F1.pressure"), -2e6, 1.2e7),
        ],
        850.0,
        (8.5e4, 8e4, 7.5e4, 7e4, 6.5e4),
        (["w1.speed", "w8.speed"], ["F1.slip"], ["F1.torque", "F2.torque"], ["F1.pressure", "F2.pressure"]),
    )


def eight_speed() -> Shift:
    """The 4-5 shift of the 8HP70 in a car: eight pressures of clutch C, one instant of brake E."""
    box = cw.Gearbox.load("zf-8hp70")
    start = TURBINE / box.ratios["4"] / FINAL_DRIVE * RADIUS
    pressures = [0.0, 0.0, 0.03e6, 0.07e6, 0.075e6, *[0.08e6] * 5, 1e6]
    model = car(box, "4", start, throttle=0.3).assemble()
    changes = {
        "gearbox.C.pressure": profile([0.0, *np.linspace(0.5, 1.3, 9), 1.4], pressures),
        "gearbox.E.pressure": profile([0.0, 0.5, 0.55, 0.75], [1e6, 1e6, 0.08e6, 0.0]),
    }
    return Shift(
        "eight_speed",
        model.changed(changes),
        1.8,
        ("gearbox.C", "gearbox.E"),
        {"gearbox.C.pressure.values[3:10]": (0.0, 0.2e6), "gearbox.E.pressure.times[4]": (0.6, 0.9)},
        cw.jerk("car", WINDOW, (0.4, 1.75)),
        [
            cw.limit("gearbox.C.heat", upper=2500.0),
            cw.limit(cw.lock("gearbox.C"), upper=1.3),
            cw.limit(cw.slope("gearbox.C.pressure"), -2e6, 1.2e7),
        ],
        4.0,
        (2500.0, 2350.0, 2200.0, 2050.0, 1900.0),
        (
            ["gearbox.in.speed"],
            ["gearbox.C.slip"],
            ["gearbox.C.torque", "gearbox.E.torque"],
            ["gearbox.C.pressure", "gearbox.E.pressure"],
        ),
    )


def calibrated(shift: Shift) -> cw.Calibration:
    """The pressures with the least jerk for nominal linings."""
    given = {"free": shift.free, "minimise": shift.jerk, "subject_to": shift.limits}
    return cw.calibrate(shift.system, shift.t_end, **given, **RUNS)


def robust(shift: Shift, system: cw.System, samples: int = 64) -> cw.Calibration:
    """The pressures that keep all limits in all samples of production and have the least jerk of the worst of them."""
    limits = [*shift.limits, cw.limit(shift.jerk, upper=shift.worst)]
    # it begins where nominal linings led to
    production = {"scatter": shift.linings, "samples": samples, "robust": "worst", "threads": 2, "starts": 1}
    given = {"free": shift.free, "minimise": shift.jerk, "subject_to": limits}
    return cw.calibrate(system, shift.t_end, **given, **production, **RUNS)


def main() -> None:
    """Calibrate both shifts, verify each with 1000 gearboxes, draw them before and after."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?", default=Path("out/calibrate_shift"), help="of the pictures")
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    for shift in (six_speed(), eight_speed()):
        began = time.perf_counter()
        nominal = calibrated(shift)
        print(f"{shift.name}, nominal linings, {time.perf_counter() - began:.1f} s\n\n{nominal}\n")
        began = time.perf_counter()
        front = nominal.front(f"{shift.clutches[0]}.heat", shift.heats)
        print(f"jerk over heat, {time.perf_counter() - began:.1f} s\n\n{front}\n")
        front.plot(folder / f"{shift.name}_front.png")
        nominal.plot(*shift.shown, path=folder / f"{shift.name}.png")
        began = time.perf_counter()
        found = robust(shift, nominal.system)
        print(f"{shift.name}, linings within 10 %, {time.perf_counter() - began:.1f} s\n\n{found}\n")
        print(f"{found.verify(1000)}\n")
        found.plot(*shift.shown, path=folder / f"{shift.name}_robust.png")
    print(f"pictures in {folder}")


if __name__ == "__main__":
    main()
