"""Random drivelines of all parts, from a seed: a chain of shafts with gears, joints, fluid, play and clutches.

Three to seven shafts of 0.02 to 2 kg m2. What drives is a torque with a ripple, an engine or a motor; what loads is a
torque, a brake, a fan or a car on tyres. Each link is one of LINKS; every run has at least one clutch or brake whose
pressure comes and goes. The run lasts 1.5 s.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

import clutchwork as cw

T_END = 1.5
Rng = np.random.Generator
Link = Callable[[cw.Driveline, str, Any, Any, Rng], None]


def pressure(rng: Rng, size: float) -> cw.Table:
    """A load [N m] that comes and goes."""
    times = np.sort(rng.uniform(0.05, T_END - 0.1, 5))
    values = size * rng.uniform(0.2, 2.0, 5) * (rng.random(5) < 0.7)
    return cw.Table([(0.0, float(values[0])), *zip(map(float, times), map(float, values), strict=True)])


def lining(rng: Rng) -> Any:
    kinetic = float(rng.uniform(0.08, 0.15))
    static = kinetic * float(rng.choice([1.0, 1.1, 1.4]))
    return cw.Coulomb(static=static, kinetic=kinetic)


def clutch(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    d.add(cw.Clutch(name, base=a, follower=b, friction=lining(rng), gain=8.0, normal_force=pressure(rng, 100.0)))


def spring(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    stiffness = 10 ** float(rng.uniform(2, 4))
    d.add(
        cw.SpringDamper(name, base=a, follower=b, stiffness=stiffness, damping=stiffness * float(rng.uniform(0, 2e-3)))
    )


def gear(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    ratio = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.5, 4))
    d.add(cw.Gear(name, input=a, output=b, ratio=ratio))


def lossy_gear(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    ratio = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.5, 4))
    d.add(
        cw.LossyGear(
            name,
            input=a,
            output=b,
            ratio=ratio,
            efficiency=float(rng.uniform(0.5, 1.0)),
            backward_efficiency=float(rng.uniform(0.4, 1.0)),
            bearing_torque=float(rng.choice([0.0, rng.uniform(0, 5)])),
        )
    )


def worm(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    d.add(
        cw.WormGear(
            name,
            worm=a,
            wheel=b,
            ratio=float(rng.uniform(5, 20)),
            lead_angle=float(rng.uniform(0.05, 0.5)),
            friction_coefficient=float(rng.uniform(0.02, 0.12)),
        )
    )


def backlash(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    restitution = float(rng.choice([0.0, rng.uniform(0, 0.7)]))
    d.add(cw.Backlash(name, base=a, follower=b, gap=float(rng.uniform(0.01, 0.4)), restitution=restitution))


def elastic_backlash(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    stiffness = 10 ** float(rng.uniform(2, 4))
    d.add(
        cw.ElasticBacklash(
            name,
            base=a,
            follower=b,
            gap=float(rng.uniform(0.01, 0.4)),
            stiffness=stiffness,
            damping=stiffness * float(rng.uniform(0, 2e-3)),
        )
    )


def converter(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    k = float(rng.uniform(1e-3, 5e-3))
    d.add(
        cw.TorqueConverter(
            name,
            impeller=a,
            turbine=b,
            speed_ratio=(0.0, 0.4, 0.8, 0.9, 1.0),
            torque_ratio=(2.2, 1.6, 1.08, 1.0, 1.0),
            capacity=(k, 0.93 * k, 0.7 * k, 0.5 * k, 0.0),
            lag=float(rng.choice([0.0, 0.05])),
        )
    )
    if rng.random() < 0.5:
        clutch(d, f"{name} lock-up", a, b, rng)


def coupling(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    k = float(rng.uniform(1e-3, 5e-3))
    d.add(
        cw.FluidCoupling(name, base=a, follower=b, speed_ratio=(0.0, 0.8, 0.95, 1.0), capacity=(k, 0.9 * k, 0.5 * k, 0))
    )


def flexible(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    d.add(
        cw.FlexibleShaft(
            name,
            base=a,
            follower=b,
            stiffness=float(rng.uniform(1e3, 2e4)),
            inertia=float(rng.uniform(0.01, 0.1)),
            segments=int(rng.integers(1, 5)),
            damping_time=1e-4,
        )
    )


def damper(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    d.add(
        cw.TorsionalDamper(
            name,
            base=a,
            follower=b,
            torque=[(-0.7, -500.0), (-0.5, -150.0), (0.5, 150.0), (0.7, 500.0)],
            friction_limit=[float(rng.uniform(1, 20))],
            friction_stiffness=[float(rng.uniform(200, 2000))],
            friction_load=[float(rng.choice([0.0, 0.05]))],
        )
    )


def ratio(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    low, high = np.sort(rng.uniform(0.4, 4, 2))
    t = float(rng.uniform(0.1, 0.7))
    table = cw.Table([(0.0, float(high)), (t, float(high)), (t + 0.5, float(low))])
    capacity = {"capacity": float(rng.uniform(20, 300))} if rng.random() < 0.5 else {}
    d.add(cw.VariableRatio(name, input=a, output=b, ratio=table, **capacity))


def joint(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    d.add(
        cw.UniversalJoint(
            name, base=a, follower=b, bend_angle=float(rng.uniform(0.05, 0.6)), phase=float(rng.uniform(0, 3))
        )
    )


def belt(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    d.add(
        cw.BeltDrive(
            name,
            base=a,
            follower=b,
            radius_base=float(rng.uniform(0.04, 0.1)),
            radius_follower=float(rng.uniform(0.04, 0.1)),
            centre_distance=0.35,
            friction_coefficient=0.35,
            groove_angle=0.66,
            preload=float(rng.uniform(100, 1500)),
            mass_per_length=float(rng.choice([0.0, 0.15])),
        )
    )


def freewheel(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    d.add(cw.OneWayClutch(name, base=a, follower=b))


def planetary(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    """From the sun to the carrier; the ring is braked."""
    ring = d.shaft(f"{name} ring", inertia=0.05)
    if rng.random() < 0.5:
        d.add(cw.Planetary(name, sun=a, ring=ring, carrier=b, ratio=2.5))
    else:
        d.add(
            cw.LossyPlanetary(
                name, sun=a, ring=ring, carrier=b, teeth_sun=30, teeth_ring=78, efficiency=float(rng.uniform(0.9, 1))
            )
        )
    brake(d, f"{name} brake", ring, rng)


def differential(d: cw.Driveline, name: str, a: Any, b: Any, rng: Rng) -> None:
    """To the next shaft, and to another one with a load of its own."""
    other = d.shaft(f"{name} other", inertia=float(rng.uniform(0.1, 1)))
    how: dict[str, Any] = {}
    if rng.random() < 0.6:
        how = {"bias": float(rng.uniform(1.2, 4)), "preload": float(rng.choice([0.0, 20.0]))}
    d.add(cw.Differential(name, carrier=a, left=b, right=other, **how))
    d.add(cw.Damper(f"{name} drag", base=d.housing, follower=other, damping=float(rng.uniform(0.1, 5))))


def brake(d: cw.Driveline, name: str, shaft: Any, rng: Rng) -> None:
    d.add(cw.Brake(name, shaft=shaft, friction=lining(rng), gain=8.0, normal_force=pressure(rng, 100.0)))


LINKS: dict[str, Link] = {
    "clutch": clutch,
    "spring": spring,
    "gear": gear,
    "lossy gear": lossy_gear,
    "worm": worm,
    "backlash": backlash,
    "elastic backlash": elastic_backlash,
    "converter": converter,
    "coupling": coupling,
    "flexible": flexible,
    "damper": damper,
    "ratio": ratio,
    "joint": joint,
    "belt": belt,
    "freewheel": freewheel,
    "planetary": planetary,
    "differential": differential,
}


def drive(d: cw.Driveline, shaft: Any, rng: Rng) -> None:
    kind = rng.integers(3)
    size = float(rng.uniform(30, 200))
    if kind == 0:
        signal = cw.Sine(amplitude=size * float(rng.uniform(0, 1.5)), frequency=float(rng.uniform(0.5, 8)), offset=size)
        d.add(cw.Torque("drive", shaft=shaft, torque=signal))
    elif kind == 1:
        d.add(
            cw.Engine(
                "drive",
                shaft=shaft,
                throttle=cw.Table([(0.0, 0.3), (0.5, 1.0), (1.0, 0.0)]),
                full_load=[(80.0, size), (200.0, 1.5 * size), (600.0, size)],
                motoring=[(0.0, -18.0), (600.0, -55.0)],
                lag=float(rng.choice([0.0, 0.08])),
                idle_speed=85.0,
                idle_gain=0.01,
                idle_integral=0.03,
                max_speed=600.0,
                limit_band=30.0,
            )
        )
    else:
        d.add(
            cw.ElectricMotor(
                "drive",
                shaft=shaft,
                command=cw.Table([(0.0, size), (0.7, size), (0.7, -size)]),
                lag=float(rng.choice([0.0, 0.02])),
                max_torque=[(0.0, size), (400.0, 0.8 * size)],
                max_power=100.0 * size,
                drag_loss=0.5,
                copper_loss=0.05,
            )
        )


def load(d: cw.Driveline, shaft: Any, rng: Rng) -> None:
    kind = rng.integers(6)
    size = float(rng.uniform(10, 100))
    if kind == 0:
        d.add(cw.ResistingTorque("load", shaft=shaft, torque=size, speed=1.0))
    elif kind == 1:
        d.add(cw.QuadraticTorque("load", shaft=shaft, nominal_torque=-size, nominal_speed=100.0))
    elif kind == 2:
        law = cw.Coulomb(static=1.2, kinetic=1.0)
        d.add(cw.BearingFriction("load", shaft=shaft, torque=size, friction=law))
    elif kind == 3:
        command = cw.Step(height=1.0, start=0.3)
        d.add(cw.Retarder("load", shaft=shaft, capacity=0.02, max_torque=size, max_power=5e3, command=command, lag=0.1))
    else:
        car = d.mass("car", mass=float(rng.uniform(200, 1500)), speed=float(rng.choice([0.0, 10.0])))
        if kind == 4:
            tyre = {"low_speed_damping": 2000.0}
            d.add(cw.Tyre("tyre", shaft=shaft, mass=car, radius=0.3, load=5000.0, **tyre))
        else:
            law = cw.Coulomb(static=0.9, kinetic=0.75)
            d.add(cw.RollingContact("tyre", shaft=shaft, mass=car, radius=0.3, friction=law, load=5000.0))
        d.add(cw.Vehicle("road", mass=car, drag_area=0.65, slope=float(rng.choice([0.0, 0.08]))))


def links(seed: int, *, with_gear: bool = False) -> list[str]:
    """Names of the links of a driveline, from the drive to the load."""
    rng = np.random.default_rng([seed, 1])
    chosen = [str(x) for x in rng.choice(list(LINKS), int(rng.integers(2, 7)))]
    at, other = rng.permutation(len(chosen))[:2]
    chosen[at] = "clutch"
    if with_gear:
        chosen[other] = "gear"
    return chosen


def driveline(seed: int, *, with_gear: bool = False) -> cw.Driveline:
    """The driveline of a seed; `with_gear`: at least one of its links is a gear."""
    rng = np.random.default_rng([seed, 2])
    d = cw.Driveline(f"parts {seed}")
    chosen = links(seed, with_gear=with_gear)
    shafts = []
    for i in range(len(chosen) + 1):
        inertia = 10 ** float(rng.uniform(math.log10(0.02), math.log10(2)))
        shafts.append(d.shaft(f"s{i}", inertia=inertia))
    for i, name in enumerate(chosen):
        LINKS[name](d, f"{name} {i}", shafts[i], shafts[i + 1], rng)
    drive(d, shafts[0], rng)
    load(d, shafts[-1], rng)
    if rng.random() < 0.4:
        brake(d, "brake", shafts[int(rng.integers(len(shafts)))], rng)
    return d
