"""A gearbox of two gear pairs and two clutches, whose shifts have closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np

import clutchwork as cw

# both pairs reverse the direction: the output turns backward
BOX = cw.Gearbox.from_dict(
    {
        "name": "layshaft",
        "input": "in",
        "output": "out",
        "sets": {
            "Z1": {"type": "gear", "first": "in", "second": "m1", "teeth_first": 20, "teeth_second": 60},
            "Z2": {"type": "gear", "first": "in", "second": "m2", "teeth_first": 30, "teeth_second": 60},
        },
        "elements": {"C1": ["out", "m1"], "C2": ["out", "m2"]},
        "gears": {"1": ["C1"], "2": ["C2"]},
    }
)
I1, I2 = 3.0, 2.0
J1, J2 = 0.2, 4.0  # kg m2, input and output
T, LOAD = 100.0, 300.0  # N m: speed is constant in first gear
W0 = 60.0  # rad/s of the output
PER_PASCAL = 1e-3  # N m/Pa
FULL = 1e6
SHAFT = "sensor.torque"


def run(*points: tuple[float, dict[str, float]], gear: str = "1", until: float = 3.0, **more: Any) -> cw.Trajectory:
    """The gearbox in a gear, with pressures or ramps of them from times [s] on."""
    d = cw.Driveline("two clutches")
    ratio = I1 if gear == "1" else I2
    engine = d.shaft("engine", inertia=J1, speed=ratio * W0)
    flange = d.shaft("flange", inertia=0.0)
    wheels = d.shaft("wheels", inertia=J2)
    lining = {"friction": cw.Coulomb(static=0.1, kinetic=0.1), "gain": PER_PASCAL / 0.1}
    shift = {"C1": dict(lining), "C2": dict(lining)}
    torque, load = more.pop("torque", T), more.pop("load", LOAD)
    if more.pop("heated", False):
        shift["C2"]["heat"] = d.thermal("plates", capacity=50.0, temperature=350.0)
    values = {"input": engine, "output": flange, "gear": gear, "inertia": 0.0, "shift": shift}
    d.add(cw.Transmission("gearbox", gearbox=BOX, **values))
    d.add(cw.TorqueSensor("sensor", base=flange, follower=wheels))
    d.add(cw.Torque("drive", shaft=engine, torque=torque))
    d.add(cw.Torque("load", shaft=wheels, torque=load))
    sim = cw.Simulator(d, rtol=1e-9)
    for time, pressures in points:
        sim.advance_to(time)
        sim.set({f"gearbox.{name}.pressure": value for name, value in pressures.items()})
    sim.advance_to(until)
    return sim.run


def ramp(name: str, begin: float, end: float, to: float, steps: int = 200) -> list[tuple[float, dict[str, float]]]:
    """A ramp from nothing as a stair that is right on average."""
    times = np.linspace(begin, end, steps + 1)
    middles = (np.arange(steps) + 0.5) / steps
    return [*((float(t), {name: float(to * x)}) for t, x in zip(times, middles, strict=False)), (end, {name: to})]


def quality(found: cw.Trajectory) -> cw.shifts.ShiftQuality:
    (one,) = cw.shifts.qualities(found, BOX, torque=SHAFT)
    return one


# second clutch ramps up to C within RAMP, then the first one opens at once
BEGIN, RAMP, C = 0.6, 0.2, 260.0
