"""Torsional dampers: springs in stages, hysteresis with memory, loops, resonance, dry friction, energy."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from clutchwork.elements.torsional_damper import over_torque

E = [(-0.3, -90.0), (-0.1, -10.0), (-0.05, 0.0), (0.05, 0.0), (0.1, 10.0), (0.3, 110.0)]


def _spring(x, points=E):
    """The table by itself, extended linearly."""
    xs, ys = np.array(points).T
    k = int(np.clip(np.searchsorted(xs, x) - 1, 0, len(xs) - 2))
    return ys[k] + (ys[k + 1] - ys[k]) / (xs[k + 1] - xs[k]) * (x - xs[k])


class Iwan:
    """Springs in series with friction by themselves: exact over ways without a turn where the springs are stiff."""

    def __init__(self, elements, points=E):
        self.elements, self.points = elements, points
        self.h, self.x = [0.0] * len(elements), 0.0

    def go(self, x):
        """The torque of all after a way in one direction."""
        for i, (k, f0, ft) in enumerate(self.elements):
            limit = f0 + ft * abs(_spring(x, self.points))
            trial = self.h[i] + k * (x - self.x)
            self.h[i] = min(trial, limit) if x >= self.x else max(trial, -limit)
        self.x = x
        return sum(self.h) + _spring(x, self.points)


def _ways(rng, turns, most):
    """Speeds that rise and fall between turns, as a table, and the twist at each knot."""
    to = rng.uniform(-most, most, turns)
    times, speeds, at = [0.0], [0.0], 0.0
    for x in to:
        times += [times[-1] + 0.1, times[-1] + 0.2]
        speeds += [(x - at) / 0.1, 0.0]
        at = x
    return list(zip(times, speeds, strict=True)), to


def _damper(d, base, follower, elements, **more):
    k, f0, ft = zip(*elements, strict=True)
    lists = {"friction_stiffness": k, "friction_limit": f0, "friction_load": ft}
    return d.add(cw.TorsionalDamper("damper", base=base, follower=follower, **{"torque": E, **lists, **more}))


@pytest.mark.parametrize("seed", range(12))
def test_random_ways_as_another_implementation_has_them(seed):
    rng = np.random.default_rng(seed)
    # stiffer than the limits may grow: 500 N m/rad is the steepest stage
    elements = [(rng.uniform(400, 3000), rng.choice([0.0, rng.uniform(1, 20)]), rng.uniform(0.02, 0.4)) for _ in "abc"]
    table, to = _ways(rng, 12, 0.45)
    d = cw.Driveline("ways")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.PrescribedSpeed("way", shaft=a, speed=cw.Table(table)))
    _damper(d, d.housing, a, elements)
    run = d.simulate(table[-1][0], dt=0.01, rtol=1e-9)
    other = Iwan(elements)
    wanted = [other.go(x) for x in run["a.angle"]]
    scale = np.max(np.abs(wanted))
    assert run["damper.torque"] == pytest.approx(-np.array(wanted), abs=1e-8 * scale)
    assert run["a.angle"][-1] == pytest.approx(to[-1], abs=1e-9)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


@pytest.mark.parametrize("slow", [False, True])
def test_a_limit_that_follows_the_speed_of_the_base(slow):
    """The limit changes while the element slides and while it sticks; beside fine steps that clip its torque."""
    k, f, fc, ft = 800.0, 2.0, 0.004, 0.1
    d = cw.Driveline("spinning")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    # the twist swings slowly against the speed, or fast
    base = cw.Sine(amplitude=40.0, frequency=9.0 if slow else 1.3, offset=60.0)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=base))
    turn = cw.PrescribedSpeed("q", shaft=b, base=a, speed=cw.Sine(amplitude=0.4, frequency=2.0))
    d.add(turn)
    d.add(
        cw.TorsionalDamper(
            "damper", base=a, follower=b, torque=E, friction_stiffness=[k], friction_limit=[f], friction_load=[ft],
            friction_speed=[fc],
        )
    )  # fmt: skip
    run = d.simulate(1.5, dt=0.01, rtol=1e-9)
    fine = np.linspace(0.0, 1.5, 300001)
    twist = 0.4 / (4 * pi) * (1 - np.cos(4 * pi * fine))
    speed = 60.0 + 40.0 * np.sin(2 * pi * (9.0 if slow else 1.3) * fine)
    xs, ys = np.array(E).T
    limits = f + fc * speed**2 + ft * np.abs(np.interp(twist, xs, ys))
    h, wanted = 0.0, [0.0]
    for move, most in zip(k * np.diff(twist), limits[1:], strict=True):
        h = min(max(h + move, -most), most)
        wanted.append(h)
    wanted = np.array(wanted)[::2000]
    found = -run["damper.friction_1.torque"]
    # the fine steps have the error of a step at each turn
    assert found == pytest.approx(wanted, abs=2e-4 * np.max(np.abs(wanted)))
    # the state is shown with a lag of 10 µs while it slides
    assert run["damper.friction_1.friction_torque"] == pytest.approx(found, abs=0.02 * np.max(np.abs(found)))
    # work between prescribed speeds is a quadrature of its own, with the tolerance at each step
    assert abs(run.energy.residual) <= 1e-6 * run.energy.turnover


@pytest.mark.parametrize("method", ["rodas5p", "dopri5"])
def test_energy_of_a_spinning_damper(method):
    d = cw.Driveline("spinning")
    a, b = d.shaft("a", inertia=0.12, speed=80.0), d.shaft("b", inertia=0.06, speed=80.0)
    elements = {"friction_stiffness": [1000.0, 500.0], "friction_limit": [2.0, 3.0], "friction_load": [0.03, 0.0]}
    damper = cw.TorsionalDamper("damper", base=a, follower=b, torque=E, friction_speed=[4e-4, 1e-4], **elements)
    d.add(damper)
    d.add(cw.Torque("engine", shaft=a, torque=cw.Sine(amplitude=120.0, frequency=11.0, offset=30.0)))
    d.add(cw.Damper("road", base=d.housing, follower=b, damping=0.3))
    run = d.simulate(0.5, rtol=1e-9, method=method)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    limit = 3.0 + 1e-4 * run["a.speed"] ** 2
    sliding = np.abs(run["damper.friction_2.torque"])
    assert np.all(sliding <= limit * (1 + 1e-9))
    assert np.sum(sliding >= limit * (1 - 1e-9)) > 10


# it sticks until then, or slides: the limit is 60 N m
@pytest.mark.parametrize("stiffness", [300.0, 3000.0])
def test_a_limit_that_falls_where_a_speed_jumps_gives_its_energy_to_the_thermal_node(stiffness):
    d = cw.Driveline("falls")
    a, b = d.shaft("a", inertia=0.01, speed=100.0), d.shaft("b", inertia=2.0)
    plates = d.thermal("plates", capacity=15.0)
    springs = {"friction_stiffness": [stiffness], "friction_speed": [6e-3], "heat": plates}
    d.add(cw.TorsionalDamper("damper", base=a, follower=b, torque=[(-1.0, -1.0), (1.0, 1.0)], **springs))
    d.add(cw.Backlash("stop", base=a, follower=d.housing, gap=0.2, restitution=0.05))
    run = d.simulate(0.02, rtol=1e-9)
    assert [event.cause for event in run.events] == ["impact"]
    # of 30 N m before the blow next to nothing is left: the limit goes with the square of the speed
    torque = np.abs(run["damper.friction_1.torque"])
    most = torque.max()
    assert most > 29.0
    assert torque[run.time > run.events[0].time].max() < 0.2
    assert run.energy.heat["damper.friction_1"] > 0.99 * most**2 / (2 * stiffness)
    assert abs(run.energy.residual) <= 1e-6 * run.energy.turnover
    assert run.energy.thermal["plates"] == pytest.approx(run.energy.heat["damper.friction_1"], rel=1e-5)


def test_loops_make_the_heat_of_their_area_at_any_rate():
    k, f, amplitude = 2000.0, 15.0, 0.08
    heats = []
    for frequency in (0.2, 1.0, 30.0):
        d = cw.Driveline("loop")
        a = d.shaft("a", inertia=1.0)
        swing = cw.Sine(amplitude=2 * pi * frequency * amplitude, frequency=frequency, phase=pi / 2)
        d.add(cw.PrescribedSpeed("swing", shaft=a, speed=swing))
        _damper(d, d.housing, a, [(k, f, 0.0)])
        # the first quarter leads from rest into the loop
        run = d.simulate(3.25 / frequency, dt=0.25 / frequency, rtol=1e-10)
        heat = -(run["damper.work"][-1] - run["damper.work"][1])
        heats.append(heat)
    assert heats == pytest.approx([3 * 4 * f * (amplitude - f / k)] * 3, rel=1e-7)


def test_smaller_loops_close_and_are_forgotten():
    elements = [(2000.0, 15.0, 0.1), (800.0, 25.0, 0.0), (500.0, 8.0, 0.3)]
    ways = [0.3, -0.1, 0.1, -0.1, 0.3, -0.3, 0.3]
    d = cw.Driveline("loops")
    a = d.shaft("a", inertia=1.0)
    table, at = [(0.0, 0.0)], 0.0
    for x in ways:
        start = table[-1][0]
        table += [(start + 0.1, (x - at) / 0.1), (start + 0.2, 0.0)]
        at = x
    d.add(cw.PrescribedSpeed("way", shaft=a, speed=cw.Table(table)))
    _damper(d, d.housing, a, elements)
    run = d.simulate(table[-1][0], dt=0.2, rtol=1e-10)
    torque = run["damper.torque"]
    # back at the turn from which the inner loop began, and at the end of the outer one
    assert torque[4] == pytest.approx(torque[2], rel=1e-8)
    assert torque[5] == pytest.approx(torque[1], rel=1e-8)
    assert torque[7] == pytest.approx(torque[1], rel=1e-8)


def test_two_masses_swing_with_the_stiffness_of_their_stage():
    d = cw.Driveline("dual-mass flywheel")
    a, b = d.shaft("a", inertia=0.12), d.shaft("b", inertia=0.05)
    table = [(-1.0, -400.0), (-0.5, -100.0), (0.5, 100.0), (1.0, 400.0)]
    d.add(cw.TorsionalDamper("damper", base=a, follower=b, torque=table, initial_twist=0.2, damping=0.01))
    reduced = 1.0 / 0.12 + 1.0 / 0.05
    (swing,) = cw.linearise(d).modes.swinging
    assert 2 * pi * swing.natural_frequency == pytest.approx(sqrt(200.0 * reduced), rel=1e-7)
    outer = cw.linearise(d.assemble().changed({"damper.initial_twist": 0.7}))
    (swing,) = outer.modes.swinging
    assert 2 * pi * swing.natural_frequency == pytest.approx(sqrt(600.0 * reduced), rel=1e-7)


def test_friction_is_a_spring_until_it_slides():
    d = cw.Driveline("disc")
    a = d.shaft("a", inertia=0.02, speed=8.0)
    d.add(cw.Spring("spring", base=d.housing, follower=a, stiffness=500.0))
    d.add(cw.JenkinsElement("ring", base=d.housing, follower=a, stiffness=2000.0, limit=3.0))
    run = d.simulate(0.05, dt=1e-4)
    slides = np.abs(run["ring.torque"]) > 3.0 - 1e-9
    assert 0 < np.sum(slides) < len(slides)
    for row in (1, int(np.flatnonzero(slides)[3]), len(run.time) - 5):
        (swing,) = cw.linearise(run, at=run.time[row]).modes.swinging
        wanted = sqrt((500.0 if slides[row] else 2500.0) / 0.02)
        assert 2 * pi * swing.natural_frequency == pytest.approx(wanted, rel=1e-7)


def test_a_swing_as_scipy_has_it():
    """Two masses with a gap, a stage and one friction element, driven by a torque with a period."""
    k, f, j1, j2 = 900.0, 6.0, 0.12, 0.05
    d = cw.Driveline("dual-mass flywheel")
    a, b = d.shaft("a", inertia=j1), d.shaft("b", inertia=j2)
    _damper(d, a, b, [(k, f, 0.0)], damping=0.02)
    d.add(cw.Torque("engine", shaft=a, torque=cw.Sine(amplitude=60.0, frequency=4.0)))
    run = d.simulate(1.0, dt=0.01, rtol=1e-11, atol=1e-11)

    def rates(time, y, mode):
        twist, h, w1, w2 = y
        s = w2 - w1
        # stick: the spring follows; slip: it stays
        torque = _spring(twist) + h + 0.02 * s
        engine = 60.0 * np.sin(2 * pi * 4.0 * time)
        return [s, k * s if mode == 0 else 0.0, (engine + torque) / j1, -torque / j2]

    def limit(time, y, mode):
        return f - abs(y[1]) if mode == 0 else (y[3] - y[2]) * mode

    limit.terminal, limit.direction = True, -1
    knots = [lambda t, y, m, x=x: y[0] - x for x, _ in E[1:-1]]
    for knot in knots:
        knot.terminal = True
    time, y, mode, speeds = 0.0, np.zeros(4), 0, np.zeros(len(run.time))
    exact = {"rtol": 1e-12, "atol": 1e-12, "method": "DOP853", "dense_output": True}
    while time < 1.0:
        made = solve_ivp(rates, (time, 1.0), y, args=(mode,), events=[limit, *knots], **exact)
        end = min([float(times[0]) for times in made.t_events if len(times)], default=1.0)
        there = (run.time >= time) & (run.time <= end)
        speeds[there] = [made.sol(at)[3] for at in run.time[there]]
        y = made.sol(end)
        if len(made.t_events[0]):
            mode = (1 if y[1] > 0 else -1) if mode == 0 else 0
            y[1] = np.clip(y[1], -f, f)
        # a little way behind the knot or the limit
        time = end + 1e-9
        y = y + 1e-9 * np.array(rates(end, y, mode))
    # the little ways behind some dozens of events
    assert run["b.speed"] == pytest.approx(speeds, abs=1e-6 * np.max(np.abs(speeds)))
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_dry_friction_beside_the_springs_sticks():
    d = cw.Driveline("clutch disc")
    a, b = d.shaft("a", inertia=0.1), d.shaft("b", inertia=0.02)
    disc = cw.TorsionalDamper("disc", base=a, follower=b, torque=[(-0.1, -100.0), (0.1, 100.0)], dry_friction=4.0)
    d.add(disc)
    d.add(cw.Torque("t", shaft=b, torque=cw.Ramp(height=12.0, duration=1.2, start=0.1)))
    d.add(cw.PrescribedSpeed("held", shaft=a, speed=0.0))
    run = d.simulate(2.0, rtol=1e-9)
    (event,) = [event for event in run.events if event.element == "disc.dry" and event.time > 0.2][:1]
    assert event.time == pytest.approx(0.1 + 0.4, abs=1e-6)
    assert run["disc.torque"][-1] == pytest.approx(run["disc.dry.torque"][-1] - 1000.0 * run["disc.twist"][-1])
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_a_jump_of_the_speed_ends_sliding():
    d = cw.Driveline("jump")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=cw.Step(height=-2.0, start=0.1, offset=1.0)))
    d.add(cw.JenkinsElement("j", base=d.housing, follower=a, stiffness=1000.0, limit=20.0))
    run = d.simulate(0.2, dt=0.01, rtol=1e-10)
    other = [min(1000.0 * x, 20.0) for x in run["a.angle"][run.time <= 0.1]]
    other += [max(20.0 - 1000.0 * (0.1 - x), -20.0) for x in run["a.angle"][run.time > 0.1]]
    before = int(np.sum(run.time <= 0.1))
    assert run["j.torque"][: before - 1] == pytest.approx(-np.array(other[: before - 1]), abs=1e-6)
    assert run["j.torque"][before:] == pytest.approx(-np.array(other[before:]), abs=1e-6)


def test_heat_goes_to_a_thermal_node():
    d = cw.Driveline("warm")
    a, ring = d.shaft("a", inertia=0.1, speed=20.0), d.thermal("ring", capacity=50.0)
    _damper(d, d.housing, a, [(2000.0, 5.0, 0.2), (900.0, 0.0, 0.4)], damping=0.05, heat=ring)
    run = d.simulate(1.0, rtol=1e-9)
    balance = run.energy
    assert balance.thermal["ring"] == pytest.approx(sum(balance.heat.values()), rel=1e-7)
    assert abs(balance.residual) <= 1e-8 * balance.turnover


@pytest.mark.parametrize(
    ("torque", "limit"),
    [
        ([(-0.1, -10.0), (0.1, 30.0)], [(-0.1, 7.0), (-0.05, 2.0), (0.1, 17.0)]),
        ([(0.1, 10.0), (0.2, 20.0)], [(-0.1, 7.0), (0.0, 2.0), (0.1, 7.0), (0.2, 12.0)]),
        ([(-0.2, -20.0), (-0.1, -10.0)], [(-0.2, 12.0), (-0.1, 7.0), (0.0, 2.0), (0.1, 7.0)]),
        ([(0.0, 5.0)], [(0.0, 4.5)]),
    ],
)
def test_limits_over_the_twist(torque, limit):
    assert np.allclose(over_torque(torque, 2.0, 0.5), limit)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"friction_limit": [1.0]}, "friction_stiffness is missing"),
        (
            {"friction_limit": [1.0], "friction_stiffness": [1.0, 2.0]},
            "friction_limit has 1 numbers for 2 of friction_stiffness",
        ),
        (
            {"friction_limit": [0.0], "friction_stiffness": [1.0]},
            "friction_limit is zero for an element without friction_load and friction_speed",
        ),
        ({"friction_limit": [-1.0], "friction_stiffness": [1.0]}, "friction_limit, number 1 = -1.0 N m: must be >= 0"),
    ],
)
def test_mistakes(values, words):
    d = cw.Driveline("mistakes")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.TorsionalDamper("x", base=d.housing, follower=a, torque=E, **values))
    assert words in str(d.check()[0])


def test_a_limit_that_falls_below_zero():
    d = cw.Driveline("mistakes")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.JenkinsElement("x", base=d.housing, follower=a, stiffness=1.0, limit=[(0.0, 1.0), (1.0, 0.0)]))
    assert "limit falls below zero beyond its ends" in str(d.check()[0])
