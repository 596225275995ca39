"""Prescribed positions and accelerations, exact and filtered: closed forms, SciPy, what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from support.runs import TIGHT, at_end

WC, AF, BF = 2 * math.pi * 0.8, 1.3617, 0.6180
POINTS = [(0.2, 0.5), (0.7, 1.5), (0.7, -1.0), (1.6, 0.4)]
SIGNALS: dict[str, tuple[Any, Any]] = {
    "constant": (0.7, lambda t: 0.7),
    "step": (cw.Step(height=1.0, start=0.5, offset=-0.2), lambda t: -0.2 + (t >= 0.5)),
    "ramp": (cw.Ramp(height=2.0, duration=0.8, start=0.3), lambda t: 2.0 * min(max((t - 0.3) / 0.8, 0.0), 1.0)),
    "table with a jump": (
        cw.Table(POINTS),
        lambda t: np.interp(t, [0.2, 0.7], [0.5, 1.5]) if t < 0.7 else np.interp(t, [0.7, 1.6], [-1.0, 0.4]),
    ),
    "sine that begins later": (
        cw.Sine(amplitude=0.6, frequency=1.3, phase=0.4, offset=0.1, start=0.25),
        lambda t: 0.1 + (t >= 0.25) * 0.6 * math.sin(2 * math.pi * 1.3 * (t - 0.25) + 0.4),
    ),
    "sine that decays": (
        cw.Sine(amplitude=0.6, frequency=2.0, damping=1.5),
        lambda t: 0.6 * math.exp(-1.5 * t) * math.sin(4 * math.pi * t),
    ),
}
KINKS = (0.2, 0.25, 0.3, 0.5, 0.7, 1.1, 1.6)


def _solved(slope: Any, start: list[float], times: np.ndarray) -> np.ndarray:
    """SciPy from kink to kink."""
    made, y, t = np.zeros((len(start), len(times))), np.array(start), 0.0
    made[:, 0] = y
    for end in sorted({*KINKS, times[-1]}):
        part = (times > t) & (times <= end)
        at = [*times[part], end] if not np.any(times[part] == end) else [*times[part]]
        # just inside, so that a jump at the end is not seen
        inner = lambda s, y, end=end: slope(min(s, np.nextafter(end, 0.0)), y)  # noqa: E731
        out = solve_ivp(inner, (t, end), y, method="DOP853", rtol=1e-12, atol=1e-13, t_eval=at)
        made[:, part], y, t = out.y[:, : part.sum()], out.y[:, -1], end
    return made


@pytest.mark.parametrize("name", SIGNALS)
@pytest.mark.parametrize("start", [(0.0, 0.0), (0.3, -0.4)])
def test_the_filter_of_a_position(name: str, start: tuple[float, float]) -> None:
    signal, function = SIGNALS[name]
    d = cw.Driveline(name)
    mass = d.mass("m", mass=2.0, position=start[0], speed=start[1] or None)
    d.add(cw.PrescribedPosition("p", shaft=mass, position=signal, cutoff=0.8))
    run = d.simulate(2.0, dt=0.1, **TIGHT)
    first = start[0] or function(0.0)
    times = np.round(np.asarray(run.time), 12)
    slope = lambda t, y: [y[1], ((function(t) - y[0]) * WC - AF * y[1]) * WC / BF]  # noqa: E731
    wanted = _solved(slope, [first, start[1]], times)
    # 1e-10: what SciPy leaves
    assert np.allclose(run["m.position"], wanted[0], rtol=0.0, atol=1e-10)
    assert np.allclose(run["m.speed"], wanted[1], rtol=0.0, atol=1e-9)


def test_the_filter_is_one_over_root_two_at_its_cutoff() -> None:
    d = cw.Driveline("corner")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.PrescribedPosition("p", shaft=a, position=cw.Sine(amplitude=1.0, frequency=5.0), cutoff=5.0))
    run = d.simulate(4.0, dt=1e-3)
    # the coefficients of the filter have four digits
    assert np.max(run["a.angle"][3000:]) == pytest.approx(1 / math.sqrt(2), rel=1e-4)


def test_an_exact_sine_and_the_torque_that_it_takes() -> None:
    """phi = c + A sin(w t + p): the torque of 2 kg m2 is -2 A w^2 sin."""
    w = 2 * math.pi * 1.5
    d = cw.Driveline("sine")
    a = d.shaft("a", inertia=2.0)
    d.add(cw.PrescribedPosition("p", shaft=a, position=cw.Sine(amplitude=0.5, frequency=1.5, phase=0.3, offset=0.1)))
    run = d.simulate(1.1, rtol=1e-9)
    swing = np.sin(w * run.time + 0.3)
    assert np.allclose(run["a.angle"], 0.1 + 0.5 * swing, rtol=0.0, atol=1e-14)
    assert np.allclose(run["a.speed"], 0.5 * w * np.cos(w * run.time + 0.3), rtol=0.0, atol=1e-13)
    assert np.allclose(run["p.torque"], -(w**2) * swing, rtol=0.0, atol=1e-11)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_points_of_a_position_are_impulses() -> None:
    """A mass of 2 kg pushed at 3 m/s from 0.5 s on, halted at 1.5 s: 9 J in, and 9 J out again."""
    d = cw.Driveline("push")
    m = d.mass("m", mass=2.0)
    d.add(cw.PrescribedPosition("p", shaft=m, position=cw.Table([(0.5, 0.0), (1.5, 3.0)])))
    run = d.simulate(1.0)
    assert run["p.work"][-1] == pytest.approx(9.0, rel=1e-12)
    assert d.simulate(2.0)["p.work"][-1] == pytest.approx(0.0, abs=1e-12)
    assert at_end(d.simulate(2.0), "m.position") == pytest.approx(3.0, rel=1e-14)


def test_a_position_from_a_base_that_moves_itself() -> None:
    d = cw.Driveline("on top")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    # the one on top is named first
    d.add(cw.PrescribedPosition("top", shaft=b, base=a, position=cw.Ramp(height=1.0, duration=2.0, offset=0.2)))
    d.add(cw.PrescribedPosition("under", shaft=a, position=cw.Sine(amplitude=1.0, frequency=0.5, offset=3.0)))
    run = d.simulate(1.7)
    assert np.allclose(run["b.angle"] - run["a.angle"], 0.2 + 0.5 * run.time, rtol=0.0, atol=1e-13)
    assert np.allclose(run["a.angle"], 3.0 + np.sin(math.pi * run.time), rtol=0.0, atol=1e-13)


def test_a_shaken_base_against_the_closed_form() -> None:
    """x'' + w0^2 x = w0^2 A sin(w t) from rest: A w0/(w0^2 - w^2) (w0 sin(w t) - w sin(w0 t))."""
    d = cw.Driveline("shaken")
    base, m = d.mass("base", mass=1.0), d.mass("m", mass=0.5)
    w, w0, size = 2 * math.pi * 2.0, math.sqrt(200.0 / 0.5), 0.01
    d.add(cw.PrescribedPosition("shaker", shaft=base, position=cw.Sine(amplitude=size, frequency=2.0)))
    d.add(cw.Spring("k", base=base, follower=m, stiffness=200.0))
    run = d.simulate(2.0, **TIGHT)
    t = run.time
    wanted = size * w0 / (w0**2 - w**2) * (w0 * np.sin(w * t) - w * np.sin(w0 * t))
    assert np.allclose(run["m.position"], wanted, rtol=0.0, atol=1e-11)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


@pytest.mark.parametrize("name", SIGNALS)
def test_an_acceleration_and_its_integrals(name: str) -> None:
    signal, function = SIGNALS[name]
    d = cw.Driveline(name)
    m = d.mass("m", mass=2.0, speed=1.5, position=0.3)
    d.add(cw.PrescribedAcceleration("a", shaft=m, acceleration=signal))
    run = d.simulate(2.0, dt=0.1, **TIGHT)
    times = np.round(np.asarray(run.time), 12)
    wanted = _solved(lambda t, y: [function(t), y[0]], [1.5, 0.3], times)
    assert np.allclose(run["m.speed"], wanted[0], rtol=0.0, atol=1e-11)
    assert np.allclose(run["m.position"], wanted[1], rtol=0.0, atol=1e-11)


@pytest.mark.parametrize(
    ("made", "words"),
    [
        ({"position": cw.Step(height=0.3, start=1.0)}, "jumps by 0.3 rad at 1 s, which takes an infinite speed"),
        ({"position": cw.Table(POINTS)}, "jumps by -2.5 rad at 0.7 s"),
        ({"position": cw.Pulse(height=1.0, period=1.0, width=0.2)}, "repeats"),
        ({"position": cw.Sampled(lambda t, r: 0.0, 0.1), "cutoff": 2.0}, "set from outside"),
        ({"position": cw.Ramp(height=1.0, duration=1.0, offset=0.4), "angle": 0.1}, "starts at 0.4 rad, 'a' at 0.1"),
        ({"acceleration": cw.Pulse(height=1.0, period=1.0, width=0.2)}, "repeats"),
    ],
)
def test_what_has_no_speed_is_refused(made: dict[str, Any], words: str) -> None:
    d = cw.Driveline("refused")
    a = d.shaft("a", inertia=1.0, angle=made.pop("angle", 0.0))
    cls = cw.PrescribedPosition if "position" in made else cw.PrescribedAcceleration
    d.add(cls("p", shaft=a, **made))
    (problem,) = d.check()
    assert problem.quantity in made
    assert words in str(problem)


def test_a_given_speed_that_the_position_does_not_start_with() -> None:
    d = cw.Driveline("contradiction")
    a = d.shaft("a", inertia=1.0, speed=1.0)
    d.add(cw.PrescribedPosition("p", shaft=a, position=cw.Ramp(height=1.0, duration=0.5)))
    assert "contradicts the prescribed speeds, which give 2 rad/s" in str(d.check()[0])


def test_another_position_for_a_sweep_and_a_speed_from_outside() -> None:
    d = cw.Driveline("changed")
    m = d.mass("m", mass=1.0)
    d.add(cw.PrescribedPosition("p", shaft=m, position=cw.Ramp(height=1.0, duration=2.0)))
    made = d.assemble().changed({"p.position": cw.Ramp(height=3.0, duration=2.0)})
    assert cw.simulate(made, 2.0)["m.position"][-1] == pytest.approx(3.0, rel=1e-12)
    sim = cw.Simulator(d)
    sim.advance(1.0)
    sim.set("p.speed", -0.5)
    sim.advance(1.0)
    assert sim["m.position"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("ratio", [1.0, -2.0, 0.5])
@pytest.mark.parametrize("based", [False, True])
def test_an_acceleration_begins_with_the_speed_behind_a_gear(ratio: float, based: bool) -> None:
    """The shaft that it drives follows from one whose speed is given: it begins with that, not at rest."""
    d = cw.Driveline("behind")
    a, b, c = d.shaft("a", inertia=1.0, speed=3.0), d.shaft("b", inertia=0.0), d.shaft("c", inertia=2.0, speed=1.0)
    d.add(cw.Gear("gear", input=a, output=b, ratio=ratio))
    d.add(cw.PrescribedAcceleration("motion", shaft=b, acceleration=4.0, **({"base": c} if based else {})))
    run = d.simulate(0.5)
    assert run["b.speed"][0] == pytest.approx(3.0 / ratio, rel=1e-12)
    assert at_end(run, "b.speed") - based * at_end(run, "c.speed") == pytest.approx(3.0 / ratio - based + 2.0, rel=1e-9)


def test_a_jump_is_made_once_where_a_shaft_without_inertia_follows_it() -> None:
    """Its jump has the modes decided again; what has inertia must not jump again, nor the work of the source."""
    d = cw.Driveline("jump")
    carrier, light = d.shaft("carrier", inertia=2.0), d.shaft("light", inertia=0.0)
    left, right = d.shaft("left", inertia=0.3), d.shaft("right", inertia=0.1)
    d.add(cw.OpenDifferential("split", carrier=carrier, left=left, right=right))
    d.add(cw.Damper("one", base=carrier, follower=light, damping=1.0))
    d.add(cw.Damper("other", base=d.housing, follower=light, damping=1.0))
    # somewhere a contact, so that modes are decided
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Brake("brake", shaft=d.shaft("rests", inertia=1.0), friction=law, gain=1.0, normal_force=1.0))
    d.add(cw.PrescribedSpeed("motor", shaft=carrier, speed=cw.Step(height=6.0, start=0.1)))
    run = d.simulate(0.2, **TIGHT)
    # equal impulses on both sides, which add up to twice the jump of the carrier
    assert at_end(run, "left.speed") == pytest.approx(2 * 6.0 * 0.1 / 0.4, rel=1e-9)
    assert at_end(run, "right.speed") == pytest.approx(2 * 6.0 * 0.3 / 0.4, rel=1e-9)
    assert at_end(run, "light.speed") == pytest.approx(3.0, rel=1e-9)
    # of dampers in series for 0.1 s, besides what has been set in motion
    heat = 0.5 * 6.0**2 * 0.1
    kinetic = 0.5 * (2.0 * 6.0**2 + 0.3 * 3.0**2 + 0.1 * 9.0**2)
    assert run.energy.sources == {"motor": pytest.approx(kinetic + heat, rel=1e-9)}
    assert abs(run.energy.residual) <= 1e-9 * kinetic


def test_what_slips_beside_a_speed_that_bends_locks_where_its_slip_vanishes():
    # friction is constant and the other speed prescribed: events are exact at any tolerance, however long the steps
    d = cw.Driveline("driven")
    u, w = d.shaft("u", inertia=1.0), d.shaft("w", inertia=0.2)
    d.add(cw.PrescribedSpeed("p", shaft=u, speed=cw.Sine(amplitude=10.0, frequency=3.0)))
    law = cw.Coulomb(static=0.12, kinetic=0.1)
    d.add(cw.Clutch("c", base=u, follower=w, friction=law, gain=1.0, normal_force=200.0, locked=True))
    times = np.linspace(0.0, 1.0, 101)
    loose, tight = (d.simulate(1.0, rtol=rtol, atol=rtol / 100, times=times) for rtol in (1e-3, 1e-12))
    assert len(loose.events) == len(tight.events) > 10
    # round-off of speeds of 10 rad/s
    np.testing.assert_allclose(loose["w.speed"], tight["w.speed"], rtol=0.0, atol=1e-12)


def test_a_position_that_jumps_by_little_is_refused_and_round_off_is_none() -> None:
    """What a jump is compared with are the terms of both pieces there, not the largest position of all."""
    d = cw.Driveline("jump")
    a = d.shaft("a", inertia=1.0)
    large = cw.Table([(0.0, 0.0), (0.1, 0.0), (0.1, 4e-4), (0.2, 4e-4), (0.4, 1e6), (1.0, 1e6)])
    d.add(cw.PrescribedPosition("p", shaft=a, position=large))
    with pytest.raises(cw.ModelError, match=r"position jumps by 0\.0004 rad at 0\.1 s"):
        d.assemble()
    # -1e-4 + (1e-4/0.0058) 0.0058 is 1e-20
    round_off = cw.Table([(0.0, -1e-4), (0.0332, -1e-4), (0.039, 0.0), (0.06228, -0.01038)])
    d = cw.Driveline("round-off")
    d.add(cw.PrescribedPosition("p", shaft=d.shaft("a", inertia=1.0), position=round_off))
    assert d.simulate(0.1).status == "done"


@pytest.mark.parametrize("work", [True, False])
@pytest.mark.parametrize("share", [0.9, 0.99, 0.999, 0.9999])
@pytest.mark.parametrize("sets", [False, True])
def test_what_is_held_breaks_away_at_the_crest_of_a_swing(share: float, work: bool, sets: bool) -> None:
    # the torque of what follows is J A w sin(w t), above the capacity around its crest alone
    inertia, speed, pace = 0.05, 1.4, 120.0
    d = cw.Driveline("crest")
    a, b = d.shaft("a"), d.shaft("b", inertia=inertia, speed=-speed)
    swing = cw.Sine(amplitude=speed, frequency=pace / (2.0 * np.pi), phase=-0.5 * np.pi)
    d.add(cw.PrescribedSpeed("swing", shaft=a, speed=swing))
    most = share * inertia * speed * pace
    for n in range(2 if sets else 1):
        force = most / 0.1 / (2 if sets else 1)
        law = cw.Coulomb(static=0.1, kinetic=0.02)
        d.add(cw.PlateContact(f"c{n}", base=a, follower=b, friction=law, gain=1.0, normal_force=force, locked=True))
    run = d.simulate(0.02, work=work)
    first = [one.time for one in run.events if one.before == "locked"]
    assert first, "it holds more than it can"
    assert first[0] == pytest.approx(np.arcsin(share) / pace, rel=1e-7)
