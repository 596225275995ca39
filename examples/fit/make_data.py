"""Write measured.csv: a made-up measurement of a wet brake, with noise. Usage: python make_data.py [FOLDER].

Four times the torque is raised until the brake breaks away, then the slip is swept up, under another load each time
and to the other side. The samples come from a known law, `TRUE`, so that a fit can be judged by it; nothing here was
measured.
"""

from __future__ import annotations

import sys
from math import pi
from pathlib import Path

import numpy as np

TRUE = {"static": 0.13, "kinetic": 0.095, "speed": 3.0, "viscous": 2.0e-4}
LOADS = (300.0, 500.0, 700.0, 900.0)  # N m, normal force times mean radius times number of faces
NOISE = 0.6  # N m, standard deviation
STEP = 0.02  # s
HEAD = "time [s],slip [rpm],torque [N m],load [N m]"


def coefficient(slip: np.ndarray) -> np.ndarray:
    """Stribeck curve over abs(slip) [rad/s], written out."""
    fall = (TRUE["static"] - TRUE["kinetic"]) * np.exp(-((slip / TRUE["speed"]) ** 2))
    return TRUE["kinetic"] + fall + TRUE["viscous"] * slip


def samples() -> np.ndarray:
    """Columns of the file."""
    noise = np.random.default_rng(20).normal(0.0, NOISE, (len(LOADS), 80))
    parts = []
    for number, load in enumerate(LOADS):
        side = 1.0 if number % 2 == 0 else -1.0
        ramp, sweep = np.linspace(0.0, 1.0, 40), np.geomspace(0.2, 60.0, 40)
        torque = np.concatenate([ramp * TRUE["static"], coefficient(sweep)]) * load
        slip = np.concatenate([np.zeros(40), sweep])
        full = np.full(80, load)
        parts.append(np.column_stack([side * slip * 30.0 / pi, side * torque + noise[number], full]))
    rows = np.vstack(parts)
    return np.column_stack([STEP * np.arange(len(rows)), rows])


def write(folder: Path) -> Path:
    """Write the file and return its path."""
    path = folder / "measured.csv"
    np.savetxt(path, samples(), delimiter=",", header=HEAD, comments="", fmt=["%.2f", "%.4f", "%.3f", "%.1f"])
    return path


if __name__ == "__main__":
    print(write(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent))
