"""Draw the picture of the car that is linearised, whose model is that of the guide."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from groups import programs

import clutchwork as cw
from clutchwork.plot.figure import figure_of
from clutchwork.plot.style import COLOURS

mpl.use("agg")

FORCE = 1400.0  # N


def model() -> Any:
    """The function of the guide that builds the car."""
    source, *_ = programs("linearise")
    names: dict[str, Any] = {}
    exec(source.partition("\nlocked =")[0], names)
    return names["car"]


def write(folder: Path) -> list[Path]:
    """Damping over slip, and the response of the half shafts with the clutch locked and slipping."""
    folder.mkdir(parents=True, exist_ok=True)
    path, car = folder / "car.png", model()
    with figure_of(72.0, formulas=True) as figure:
        left, right = figure.subplots(1, 2)
        slips = np.linspace(12.0, 80.0, 69)
        damping = [
            cw.linearise(car(80.0, FORCE, 150.0 + slip)).modes.swinging[0].damping
            for slip in slips
        ]
        left.plot(slips, 100.0 * np.array(damping), color=COLOURS[0])
        left.axhline(0.0, color="#404040", linewidth=0.6)
        left.fill_between(
            slips,
            100.0 * np.array(damping),
            0.0,
            where=np.array(damping) < 0.0,
            color="#F3C9AE",
        )
        left.set_xlabel("slip [rad/s]")
        left.set_ylabel("damping ratio of the driveline [%]")
        left.set_title("a)  clutch slipping: below zero it judders", loc="left")
        frequencies = np.geomspace(0.3, 60.0, 600)
        # 0.28 times the gain of 0.2 m is the torque per normal force
        for label, color, state, source, per_torque in (
            (
                "torque of the engine, locked",
                COLOURS[0],
                car(0.0, 5000.0, 150.0),
                "combustion.torque",
                1.0,
            ),
            (
                "torque of the clutch, slipping",
                COLOURS[1],
                car(80.0, FORCE, 200.0),
                "clutch.normal_force",
                0.056,
            ),
        ):
            lin = cw.linearise(state, inputs=source, outputs="half_shafts.torque")
            response = np.abs(lin.frequency_response(frequencies)[:, 0, 0]) / per_torque
            right.loglog(frequencies, response, color=color, label=label)
        right.set_xlabel("frequency [Hz]")
        right.set_ylabel("half shafts over source [N m / N m]")
        right.set_ylim(0.03, 1000.0)
        right.set_title("b)  what of a torque ripple arrives", loc="left")
        right.legend(loc="upper right")
        figure.savefig(path)
    return [path]
