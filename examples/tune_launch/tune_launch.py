"""A launch is tuned by trial: python examples/tune_launch/tune_launch.py [FOLDER]."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import clutchwork as cw

Array = NDArray[np.float64]
PERIOD, T_END = 0.02, 3.0  # s
IDLE = 90.0  # rad/s
STALL = 60.0  # rad/s
BEGIN = np.array([0.1, 0.0, 0.0, 0.0])  # a pressure of 2.2 bar at once


def car() -> cw.Driveline:
    """An engine at 70 % of its torque, a disc clutch with a thermal mass, and a car of 1400 kg in first gear."""
    d = cw.Driveline("car that launches")
    engine = d.shaft("engine", inertia=0.15, speed=IDLE)
    gearbox, wheels = d.shaft("gearbox", inertia=0.02), d.shaft("wheels", inertia=1.5)
    body = d.mass("car", mass=1400.0)
    torque = [(0.0, 60.0), (100.0, 120.0), (400.0, 140.0), (500.0, 60.0), (560.0, -20.0)]  # rad/s, N m
    d.add(cw.SpeedTorque("combustion", shaft=engine, torque=torque, gain=0.7))
    actuator = d.add(cw.PressureActuator("actuator", command=0.0, lag=0.1))
    d.add(
        cw.DiskClutch(
            "clutch",
            base=engine,
            follower=gearbox,
            friction=cw.Stribeck(static=0.36, kinetic=0.30, speed=8.0),
            outer_diameter=0.215,
            inner_diameter=0.145,
            surfaces=2,
            area=8e-3,
            pressure=actuator,
            thermal_mass=1500.0,
        )
    )
    axle = d.shaft("axle", inertia=0.05)
    d.add(cw.Gear("gears", input=gearbox, output=axle, ratio=13.5))
    d.add(cw.SpringDamper("half_shafts", base=axle, follower=wheels, stiffness=9e3, damping=120.0))
    d.add(cw.RollingWheel("tyres", shaft=wheels, mass=body, radius=0.3))
    d.add(cw.ResistingTorque("rolling", shaft=body, torque=160.0, speed=0.05))
    return d


def reward(moment: cw.Moment) -> float:
    """Less heat, less jolt, a lock-up soon, and never a stalled engine."""
    now, before = moment.now, moment.before
    heat = (now["clutch.heat"] - before["clutch.heat"]) / 5e3  # J
    jolt = ((now["half_shafts.torque"] - before["half_shafts.torque"]) / 300.0) ** 2  # N m in 20 ms
    slips = 0.1 if now["clutch.state"] != "locked" else 0.0
    return -heat - jolt - slips - (20.0 if stalls(moment) else 0.0)


def stalls(moment: cw.Moment) -> bool:
    """Whether the engine is too slow."""
    return bool(moment.now["engine.speed"] < STALL)


def environment(**how: Any) -> Any:
    """The launch as an environment: the pressure of the clutch is the action, its lining and the car vary."""
    return cw.environment(
        car(),
        T_END,
        period=PERIOD,
        actions={"actuator.command": (0.0, 4e5)},
        observations={"engine.speed": (0.0, 300.0), "clutch.slip": (-300.0, 300.0), "half_shafts.torque": (-2e3, 2e3)},
        reward=reward,
        ends=stalls,
        vary={"clutch.friction.kinetic": (0.27, 0.33), "car.mass": (1300.0, 1700.0)},
        **how,
    )


def act(policy: Array, seen: Array) -> Array:
    """A policy of four numbers: an offset, and a weight for what is seen."""
    return np.clip([policy[0] + policy[1:] @ seen], -1.0, 1.0)


def episode(env: Any, policy: Array, seed: int | None = None, **options: Any) -> float:
    """Sum of the rewards of one launch."""
    seen, _ = env.reset(seed=seed, options=options)
    total, over = 0.0, False
    while not over:
        seen, one, ended, cut, _ = env.step(act(policy, seen))
        total, over = total + float(one), ended or cut
    return total


def learn(env: Any, rounds: int = 12, many: int = 24, best: int = 6, seed: int = 1) -> tuple[Array, list[float]]:
    """Cross-entropy method: draw policies, keep the best, draw around them.

    Returns the policy, and the best mean reward of each round.

    Source: Rubinstein, Kroese, The Cross-Entropy Method, Springer 2004, doi 10.1007/978-1-4757-4321-0.
    """
    draw = np.random.default_rng(seed)
    middle, width, history = BEGIN, np.full(4, 0.5), []
    for number in range(rounds):
        policies = [middle, *(middle + width * draw.standard_normal((many - 1, 4)))]
        # all of a round meet the same two cars
        scores = [np.mean([episode(env, one, seed=2 * number + k) for k in range(2)]) for one in policies]
        order = np.argsort(scores)[::-1][:best]
        chosen = np.array([policies[i] for i in order])
        middle, width = chosen.mean(axis=0), chosen.std(axis=0) + 0.02
        history.append(float(scores[order[0]]))
    return middle, history


def launch(policy: Array) -> cw.Trajectory:
    """The launch of the nominal car."""
    env = environment()
    episode(env, policy, values={"clutch.friction.kinetic": 0.30, "car.mass": 1400.0})
    return env.unwrapped.sim.run


def picture(before: cw.Trajectory, after: cw.Trajectory, path: Path) -> None:
    """The launch before and after."""
    names = ("engine.speed", "gearbox.speed", "half_shafts.torque", "clutch.pressure")
    cw.compare({"before": before, "learnt": after}, *names, path=path)


def main(folder: Path) -> None:
    """Learn, and show the launch before and after."""
    env = environment()
    policy, history = learn(env)
    print("best reward of each round:", " ".join(f"{one:.2f}" for one in history))
    runs = {name: launch(one) for name, one in (("before", BEGIN), ("learnt", policy))}
    for (name, run), one in zip(runs.items(), (BEGIN, policy), strict=True):
        locks = next((event.time for event in run.events.of("clutch") if event.after == "locked"), math.nan)
        unseen = np.mean([episode(env, one, seed=1000 + number) for number in range(10)])
        heat = run["clutch.heat"][-1] / 1e3
        print(f"{name}: locks after {locks:.2f} s, {heat:.2f} kJ; reward of ten other cars {unseen:.2f}")
    folder.mkdir(parents=True, exist_ok=True)
    picture(runs["before"], runs["learnt"], folder / "tune_launch.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/tune_launch"))
