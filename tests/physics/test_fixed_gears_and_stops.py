"""Steps of one length through gear losses and stops: docs/theory/fixed-steps.md, rules 6 and 7."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount
from support.any_model import agree, judge, model


def fixed(step: float) -> dict[str, Any]:
    return {"method": "fixed", "step": step}


def geared(kind: str) -> cw.Driveline:
    """A motor whose torque swings through zero, a gear with losses, and a disc behind a shaft."""
    d = cw.Driveline(kind)
    motor, hub = d.shaft("motor", inertia=0.05, speed=20.0), d.shaft("hub", inertia=0.4)
    disc = d.shaft("disc", inertia=0.6)
    losses = {"efficiency": 0.93, "backward_efficiency": 0.9, "bearing_torque": 0.2}
    table = [[0.0, 0.8, 0.75, 0.5, 0.5], [10.0, 0.9, 0.85, 0.3, 0.3], [60.0, 0.95, 0.9, 0.2, 0.2]]
    gear = {
        "lossy": lambda: cw.LossyGear("gear", input=motor, output=hub, ratio=4.0, **losses),
        "table": lambda: cw.LossyGear("gear", input=motor, output=hub, ratio=4.0, loss_table=table),
        "poor": lambda: cw.LossyGear(
            "gear", input=motor, output=hub, ratio=4.0, efficiency=0.5, backward_efficiency=0.3
        ),
        "self-locking": lambda: cw.WormGear(
            "gear", worm=motor, wheel=hub, ratio=30.0, lead_angle=0.08, friction_coefficient=0.12
        ),
    }
    d.add(gear[kind]())
    d.add(cw.SpringDamper("shaft", base=hub, follower=disc, stiffness=900.0, damping=2.0))
    d.add(cw.Damper("drag", base=d.housing, follower=disc, damping=1.0))
    d.add(cw.Torque("drive", shaft=motor, torque=cw.Sine(amplitude=60.0, frequency=1.3, offset=5.0)))
    return d


@pytest.mark.parametrize("kind", ["lossy", "table", "poor", "self-locking"])
def test_gear_losses_follow_their_load(kind: str) -> None:
    system, times = geared(kind).assemble(), np.linspace(0.0, 2.0, 41)
    names = ("motor", "hub", "disc")

    def speeds(**options: Any) -> np.ndarray:
        run = cw.simulate(system, 2.0, times=times, **options)
        assert run.finished, run.message
        # of the exact run the error of its tolerance, of steps of one length round-off
        assert abs(run.energy.residual) < (1e-12 if options.get("step") else 1e-9) * run.energy.turnover
        return np.array([run[f"{name}.speed"] for name in names])

    exact = speeds(rtol=1e-10, atol=1e-12)
    steps = [2e-3, 1e-3, 5e-4, 2.5e-4]
    errors = [float(np.abs(speeds(**fixed(step)) - exact).max() / np.abs(exact).max()) for step in steps]
    # two between events, one where the load jumps with the slip
    assert np.polyfit(np.log(steps), np.log(errors), 1)[0] > 0.8, errors
    # of the largest speed, at 1 ms
    assert errors[1] < 2e-3, errors


def test_a_gear_at_rest_beside_a_brake_that_holds_it() -> None:
    """What loads the gear is round-off there, which decides nothing: no torque below the static one moves it."""
    d = cw.Driveline("held")
    rotor, flange = d.shaft("rotor", inertia=1.5e-4), d.shaft("flange", inertia=0.02)
    d.add(cw.Torque("motor", shaft=rotor, torque=0.0))
    stiction = cw.Stribeck(static=0.03, kinetic=0.02, speed=2.0)
    d.add(cw.Brake("seal", shaft=rotor, friction=stiction, gain=1.0, normal_force=1.0))
    d.add(cw.LossyGear("gear", input=rotor, output=flange, ratio=100.0, efficiency=0.7))
    torques = np.linspace(-0.0299, 0.0299, 200)
    sims = cw.Simulators(d, len(torques), **fixed(1e-3))
    sims["motor.torque"] = torques
    sims.advance(1e-3)
    for _ in range(20):
        sims.advance(1e-3)
        assert not sims.events
    assert not sims.failed.any()
    assert np.abs(sims["rotor.speed"]).max() < 1e-12
    assert np.abs(sims["seal.torque"] + torques).max() < 1e-12


def bound(run: cw.Trajectory) -> np.ndarray:
    """What the gear takes of the torque of its input less what friction takes of it, in units of that."""
    return np.abs(run["gear.torque"]) - run["gear.capacity"]


@pytest.mark.parametrize("kind", ["lossy", "poor", "self-locking"])
def test_a_contact_holds_what_its_load_lets_it(kind: str) -> None:
    """The friction of each row is within its bound at the load of the same step, not of the last one."""
    run = geared(kind).simulate(2.0, output="steps", **fixed(1e-3))
    assert bound(run).max() < 1e-9 * run["gear.capacity"].max()


def falling(restitution: float) -> cw.Driveline:
    """A disc that a constant torque drives against a stop."""
    d = cw.Driveline("falling")
    disc = d.shaft("disc", inertia=2.0)
    d.add(cw.Torque("pull", shaft=disc, torque=-20.0))
    d.add(cw.EndStop("stop", follower=disc, lower=-1.0, lower_restitution=restitution, rest_speed=1e-3))
    return d


def test_bounces_are_those_of_the_closed_form() -> None:
    """The parabola of a constant torque is exact, so that every impact is where it should be."""
    run = falling(0.6).simulate(2.0, times=[0.7, 2.0], **fixed(1e-3))
    # 10 rad/s2 over 1 rad, then bounces of 2 s / a each
    first, speed = np.sqrt(0.2), 10.0 * np.sqrt(0.2)
    at = first + np.cumsum([0.0, *(2 * speed * 0.6**k / 10.0 for k in range(1, 5))])
    # round-off of 2000 sums
    assert [e.time for e in run.events][:5] == pytest.approx(at, abs=1e-12)
    assert run["disc.angle"][-1] == pytest.approx(-1.0, abs=1e-12)
    assert run["disc.speed"][-1] == 0.0
    assert run.events[-1].after == "locked"


def rattling() -> cw.Driveline:
    """Two discs with play between them, driven by a torque that swings, against a stop of their own."""
    d = cw.Driveline("rattling")
    a, b = d.shaft("a", inertia=0.2, speed=5.0), d.shaft("b", inertia=0.5)
    d.add(cw.Backlash("play", base=a, follower=b, gap=0.05, restitution=0.3))
    d.add(cw.EndStop("stop", follower=b, upper=0.6, upper_restitution=0.2))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=8.0, frequency=2.0)))
    d.add(cw.Damper("drag", base=d.housing, follower=b, damping=0.3))
    return d


def test_play_and_stops() -> None:
    system, times = rattling().assemble(), np.linspace(0.05, 1.0, 20)
    exact = cw.simulate(system, 1.0, times=times, rtol=1e-10, atol=1e-12)
    assert {"play", "stop"} <= {event.element for event in exact.events}
    errors = []
    for step in (2e-3, 1e-3, 5e-4):
        run = cw.simulate(system, 1.0, times=times, **fixed(step))
        assert run.finished, run.message
        assert abs(run.energy.residual) < 1e-12 * run.energy.turnover
        # nothing goes through a stop: each impact is off by some millionths of the play at 2 ms
        assert np.abs(run["a.angle"] - run["b.angle"]).max() < 0.025 * (1 + 1e-4)
        assert run["b.angle"].max() < 0.6 * (1 + 1e-4)
        errors.append(max(np.abs(run[f"{name}.speed"] - exact[f"{name}.speed"]).max() for name in "ab"))
    # instants of impacts are of second order as the motion between them, what follows of first at the least
    assert errors[2] < 0.5 * errors[0]
    # rad/s of 5
    assert errors[1] < 5e-3


def test_balls_in_a_row_pass_an_impact_on() -> None:
    """Newton's cradle within one step: the last ball leaves with the speed of the first."""
    d = cw.Driveline("cradle")
    balls = [d.shaft(f"ball{i}", inertia=1.0, speed=1.0 if i == 0 else 0.0) for i in range(4)]
    for i in range(3):
        gap = {"gap": 2e-4, "restitution": 1.0, "initial_twist": 0.0}
        d.add(cw.Backlash(f"play{i}", base=balls[i], follower=balls[i + 1], **gap))
    run = d.simulate(4e-4, **fixed(1e-3))
    assert [run[f"ball{i}.speed"][-1] for i in range(4)] == pytest.approx([0.0, 0.0, 0.0, 1.0], abs=1e-12)
    # what goes on within the step is bounded, and ends together
    run = d.simulate(0.1, times=[0.0, 0.1], **fixed(1e-3))
    assert run.finished
    assert sum(run[f"ball{i}.speed"][-1] for i in range(4)) == pytest.approx(1.0, abs=1e-12)


def test_many_impacts_of_one_step_end() -> None:
    """A tight play that rattles within each step: bounded, without a gain of energy."""
    d = cw.Driveline("tight")
    a, b = d.shaft("a", inertia=0.2, speed=5.0), d.shaft("b", inertia=0.5)
    d.add(cw.Backlash("play", base=a, follower=b, gap=1e-6, restitution=0.9))
    run = d.simulate(0.1, times=[0.0, 0.1], **fixed(1e-3))
    assert run.finished
    # both go on together with the momentum of the first
    assert run["a.speed"][-1] == pytest.approx(5.0 * 0.2 / 0.7, rel=1e-9)
    assert abs(run.energy.residual) < 1e-12 * run.energy.turnover
    assert run.statistics["steps"] < 120


def test_saved_states_go_on_with_the_same_bits() -> None:
    for d in (geared("poor"), rattling()):
        system, times = d.assemble(), [0.31, 0.4, 0.6]
        whole = cw.simulate(system, 0.6, times=times, **fixed(1e-3))
        state = cw.simulate(system, 0.6, **fixed(1e-3)).state(0.3)
        rest = cw.simulate(system, 0.6, times=times, start=state, **fixed(1e-3))
        assert rest.rows.tobytes() == whole.rows.tobytes()


def test_a_stop_between_prescribed_speeds_jams() -> None:
    d = cw.Driveline("driven")
    a = d.shaft("a", speed=1.0)
    d.add(cw.PrescribedSpeed("drive", shaft=a, speed=1.0))
    d.add(cw.EndStop("stop", follower=a, upper=0.1))
    with pytest.warns(cw.StoppedEarly, match=r"stopped at 0\.1 s: prescribed speeds go beyond a stop at 'stop'"):
        d.simulate(1.0, **fixed(1e-3))


@pytest.mark.random
def test_random_drivelines_close_their_energy() -> None:
    """Whatever fixed steps take: each run ends as the exact one does, and accounts for all energy."""
    taken, lost, open_parts = 0, [], []
    for seed in range(amount(100)):
        made = model.model(seed)
        try:
            exact = agree.run(made)
            if exact.status != "done" or judge.explodes(exact):
                continue
            run = agree.run(made, output="steps", **fixed(1e-4))
        except cw.ClutchworkError:
            continue
        taken += 1
        if not run.finished:
            lost.append(f"seed {seed}: {run.message}")
            continue
        open_parts.append(abs(run.energy.residual) / (run.energy.turnover + 1e-9))
    assert taken > amount(100) // 4
    # round-off of thousands of steps; an elastic flank that is met within a step is not a linear spring over it
    assert np.quantile(open_parts, 0.95) < 1e-9
    # an oscillation beyond two radians a step may grow without a bound
    assert len(lost) <= 0.03 * taken + 1, lost


def test_an_engine_at_rest_stays_there() -> None:
    """The round-off of a locked shaft has a sign, with which the torque of a stalled engine must not change."""
    d = cw.Driveline("stalled")
    shaft = d.shaft("crank", inertia=0.4)
    speeds, throttles = [0.0, 9.44, 23.6], [0.0, 0.4, 1.0]
    torques = [[-12.5, 5.43, 41.3], [-12.5, 14.4, 34.9], [-12.5, 6.24, 56.6]]
    engine = {"speeds": speeds, "throttles": throttles, "torques": torques, "throttle": 0.517, "initial_throttle": 0.0}
    d.add(cw.Engine("engine", shaft=d.housing, base=shaft, **engine))
    d.add(cw.Torque("starter", shaft=shaft, torque=14.6))
    exact, run = d.simulate(0.05), d.simulate(0.05, **fixed(1e-3))
    assert np.abs(exact["crank.speed"]).max() < 1e-9
    assert np.abs(run["crank.speed"]).max() < 1e-9


def hoist(count: int) -> cw.Driveline:
    """Worm gears that lock themselves, each driven forward while its heavy load would turn it back."""
    d = cw.Driveline("hoists")
    for i in range(count):
        worm, wheel = d.shaft(f"worm{i}", inertia=0.05, speed=60.0), d.shaft(f"wheel{i}", inertia=40.0)
        gear = {"ratio": 30.0, "lead_angle": 0.08, "friction_coefficient": 0.3}
        d.add(cw.WormGear(f"gear{i}", worm=worm, wheel=wheel, **gear))
        d.add(cw.Torque(f"motor{i}", shaft=worm, torque=cw.Table([(0.0, 5.0), (0.1, 5.0), (0.3, -5.0)])))
        d.add(cw.Torque(f"load{i}", shaft=wheel, torque=-100.0))
    return d


@pytest.mark.parametrize("count", [1, 2, 3])
def test_gears_that_lock_themselves_do_not_know_of_each_other(count: int) -> None:
    """Heavy wheels, at which the friction would feed itself on the wrong line; each alone decides that."""
    d, times = hoist(count), np.linspace(0.0, 1.5, 31)
    exact, run = d.simulate(1.5, times=times, rtol=1e-9), d.simulate(1.5, times=times, **fixed(1e-3))
    assert run.finished, run.message
    for i in range(count):
        # rad/s of 60: of first order where it locks
        assert np.abs(run[f"worm{i}.speed"] - exact[f"worm{i}.speed"]).max() < 0.1


def test_an_impact_before_a_knot_of_the_same_step() -> None:
    """The part of a step up to an impact has the signals of that part."""
    d = cw.Driveline("late")
    disc = d.shaft("disc", inertia=1.0, speed=-1.0)
    d.add(cw.EndStop("stop", follower=disc, lower=-0.052, lower_restitution=0.5))
    d.add(cw.Torque("push", shaft=disc, torque=cw.Table([(0.0, 0.0), (0.0545, 0.0), (0.0545, 1000.0), (1.0, 1000.0)])))
    run = d.simulate(0.06, times=[0.06], **fixed(5e-3))
    assert [(event.element, event.cause) for event in run.events] == [("stop", "impact")]
    assert run.events[0].time == pytest.approx(0.052, abs=1e-12)
    # half of 1 rad/s back; a torque that jumps inside a part of a step acts from the next middle on
    assert run["disc.speed"][-1] == pytest.approx(0.5 + 1000.0 * 5e-3, abs=1e-9)


def test_a_row_at_the_instant_of_an_impact_is_there() -> None:
    d = cw.Driveline("end")
    disc = d.shaft("disc", inertia=1.0, speed=1.0)
    d.add(cw.EndStop("stop", follower=disc, upper=0.0105, upper_restitution=0.5))
    run = d.simulate(0.0105, times=[0.0, 0.0105], **fixed(1e-3))
    assert run.time.tolist() == [0.0, 0.0105]
    steps = d.simulate(0.0105, output="steps", **fixed(1e-3))
    # both sides of it
    assert steps["disc.speed"][-2:] == pytest.approx([1.0, -0.5])


def swung(gap: float) -> cw.Driveline:
    """Two free discs with play, thrown from one flank to the other."""
    d = cw.Driveline("swung")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.Backlash("play", base=a, follower=b, gap=gap))
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=500.0, frequency=11.0)))
    return d


@pytest.mark.parametrize("step", [7e-3, 1e-3])
def test_no_flank_is_passed(step: float) -> None:
    """One that opens in a step may meet the other flank in it; positions stay those of the shafts."""
    run = swung(1e-3).simulate(2.0, output="steps", **fixed(step))
    assert len(run.events) > 50
    twist = run["b.angle"] - run["a.angle"]
    # each impact misses the flank by what the second order leaves of its part of a step
    assert np.abs(twist).max() < 0.5e-3 * (1 + 1e-2)


def test_what_an_impact_breaks_loose_is_an_event() -> None:
    d = cw.Driveline("struck")
    a, b = d.shaft("a", inertia=1.0, speed=1.0), d.shaft("b", inertia=1.0, speed=1.0)
    law = cw.Coulomb(static=0.2, kinetic=0.1)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1.0, normal_force=10.0, locked=True))
    d.add(cw.EndStop("stop", follower=a, upper=0.0105, upper_restitution=0.5))
    told = [
        [(e.element, e.before, e.after, e.cause) for e in d.simulate(0.05, **how).events] for how in ({}, fixed(1e-3))
    ]
    assert ("c", "locked", "forward", "other event") in told[0]
    assert ("c", "locked", "forward", "other event") in told[1]


def test_calls_that_end_behind_an_impact_change_nothing() -> None:
    """More events than one call holds, and calls of their own."""
    system = swung(1e-3).assemble()
    times = np.linspace(0.0, 8.0, 5)
    whole = cw.simulate(system, 8.0, times=times, **fixed(1e-3))
    assert len(whole.events) > 300
    steps = cw.simulate(system, 8.0, output="steps", **fixed(1e-3))
    assert steps["a.speed"][-1] == whole["a.speed"][-1]
