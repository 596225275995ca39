"""A car with an automatic gearbox of the catalogue: engine, converter with lock-up, gearbox, axle, tyres, road."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import clutchwork as cw

RADIUS = 0.33  # m
MASS = 1900.0  # kg
FINAL_DRIVE = 3.15
IDLE = 75.0  # rad/s
# most torque at the turbine for which shift elements are sized: engine times converter [N m]
RATED = 700.0

# full load and drag of the engine over its speed, rad/s and N m: 3.0 litres, turbocharged
FULL_LOAD = (
    *((0.0, 100.0), (80.0, 180.0), (140.0, 380.0), (180.0, 450.0), (480.0, 450.0), (600.0, 390.0), (680.0, 250.0)),
    *((720.0, 0.0),),
)
MOTORING = ((0.0, -25.0), (100.0, -28.0), (300.0, -38.0), (700.0, -70.0))

SPEED_RATIO = (0.0, 0.2, 0.4, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 1.0)
TORQUE_RATIO = (2.0, 1.8, 1.58, 1.34, 1.22, 1.09, 1.02, 1.0, 1.0, 1.0)
CAPACITY = (7.0e-3, 6.8e-3, 6.5e-3, 5.9e-3, 5.3e-3, 4.4e-3, 3.8e-3, 2.9e-3, 1.7e-3, 0.0)  # N m s2/rad2

# signals whose sum is the torque at the input of the gearbox
TURBINE = ("converter.turbine.torque", "lock_up.torque")


def car(
    box: cw.Gearbox,
    gear: str,
    speed: float = 0.0,
    throttle: float = 0.0,
    shift: Mapping[str, Mapping[str, Any]] | None = None,
    crank: cw.Node | None = None,
) -> cw.Driveline:
    """The car in a gear at a speed [m/s], its lock-up clutch open; shift, fields of shift elements by name.

    Parameters: crank, that of the engine where something else needs it too, `crankshaft` by default.
    """
    d = cw.Driveline(f"car with {box.title or box.name}")
    turning = speed / RADIUS * FINAL_DRIVE
    # in neutral the turbine goes with the engine
    ratio = box.ratios.get(gear)
    turbine = turning * ratio if ratio else IDLE
    engine = d.add_node(crank or crankshaft(box, gear, speed))
    shaft = d.shaft("turbine", inertia=0.06, speed=turbine)
    output = d.shaft("output", inertia=0.02, speed=None if ratio else turning)
    _engine(d, engine, shaft, throttle)
    ends = {"gearbox": box, "input": shaft, "output": output, "gear": gear}
    d.add(cw.Transmission("gearbox", **ends, inertia=0.008, torque=RATED, shift=shift))
    _axle(d, output, speed)
    return d


def crankshaft(box: cw.Gearbox, gear: str, speed: float) -> cw.Node:
    """The shaft of the engine with the car in a gear at a speed [m/s]."""
    turbine = speed / RADIUS * FINAL_DRIVE * box.ratios.get(gear, 0.0)
    return cw.Node("engine", inertia=0.18, speed=max(IDLE, turbine))


def _engine(d: cw.Driveline, engine: cw.Node, turbine: cw.Node, throttle: float) -> None:
    """Engine with idle control, converter, and the lock-up clutch beside it."""
    d.add(
        cw.Engine(
            "combustion",
            shaft=engine,
            throttle=throttle,
            full_load=FULL_LOAD,
            motoring=MOTORING,
            lag=0.06,
            idle_speed=IDLE,
            idle_gain=0.02,
            idle_integral=0.05,
            idle_limit=0.5,
            initial_idle=0.12,
        )
    )
    d.add(
        cw.TorqueConverter(
            "converter",
            impeller=engine,
            turbine=turbine,
            speed_ratio=SPEED_RATIO,
            torque_ratio=TORQUE_RATIO,
            capacity=CAPACITY,
        )
    )
    lining = cw.Coulomb(static=0.13, kinetic=0.12)
    d.add(cw.Clutch("lock_up", base=engine, follower=turbine, friction=lining, gain=6e-3, pressure=0.0))


def _axle(d: cw.Driveline, output: cw.Node, speed: float) -> None:
    """Final drive, both half shafts as one, tyres, brakes, vehicle."""
    turning = speed / RADIUS
    axle = d.shaft("axle", inertia=0.08)
    wheels = d.shaft("wheels", inertia=2.4, speed=turning)
    mass = d.mass("car", mass=MASS, speed=speed)
    d.add(cw.Gear("final_drive", input=output, output=axle, ratio=FINAL_DRIVE))
    d.add(cw.SpringDamper("half_shafts", base=axle, follower=wheels, stiffness=1.8e4, damping=60.0))
    load = 0.55 * MASS * 9.81
    d.add(cw.Tyre("tyres", shaft=wheels, mass=mass, radius=RADIUS, load=load, low_speed_damping=4000.0))
    full = cw.Coulomb(static=1.0, kinetic=0.9)
    d.add(cw.Brake("brakes", shaft=mass, friction=full, gain=14e3, normal_force=0.0))
    d.add(cw.Vehicle("road", mass=mass, drag_area=0.7, rolling_coefficient=0.011))
