"""Two gear shifts calibrated for least jerk: python examples/calibrate_shift/calibrate_shift.py [FOLDER].

Linings scatter by 10 %; all limits hold all the same.
"""

from __future__ import annotations

import sys
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


@dataclass(frozen=True)
class Shift:
    """What is calibrated: pressures that are free, limits, and what scatters."""

    name: str
    system: cw.System
    t_end: float
    free: dict[str, Any]
    jerk: Any
    limits: list[Any]
    scatter: dict[str, Any]
    shown: tuple[list[str], ...]


def linings(*clutches: str) -> dict[str, Any]:
    """Linings of both clutches, each within 10 % of the drawing."""
    return {f"lining {name}": cw.together(f"{name}.gain", factor=(0.9, 1.1)) for name in clutches}


def six_speed() -> Shift:
    """The 3-4 shift of the six-speed box under load: ten pressures of the oncoming clutch, one instant of the other."""
    times = np.round(np.linspace(2.0, 2.8, 9), 3)
    first = np.interp(times, [2.0, 2.15, 2.9], [0.0, 1.2e5, 4.5e5])
    points = [(0.0, 0.0), *((float(t), float(p)) for t, p in zip(times, first, strict=True)), (2.9, 4.5e5), (3.1, 2e6)]
    oncoming = cw.Table(points)
    leaving = cw.Table([(0.0, 0.0), (0.1, 0.0), (0.3, 3.5e5), (1.2, 9e5), (1.4, 2e6), (2.0, 2e6), (2.15, 0.0)])
    model = cw.Driveline.load(EXAMPLES / "six_speed" / "model.toml").assemble()
    return Shift(
        "six_speed",
        model.changed({"F1.pressure": oncoming, "F2.pressure": leaving}),
        3.4,
        {"F1.pressure.values[3:11]": ("0 bar", "10 bar"), "F2.pressure.times[7]": (2.05, 2.3)},
        cw.jerk("w8", WINDOW, (1.8, 3.3)),
        [
            cw.limit("F1.heat", upper="100 kJ"),
            cw.limit(cw.lock("F1"), upper=2.9),
            cw.limit(cw.slope("F1.pressure"), -4e6, 1.2e7),
        ],
        linings("F1", "F2"),
        (["w1.speed", "w8.speed"], ["F1.slip"], ["F1.torque", "F2.torque"], ["F1.pressure", "F2.pressure"]),
    )


def eight_speed() -> Shift:
    """The 4-5 shift of the 8HP70 in a car: eight pressures of clutch C, one instant of brake E."""
    box = cw.Gearbox.load("zf-8hp70")
    start = TURBINE / box.ratios["4"] / FINAL_DRIVE * RADIUS
    levels = [0.03e6, 0.07e6, 0.075e6, 0.08e6, 0.08e6, 0.08e6, 0.08e6, 0.08e6]
    times = [0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3]
    oncoming = cw.Table([(0.0, 0.0), (0.5, 0.0), *zip(times, levels, strict=True), (1.4, 1e6)])
    leaving = cw.Table([(0.0, 1e6), (0.5, 1e6), (0.55, 0.08e6), (0.75, 0.0)])
    model = car(box, "4", start, throttle=0.3).assemble()
    return Shift(
        "eight_speed",
        model.changed({"gearbox.C.pressure": oncoming, "gearbox.E.pressure": leaving}),
        1.8,
        {"gearbox.C.pressure.values[3:10]": (0.0, 0.2e6), "gearbox.E.pressure.times[4]": (0.6, 0.9)},
        cw.jerk("car", WINDOW, (0.4, 1.75)),
        [
            cw.limit("gearbox.C.heat", upper=2500.0),
            cw.limit(cw.lock("gearbox.C"), upper=1.3),
            cw.limit(cw.slope("gearbox.C.pressure"), -2e6, 1.2e7),
        ],
        linings("gearbox.C", "gearbox.E"),
        (
            ["gearbox.in.speed"],
            ["gearbox.C.slip"],
            ["gearbox.C.torque", "gearbox.E.torque"],
            ["gearbox.C.pressure", "gearbox.E.pressure"],
        ),
    )


def calibrated(shift: Shift, samples: int = 64) -> Any:
    """The pressures that keep all limits in all samples of production and have the least jerk of the worst of them."""
    return cw.calibrate(
        shift.system,
        shift.t_end,
        free=shift.free,
        minimise=shift.jerk,
        subject_to=shift.limits,
        scatter=shift.scatter,
        samples=samples,
        robust="worst",
        threads=2,
    )


def main() -> None:
    """Calibrate both shifts, verify each with 1000 samples, draw them before and after."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/calibrate_shift")
    folder.mkdir(parents=True, exist_ok=True)
    for shift in (six_speed(), eight_speed()):
        found = calibrated(shift)
        verified = found.verify(1000)
        print(f"{shift.name}\n\n{found}\n\n{verified}\nlargest jerk of them {verified.goals.max():.4g}\n")
        found.plot(*shift.shown, path=folder / f"{shift.name}.png")
    print(f"pictures in {folder}")


if __name__ == "__main__":
    main()
