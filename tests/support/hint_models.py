"""For each rule a model that it speaks of, and the same model corrected."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import clutchwork as cw

COULOMB = cw.Coulomb(static=0.35, kinetic=0.3)


class Case(NamedTuple):
    """A model as it should not be and as it should be; both run for `t_end` [s]."""

    wrong: Callable[[], cw.Driveline]
    right: Callable[[], cw.Driveline]
    t_end: float


def launch(
    capacity: float, load: object = 1.0, sign: float = 1.0, size: float = 1.0, turned: bool = False
) -> cw.Driveline:
    """Engine of 0.2 kg m2 at 100 rad/s with 100 N m, load of 1 kg m2 with -80 N m; clutch of a kinetic capacity [N m].

    `sign` mirrors speeds and torques, `size` multiplies inertias and torques alike, `turned` adds all in other order.
    """
    d = cw.Driveline("launch")
    makers = [
        lambda: d.shaft("engine", inertia=0.2 * size, speed=100.0 * sign),
        lambda: d.shaft("load", inertia=1.0 * size),
    ]
    engine, follower = [make() for make in makers] if not turned else [make() for make in makers[::-1]][::-1]
    parts = [
        cw.Torque("drive", shaft=engine, torque=100.0 * sign * size),
        cw.Torque("road", shaft=follower, torque=-80.0 * sign * size),
        cw.Clutch("c", base=engine, follower=follower, friction=COULOMB, gain=capacity * size / 0.3, normal_force=load),
    ]
    for part in parts[::-1] if turned else parts:
        d.add(part)
    return d


def hill(force: float) -> cw.Driveline:
    """A brake of 0.3 N m per N, pulled with a force [N] from 0.1 to 0.2 s on, that shall hold 100 N m."""
    d = cw.Driveline("hill")
    wheel = d.shaft("wheel", inertia=2.0)
    d.add(cw.Torque("slope", shaft=wheel, torque=100.0))
    pull = cw.Table([(0.1, 0.0), (0.2, force)])
    d.add(cw.Brake("hand_brake", shaft=wheel, friction=COULOMB, gain=1.0, normal_force=pull))
    return d


def shift(close: float, load: float = -200.0) -> cw.Driveline:
    """Two clutches over ratios of 4 and 2.5: the first opens from 0.8 to 0.9 s, the second closes from `close` on."""
    d = cw.Driveline("shift")
    engine, output = d.shaft("engine", inertia=0.2, speed=200.0), d.shaft("output", inertia=20.0, speed=50.0)
    hubs = [d.shaft(f"hub{k}", inertia=0.02) for k in (1, 2)]
    d.add(cw.Torque("drive", shaft=engine, torque=100.0))
    for hub, ratio in zip(hubs, (4.0, 2.5), strict=True):
        d.add(cw.Gear(f"gear_{hub.name}", input=hub, output=output, ratio=ratio))
    loads = ([(0.8, 1.0), (0.9, 0.0)], [(close, 0.0), (close + 0.1, 1.0)])
    for hub, points in zip(hubs, loads, strict=True):
        name = hub.name.replace("hub", "c")
        d.add(
            cw.Clutch(
                name, base=engine, follower=hub, friction=COULOMB, gain=1000.0, normal_force=cw.Table(list(points))
            )
        )
    d.add(cw.Torque("road", shaft=output, torque=load))
    return d


def held(torque: float) -> cw.Driveline:
    """A brake of 70 N m static that is said to hold a shaft against a torque [N m]."""
    d = cw.Driveline("held")
    shaft = d.shaft("shaft", inertia=0.5)
    d.add(cw.Torque("pull", shaft=shaft, torque=torque))
    d.add(cw.Brake("b", shaft=shaft, friction=COULOMB, gain=200.0, normal_force=1.0, locked=True))
    return d


def neutral(damping: float) -> cw.Driveline:
    """A drum between two clutches that open at 0.5 and 0.6 s; the drag of its bearing [N m s/rad]."""
    d = cw.Driveline("neutral")
    engine, drum, load = (d.shaft(name, inertia=0.5, speed=80.0) for name in ("engine", "drum", "load"))
    for name, base, follower, open_at in (("c1", engine, drum, 0.5), ("c2", drum, load, 0.6)):
        pressed = cw.Table([(open_at, 1.0), (open_at + 0.01, 0.0)])
        d.add(cw.Clutch(name, base=base, follower=follower, friction=COULOMB, gain=500.0, normal_force=pressed))
    d.add(cw.Damper("mount", base=d.housing, follower=engine, damping=0.1))
    d.add(cw.Damper("road", base=d.housing, follower=load, damping=0.1))
    if damping:
        d.add(cw.Damper("bearing", base=d.housing, follower=drum, damping=damping))
    return d


def ringing(damping: float) -> cw.Driveline:
    """Two wheels of 0.2 and 0.1 kg m2 on a shaft of 1e6 N m/rad, 616 Hz, that a clutch loads from 0.5 s on."""
    d = cw.Driveline("ringing")
    a, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("b", inertia=0.1, speed=100.0)
    load = d.shaft("load", inertia=1.0)
    d.add(cw.SpringDamper("stub", base=a, follower=b, stiffness=1e6, damping=damping))
    d.add(cw.Torque("drive", shaft=a, torque=100.0))
    d.add(cw.Damper("road", base=d.housing, follower=load, damping=2.0))
    pressed = cw.Table([(0.5, 0.0), (0.51, 1.0)])
    d.add(cw.Clutch("c", base=b, follower=load, friction=COULOMB, gain=500.0, normal_force=pressed))
    return d


def belted(preload: float) -> cw.Driveline:
    """A belt drive at 30 m/s, whose belt needs 450 N to stay on its pulleys."""
    d = cw.Driveline("belt")
    motor, fan = d.shaft("motor", inertia=0.1, speed=300.0), d.shaft("fan", inertia=0.1, speed=300.0)
    pulleys = {"radius_base": 0.1, "radius_follower": 0.1, "centre_distance": 0.5}
    belt = cw.BeltDrive(
        "belt", base=motor, follower=fan, friction_coefficient=0.3, preload=preload, mass_per_length=0.5, **pulleys
    )
    d.add(belt)
    return d


def warm(last: float, friction: cw.Law | None = None, capacity: float = 200.0) -> cw.Driveline:
    """A clutch that slips with 15 N m at 100 rad/s for 30 s into a mass [J/K]; its table ends at a temperature [K]."""
    d = cw.Driveline("warm")
    drive, out = d.shaft("drive", inertia=1.0), d.shaft("out", inertia=1.0)
    d.add(cw.PrescribedSpeed("fast", shaft=drive, speed=100.0))
    d.add(cw.PrescribedSpeed("still", shaft=out, speed=0.0))
    plates = d.thermal("plates", capacity=capacity, temperature=300.0)
    table = cw.TemperatureTable(static=((300.0, 0.35), (last, 0.35)), kinetic=((300.0, 0.3), (last, 0.3)))
    d.add(
        cw.Clutch("c", base=drive, follower=out, friction=friction or table, gain=50.0, normal_force=1.0, heat=plates)
    )
    return d


def racing(last: float, gain: float = 1.0) -> cw.Driveline:
    """An engine of 100 N m at 0 to the last speed [rad/s] of its table, which turns 0.5 kg m2 from 100 rad/s on."""
    d = cw.Driveline("racing")
    shaft = d.shaft("engine", inertia=0.5, speed=100.0)
    d.add(cw.SpeedTorque("ice", shaft=shaft, torque=[(0.0, 100.0), (last, 100.0)], gain=gain))
    return d


def juddering(damping: float) -> cw.Driveline:
    """A clutch that slips with 50 rad/s, where its torque falls by 0.4852 N m s/rad, on a spring with a damping."""
    d = cw.Driveline("judder")
    engine, hub = d.shaft("engine", inertia=0.2), d.shaft("hub", inertia=0.05, speed=100.0)
    vehicle = d.shaft("vehicle", inertia=3.0)
    d.add(cw.PrescribedSpeed("pace", shaft=engine, speed=150.0))
    d.add(cw.PrescribedSpeed("road", shaft=vehicle, speed=100.0))
    # the spring carries the friction from the start, but for a tenth
    twist = -0.9 * 800.0 * (0.2 + 0.1 * float(np.exp(-0.5))) / 2000.0
    d.add(cw.SpringDamper("k", base=hub, follower=vehicle, stiffness=2000.0, damping=damping, initial_twist=twist))
    law = cw.Stribeck(static=0.3, kinetic=0.2, speed=100.0, shape="tustin")
    d.add(cw.Clutch("c", base=engine, follower=hub, friction=law, gain=800.0, normal_force=1.0))
    return d


def dog(speed: float) -> cw.Driveline:
    """A dog clutch in mesh, whose base turns with a speed [rad/s] at the start."""
    d = cw.Driveline("dog")
    base, follower = d.shaft("base", inertia=1.0, speed=speed), d.shaft("follower", inertia=1.0)
    d.add(
        cw.DogClutch("dog", base=base, follower=follower, teeth=24, gap=0.02, stiffness=1e5, command=1.0, engaged=True)
    )
    return d


def lonely(joined: bool) -> cw.Driveline:
    """A flywheel that is joined to the rest, or to nothing."""
    d = cw.Driveline("lonely")
    shaft, flywheel = d.shaft("shaft", inertia=1.0), d.shaft("flywheel", inertia=2.0)
    d.add(cw.Torque("drive", shaft=shaft, torque=1.0))
    if joined:
        d.add(cw.Gear("gear", input=shaft, output=flywheel, ratio=2.0))
    return d


def parallel(gears: int) -> cw.Driveline:
    """Gears of one ratio between the same shafts."""
    d = cw.Driveline("parallel")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    for k in range(gears):
        d.add(cw.Gear(f"g{k}", input=a, output=b, ratio=2.0))
    d.add(cw.Torque("drive", shaft=a, torque=1.0))
    return d


def coasting(**carrier: float) -> cw.Driveline:
    """A planetary set whose sun turns, with a speed of its carrier or without."""
    d = cw.Driveline("coasting")
    sun, ring = d.shaft("sun", inertia=0.1, speed=100.0), d.shaft("ring", inertia=0.2)
    d.add(cw.Planetary("set", sun=sun, carrier=d.shaft("carrier", inertia=0.2, **carrier), ring=ring, ratio=3.0))
    return d


CRITICAL = 2.0 * float(np.sqrt(1e6 / 15.0))  # N m s/rad, of the shaft of `ringing`


def towed(speed: float) -> cw.Driveline:
    """A converter whose wheels are pulled along."""
    d = cw.Driveline("towed")
    engine, turbine = d.shaft("engine", inertia=0.2, speed=speed), d.shaft("turbine", inertia=1.0, speed=0.5 * speed)
    tables = {"speed_ratio": (0.0, 1.0), "torque_ratio": (2.0, 1.0), "capacity": (1e-3, 0.0)}
    d.add(cw.TorqueConverter("converter", impeller=engine, turbine=turbine, **tables))
    return d


def pumped(*, relief: bool = True, swapped: bool = False, filter_area: float = 1e-4) -> cw.Driveline:
    """A pump with a filter before it, a line with a way valve behind it."""
    d = cw.Driveline("pumped")
    shaft = d.shaft("shaft", inertia=0.1, speed=150.0)
    d.add(cw.PrescribedSpeed("motor", shaft=shaft, speed=150.0))
    suction, line, port = (d.add(cw.OilVolume(name, volume=1e-4)) for name in ("suction", "line", "port"))
    d.add(cw.Orifice("filter", inlet=0.0, outlet=suction, area=filter_area))
    d.add(cw.Pump("pump", shaft=shaft, inlet=suction, outlet=line, displacement=2e-5))
    ports = {"supply": port, "clutch": line} if swapped else {"supply": line, "clutch": port}
    d.add(cw.SpoolValve("valve", **ports, command=4e5, supply_area=1e-5, exhaust_area=1e-5, span=2e4))
    if relief:
        d.add(cw.ReliefValve("relief", inlet=line, command=1.5e6, area=6e-5))
    return d


CASES: dict[str, Case] = {
    "no relief valve": Case(lambda: pumped(relief=False), pumped, 0.05),
    "ports swapped": Case(lambda: pumped(swapped=True), pumped, 0.05),
    "starved pump": Case(lambda: pumped(filter_area=2e-5), pumped, 0.3),
    "unknown there": Case(lambda: towed(-20.0), lambda: towed(20.0), 0.2),
    "never locks": Case(lambda: launch(60.0), lambda: launch(150.0), 2.0),
    "lifts off": Case(lambda: belted(300.0), lambda: belted(900.0), 1.0),
    "full and slips": Case(lambda: hill(250.0), lambda: hill(500.0), 2.0),
    "tie-up": Case(lambda: shift(0.5), lambda: shift(0.87), 3.0),
    "breaks away at the start": Case(lambda: held(80.0), lambda: held(60.0), 1.0),
    "turns freely": Case(lambda: neutral(0.0), lambda: neutral(0.01), 2.0),
    "stiff": Case(lambda: ringing(0.0), lambda: ringing(CRITICAL), 2.0),
    "outside its table": Case(lambda: warm(400.0), lambda: warm(700.0), 30.0),
    "too hot": Case(lambda: warm(900.0, capacity=80.0), lambda: warm(900.0), 30.0),
    "judder": Case(lambda: juddering(0.1), lambda: juddering(0.6), 4.0),
    "too fast to mesh": Case(lambda: dog(10.0), lambda: dog(2.0), 0.1),
    "joined to nothing": Case(lambda: lonely(False), lambda: lonely(True), 0.1),
    "start left open": Case(coasting, lambda: coasting(speed=25.0), 0.1),
    "redundant gear": Case(lambda: parallel(2), lambda: parallel(1), 0.1),
}
