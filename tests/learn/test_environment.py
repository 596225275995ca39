"""Environments: what Gymnasium asks of one, and that a step is that of the Simulator."""

from __future__ import annotations

import sys

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import clutchwork as cw
from support.random_contacts import driveline as random_driveline


def discs() -> cw.Driveline:
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    lining = cw.Coulomb(static=0.125, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=5e-4, pressure=0.0))
    return d


def reward(moment: cw.Moment) -> float:
    return float(moment.now["load.speed"] - moment.before["load.speed"])


def environment(**more):
    given = {
        "actions": {"c1.pressure": (0.0, 2e5)},
        "observations": {"engine.speed": (0.0, 100.0), "c1.slip": (-100.0, 100.0)},
        "reward": reward,
    }
    return cw.environment(discs(), 2.0, **(given | more))


def checked(make) -> None:
    """What Gymnasium checks of an environment that people registered."""
    gymnasium.register("clutchwork-test-v0", entry_point=make)
    try:
        check_env(gymnasium.make("clutchwork-test-v0").unwrapped)
    finally:
        gymnasium.registry.pop("clutchwork-test-v0")


@pytest.mark.parametrize("modes", [{}, {"render_mode": "rgb_array"}])
def test_what_gymnasium_checks(modes):
    checked(lambda **more: environment(vary={"c1.gain": (4e-4, 6e-4)}, **(modes | more)))


@pytest.mark.parametrize("seed", range(20))
def test_gymnasium_checks_random_drivelines(seed):
    d = random_driveline(seed, simple=True)
    names = [item.name for item in d.assemble().inputs]
    pressed = [name for name in names if name.endswith(("pressure", "normal_force", "torque"))]
    assert pressed
    checked(
        lambda **more: cw.environment(
            d,
            0.1,
            actions=dict.fromkeys(pressed, (0.0, 500.0)),
            observations={f"{node.name}.speed": (-300.0, 300.0) for node in d.nodes},
            reward=lambda moment: 0.0,
            **more,
        )
    )


def test_full_pressure_is_the_engagement_in_closed_form():
    env = environment()
    env.reset(seed=0)
    total, over, time = 0.0, False, []
    while not over:
        _, one, ended, over, info = env.step(np.array([1.0]))
        total, time = total + one, [*time, info["time"]]
        assert not ended
    # 10 N m for 1.6 s: both turn with 20 rad/s
    lock = env.unwrapped.sim.events.of("c1")[-1]
    assert lock.time == pytest.approx(1.6, abs=1e-9)
    assert total == pytest.approx(20.0, abs=1e-9)
    assert time == pytest.approx(np.arange(1, 201) * 0.01, abs=1e-12)


def test_an_episode_equals_a_simulator_stepped_by_hand():
    draw = np.random.default_rng(3)
    actions = draw.uniform(-1.0, 1.0, 50)
    env, sim = environment(), cw.Simulator(discs())
    seen, _ = env.reset()
    for action in actions:
        seen, *_ = env.step(np.array([action]))
        sim.set("c1.pressure", float((action + 1.0) / 2.0 * 2e5))
        sim.advance(0.01)
        assert env.unwrapped.sim["engine.speed"] == sim["engine.speed"]
    assert seen[0] == np.float32(2.0 * sim["engine.speed"] / 100.0 - 1.0)


def test_the_same_seed_is_the_same_episode():
    env = environment(
        vary={"c1.gain": (4e-4, 6e-4), "load.inertia": [0.5, 0.8], "engine.speed": lambda g: g.normal(90)}
    )
    drawn = [env.reset(seed=seed)[1]["values"] for seed in (7, 8, 7)]
    assert drawn[0] == drawn[2] != drawn[1]
    assert 4e-4 <= drawn[0]["c1.gain"] <= 6e-4
    # speeds are read from momenta
    assert env.unwrapped.sim["engine.speed"] == pytest.approx(drawn[0]["engine.speed"], rel=1e-14)
    given = {"values": {"c1.gain": 5e-4, "load.inertia": 2.0, "engine.speed": 10.0}}
    assert env.reset(options=given)[1]["values"] == given["values"]


def test_a_failed_run_ends_the_episode():
    d = discs()
    d.add(
        cw.Torque("broken", shaft=d.nodes[0], torque=cw.Sampled(lambda time, _: 0.0 if time < 0.015 else 1 / 0, 0.01))
    )
    env = cw.environment(
        d,
        2.0,
        actions={"c1.pressure": (0.0, 2e5)},
        observations=["engine.speed"],
        reward=lambda m: -float(bool(m.failure)),
    )
    env.reset()
    steps = [env.step(np.array([0.0]))[1:3] for _ in range(3)]
    assert steps == [(0.0, False), (0.0, False), (-1.0, True)]


def test_values_out_of_their_range_are_seen_at_its_end():
    env = environment(observations={"engine.speed": (0.0, 50.0), "load.speed": None})
    seen, _ = env.reset()
    assert seen.tolist() == [1.0, 0.0]


def test_all_mistakes_at_once():
    with pytest.raises(cw.UseError) as caught:
        environment(
            actions={"c1.pressure": (0.0, 0.0)}, observations=3, reward=1, ends=2, vary={"c1.gain": 1.0}, period=-1,
            render_mode="human",
        )  # fmt: skip
    for words in (
        "actions of",
        "observations is 3",
        "reward is 1",
        "ends is 2",
        "vary of",
        "period is -1",
        "render_mode",
    ):
        assert words in str(caught.value)
    with pytest.raises(cw.UseError, match="vary or start"):
        environment(vary={"c1.gain": (1.0, 2.0)}, start=cw.Simulator(discs()).save())


def test_values_have_units():
    given = {
        "actions": {"c1.pressure": ("0 bar", "2 bar")},
        "observations": {"engine.speed": ("0 rpm", "955 rpm"), "c1.slip": (-100.0, 100.0)},
        "vary": {"load.inertia": ("5000 kg cm2", "1 kg m2")},
    }
    env = cw.environment(discs(), "2 s", period="20 ms", reward=reward, **given)
    drawn = env.reset(seed=1)[1]["values"]["load.inertia"]
    assert 0.5 <= drawn <= 1.0
    seen, *_, info = env.step(np.array([1.0]))
    assert info["time"] == 0.02
    assert env.unwrapped.sim["c1.pressure"] == 2e5
    top = 955.0 * 2.0 * np.pi / 60.0
    assert seen[0] == np.float32(2.0 * env.unwrapped.sim["engine.speed"] / top - 1.0)


def test_what_varies_is_checked_at_once():
    with pytest.raises(cw.ModelError, match=r"c1\.gain"):
        environment(vary={"c1.gian": (4e-4, 6e-4)})
    with pytest.raises(cw.ModelError, match="inertia"):
        environment(vary={"load.inertia": (-1.0, 6e-4)})
    with pytest.raises(cw.UseError, match="the lower one first"):
        environment(actions={"c1.pressure": (2e5, 0.0)})
    with pytest.raises(cw.UseError, match="with one that fits"):
        environment(actions={"c1.pressure": ("0 N", "1 N")})


@pytest.mark.parametrize("action", ["a", [0.0, 0.0], [np.nan], None])
def test_actions_that_are_none(action):
    env = environment()
    env.reset()
    with pytest.raises(cw.UseError, match=r"give 1 number from -1 to 1, for c1\.pressure"):
        env.step(action)


def test_times_are_those_of_a_simulator():
    env = environment(period=0.02)
    env.reset()
    assert [env.step(np.array([0.0]))[4]["time"] for _ in range(100)] == [round(0.02 * n, 10) for n in range(1, 101)]


def test_unknown_names_are_errors_at_once():
    with pytest.raises(cw.ModelError, match=r"c1\.pressure"):
        environment(actions={"c1.presure": (0.0, 2e5)})
    with pytest.raises(KeyError, match=r"engine\.speed"):
        environment(observations=["engine.sped"])


def test_a_reward_that_is_not_a_number():
    env = environment(reward=lambda moment: None)
    env.reset()
    with pytest.raises(cw.ClutchworkError, match="return a finite number"):
        env.step(np.array([0.0]))


def test_without_gymnasium(monkeypatch):
    monkeypatch.setitem(sys.modules, "gymnasium", None)
    with pytest.raises(ImportError, match=r'an environment needs gymnasium: pip install "clutchwork\[learn\]"'):
        environment()


def test_values_of_one_episode_are_not_those_of_the_next():
    """What an episode was given by options is gone with it."""
    env = environment(observations=["engine.speed"])
    assert env.reset(options={"values": {"engine.speed": 50.0}})[0] == [50.0]
    env.step(np.zeros(1))
    assert env.reset()[0] == [100.0]
    assert env.reset(options={"values": {"c1.gain": 6e-4}})[0] == [100.0]


@pytest.mark.parametrize("period", [0.1, 0.01, 0.3])
def test_instants_are_multiples_of_the_period(period):
    """They are those of a Simulator that advances by the period, and the last one is the end."""
    env, times = environment(period=period), []
    env.reset()
    over = False
    while not over:
        *_, over, info = env.step(np.zeros(1))
        times.append(info["time"])
    whole = int(2.0 / period + 1e-9)
    assert times[:whole] == [float(f"{(k + 1) * period:.15g}") for k in range(whole)]
    assert times[-1] == 2.0


def test_an_episode_ends_after_it_begins():
    sim = cw.Simulator(discs())
    sim.advance(2.0)
    with pytest.raises(cw.UseError, match=r"t_end is 2 s, and start is at 2 s"):
        environment(start=sim.save())
