"""Rigid stops against closed forms: impacts, bounces and their end, contact, and who takes part."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from reference.msl.model import translate
from support.runs import EXACT, TIGHT, at_end

MASS, WEIGHT, HEIGHT = 2.0, 20.0, 1.0  # kg, N, m
FALL = sqrt(2 * HEIGHT * MASS / WEIGHT)  # s


def ball(restitution: float, **fields: Any) -> cw.Driveline:
    """A ball above the floor, under its weight."""
    d = cw.Driveline("ball")
    body = d.mass("ball", mass=MASS, position=HEIGHT, speed=fields.pop("speed", 0.0))
    d.add(cw.EndStop("floor", follower=body, lower=0.0, lower_restitution=restitution, **fields))
    d.add(cw.Torque("weight", shaft=body, torque=fields.pop("weight", -WEIGHT)))
    return d


def impacts(run: Any, element: str | None = None) -> list[Any]:
    """Events at which a gap closed, in order."""
    return [e for e in run.events if e.cause in ("impact", "impulse") and element in (None, e.element)]


def test_a_ball_that_does_not_bounce_stays_on_the_floor() -> None:
    run = ball(0.0).simulate(1.0, **TIGHT)
    (hit,) = impacts(run)
    assert hit.time == pytest.approx(FALL, abs=EXACT)
    assert (hit.before, hit.after, hit.torque_after) == ("open", "locked", pytest.approx(WEIGHT))
    assert hit.energy_lost == pytest.approx(WEIGHT * HEIGHT, rel=1e-9)
    later = run.time > hit.time
    assert np.all(run["floor.position"][later] == 0.0)
    assert np.all(run["ball.speed"][later] == 0.0)
    assert run.energy.heat["floor"] == pytest.approx(WEIGHT * HEIGHT, rel=1e-9)


@pytest.mark.parametrize("restitution", [0.3, 0.5, 0.9])
def test_a_ball_bounces_at_known_times_and_its_bounces_end(restitution: float) -> None:
    """The n-th bounce takes 2 e^n of the fall; all together last (1 + e)/(1 - e) of it."""
    end = FALL * (1 + restitution) / (1 - restitution)
    run = ball(restitution).simulate(1.1 * end, **TIGHT)
    hits = impacts(run)
    times = FALL * (1 + 2 * np.cumsum(restitution ** np.arange(1, len(hits))))
    assert [e.time for e in hits[1:]] == pytest.approx(times, abs=EXACT)
    # what is left below the speed of rest, 1e-6 m/s
    assert hits[-1].after == "locked"
    assert end - 3e-7 / (1 - restitution) <= hits[-1].time <= end + EXACT
    speed = WEIGHT / MASS * FALL
    for n, hit in enumerate(hits[:10]):
        lost = 0.5 * MASS * (1 - restitution**2) * (speed * restitution**n) ** 2
        assert hit.energy_lost == pytest.approx(lost, rel=1e-8)
    assert np.min(run["floor.position"]) >= -1e-13
    assert at_end(run, "floor.torque") == pytest.approx(WEIGHT)


def test_an_elastic_ball_bounces_for_ever() -> None:
    run = ball(1.0).simulate(40.0, **TIGHT)
    times = FALL * np.arange(1, 90, 2)
    assert [e.time for e in impacts(run)] == pytest.approx(times[times <= 40.0], abs=1e-9)
    assert abs(run.energy.residual) <= 1e-12 * WEIGHT * HEIGHT


@pytest.mark.parametrize("restitution", [0.0, 0.6, 1.0])
def test_two_shafts_and_a_gear_with_play(restitution: float) -> None:
    """s+ = -e s-; heat (1 - e^2) J s^2/2 with the reduced inertia; the impulse is that of the closed form."""
    d = cw.Driveline("gear")
    motor = d.shaft("motor", inertia=0.3, speed=10.0)
    out = d.shaft("out", inertia=0.1)
    load = d.shaft("load", inertia=2.0, speed=1.0)
    d.add(cw.Gear("gear", input=motor, output=out, ratio=4.0))
    d.add(cw.Backlash("lash", base=out, follower=load, gap=0.02, restitution=restitution))
    one, slip = 0.3 * 16 + 0.1, 1.0 - 10.0 / 4
    run = d.simulate(0.012, **TIGHT)
    (hit,) = impacts(run)
    assert hit.time == pytest.approx(0.01 / 1.5, abs=EXACT)
    reduced = 1 / (1 / one + 1 / 2.0)
    impulse = (1 + restitution) * reduced * -slip
    assert at_end(run, "load.speed") == pytest.approx(1.0 + impulse / 2.0, rel=1e-12)
    assert at_end(run, "out.speed") == pytest.approx(2.5 - impulse / one, rel=1e-12)
    lost = (1 - restitution**2) * reduced * slip**2 / 2
    assert run.energy.heat["lash"] == pytest.approx(lost, abs=1e-14)
    assert run.energy.impulses == pytest.approx(lost, abs=1e-13)


@pytest.mark.parametrize(("gap", "speeds"), [(0.0, (-1 / 3, 2 / 3, 2 / 3)), (1e-3, (0.0, 0.0, 1.0))])
def test_three_equal_balls(gap: float, speeds: tuple[float, ...]) -> None:
    """Those that touch share an impact; across a gap it is handed on: docs/theory/play.md, rule 1."""
    d = cw.Driveline("cradle")
    places = (0.0, 0.1, 0.1 + gap)
    balls = [d.mass(f"b{i}", mass=0.5, position=x, speed=float(i == 0)) for i, x in enumerate(places)]
    for i in range(2):
        d.add(cw.EndStop(f"s{i}", base=balls[i], follower=balls[i + 1], lower=0.0, lower_restitution=1.0))
    run = d.simulate(0.2, **TIGHT)
    assert [at_end(run, f"b{i}.speed") for i in range(3)] == pytest.approx(speeds, abs=1e-12)
    assert abs(run.energy.residual) <= 1e-14
    assert run.energy.kinetic == pytest.approx(0.0, abs=1e-14)


def test_what_presses_holds_until_its_force_changes_sign() -> None:
    """A load A sin(t - p): at the lower end until p, then it swings to the upper end, where it is pressed at once."""
    d = cw.Driveline("slide")
    slide = d.mass("slide", mass=1.0, speed=0.0)
    d.add(cw.EndStop("ends", follower=slide, lower=0.0, upper=0.01))
    d.add(cw.Torque("push", shaft=slide, torque=cw.Sine(amplitude=3.0, frequency=1 / (2 * np.pi), phase=-0.4)))
    run = d.simulate(3.0, **TIGHT)
    opened, closed = list(run.events)[:2]
    assert (opened.time, opened.before, opened.after) == (pytest.approx(0.4, abs=EXACT), "locked", "open")
    assert opened.cause == "torque limit"
    # 3 (t - sin t) of the way
    assert 3 * (closed.time - 0.4 - np.sin(closed.time - 0.4)) == pytest.approx(0.01, abs=1e-12)
    assert np.all(run["ends.torque"][run.time < opened.time] >= 0.0)
    assert np.all(run["ends.torque"][run.time > closed.time] <= 0.0)


def test_a_backlash_driven_back_and_forth() -> None:
    """Limit cycle: at each turn of the torque the gap is crossed, sqrt(2 b J/T); each impact makes T b of heat."""
    inertia, torque, gap, half = 0.05, 2.0, 0.03, 0.1
    d = cw.Driveline("back and forth")
    shaft = d.shaft("j", inertia=inertia)
    d.add(cw.Backlash("lash", base=d.housing, follower=shaft, gap=gap, initial_twist=gap / 2))
    knots = [(k * half + side * 1e-12, torque * (-1) ** (k + side)) for k in range(8) for side in (0, 1)]
    d.add(cw.Torque("drive", shaft=shaft, torque=cw.Table([(t, y) for t, y in knots])))
    run = d.simulate(8 * half, **TIGHT)
    crossing = sqrt(2 * gap * inertia / torque)
    assert [e.time for e in impacts(run)] == pytest.approx(half * np.arange(8) + crossing, abs=1e-9)
    assert run.energy.heat["lash"] == pytest.approx(8 * torque * gap, rel=1e-9)


def test_friction_transmits_no_impulse() -> None:
    """A clutch behind the shaft that is hit slips, and locks again by its own torque."""
    d = cw.Driveline("behind a clutch")
    hammer, anvil, wheel = (d.shaft(n, inertia=J) for n, J in (("hammer", 1.0), ("anvil", 1.0), ("wheel", 3.0)))
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Clutch("clutch", base=anvil, follower=wheel, friction=law, gain=1.0, normal_force=6.0, locked=True))
    d.add(cw.Backlash("lash", base=anvil, follower=hammer, gap=0.2))
    d.add(cw.Torque("pull", shaft=hammer, torque=cw.Table([(0.0, 5.0), (0.2, 5.0), (0.2 + 1e-9, 0.0)])))
    run = d.simulate(2.0, **TIGHT)
    hit = impacts(run)[0]
    slipping = next(e for e in run.events if e.element == "clutch" and e.before == "locked")
    assert slipping.time == hit.time
    speed = 5.0 * 0.2
    at = np.searchsorted(run.time, hit.time, side="right")
    assert run["anvil.speed"][at] == pytest.approx(speed / 2, abs=1e-6)
    assert run["wheel.speed"][at] == pytest.approx(0.0, abs=1e-6)
    # momentum, and all of them locked together
    assert at_end(run, "wheel.speed") == pytest.approx(speed / 5.0, rel=1e-8)


def test_a_start_at_an_end() -> None:
    """Closing: an impulse at the start, and its heat is counted; parting: nothing; at rest: decided by the forces."""
    d = ball(0.5, initial_position=0.0, speed=-1.0)
    run = d.simulate(0.01, **TIGHT)
    (hit,) = impacts(run)
    assert (hit.time, hit.cause) == (0.0, "impulse")
    assert run["ball.speed"][0] == pytest.approx(0.5)
    assert run.energy.heat["floor"] == pytest.approx(0.5 * MASS * 0.75)
    assert abs(run.energy.residual) <= 1e-13
    assert not impacts(ball(0.5, initial_position=0.0, speed=1.0).simulate(0.01))
    still = ball(0.5, initial_position=0.0).simulate(0.01)
    assert still["floor.state"][0] == "locked"
    assert at_end(still, "floor.torque") == pytest.approx(WEIGHT)


def test_two_ends_that_are_met_together() -> None:
    """A bar between two walls that close at the same instant, with restitutions of their own."""
    d = cw.Driveline("twins")
    for name, e in (("a", 0.2), ("b", 0.8)):
        body = d.shaft(name, inertia=0.3, speed=-2.0)
        d.add(cw.EndStop(f"{name} stop", follower=body, lower=-0.5, lower_restitution=e))
    run = d.simulate(0.4, **TIGHT)
    assert [e.time for e in impacts(run)] == pytest.approx([0.25, 0.25], abs=1e-12)
    assert at_end(run, "a.speed") == pytest.approx(0.4)
    assert at_end(run, "b.speed") == pytest.approx(1.6)


def test_friction_and_stop_hold_together() -> None:
    """Pulled from its stop a body with friction stays until the pull exceeds the friction."""
    d = cw.Driveline("stuck")
    slide = d.mass("slide", mass=1.0)
    d.add(cw.EndStop("stop", follower=slide, lower=0.0))
    d.add(cw.BearingFriction("guide", shaft=slide, friction=cw.Coulomb(static=1.2, kinetic=1.0), torque=5.0))
    d.add(cw.Torque("pull", shaft=slide, torque=cw.Ramp(height=20.0, duration=2.0, offset=-10.0)))
    run = d.simulate(2.0, **TIGHT)
    # -10 + 10 t exceeds 6 N
    opened = [e for e in run.events.of("guide") if e.before == "locked"]
    assert [e.time for e in opened] == [pytest.approx(1.6, abs=1e-9)]
    assert np.min(run["stop.torque"]) >= -1e-9
    assert np.max(np.abs(run["guide.torque"])) <= 6.0 * (1 + 1e-9)


def test_a_wall_that_moves() -> None:
    """Against a prescribed speed u the ball leaves at u + e (u - v); the source takes its share of the energy."""
    d = cw.Driveline("racket")
    racket, body = d.mass("racket"), d.mass("ball", mass=0.5, speed=-3.0, position=0.2)
    d.add(cw.PrescribedSpeed("arm", shaft=racket, speed=2.0))
    d.add(cw.EndStop("strings", base=racket, follower=body, lower=0.0, lower_restitution=0.7))
    run = d.simulate(0.06, rtol=1e-11, atol=1e-12)
    assert [e.time for e in impacts(run)] == [pytest.approx(0.04, abs=EXACT)]
    assert at_end(run, "ball.speed") == pytest.approx(2.0 + 0.7 * 5.0, rel=1e-12)
    assert abs(run.energy.residual) <= 1e-12


@pytest.mark.parametrize("signal", [1.0, cw.Sine(amplitude=2.0, frequency=0.5)])
def test_prescribed_speeds_go_beyond_a_stop(signal: Any) -> None:
    d = cw.Driveline("blocked")
    shaft = d.shaft("shaft")
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=signal))
    d.add(cw.EndStop("stop", follower=shaft, upper=0.3))
    with pytest.warns(cw.StoppedEarly, match="beyond a stop"):
        run = d.simulate(2.0)
    assert run.status == "jammed"
    assert "'stop'" in run.message


def test_mistakes() -> None:
    d = cw.Driveline("wrong")
    body = d.mass("m", mass=1.0, position=2.0)
    d.add(cw.EndStop("none", follower=body))
    d.add(cw.EndStop("turned", follower=body, lower=1.0, upper=0.5))
    d.add(cw.EndStop("outside", follower=body, lower=0.0, upper=1.0))
    d.add(cw.Backlash("twist", base=d.housing, follower=body, gap=0.1, initial_twist=0.2))
    found = "\n".join(map(str, d.check()))
    for words in (
        "give one end or both",
        "not above the lower end",
        "is 2 at the start, above the upper end, 1",
        "outside the gap of 0.1",
    ):
        assert words in found


def test_a_run_goes_on_from_a_closed_stop() -> None:
    """A state that was saved in contact, and one between two bounces."""
    for time in (0.7, 2.5):
        whole, again = cw.Simulator(ball(0.6)), cw.Simulator(ball(0.6))
        whole.advance_to(time)
        again.restore(whole.save())
        for sim in (whole, again):
            sim.advance_to(3.0)
        assert [again[name] for name in ("ball.position", "ball.speed", "floor.torque", "floor.work")] == [
            whole[name] for name in ("ball.position", "ball.speed", "floor.torque", "floor.work")
        ]
        assert list(again.events) == [e for e in whole.events if e.time > time]


def test_a_mass_with_stop_and_friction_of_the_conventions() -> None:
    """Slowed by its friction it stays where it meets its stop, its centre half its length short of it."""
    stopped = {"type": "mass_with_stop_and_friction", "m": 2.0, "L": 0.2, "smin": -1.0, "smax": 1.0}
    friction = {"F_prop": 1.0, "F_Coulomb": 4.0, "F_Stribeck": 2.0, "fexp": 3.0}
    case = {
        "name": "slide",
        "stop_time": 2.0,
        "elements": {"m": {**stopped, **friction}},
        "connections": [],
        "signals": {},
        "initial": {"m.s": 0.0, "m.v": 5.0},
        "outputs": [{"csv": "s", "signal": "m.s"}, {"csv": "v", "signal": "m.v"}],
    }
    model = translate(case)
    run = model.driveline.simulate(2.0, **TIGHT)
    (hit,) = impacts(run)

    def slope(t: float, y: list[float]) -> list[float]:
        return [y[1], -(y[1] + 4.0 + 2.0 * np.exp(-3.0 * y[1])) / 2.0]

    known = solve_ivp(slope, (0.0, hit.time), [0.0, 5.0], rtol=1e-11, atol=1e-12)
    assert known.y[0][-1] == pytest.approx(0.9, abs=1e-8)
    assert model.outputs["s"](run)[-1] == pytest.approx(0.9, abs=1e-12)
    assert model.outputs["v"](run)[-1] == 0.0
    assert hit.energy_before == pytest.approx(known.y[1][-1] ** 2, rel=1e-8)


@pytest.mark.parametrize("push", [-5.0, -8.0, -9.5])
@pytest.mark.parametrize("law", [cw.Coulomb(static=0.4, kinetic=0.4), cw.Stribeck(static=0.4, kinetic=0.2, speed=5.0)])
def test_bounces_that_a_brake_makes_smaller_end(law: cw.Law, push: float) -> None:
    """A wheel of 40 N m between two plays that are drawn apart: each end strikes the two others, in turns.

    With u, what is left of a strike, the struck pair stops within u^2 / 2 a_pair, and the other end comes back at the
    root of u^2 - a_end u^2 / a_pair.
    """
    d = cw.Driveline("two plays")
    left, wheel, right = (d.shaft(name, inertia=1.0) for name in ("left", "wheel", "right"))
    for name, base, follower in (("first", left, wheel), ("second", wheel, right)):
        d.add(cw.Backlash(name, base=base, follower=follower, gap=0.01))
    for shaft, torque in ((left, push), (right, 10.0)):
        d.add(cw.Torque(f"pull_{shaft.name}", shaft=shaft, torque=torque))
    d.add(cw.Brake("brake", shaft=wheel, friction=law, gain=1.0, normal_force=100.0))
    run = d.simulate(0.5, **TIGHT)
    assert run.status == "done"
    times = np.array([e.time for e in impacts(run, "first")])
    # kg m2 three of them move after a strike, two of them brake
    shares = [sqrt(1.0 - own / (0.5 * (40.0 - other))) / 3.0 for own, other in ((-push, 10.0), (10.0, -push))]
    ratio = shares[0] * shares[1]
    gaps = np.diff(times)
    assert gaps[1:3] / gaps[:2] == pytest.approx([ratio, ratio], rel=1e-3)
    assert times[-1] == pytest.approx(times[1] + gaps[1] / (1.0 - ratio), abs=1e-8)
    assert all(at_end(run, f"{shaft}.speed") == 0.0 for shaft in ("left", "wheel", "right"))


@pytest.mark.parametrize("seed", range(70, 100))
def test_flanks_push_their_shafts_and_do_not_pull(seed: int) -> None:
    """Stars of shafts at the flanks of elastic plays, which strike each other several times at one instant."""
    rng = np.random.default_rng([seed, 16])
    d = cw.Driveline("star")
    ends = int(rng.integers(2, 4))
    speeds, inertias = rng.integers(-9, 10, ends + 1).astype(float), 10.0 ** rng.uniform(-1.0, 0.5, ends + 1)
    shafts = [d.shaft(f"s{k}", inertia=inertias[k], speed=speeds[k]) for k in range(ends + 1)]
    sides = rng.choice([-1.0, 1.0], ends)
    for k, side in enumerate(sides, start=1):
        bounce = float(rng.choice([0.0, 0.5, 1.0]))
        twist = 0.005 * float(side)
        play = cw.Backlash(
            f"p{k}", base=shafts[0], follower=shafts[k], gap=0.01, restitution=bounce, initial_twist=twist
        )
        d.add(play)
    run = d.simulate(1e-6)
    after = np.array([run[f"s{k}.speed"][0] for k in range(ends + 1)])
    # at its upper end a follower is pushed down
    assert np.all(-sides * (after - speeds)[1:] >= -1e-9 * 10.0)
    assert inertias @ after == pytest.approx(inertias @ speeds, abs=1e-9 * 10.0 * inertias.sum())


def test_two_plays_that_open_each_other_come_to_rest() -> None:
    """A shaft between two flanks and two clutches: each blow opens the other flank, by less each time."""
    d = cw.Driveline("between")
    names = {"a": 0.5, "b": 1.0, "c": 0.1, "e": 1.0, "end": 2.0}
    a, b, c, e, end = (d.shaft(n, inertia=j, speed=1.0 if n == "c" else 0.0) for n, j in names.items())
    d.add(cw.Backlash("left", base=a, follower=b, gap=0.01))
    d.add(cw.EndStop("stop", base=b, follower=c, lower=-0.05, upper=0.05))
    d.add(cw.Backlash("right", base=c, follower=e, gap=0.01))
    d.add(cw.SpringDamper("spring", base=a, follower=end, stiffness=1000.0, damping=0.0))
    holding, sliding = cw.Coulomb(static=0.24, kinetic=0.2), cw.Coulomb(static=0.3, kinetic=0.25)
    d.add(cw.Clutch("held", base=b, follower=end, friction=holding, gain=1.0, normal_force=100.0))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Ramp(height=20.0, duration=0.1, start=0.15)))
    load = cw.Sine(amplitude=80.0, frequency=2.0, offset=80.0, phase=np.pi / 2)
    d.add(cw.Clutch("wave", base=a, follower=c, friction=sliding, gain=1.0, normal_force=load))
    run = d.simulate(0.5)
    assert run.status == "done"
    assert len(run.events) < 1000
    # of the turnover of some joules, to the tolerance of the run
    assert abs(run.energy.residual) < 1e-6
