"""The car of examples/eight_speed with the valve body of its gearbox: pump, line pressure, spool valves, pistons."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).resolve().parents[1] / "eight_speed"))
from eight_speed_model import FINAL_DRIVE as FINAL_DRIVE
from eight_speed_model import RADIUS as RADIUS
from eight_speed_model import RATED, car, crankshaft

import clutchwork as cw

PISTON = 6e-3  # m2
FULL = 1e6  # Pa
# force of a piston at that pressure, less its return spring [N]
PRESSED = 5500.0
# kinetic coefficient of the linings and its reserve over the torques that they carry
COEFFICIENT, RESERVE = 0.11, 1.5


def hydraulic_car(box: cw.Gearbox, gear: str, speed: float, throttle: float = 0.0, **body: Any) -> cw.Driveline:
    """The car in a gear at a speed [m/s]; more values are those of the valve body."""
    engine = crankshaft(box, gear, speed)
    torques = {name: max(one.torque, 0.1) * RATED for name, one in box.capacities().items()}
    valves = cw.ValveBody(
        "body",
        shaft=engine,
        piston_areas=dict.fromkeys(torques, PISTON),
        pressures=dict.fromkeys(box.closed_in(gear), FULL) or None,
        **body,
    )
    shift = {
        name: {"normal_force": valves.part(f"{name}_piston"), "gain": RESERVE * torque / COEFFICIENT / PRESSED}
        for name, torque in torques.items()
    }
    d = car(box, gear, speed, throttle, shift, engine)
    d.add(valves)
    return d
