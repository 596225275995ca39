"""Cams and followers: closed forms, SciPy with lift-off and landing, energy. docs/theory/varying-ratios.md (16)"""

from __future__ import annotations

from math import cos, pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

import clutchwork as cw
from clutchwork.elements.bases.lifts import curvatures
from support.amount import amount
from support.runs import EXACT, TIGHT, at_end
from support.sweep import simulate, stopped, sweep

TURN = 2.0 * pi
STROKE, SHAFT, MASS = 0.02, 0.004, 0.5  # m, kg m2, kg


def harmonic(points=16, stroke=STROKE):
    """A rise and a fall, stroke/2 (1 - cos(angle))."""
    return [(TURN * k / points, 0.5 * stroke * (1.0 - cos(TURN * k / points))) for k in range(points)] + [(TURN, 0.0)]


# points at uneven distances, and a lift without symmetry
UNEVEN = [
    (-1.0, 0.0),
    (-0.2, 0.001),
    (0.4, 0.009),
    (1.1, 0.014),
    (1.6, 0.012),
    (2.9, 0.006),
    (4.1, 0.001),
    (TURN - 1.0, 0.0),
]


def spline(lift):
    """The same spline by SciPy."""
    return CubicSpline(*zip(*lift, strict=True), bc_type="periodic")


def valve(lift=UNEVEN, speed=30.0, force=40.0, stiffness=0.0, **more):
    """A free cam shaft and a follower that a force and a spring press on it."""
    d = cw.Driveline("valve")
    a, m = d.shaft("a", inertia=SHAFT, speed=speed), d.mass("m", mass=MASS)
    d.add(cw.Cam("cam", shaft=a, mass=m, lift=lift, **more))
    d.add(cw.Torque("press", shaft=m, torque=-force))
    if stiffness:
        d.add(cw.Spring("spring", base=d.housing, follower=m, stiffness=stiffness))
    return d, a


def driven(speed, force=40.0, stiffness=0.0, lift=None, **more):
    """The same with a cam at a constant speed."""
    d, a = valve(lift or harmonic(), None, force, stiffness, **more)
    d.add(cw.PrescribedSpeed("motor", shaft=a, speed=speed))
    return d


def test_the_spline_is_that_of_scipy():
    x, y = zip(*UNEVEN, strict=True)
    assert np.allclose(curvatures(UNEVEN), spline(UNEVEN)(x, 2), rtol=1e-12, atol=1e-15)
    assert y[0] == y[-1]


def test_a_groove_keeps_the_energy():
    """(J + m x'^2) w^2 is constant, forward and backward over both ends of the table."""
    lift = spline(UNEVEN)
    for speed in (50.0, -50.0):
        d = cw.Driveline("groove")
        a, m = d.shaft("a", inertia=SHAFT, speed=speed), d.mass("m", mass=MASS)
        d.add(cw.CamProfile("c", shaft=a, mass=m, lift=UNEVEN, curvature=curvatures(UNEVEN), phase=0.3))
        run = d.simulate(0.5, dt=1e-3, rtol=1e-9)
        energy = (SHAFT + MASS * lift(run["a.angle"] + 0.3, 1) ** 2) * run["a.speed"] ** 2
        # the error of some thousand steps at rtol 1e-9
        assert np.ptp(energy) <= 2e-8 * energy[0]
        assert np.max(abs(run["m.position"] - (lift(run["a.angle"] + 0.3) - lift(0.3)))) <= 1e-8
        assert np.all((run["c.angle"] >= -1.0 - 1e-9) & (run["c.angle"] <= TURN - 1.0 + 1e-9))
        assert abs(run["a.angle"][-1]) > 3.0 * TURN
        assert abs(run.energy.residual) <= 1e-8 * energy[0]


@pytest.mark.parametrize("speed", [30.0, -30.0])
def test_a_pressed_follower_stays_on_the_lift(speed):
    """J w^2/2 + m v^2/2 + F x is constant where the force keeps it down."""
    run = valve(speed=speed, force=200.0)[0].simulate(0.5, dt=1e-3, rtol=1e-9)
    assert len(run.events.changes()) == 0
    lift = spline(UNEVEN)
    place, w = lift(run["a.angle"]) - lift(0.0), run["a.speed"]
    energy = 0.5 * (SHAFT + MASS * lift(run["a.angle"], 1) ** 2) * w**2 + 200.0 * place
    moved = energy[0] + 200.0 * np.ptp(place)
    assert np.ptp(energy) <= 2e-8 * moved
    assert np.max(abs(run["m.position"] - place)) <= 1e-8
    # the dense output between steps that end at exactly zero
    assert np.max(abs(run["cam.position"])) <= 1e-16
    # the force accelerates the follower by x' dw/dt + x'' w^2, and acts on the shaft by -x'
    first, second = lift(run["a.angle"], 1), lift(run["a.angle"], 2)
    force = run["cam.torque"]
    assert np.allclose(force, 200.0 + MASS * (first * run["a.acceleration"] + second * w**2), rtol=1e-7)
    assert np.allclose(SHAFT * run["a.acceleration"], -first * force, rtol=1e-7, atol=1e-7)
    # what the press takes and gives again is no turnover of the whole run
    assert abs(run.energy.residual) <= 1e-8 * moved


@pytest.mark.parametrize("stiffness", [0.0, 900.0])
def test_it_lifts_off_at_its_speed(stiffness):
    """F + k x + m x'' w^2 turns at the top of a harmonic cam: w^2 = (F + k h)/(m k h/2), k that of a spline there."""
    step = TURN / 16
    curvature = 0.5 * STROKE * (6.0 / step**2) * (1.0 - cos(step)) / (2.0 + cos(step))
    critical = sqrt((40.0 + stiffness * STROKE) / (MASS * curvature))
    # within some 1e-6 of w sqrt(F/(m h/2)), as the spline is of the cosine
    assert critical == pytest.approx(sqrt((40.0 + stiffness * STROKE) / (MASS * 0.5 * STROKE)), rel=0.01)
    below, above = (driven(critical * (1.0 + x), stiffness=stiffness).simulate(0.5, **TIGHT) for x in (-1e-6, 1e-6))
    assert len(below.events.changes()) == 0
    assert [event.after for event in above.events.changes()][:2] == ["open", "locked"]
    assert above["a.angle"][0] == 0.0
    # just before the top
    assert above.events.changes()[0].time * critical == pytest.approx(pi, abs=2e-2)


def test_the_lift_off_is_where_the_force_turns():
    """At a constant speed x''(a) = -F/(m w^2), on a piece of the spline where that is linear."""
    speed = 90.0
    run = driven(speed, lift=UNEVEN).simulate(0.2, **TIGHT)
    off = run.events.changes()[0]
    assert (off.before, off.after, off.cause) == ("locked", "open", "torque limit")
    x, bend = [x for x, _ in UNEVEN], spline(UNEVEN)([x for x, _ in UNEVEN], 2)
    level = -40.0 / (MASS * speed**2)
    k = next(k for k in range(1, 7) if bend[k] > level > bend[k + 1])
    angle = x[k] + (x[k + 1] - x[k]) * (bend[k] - level) / (bend[k] - bend[k + 1])
    assert off.time == pytest.approx(angle / speed, abs=EXACT)


@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("speed", [0.0, -12.0])
def test_a_landing_on_a_free_cam(speed, restitution):
    """One impact between the follower and the shaft behind its lever x': (1 - e^2)/2 of the reduced mass of heat."""
    force, gap = 40.0, 0.004
    d, _ = valve(speed=speed, force=force, initial_gap=gap, restitution=restitution)
    run = d.simulate(0.05, **TIGHT)
    lift = spline(UNEVEN)

    def distance(t):
        return gap - 0.5 * force / MASS * t * t - (lift(speed * t) - lift(0.0))

    low, high = 0.0, sqrt(2.0 * (gap + 0.02) * MASS / force)
    for _ in range(80):
        low, high = (low, 0.5 * (low + high)) if distance(0.5 * (low + high)) < 0 else (0.5 * (low + high), high)
    hit = next(event for event in run.events if event.cause == "impact")
    assert hit.time == pytest.approx(low, abs=EXACT)
    lever = lift(speed * low, 1)
    closing = force / MASS * low + lever * speed
    reduced = 1.0 / (1.0 / MASS + lever**2 / SHAFT)
    assert hit.energy_lost == pytest.approx(0.5 * (1.0 - restitution**2) * reduced * closing**2, rel=1e-7, abs=1e-12)
    after = run.at([hit.time + 1e-9])
    impulse = (1.0 + restitution) * reduced * closing
    assert after["a.speed"][0] == pytest.approx(speed - lever * impulse / SHAFT, rel=1e-6, abs=1e-6)
    assert after["m.speed"][0] == pytest.approx(-force / MASS * low + impulse / MASS, rel=1e-5, abs=1e-6)
    assert abs(run.energy.residual) <= 1e-10 * run.energy.turnover


def test_cycles_with_lift_off_as_scipy_has_them():
    """A driven shaft, a spring that is too weak: held, open and landing again for some revolutions."""
    lift, k, c, torque, force = spline(UNEVEN), 800.0, 0.002, 0.35, 10.0
    d, a = valve(speed=60.0, force=force, stiffness=k)
    d.add(cw.Torque("drive", shaft=a, torque=torque))
    d.add(cw.Damper("drag", base=d.housing, follower=a, damping=c))
    run = d.simulate(0.5, dt=1e-3, rtol=1e-10, atol=1e-12)
    place = lift(0.0)

    def press(x):
        return -force - k * (x - place)

    def held(_, y):
        first, second = lift(y[0], 1), lift(y[0], 2)
        moment = torque - c * y[1] + first * (press(lift(y[0])) - MASS * second * y[1] ** 2)
        return [y[1], moment / (SHAFT + MASS * first**2)]

    def contact(t, y):
        return MASS * (lift(y[0], 1) * held(t, y)[1] + lift(y[0], 2) * y[1] ** 2) - press(lift(y[0]))

    def free(_, y):
        return [y[1], (torque - c * y[1]) / SHAFT, y[3], press(y[2]) / MASS]

    def gap(_, y):
        return y[2] - lift(y[0])

    contact.terminal = gap.terminal = True
    contact.direction = gap.direction = -1
    precise = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13, "max_step": 1e-3}
    t, y, times = 0.0, np.array([0.0, 60.0]), []
    while t < 0.5:
        part = solve_ivp(held, (t, 0.5), y, events=contact, **precise)
        t, y = part.t[-1], part.y[:, -1]
        if part.status != 1:
            break
        times.append(t)
        y = np.array([*y, lift(y[0]), lift(y[0], 1) * y[1]])
        start = t + 1e-6
        y = solve_ivp(free, (t, start), y, **precise).y[:, -1]
        part = solve_ivp(free, (start, 0.5), y, events=gap, **precise)
        t, y = part.t[-1], part.y[:, -1]
        if part.status != 1:
            break
        times.append(t)
        lever = lift(y[0], 1)
        y = np.array([y[0], (SHAFT * y[1] + MASS * lever * y[3]) / (SHAFT + MASS * lever**2)])
    assert len(times) >= 6
    assert [event.time for event in run.events.changes()] == pytest.approx(times, abs=1e-7)
    assert run["a.angle"][-1] == pytest.approx(y[0], rel=1e-7)
    assert run["a.speed"][-1] == pytest.approx(y[1], rel=1e-6)
    assert run.energy.heat["cam"] > 0.0
    # measured 1e-9 of it
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    assert np.min(run["cam.position"]) >= -1e-13
    assert np.min(run["cam.torque"]) >= -1e-9


def test_backward_is_forward_on_the_mirrored_cam():
    mirrored = [(-x, y) for x, y in reversed(UNEVEN)]
    one, other = (
        valve(lift, speed, 15.0, restitution=0.3)[0].simulate(0.5, dt=1e-3, **TIGHT)
        for lift, speed in ((UNEVEN, 80.0), (mirrored, -80.0))
    )
    assert len(one.events.changes()) >= 4
    pairs = zip(one.events.changes(), other.events.changes(), strict=True)
    assert all(abs(a.time - b.time) <= 1e-8 and a.after == b.after for a, b in pairs)
    assert np.allclose(one["a.speed"], -other["a.speed"], rtol=1e-7)
    assert np.allclose(one["m.position"], other["m.position"], atol=1e-9)


def test_it_repeats_over_many_turns():
    """A hundred revolutions are the first one, a hundred times."""
    speed, force = 40.0, 60.0
    period = TURN / speed
    run = driven(speed, force, lift=UNEVEN).simulate(100.3 * period, dt=period / 7, rtol=1e-9)
    lift = spline(UNEVEN)
    assert np.max(abs(run["m.position"] - (lift(speed * run.time) - lift(0.0)))) <= 1e-8
    assert np.max(abs(run["cam.torque"] - force - MASS * lift(speed * run.time, 2) * speed**2)) <= 1e-6 * force
    assert len(run.events.changes()) == 0


@pytest.mark.parametrize("phase", [-7.0, -1.0, 0.4, TURN - 1.0, 100.0])
def test_it_starts_anywhere(phase):
    """At a point of the table as well; the follower takes the speed of the surface."""
    run = valve(force=200.0, phase=phase)[0].simulate(0.02, dt=1e-3, rtol=1e-9)
    lift = spline(UNEVEN)
    assert run["m.speed"][0] == pytest.approx(30.0 * lift(phase, 1), abs=1e-12)
    assert np.max(abs(run["m.position"] - (lift(run["a.angle"] + phase) - lift(phase)))) <= 1e-9
    assert len(run.events.changes()) == 0


def test_a_follower_at_rest_is_hit_by_a_cam_that_rises():
    d = cw.Driveline("hit")
    a, m = d.shaft("a", inertia=SHAFT, speed=30.0), d.mass("m", mass=MASS, speed=0.0)
    d.add(cw.Cam("cam", shaft=a, mass=m, lift=UNEVEN))
    run = d.simulate(1e-6, **TIGHT)
    lift = spline(UNEVEN)
    lever = lift(0.0, 1)
    reduced = 1.0 / (1.0 / MASS + lever**2 / SHAFT)
    assert run.energy.heat["cam"] == pytest.approx(0.5 * reduced * (lever * 30.0) ** 2, rel=1e-9)
    lever = lift(at_end(run, "a.angle"), 1)
    assert at_end(run, "m.speed") == pytest.approx(lever * at_end(run, "a.speed"), rel=1e-9)


def test_a_follower_pushes_the_cam_against_a_brake():
    """At rest the brake carries F x', until that is its capacity; both are held by rows, one of them varies."""
    d, a = valve(speed=0.0, force=0.0, phase=0.1)
    d.add(cw.Torque("more", shaft=d.nodes[1], torque=cw.Ramp(height=-100.0, duration=1.0)))
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Brake("brake", shaft=a, friction=law, gain=0.5, normal_force=1.0, locked=True))
    run = d.simulate(1.0, dt=0.01, rtol=1e-9)
    lever = spline(UNEVEN)(0.1, 1)
    (slips,) = [event for event in run.events.changes() if event.element == "brake"][:1]
    assert slips.time == pytest.approx(0.5 / (100.0 * lever), abs=EXACT)
    held = run.time < slips.time
    assert np.allclose(run["cam.torque"][held], 100.0 * run.time[held], atol=1e-9)
    assert np.allclose(run["brake.torque"][held], lever * 100.0 * run.time[held], atol=1e-9)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_what_switches_elsewhere_does_not_lift_it():
    """Decisions in a long contact see a gap of exactly zero."""
    d, a = valve(speed=30.0, force=60.0)
    b = d.shaft("b", inertia=0.05, speed=29.0)
    law = cw.Coulomb(static=1.0, kinetic=0.9)
    d.add(cw.Clutch("clutch", base=a, follower=b, friction=law, gain=1.0, normal_force=0.35))
    run = d.simulate(3.0, dt=1e-3, rtol=1e-9, atol=1e-9)
    names = [event.element for event in run.events]
    assert names.count("clutch") >= 28
    assert names.count("cam") == 0
    # relative to what moves
    assert abs(run.energy.residual) <= 1e-8 * 0.5 * 0.05 * 30.0**2


ROUND = [(0.0, 0.0), (2.0, 0.01), (4.0, 0.01), (TURN, 0.0)]


@pytest.mark.parametrize(
    ("lift", "words"),
    [
        ([(0.0, 0.0), (3.0, 0.01), (TURN, 0.0)], "has 3 points, must have at least 4"),
        ([(0.0, 0.0), (2.0, 0.01), (4.0, 0.01), (6.0, 0.0)], "from 0 rad to 6 rad, must cover one revolution"),
        ([*ROUND[:-1], (TURN, 1e-4)], "ends at 0.0001 m and starts at 0 m: it does not close"),
        ([(0.0, 0.0), (4.0, 0.01), (2.0, 0.01), (TURN, 0.0)], "lift"),
        ([(0.0, 0.0)], "has 1 points"),
        ([], "lift"),
    ],
)
def test_a_lift_that_is_none_is_refused(lift, words):
    found = [str(problem) for problem in valve(lift)[0].check()]
    assert any(words in one and "cam" in one for one in found), found


def test_a_curvature_that_makes_kinks_is_refused():
    for bend, words in ([0.0] * 4, "jump from"), ([0.0] * 3, "has 3 values for 4 points"):
        d = cw.Driveline("kink")
        a, m = d.shaft("a", inertia=1.0), d.mass("m", mass=1.0)
        d.add(cw.CamProfile("c", shaft=a, mass=m, lift=ROUND, curvature=bend))
        found = [str(problem) for problem in d.check()]
        assert any(words in one for one in found), found


def _hit_at_an_end(seed: int) -> str:
    """A follower that moves into a cam, or away, at an end of its travel, where no speed of the shaft follows."""
    rng = np.random.default_rng([seed, 42])
    count = int(rng.integers(3, 8))
    knots = np.sort(rng.uniform(0.3, TURN - 0.3, count))
    if (np.diff(knots) < 0.1).any():
        return ""
    lift = [(0.0, 0.0), *zip(knots, rng.uniform(0.0, 0.03, count), strict=True), (TURN, 0.0)]
    phase = float(rng.choice(spline(lift).derivative().roots(extrapolate=False)))
    speed, more = float(rng.uniform(-3.0, 3.0)), {"restitution": float(rng.choice([0.0, 0.5]))}
    runs = []
    for turning in (None, 0.0):
        d = cw.Driveline()
        shaft, mass = d.shaft("s", inertia=1.0, speed=turning), d.mass("m", mass=1.0, speed=speed)
        d.add(cw.Cam("c", shaft=shaft, mass=mass, lift=lift, phase=phase, **more))
        runs.append(simulate(d, 0.02, times=np.linspace(0.0, 0.02, 5)))
    free, given = runs
    apart = max(float(np.abs(free[name] - given[name]).max()) for name in ("s.speed", "m.speed"))
    return stopped(free) or (f"{apart:g} apart" if apart > 0.0 else "")


@pytest.mark.random
def test_no_speed_of_a_cam_follows_at_the_end_of_its_travel() -> None:
    sweep(_hit_at_an_end, amount(60))
