"""Small drivelines of what derivatives have found hard, with every way to ask for values and derivatives.

Lossy gears under loads that turn round in steps, plays, engines that stall, converters, claws, actuators that fill,
planetary sets in gear, linings that heat up; outputs are those that look into steps too.

    PYTHONPATH=tests python -m support.hard_gradients --models 100 --seed 0
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.sweeps.outputs import asked
from support import by_differences, free_numbers
from support.any_model.gradients import arguments
from support.compared_gradients import Tally, compared, summed, told

Rng = np.random.Generator


def friction(rng: Rng) -> cw.Law:
    """Any of three laws."""
    laws = (
        cw.Coulomb(static=0.13, kinetic=0.1),
        cw.Stribeck(static=0.14, kinetic=0.1, speed=float(rng.uniform(3.0, 15.0))),
        cw.Exponential(static=0.12, slow=0.11, fast=0.09, speed=10.0),
    )
    return laws[rng.integers(3)]


def load(rng: Rng, size: float, t_end: float) -> Any:
    """A torque that turns round: in a step, in a table that jumps, slowly, again and again."""
    at = float(rng.uniform(0.2, 0.7) * t_end)
    return (
        cw.Step(height=-2.0 * size * rng.uniform(0.6, 1.4), start=at, offset=size),
        cw.Table([(0.0, size), (at, size), (at, -size * rng.uniform(0.3, 1.0)), (t_end, size * 0.3)]),
        cw.Table([(0.0, 0.0), (at, size), (t_end, -size)]),
        cw.Sine(amplitude=size, frequency=rng.uniform(1.0, 6.0) / t_end, offset=size * rng.uniform(-0.5, 0.5)),
    )[rng.integers(4)]


def _drag(d: cw.Driveline, shaft: Any, torque: float) -> None:
    d.add(cw.QuadraticTorque("drag", shaft=shaft, nominal_torque=-torque, nominal_speed=50.0))


def lossy(rng: Rng, d: cw.Driveline, t_end: float) -> None:
    """Gears with losses, one behind the other."""
    e, w = d.shaft("e", inertia=rng.uniform(0.05, 0.4), speed=rng.uniform(20, 120)), d.shaft("w", inertia=2.0)
    loss = {"efficiency": rng.uniform(0.85, 0.97), "backward_efficiency": rng.uniform(0.5, 0.95)}
    d.add(cw.LossyGear("g", input=e, output=w, ratio=rng.uniform(1.5, 4.0), **loss))
    d.add(cw.Torque("t", shaft=e, torque=load(rng, 60.0, t_end)))
    _drag(d, w, 30.0)
    if rng.random() < 0.5:
        v = d.shaft("v", inertia=1.0)
        d.add(cw.SpringDamper("k", base=w, follower=v, stiffness=rng.uniform(300, 3000), damping=2.0))
        if rng.random() < 0.5:
            d.add(cw.LossyGear("h", input=v, output=d.shaft("x", inertia=0.5), ratio=2.0, **loss))


def play(rng: Rng, d: cw.Driveline, t_end: float) -> None:
    """A play, rigid or elastic."""
    a, b = d.shaft("a", inertia=rng.uniform(0.1, 0.5), speed=rng.uniform(0, 6)), d.shaft("b", inertia=0.8)
    gap = rng.uniform(0.02, 0.2)
    if rng.random() < 0.5:
        d.add(cw.Backlash("k", base=a, follower=b, gap=gap, restitution=rng.uniform(0.0, 0.7)))
    else:
        d.add(cw.ElasticBacklash("k", base=a, follower=b, stiffness=900.0, damping=rng.uniform(0.5, 5.0), gap=gap))
    d.add(cw.Torque("t", shaft=a, torque=load(rng, 10.0, t_end)))
    d.add(cw.Damper("r", base=b, follower=d.housing, damping=rng.uniform(0.1, 0.6)))


def engine(rng: Rng, d: cw.Driveline, t_end: float) -> None:
    """An engine that a clutch may stall."""
    e, w = d.shaft("e", inertia=rng.uniform(0.1, 0.4), speed=rng.uniform(70, 150)), d.shaft("w", inertia=1.0)
    throttle = cw.Table([(0.0, 0.2), (t_end / 2, rng.uniform(0.4, 0.9)), (t_end, 0.1)])
    full = ((0.0, 100.0), (150.0, 140.0), (300.0, 150.0), (500.0, 90.0))
    idle = {"idle_speed": 80.0, "idle_gain": 0.01} if rng.random() < 0.5 else {}
    more = {"lag": float(rng.choice([0.0, 0.05])), "max_speed": float(rng.choice([160.0, 400.0])), **idle}
    drag = ((0.0, -10.0), (500.0, -40.0))
    stall = rng.uniform(40, 75)
    d.add(cw.Engine("eng", shaft=e, throttle=throttle, full_load=full, motoring=drag, stall_speed=stall, **more))
    pressure = cw.Table([(0.0, 0.0), (0.2 * t_end, rng.uniform(1e5, 3e5)), (t_end, 2e5)])
    d.add(cw.Clutch("c", base=e, follower=w, friction=friction(rng), gain=5e-4, pressure=pressure))
    _drag(d, w, 60.0)


def converter(rng: Rng, d: cw.Driveline, t_end: float) -> None:
    """A torque converter."""
    e, t, w = (d.shaft(n, inertia=i, speed=v) for n, i, v in (("e", 0.2, 120.0), ("tu", 0.05, 40.0), ("w", 2.0, 40.0)))
    table = {"speed_ratio": (0.0, 0.4, 0.8, 1.0), "torque_ratio": (2.0, 1.6, 1.0, 1.0)}
    lag = {"lag": 0.02} if rng.random() < 0.3 else {}
    d.add(cw.TorqueConverter("tc", impeller=e, turbine=t, capacity=(6e-3, 6.5e-3, 4e-3, 0.0), **table, **lag))
    d.add(cw.Torque("t", shaft=e, torque=load(rng, rng.uniform(40.0, 120.0), t_end)))
    d.add(cw.SpringDamper("k", base=t, follower=w, stiffness=rng.uniform(500, 3000), damping=3.0))
    _drag(d, w, 60.0)


def claw(rng: Rng, d: cw.Driveline, t_end: float) -> None:
    """Claws that meet and mesh."""
    b_speed = rng.uniform(5, 12)
    a = d.shaft("a", inertia=rng.uniform(0.05, 0.3), speed=b_speed + rng.uniform(-6, 6))
    b = d.shaft("b", inertia=rng.uniform(0.5, 2.0), speed=b_speed)
    command = cw.Step(height=1.0, start=0.2 * t_end)
    d.add(cw.DogClutch("dog", base=a, follower=b, teeth=12, gap=0.05, stiffness=3e4, command=command, lag=0.02))
    d.add(cw.Torque("t", shaft=a, torque=load(rng, 6.0, t_end)))
    d.add(cw.Damper("r", base=b, follower=d.housing, damping=rng.uniform(0.1, 0.6)))


def actuator(rng: Rng, d: cw.Driveline, t_end: float) -> None:
    """A piston that fills, and limits how fast its pressure rises."""
    a, b = d.shaft("a", inertia=rng.uniform(0.2, 0.6), speed=rng.uniform(40, 120)), d.shaft("b", inertia=0.8)
    at = float(rng.uniform(0.1, 0.3) * t_end)
    table = cw.Table([(0.0, 0.0), (at, 0.0), (at, 3e5), (t_end, rng.uniform(2e5, 5e5))])
    command = table if rng.random() < 0.7 else cw.Step(height=4e5, start=at)
    limits = {"rise": 4e6, "fall": 6e6} if rng.random() < 0.5 else {}
    fills = {"fill_time": rng.uniform(0.02, 0.1), "spring": 2e4, "lag": rng.uniform(0.01, 0.05)}
    p = cw.PressureActuator("p", command=command, **fills, **limits)
    d.add(p)
    d.add(cw.Clutch("c", base=a, follower=b, friction=friction(rng), gain=5e-4, pressure=p))
    d.add(cw.Torque("t", shaft=a, torque=load(rng, 30.0, t_end)))
    _drag(d, b, 20.0)


def planet(rng: Rng, d: cw.Driveline, t_end: float) -> None:
    """A planetary set that shifts from a brake to a clutch."""
    s, c, r = (
        d.shaft("s", inertia=0.1, speed=rng.uniform(20, 90)),
        d.shaft("c", inertia=1.0),
        d.shaft("r", inertia=0.1),
    )
    cls, ratio = cw.Planetary if rng.random() < 0.5 else cw.LossyPlanetary, rng.uniform(1.6, 3.0)
    losses = {} if cls is cw.Planetary else {"efficiency": 0.97}
    d.add(cls("pg", sun=s, carrier=c, ring=r, ratio=ratio, **losses))
    at = rng.uniform(0.1, 0.4) * t_end
    away = cw.Table([(0.0, 2e5), (at, 2e5), (at + 0.1 * t_end, 0.0)])
    come = cw.Table([(0.0, 0.0), (at, 0.0), (at + 0.2 * t_end, rng.uniform(1e5, 3e5))])
    d.add(cw.Brake("b1", shaft=r, friction=friction(rng), gain=5e-4, pressure=away if rng.random() < 0.5 else 2e5))
    d.add(cw.Clutch("c1", base=s, follower=c, friction=friction(rng), gain=5e-4, pressure=come))
    d.add(cw.Torque("t", shaft=s, torque=load(rng, 30.0, t_end)))
    _drag(d, c, 20.0)


def thermal(rng: Rng, d: cw.Driveline, t_end: float) -> None:
    """A lining that heats up."""
    a, b = d.shaft("a", inertia=rng.uniform(0.2, 0.6), speed=rng.uniform(60, 160)), d.shaft("b", inertia=0.8)
    plates, air = (
        d.thermal("plates", capacity=rng.uniform(3.0, 30.0), temperature=300.0),
        d.ambient("air", temperature=300.0),
    )
    law = cw.TemperatureTable(
        static=[(280.0, 0.16), (340.0, 0.15), (420.0, 0.12), (600.0, 0.11)],
        kinetic=[(280.0, 0.13), (340.0, 0.12), (420.0, 0.1), (600.0, 0.09)],
        temperature=plates,
    )
    pressure = cw.Table([(0.0, 0.0), (0.3 * t_end, 2e5), (t_end, 1e5)])
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=5e-4, pressure=pressure, heat=plates))
    d.add(cw.Convection("air_flow", hot=plates, cold=air, conductance=20.0))
    d.add(cw.Torque("t", shaft=a, torque=load(rng, 30.0, t_end)))


def light(rng: Rng, d: cw.Driveline, t_end: float) -> None:
    """A shaft without inertia between two others, driven in the middle."""
    a, m, b = d.shaft("a", inertia=0.3, speed=rng.uniform(0, 20)), d.shaft("m"), d.shaft("b", inertia=0.8)
    d.add(cw.SpringDamper("k1", base=a, follower=m, stiffness=rng.uniform(200, 900), damping=3.0))
    d.add(cw.SpringDamper("k2", base=m, follower=b, stiffness=rng.uniform(400, 2000), damping=1.0))
    d.add(cw.Torque("t", shaft=m, torque=load(rng, 20.0, t_end)))


KINDS: dict[str, Callable[[Rng, cw.Driveline, float], None]] = {
    made.__name__: made for made in (lossy, play, engine, converter, claw, actuator, planet, thermal, light)
}


def system_of(seed: int) -> tuple[str, cw.System, float]:
    """The driveline of a seed, its kind, and its end time."""
    rng = np.random.default_rng([seed, 91])
    kind, t_end = list(KINDS)[seed % len(KINDS)], float(rng.uniform(0.3, 1.0))
    d = cw.Driveline(f"{kind} {seed}")
    KINDS[kind](rng, d, t_end)
    return kind, d.assemble(), t_end


def outputs(run: cw.Trajectory, rng: Rng) -> dict[str, Any]:
    """Ends, an instant, extremes of a torque and a speed, a squared jerk, a lock-up that happens."""
    nodes = [node.name for node in run.system.nodes if f"{node.name}.speed" in run and not node.fixed]
    torques = [name for name in run.names if name.endswith(".torque")]
    found: list[Any] = [f"{name}.speed" for name in rng.permutation(nodes)[:2]]
    found.append(cw.at(f"{rng.choice(nodes)}.speed", float(rng.uniform(0.1, 0.9)) * run.t_end))
    found += [cw.peak(str(rng.choice(torques))), cw.maximum(str(rng.choice(torques)))]
    found += [cw.minimum(f"{rng.choice(nodes)}.speed"), cw.squared_jerk(str(rng.choice(nodes)))]
    for one in run.system.contacts:
        found += [f"{one.name}.heat"] if f"{one.name}.heat" in run else []
        when = cw.lock(one.name)
        found += [when] if not np.isnan(when.of(run)) else []
    return dict(asked(found))


def checked(seed: int, count: int) -> Tally:
    """Derivatives of a driveline by some of its numbers."""
    tally, rng = Tally(), np.random.default_rng([seed, 92])
    _, system, t_end = system_of(seed)
    run = cw.simulate(system, t_end, rtol=1e-8, atol=1e-10)
    if not run.finished:
        return tally
    wanted = outputs(run, rng)
    scales = by_differences.scales(run, wanted)
    compared(tally, system, t_end, wanted, scales, free_numbers.some(system, rng, count))
    return tally


def main() -> None:
    """Run it."""
    given, tallies = arguments(__doc__), list[Tally]()
    for seed in range(given.seed, given.seed + given.models):
        try:
            tallies.append(checked(seed, given.numbers))
        except cw.ClutchworkError as error:
            print(f"seed {seed} ERROR {type(error).__name__}: {error}", flush=True)
            continue
        for what, words in told(tallies[-1]):
            print(f"seed {seed} {list(KINDS)[seed % len(KINDS)]} {what.upper()} {words}", flush=True)
    print(summed(iter(tallies)))


if __name__ == "__main__":
    main()
