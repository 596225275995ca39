"""A car around any gearbox of the catalogue, for tests of shifts: engine, converter, gearbox, axle, road."""

from __future__ import annotations

from typing import Any

import clutchwork as cw

RADIUS, MASS, FINAL_DRIVE, IDLE = 0.33, 1800.0, 3.2, 75.0  # m, kg, 1, rad/s
FULL_LOAD = ((0.0, 150.0), (100.0, 250.0), (180.0, 380.0), (500.0, 380.0), (650.0, 300.0), (720.0, 0.0))
MOTORING = ((0.0, -25.0), (700.0, -70.0))
SENSED = cw.shifts.Sensed(torque=("converter.turbine.torque",), throttle="combustion.throttle")
RIGID = cw.shifts.Sensed(torque=("combustion.torque", "combustion.drag.torque"), throttle="combustion.throttle")
SPEED = 200.0  # rad/s of the input in a drive
ENGINE: dict[str, Any] = {
    "full_load": FULL_LOAD, "motoring": MOTORING, "lag": 0.05, "idle_speed": IDLE, "idle_gain": 0.02,
    "idle_integral": 0.05, "idle_limit": 0.5, "initial_idle": 0.1,
}  # fmt: skip


def car(
    box: cw.Gearbox,
    gear: str,
    turbine: float = SPEED,
    throttle: float = 0.0,
    *,
    crank: cw.Node | None = None,
    **transmission: Any,
) -> cw.Driveline:
    """The car in a gear, its input at a speed [rad/s]; in neutral it stands. Parameters: crank, that of the engine."""
    d = cw.Driveline(f"{box.name} in {gear}")
    ratio = box.ratios.get(gear)
    turbine = turbine if ratio else 0.0
    turning = turbine / ratio if ratio else 0.0
    engine = d.add_node(crank or crankshaft(turbine))
    shaft = d.shaft("turbine", inertia=0.06, speed=turbine)
    output = d.shaft("output", inertia=0.02, speed=None if ratio else 0.0)
    d.add(cw.Engine("combustion", shaft=engine, throttle=throttle, **ENGINE))
    d.add(
        cw.TorqueConverter(
            "converter",
            impeller=engine,
            turbine=shaft,
            speed_ratio=(0.0, 0.4, 0.8, 0.9, 1.0),
            torque_ratio=(2.0, 1.58, 1.09, 1.0, 1.0),
            capacity=(7.0e-3, 6.5e-3, 4.4e-3, 2.9e-3, 0.0),
        )
    )
    values = {"inertia": 0.008, "torque": 600.0, **transmission}
    d.add(cw.Transmission("gearbox", gearbox=box, input=shaft, output=output, gear=gear if ratio else None, **values))
    _axle(d, output, turning)
    return d


def crankshaft(turbine: float) -> cw.Node:
    """Shaft of the engine where the turbine turns at a speed [rad/s]."""
    return cw.Node("engine", inertia=0.2, speed=max(IDLE, turbine))


def rigid(box: cw.Gearbox, gear: str, engine: float = IDLE, **transmission: Any) -> cw.Driveline:
    """The same without a converter: the engine drives the gearbox by a stiff shaft."""
    d = cw.Driveline(f"{box.name} in {gear}, no converter")
    ratio = box.ratios.get(gear)
    turning = engine / ratio if ratio else 0.0
    shaft = d.shaft("engine", inertia=0.25, speed=engine)
    output = d.shaft("output", inertia=0.02, speed=None if ratio else 0.0)
    d.add(cw.Engine("combustion", shaft=shaft, throttle=0.0, **ENGINE))
    values = {"inertia": 0.008, "torque": 450.0, **transmission}
    d.add(cw.Transmission("gearbox", gearbox=box, input=shaft, output=output, gear=gear if ratio else None, **values))
    _axle(d, output, turning)
    return d


def hydraulic(box: cw.Gearbox, gear: str, turbine: float = SPEED, *, pistons: bool = False) -> cw.Driveline:
    """The car whose elements are pressed by a valve and a piston each, or by a `PressureActuator`."""
    most = {name: max(one.torque, 0.1) * 900.0 for name, one in box.capacities().items()}
    closed, shift, parts = box.closed_in(gear), dict[str, dict[str, Any]](), list[Any]()
    for name in (element.name for element in box.elements):
        on = name in closed
        if pistons:
            filled = {"filled": on, "initial_pressure": 1e6 if on else 0.0}
            values = {"lag": 0.03, "fill_time": 0.1, "fill_pressure": 5e5, "spring": 5e4, **filled}
            parts.append(cw.PressureActuator(f"{name}_piston", command=1.05e6 if on else 0.0, **values))
            shift[name] = {"pressure": parts[-1]}
            continue
        table = ((0.0, 0.0), (0.1, 0.0), (1.0, 1e6))
        start = {"current": float(on), "initial_pressure": 1e6 if on else 0.0}
        valve = cw.PressureValve(f"{name}_valve", pressure=table, lag=0.015, **start)
        springs = {"preload": 300.0, "spring_rate": 1e5, "kiss_stroke": 2e-3, "contact_rate": 1e7}
        areas = {"orifice_area": 2.5e-6, "piston_area": 6e-3, "initial_stroke": 2.53e-3 if on else 0.0}
        piston = cw.ClutchActuator(f"{name}_piston", supply_pressure=valve, **springs, **areas)
        parts += [valve, piston]
        # the piston has 5.4 kN at 1 MPa
        shift[name] = {"normal_force": piston, "gain": most[name] / 0.13 / 5400.0}
    d = car(box, gear, turbine, shift=shift)
    for part in parts:
        d.add(part)
    return d


def with_valve_body(box: cw.Gearbox, gear: str, turbine: float = SPEED, **body: Any) -> cw.Driveline:
    """The car whose elements are pressed by a valve body: pump on the engine, line pressure, spool valves, pistons."""
    most = {name: max(one.torque, 0.1) * 900.0 for name, one in box.capacities().items()}
    names = [element.name for element in box.elements]
    closed = box.closed_in(gear)
    engine = crankshaft(turbine if box.ratios.get(gear) else 0.0)
    made = cw.ValveBody(
        "body",
        shaft=engine,
        piston_areas=dict.fromkeys(names, 6e-3),
        pressures=dict.fromkeys(closed, 1e6) or None,
        **body,
    )
    # a piston has 5.5 kN at 1 MPa
    shift = {name: {"normal_force": made.part(f"{name}_piston"), "gain": most[name] / 0.13 / 5500.0} for name in names}
    d = car(box, gear, turbine, crank=engine, shift=shift)
    d.add(made)
    return d


def _axle(d: cw.Driveline, output: Any, turning: float) -> None:
    """Final drive, half shafts, wheels that roll, brakes and road."""
    axle = d.shaft("axle", inertia=0.08)
    wheels = d.shaft("wheels", inertia=2.4)
    mass = d.mass("car", mass=MASS, speed=turning / FINAL_DRIVE * RADIUS)
    d.add(cw.Gear("final_drive", input=output, output=axle, ratio=FINAL_DRIVE))
    d.add(cw.SpringDamper("half_shafts", base=axle, follower=wheels, stiffness=1.8e4, damping=60.0))
    d.add(cw.RollingWheel("tyres", shaft=wheels, mass=mass, radius=RADIUS))
    d.add(cw.Brake("brakes", shaft=mass, friction=cw.Coulomb(static=1.0, kinetic=0.9), gain=14e3, normal_force=0.0))
    d.add(cw.Vehicle("road", mass=mass, drag_area=0.7, rolling_coefficient=0.011))


def survey(box: cw.Gearbox, shifts: Any = (), **more: Any) -> cw.shifts.Survey:
    """Shifts of that car."""
    return cw.shifts.survey(
        lambda gear: car(box, gear),
        box,
        shifts,
        sensed=SENSED,
        torque="half_shafts.torque",
        acceleration="car.acceleration",
        rtol=1e-6,
        **more,
    )
