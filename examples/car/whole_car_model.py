"""The car: engine, converter with lock-up, six-speed gearbox, shafts, differential, tyres, vehicle on a road."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import clutchwork as cw

CLUTCHES = ("F1", "F2", "F3", "F4", "F5", "F6")
# which clutches are closed in a gear: the first of the divider, the second of the base gearbox
GEARS = {1: ("F2", "F6"), 2: ("F1", "F6"), 3: ("F2", "F4"), 4: ("F1", "F4"), 5: ("F2", "F3"), 6: ("F1", "F3")}
# turbine speed over that of the output, by the teeth
RATIOS = {1: 4.5550, 2: 3.3500, 3: 2.4886, 4: 1.8302, 5: 1.3597, 6: 1.0}
# torque that a clutch holds in a gear over that of the turbine
HOLDS = {"F1": 1.0, "F2": 0.36, "F3": 1.36, "F4": 1.13, "F5": 3.2, "F6": 3.2}
# effective torque over pressure and coefficient [m3]: 6 to 8 surfaces each
GAIN = {"F1": 4.5e-3, "F2": 2.0e-3, "F3": 5.5e-3, "F4": 5.0e-3, "F5": 12e-3, "F6": 12e-3, "lock_up": 4.0e-3}
FULL = 1.2e6  # Pa
FINAL_DRIVE = 3.2
RADIUS = 0.31  # m
MASS = 1550.0  # kg

# full load and drag of the engine over its speed, rad/s and N m: 2.0 litres, turbocharged
FULL_LOAD = (
    *((0.0, 60.0), (80.0, 110.0), (150.0, 220.0), (200.0, 260.0), (420.0, 260.0), (520.0, 230.0), (620.0, 180.0)),
    *((680.0, 0.0),),
)
MOTORING = ((0.0, -18.0), (100.0, -20.0), (300.0, -28.0), (650.0, -48.0))
IDLE = 80.0  # rad/s

SPEED_RATIO = (0.0, 0.2, 0.4, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 1.0)
TORQUE_RATIO = (2.0, 1.8, 1.58, 1.34, 1.22, 1.09, 1.02, 1.0, 1.0, 1.0)
CAPACITY = (4.6e-3, 4.5e-3, 4.3e-3, 3.9e-3, 3.5e-3, 2.9e-3, 2.5e-3, 1.9e-3, 1.1e-3, 0.0)  # N m s2/rad2


@dataclass(frozen=True)
class Inputs:
    """What sets the car: signals, numbers or processes."""

    throttle: object  # 0 to 1
    brake: object  # share of 12 kN, 0 to 1
    pressures: Mapping[str, object]  # Pa, of the six clutches and of the lock-up clutch
    driver: cw.Driver | None = None  # who presses the pedals, where that is done in the core


def whole_car(
    driven: Callable[[cw.Node], Inputs], speed: float = 0.0, slope: object = 0.0, gear: int = 1
) -> cw.Driveline:
    """The car at a speed [m/s] in a gear, or at rest with its engine at idle.

    Parameters: driven, what sets it, from the mass of the car; slope, rise over way, or a `Road`.
    """
    d = cw.Driveline("whole car")
    inputs = driven(d.mass("car", mass=MASS, speed=speed))
    if inputs.driver is not None:
        d.add(inputs.driver)
    output = speed / RADIUS * FINAL_DRIVE
    turbine = output * RATIOS[gear]
    engine = d.shaft("engine", inertia=0.16, speed=max(IDLE, turbine))
    _gearbox(d, inputs, turbine, gear)
    _engine(d, engine, inputs)
    _converter(d, engine, inputs)
    _axle(d, inputs, speed, slope)
    return d


def _engine(d: cw.Driveline, shaft: cw.Node, inputs: Inputs) -> None:
    """Full load and drag over the speed, idle control, cut above 620 rad/s."""
    d.add(
        cw.Engine(
            "combustion",
            shaft=shaft,
            throttle=inputs.throttle,
            full_load=FULL_LOAD,
            motoring=MOTORING,
            lag=0.08,
            idle_speed=IDLE,
            idle_gain=0.02,
            idle_integral=0.05,
            idle_limit=0.5,
            initial_idle=0.15,
        )
    )


def _converter(d: cw.Driveline, engine: cw.Node, inputs: Inputs) -> None:
    """The converter, and its lock-up clutch beside it."""
    turbine = node(d, "w1")
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
    d.add(_clutch("lock_up", engine, turbine, inputs))


def _gearbox(d: cw.Driveline, inputs: Inputs, turbine: float, gear: int) -> None:
    """The six-speed gearbox of examples/six_speed, as heavy as that of a car."""
    inertias = {"w1": 0.05, "w2": 0.012, "w3": 0.006, "w4": 0.01, "w5": 0.008, "w6": 0.03, "w7": 0.02, "w8": 0.02}
    for name, inertia in inertias.items():
        d.shaft(name, inertia=inertia, speed=_start(gear, turbine).get(name))
    w = {name: node(d, name) for name in inertias}
    d.add(cw.Planetary("divider", sun=w["w3"], ring=w["w1"], carrier=w["w2"], ratio=2.78))
    d.add(cw.Planetary("row1", sun=w["w4"], ring=w["w5"], carrier=w["w6"], ratio=1.83))
    d.add(cw.Planetary("row2", sun=w["w4"], ring=w["w6"], carrier=w["w8"], ratio=2.35))
    d.add(cw.Planetary("row3", sun=w["w6"], ring=w["w7"], carrier=w["w8"], ratio=2.0))
    d.add(cw.SpringDamper("shaft", base=w["w2"], follower=w["w4"], stiffness=3e4, damping=12.0))
    ends = {
        "F1": ("w2", "w1"),
        "F2": ("", "w3"),
        "F3": ("w8", "w4"),
        "F4": ("", "w5"),
        "F5": ("", "w7"),
        "F6": ("", "w6"),
    }
    for name, (base, follower) in ends.items():
        d.add(_clutch(name, w.get(base, d.housing), w[follower], inputs))


def _start(gear: int, turbine: float) -> dict[str, float]:
    """Speeds that are free in a gear, of the others that follow from it."""
    output = turbine / RATIOS[gear]
    middle = output * {"F6": 3.35, "F4": 1.8302, "F3": 1.0}[GEARS[gear][1]]
    return {"w1": turbine, "w4": middle, "w2": middle}


def _clutch(name: str, base: cw.Node, follower: cw.Node, inputs: Inputs) -> cw.Component:
    """A wet clutch or brake: 0.15 at rest, a little less where it slips fast."""
    lining = cw.Exponential(static=0.15, slow=0.14, fast=0.115, speed=20.0)
    pressure = inputs.pressures[name]
    return cw.Clutch(name, base=base, follower=follower, friction=lining, gain=GAIN[name], pressure=pressure)


def _axle(d: cw.Driveline, inputs: Inputs, speed: float, slope: object) -> None:
    """Final drive, differential, half shafts, tyres, brakes, vehicle."""
    turning = speed / RADIUS
    pinion = node(d, "w8")
    carrier = d.shaft("carrier", inertia=0.03, speed=None)
    d.add(cw.Gear("final_drive", input=pinion, output=carrier, ratio=FINAL_DRIVE))
    car = node(d, "car")
    sides = {side: d.shaft(f"{side}_side", inertia=0.005, speed=turning) for side in ("left", "right")}
    d.add(cw.Differential("differential", carrier=carrier, left=sides["left"], right=sides["right"]))
    for side, stiffness in (("left", 9e3), ("right", 7e3)):
        wheel = d.shaft(f"{side}_wheel", inertia=0.9, speed=turning)
        d.add(cw.SpringDamper(f"{side}_shaft", base=sides[side], follower=wheel, stiffness=stiffness, damping=6.0))
        d.add(
            cw.Tyre(
                f"{side}_tyre",
                shaft=wheel,
                mass=car,
                radius=RADIUS,
                load=0.29 * MASS * 9.81,
                low_speed_damping=2000.0,
            )
        )
    # all four brakes as one force on the car
    d.add(
        cw.Brake(
            "brakes", shaft=car, friction=cw.Coulomb(static=1.0, kinetic=0.9), gain=12e3, normal_force=inputs.brake
        )
    )
    d.add(cw.Vehicle("road", mass=car, drag_area=0.66, rolling_coefficient=0.011, slope=slope))


def node(d: cw.Driveline, name: str) -> cw.Node:
    """A shaft of a driveline by name."""
    return next(one for one in d.nodes if one.name == name)
