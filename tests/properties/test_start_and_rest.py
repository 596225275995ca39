"""Elements where motion starts, rests or turns: random models against closed forms, twins and finer tolerances."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.gearbox.store import names
from support.amount import amount
from support.sweep import log_uniform, simulate, stopped, sweep

Rng = np.random.Generator
FINE = {"rtol": 1e-9, "atol": 1e-11}


def jenkins(seed: int) -> str:
    """A knot of a torque of zero changes nothing, and where it slides friction does not drive."""

    def run(knot: float | None) -> Any:
        rng = np.random.default_rng([seed, 71])
        d = cw.Driveline("jenkins")
        a, b, c = (
            d.shaft(n, inertia=log_uniform(rng, 1e-3, 0.1), speed=float(rng.uniform(-30.0, 30.0))) for n in "abc"
        )
        d.add(cw.Spring("k", base=b, follower=a, stiffness=log_uniform(rng, 5.0, 500.0)))
        limit = float(rng.uniform(0.05, 2.0))
        d.add(cw.JenkinsElement("je", base=a, follower=c, stiffness=log_uniform(rng, 50.0, 5e3), limit=limit))
        if knot is not None:
            d.add(cw.Torque("nothing", shaft=a, torque=cw.Table([(knot, 0.0), (knot + 1e-4, 0.0)])))
        return simulate(d, 0.3, output="steps"), limit

    rng = np.random.default_rng([seed, 72])
    (plain, limit), (cut, _) = run(None), run(float(rng.uniform(0.01, 0.28)))
    for found in (plain, cut):
        slides = np.abs(found["je.torque"]) >= limit * (1 - 1e-9)
        slip = found["c.speed"] - found["a.speed"]
        drives = np.where(slides, found["je.torque"] * slip, 0.0).max()
        if drives > 1e-3 * limit:
            return f"slides and drives with {drives:.3g} W"
    apart = max(abs(plain[f"{n}.speed"][-1] - cut[f"{n}.speed"][-1]) for n in "abc")
    return f"ends {apart:.3g} rad/s apart with a knot" if apart > 1e-3 else ""


def engine(seed: int) -> str:
    """An engine that a brake has stopped does the same at all tolerances, and with all torques times a factor."""
    rng = np.random.default_rng([seed, 73])
    inertia, drive, speed = log_uniform(rng, 0.02, 0.5), log_uniform(rng, 20.0, 200.0), float(rng.uniform(1.0, 30.0))
    drags = float(rng.choice([0.0, 0.2])) * drive
    stall = float(rng.choice([0.0, 0.0, 60.0]))
    start, width, t_end = float(rng.uniform(0.02, 0.1)), 0.1, 0.25
    ends = []
    for factor in (1.0, 2.0, 3.7):
        force = cw.Pulse(height=40 * drive * factor, period=1.0, width=width, start=start, offset=0.2 * drive * factor)
        for options in ({}, {"rtol": 1e-8}, FINE):
            d = cw.Driveline("engine")
            s = d.shaft("s", inertia=inertia * factor, speed=speed)
            friction = cw.Coulomb(static=0.3, kinetic=0.2)
            d.add(cw.Brake("b", shaft=s, friction=friction, gain=1.0, normal_force=force))
            motoring = [(0.0, -drags * factor), (200.0, -drags * factor)]
            curve = [(0.0, drive * factor), (230.0, 0.8 * drive * factor)]
            d.add(cw.Engine("e", shaft=s, throttle=1.0, full_load=curve, motoring=motoring, stall_speed=stall))
            run = simulate(d, t_end, **options)
            if text := stopped(run):
                return text
            ends.append(float(run["s.speed"][-1]))
    if max(ends) - min(ends) > 1e-2 * (1 + max(map(abs, ends))):
        return f"ends at {sorted({round(x, 4) for x in ends})} rad/s"
    burns = ends[0] > 1.0
    return "" if burns == (stall == 0.0) else f"stall_speed {stall}, ends with {ends[0]:.4g} rad/s"


def ripple(seed: int) -> str:
    """An engine with a ripple far above 1 stops, stands or goes on, and the run with it."""
    rng = np.random.default_rng([seed, 74])
    d = cw.Driveline("ripple")
    s = d.shaft("s", inertia=log_uniform(rng, 0.1, 2.0), speed=float(rng.uniform(0.5, 20.0)))
    d.add(
        cw.Engine(
            "e",
            shaft=s,
            throttle=float(rng.uniform(0.1, 1.0)),
            full_load=[(0.0, 50.0), (100.0, 30.0)],
            motoring=[(0.0, -float(rng.uniform(0.0, 8.0))), (100.0, -20.0)],
            orders=[0.5, 2.0],
            amplitudes=[float(x) for x in rng.uniform(0.2, 16.0, 2)],
            stall_speed=float(rng.choice([0.0, rng.uniform(0.0, 15.0)])),
        )
    )
    d.add(cw.Torque("load", shaft=s, torque=float(rng.uniform(-30.0, 30.0))))
    return stopped(simulate(d, 0.5, max_steps=20_000))


def motor(seed: int) -> str:
    """A motor that brakes with more than it drives with comes to rest, or is pushed on, without chatter."""
    rng = np.random.default_rng([seed, 75])
    drives = log_uniform(rng, 5.0, 50.0)
    brakes, push = drives * float(rng.uniform(1.5, 4.0)), drives * float(rng.choice([0.3, 1.2, 5.0]))
    d = cw.Driveline("motor")
    s = d.shaft("s", inertia=log_uniform(rng, 0.05, 1.0), speed=float(rng.uniform(-5.0, 5.0)))
    d.add(cw.ElectricMotor("m", shaft=s, command=-10 * brakes, max_torque=drives, generator_torque=brakes))
    d.add(cw.Torque("t", shaft=s, torque=push))
    run = simulate(d, 3.0, max_steps=20_000)
    if text := stopped(run):
        return text
    # it is pulled backward, stands on its limit, or is pushed on
    rate = float(run["s.acceleration"][-1]) * run["s.speed"][-1]
    wanted = -1 if push < drives else 0 if push < brakes else 1
    way = float(run["s.speed"][-1])
    good = {-1: way < 0 < rate, 0: abs(way) < 0.11, 1: way > 0 and rate > 0}[wanted]
    return "" if good else f"push {push:.3g} of {drives:.3g} to {brakes:.3g} N m: {way:.3g} rad/s"


def actuator(seed: int) -> str:
    """Fill time beside limits of the rise and the fall: the same pressures at all tolerances."""
    rng = np.random.default_rng([seed, 76])
    lag, fill = log_uniform(rng, 2e-3, 0.1), float(rng.uniform(0.0, 0.3))
    times = np.sort(rng.uniform(0.02, 0.9, 4))
    levels = np.repeat(rng.uniform(0.0, 3e5, 5) * (rng.random(5) < 0.7), 2)
    command = cw.Table(list(zip(map(float, [0.0, *np.repeat(times, 2), 1.0]), map(float, levels), strict=True)))
    spring, full = float(rng.choice([0.0, 2e4])), log_uniform(rng, 1e3, 1e5)
    rise, fall = log_uniform(rng, 1e5, 1e7), log_uniform(rng, 1e5, 1e7)

    def run(rtol: float) -> Any:
        d = cw.Driveline("actuator")
        d.shaft("s", inertia=1.0)
        limits: Any = {"rise": rise, "fall": fall, "spring": spring, "fill_time": fill, "fill_pressure": full}
        d.add(cw.PressureActuator("act", command=command, lag=lag, **limits))
        return simulate(d, 1.0, dt=0.01, rtol=rtol, atol=1e-3 * rtol, max_steps=20_000)

    coarse, fine = run(1e-6), run(1e-10)
    if text := stopped(coarse) or stopped(fine):
        return text
    off = np.abs(coarse["act.pressure"] - fine["act.pressure"]).max()
    return f"pressures {off:.3g} Pa apart" if off > 1e-4 * (1e5 + np.abs(fine["act.pressure"]).max()) else ""


def dog(seed: int) -> str:
    """One that is in mesh at the start carries, at any slip, until its sleeve is out."""
    rng = np.random.default_rng([seed, 77])
    teeth = int(rng.integers(4, 40))
    gap = float(rng.uniform(0.1, 0.6)) * 2 * np.pi / teeth
    command = float(rng.choice([0.0, 0.4, 1.0]))
    d = cw.Driveline("dog")
    a, b = (d.shaft(n, inertia=log_uniform(rng, 0.1, 2.0), speed=float(rng.uniform(-30.0, 30.0))) for n in "ab")
    d.add(
        cw.DogClutch(
            "dog",
            base=a,
            follower=b,
            teeth=teeth,
            gap=gap,
            stiffness=log_uniform(rng, 10.0, 1e5),
            command=command,
            speed=float(rng.uniform(0.5, 5.0)),
            initial_angle=float(rng.uniform(-0.5, 0.5)) * gap,
            pointed=bool(rng.random() < 0.3),
            engaged=True,
        )
    )
    run = simulate(d, 0.3, output="steps")
    if text := stopped(run):
        return text
    apart = abs(float(run["b.angle"][-1] - run["a.angle"][-1]))
    if command == 1.0 and apart > 2 * np.pi / teeth + gap and np.abs(run["dog.torque"]).max() == 0.0:
        return f"turns by {apart:.3g} rad in mesh and carries nothing"
    out = run["dog.sleeve"] < 0.5 - 1e-6
    return "carries with the sleeve out" if np.abs(run["dog.torque"][out]).max(initial=0.0) > 0 else ""


def dahl(seed: int) -> str:
    """Below exponent 1 the bristles are full after the slip mu/(k (1 - i)); from there on until it turns."""
    rng = np.random.default_rng([seed, 78])
    kinetic, stiffness, i = float(rng.uniform(0.05, 0.5)), log_uniform(rng, 50.0, 1e4), float(rng.uniform(0.05, 0.95))
    speed = log_uniform(rng, 0.05, 5.0)
    d = cw.Driveline("dahl")
    s = d.shaft("s", inertia=1.0)
    turn = 4 * kinetic / (stiffness * (1 - i)) / speed
    motion = cw.Table([(0.0, speed), (turn, speed), (turn, -speed), (3 * turn, -speed)])
    d.add(cw.PrescribedSpeed("m", shaft=s, speed=motion))
    law = cw.Dahl(kinetic=kinetic, stiffness=stiffness, exponent=i)
    d.add(cw.Brake("c", shaft=s, friction=law, gain=1.0, normal_force=1.0))
    run = simulate(d, 2.5 * turn, dt=turn / 50, max_steps=20_000, rtol=1e-8, atol=1e-10)
    if text := stopped(run):
        return text
    x = np.where(run.time <= turn, run.time, run.time - turn) * speed * stiffness / kinetic

    def full(start: float) -> Any:
        return 1 - np.maximum(start ** (1 - i) - (1 - i) * x, 0.0) ** (1 / (1 - i))

    known = kinetic * np.where(run.time <= turn, -full(1.0), full(2.0))
    jumps = np.abs(run.time - turn) < 1e-9
    off = np.abs(run["c.torque"] - known)[~jumps].max() / kinetic
    return f"off by {off:.3g} of {kinetic:.3g}, exponent {i:.3g}" if off > 1e-5 else ""


def vanishing(seed: int) -> str:
    """Fluid between shafts whose speeds fade beyond the smallest numbers."""
    rng = np.random.default_rng([seed, 79])
    d = cw.Driveline("fluid")
    a, b = (d.shaft(n, inertia=log_uniform(rng, 0.005, 0.5), speed=float(rng.uniform(-2.0, 2.0))) for n in "ab")
    if rng.random() < 0.5:
        d.add(
            cw.FluidCoupling(
                "f", base=a, follower=b, speed_ratio=[-0.5, 0.0, 0.9, 1.0], capacity=[0.005, 0.005, 0.003, 0]
            )
        )
    else:
        table = {"speed_ratio": (0.0, 0.8, 1.0), "torque_ratio": (2.0, 1.0, 1.0), "capacity": (3e-3, 2e-3, 0.0)}
        d.add(cw.TorqueConverter("f", impeller=a, turbine=b, **table))
    for n, shaft in (("da", a), ("db", b)):
        d.add(cw.Damper(n, base=d.housing, follower=shaft, damping=log_uniform(rng, 5.0, 200.0)))
    return stopped(simulate(d, 3.0))


def acceleration(seed: int) -> str:
    """A prescribed acceleration begins with the speed of its shaft, wherever the run does; a state goes on from it."""
    rng = np.random.default_rng([seed, 80])
    speed, start = float(rng.uniform(-5.0, 5.0)), float(rng.uniform(0.05, 0.8))
    x = np.sort(rng.uniform(0.0, 1.0, 4))
    table = [(float(t), float(a)) for t, a in zip(x, rng.uniform(-9.0, 9.0, 4), strict=True)]
    wave = cw.Sine(amplitude=float(rng.uniform(0.1, 5.0)), frequency=float(rng.uniform(0.1, 5.0)))
    given = cw.Table(table) if rng.random() < 0.5 else wave
    d = cw.Driveline("acceleration")
    a, b = d.shaft("a", inertia=1.0, speed=speed), d.shaft("b", inertia=1.0)
    d.add(cw.PrescribedAcceleration("m", shaft=a, acceleration=given))
    d.add(cw.Damper("d", base=a, follower=b, damping=1.0))
    run = simulate(d, 1.2, t_start=start, **FINE)
    whole = simulate(d, 1.2, times=[0.0, start, 1.2], **FINE)
    if abs(run["a.speed"][0] - speed) > 1e-14 * (1 + abs(speed)):
        return f"begins at {start:.3g} s with {run['a.speed'][0]} rad/s of {speed}"
    gained = float(whole["a.speed"][2] - whole["a.speed"][1])
    on = simulate(d, 1.2, start=run.state(at=float(run.time[len(run.time) // 2])), **FINE)
    off = max(abs(float(found["a.speed"][-1]) - speed - gained) for found in (run, on))
    return f"off by {off:.3g} rad/s" if off > 1e-9 else ""


@pytest.mark.parametrize("joined", [False, True])
def test_an_acceleration_begins_with_what_a_gearbox_in_gear_gives(joined: bool) -> None:
    """The speed of its input is given; behind a rigid joint too, through a shaft without inertia."""
    d = cw.Driveline("in gear")
    a, out = d.shaft("a", inertia=0.8, speed=-69.4), d.shaft("out", inertia=0.05)
    into = a
    if joined:
        into = d.shaft("into", inertia=0.0)
        d.add(cw.Gear("joint", input=a, output=into, ratio=1.0))
    box = cw.Gearbox.load("sa-sprinter7")
    d.add(cw.Transmission("box", input=into, output=out, gearbox=box, torque=561.0, inertia=0.0475, gear="2"))
    d.add(cw.PrescribedAcceleration("m", shaft=out, acceleration=-0.5))
    run = d.simulate(0.01)
    assert run["a.speed"][0] == pytest.approx(-69.4, rel=1e-12)
    assert run["out.speed"][0] == pytest.approx(-69.4 / box.ratios["2"], rel=1e-12)
    assert not run.events.changes()


def gearbox(seed: int) -> str:
    """A gearbox in gear starts the same behind rigid gears as on the shaft itself."""
    rng = np.random.default_rng([seed, 81])
    known = names()
    name = str(known[int(rng.integers(len(known)))])
    gears = list(cw.Gearbox.load(name).gears)
    gear, ratio = str(gears[int(rng.integers(len(gears)))]), float(rng.choice([-2.0, 0.5, 1.0]))
    speed, at_output, starts = float(rng.uniform(-50.0, 50.0)), bool(rng.random() < 0.4), []
    for joined in (False, True):
        d = cw.Driveline("joined")
        given: Any = {} if joined else {"speed": speed}
        a, b = (d.shaft(n, inertia=1.0, **(given if at_output == (n == "b") else {})) for n in "ab")
        if joined:
            far = d.shaft("far", inertia=0.0, speed=speed * ratio)
            d.add(cw.Gear("joint", input=far, output=b if at_output else a, ratio=ratio))
        d.add(cw.Transmission("box", input=a, output=b, gearbox=name, gear=gear))
        run = simulate(d, 0.01)
        starts.append([float(run[f"{n}.speed"][0]) for n in "ab"])
    apart = max(abs(x - y) for x, y in zip(*starts, strict=True))
    return f"{name} in {gear} starts at {starts}" if apart > 1e-6 * abs(speed) else ""


CHECKS = [jenkins, engine, ripple, motor, actuator, dog, dahl, vanishing, acceleration, gearbox]


@pytest.mark.random
@pytest.mark.parametrize("check", CHECKS)
def test_elements_start_rest_and_turn_as_they_should(check: Any) -> None:
    sweep(check, amount(100))


def thrown(seed: int) -> str:
    """Shoes of a centrifugal clutch on a shaft whose speed follows from that of another, and where that is given."""
    rng = np.random.default_rng([seed, 43])
    how = str(rng.choice(["gear", "ratio", "motion"]))
    ratio, speed = float(rng.choice([-1.0, 1.0])) * log_uniform(rng, 0.3, 4.0), float(rng.uniform(-80.0, 80.0))
    onset = log_uniform(rng, 3.0, 30.0)
    runs = []
    for given in (None, speed / ratio):
        d = cw.Driveline(f"thrown {seed}")
        a, b, c = (
            d.shaft("a", inertia=0.5, speed=speed),
            d.shaft("b", inertia=0.2, speed=given),
            d.shaft("c", inertia=0.3),
        )
        if how == "gear":
            d.add(cw.Gear("joint", input=a, output=b, ratio=ratio))
        elif how == "ratio":
            d.add(cw.VariableRatio("joint", input=a, output=b, ratio=ratio))
        else:
            d.add(cw.PrescribedSpeed("joint", shaft=b, speed=speed / ratio))
        law = cw.Coulomb(static=0.3, kinetic=0.3)
        shoes = {"mass": 0.1, "radius": 0.05, "drum_radius": 0.08, "onset": onset}
        d.add(cw.CentrifugalClutch("k", base=b, follower=c, friction=law, **shoes))
        runs.append(simulate(d, 0.05, times=np.linspace(0.0, 0.05, 11)))
    follows, known = runs
    apart = max(float(np.abs(follows[f"{n}.speed"] - known[f"{n}.speed"]).max()) for n in "abc")
    return stopped(follows) or (f"{how}: {apart:.3g} rad/s apart" if apart > 1e-8 * abs(speed) else "")


@pytest.mark.random
def test_shoes_start_where_their_shaft_throws_them() -> None:
    sweep(thrown, amount(60))
