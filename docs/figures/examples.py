"""Draw the pictures of examples that have none on a page of their own."""

from __future__ import annotations

import contextlib
import io
import sys
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")
import clutchwork as cw
from clutchwork import fit

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
NAMES = ("cosimulation", "engine_clutch_vehicle", "launch", "tune_launch")
sys.path[:0] = [str(EXAMPLES / name) for name in ("car_launch", *NAMES)]

import cosimulation  # noqa: E402
import engine_clutch_vehicle  # noqa: E402
import launch  # noqa: E402
import tune_launch  # noqa: E402

SCRIPTS = (cosimulation, engine_clutch_vehicle, launch, tune_launch)


def write(folder: Path) -> list[Path]:
    """Run the examples, and draw the gearbox and the fit, whose examples are files."""
    folder.mkdir(parents=True, exist_ok=True)
    for script in SCRIPTS:
        # what they print is on their pages
        with contextlib.redirect_stdout(io.StringIO()):
            script.main(folder)
    gearbox = cw.Driveline.load(EXAMPLES / "six_speed" / "model.toml")
    gearbox.simulate().plot(folder / "six_speed.png")
    found = fit.fit_csv(
        EXAMPLES / "fit" / "measured.csv",
        cw.Stribeck(static=0.2, kinetic=0.1, speed=1.0, viscous=1e-4),
        slip="slip",
        torque="torque",
        load="load",
    )
    found.plot(folder / "fit.png")
    made = (
        "cosimulation",
        "engine_clutch_vehicle",
        "stall",
        "tune_launch",
        "six_speed",
        "fit",
    )
    return [folder / f"{name}.png" for name in made]
