"""Many environments side by side do what single ones do one after the other. docs/guide/learn.md"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw

gymnasium = pytest.importorskip("gymnasium")
from gymnasium.vector import AutoresetMode, SyncVectorEnv  # noqa: E402

COUNT, END, PERIOD = 6, 0.5, 0.02
ACTIONS = {"c1.pressure": (0.0, 4e5)}
SEEN: dict[str, Any] = {"engine.speed": (0.0, 200.0), "car.speed": (0.0, 200.0), "c1.torque": None}
VARY = {"c1.friction.kinetic": (0.2, 0.3), "car.inertia": (0.6, 1.5)}


def launch() -> cw.Driveline:
    d = cw.Driveline("launch")
    engine, car = d.shaft("engine", inertia=0.2, speed=150.0), d.shaft("car", inertia=1.2)
    lining = cw.Stribeck(static=0.35, kinetic=0.28, speed=10.0)
    d.add(cw.Clutch("c1", base=engine, follower=car, friction=lining, gain=4e-3, pressure=0.0))
    d.add(cw.Torque("combustion", shaft=engine, torque=60.0))
    return d


def reward(moment: Any) -> Any:
    """Of one, or of all: signals are numbers, or arrays of them."""
    return (
        -1e-3 * (moment.now["c1.heat"] - moment.before["c1.heat"]) - 0.1 * abs(moment.action["c1.pressure"] - 1e5) / 1e5
    )


def stalls(moment: Any) -> Any:
    return moment.now["engine.speed"] < 60.0


def many(**how: Any) -> Any:
    given = {"actions": ACTIONS, "observations": SEEN, "reward": reward, "period": PERIOD, "ends": stalls, **how}
    return cw.vector_environment(launch(), COUNT, END, **given)


def single() -> Any:
    return cw.environment(
        launch(), END, actions=ACTIONS, observations=SEEN, reward=reward, period=PERIOD, ends=stalls, vary=VARY
    )


@pytest.mark.parametrize("mode", ["next step", "same step"])
def test_they_are_those_of_gymnasium_one_after_the_other(mode: str) -> None:
    """Episodes end by time and by stalling, at different steps, and begin with other values."""
    reset = AutoresetMode(mode.title().replace(" ", ""))
    others = SyncVectorEnv([single] * COUNT, autoreset_mode=reset)
    envs = many(vary=VARY, autoreset=mode)
    assert envs.observation_space == others.observation_space
    assert envs.action_space == others.action_space
    np.testing.assert_array_equal(envs.reset(seed=3)[0], others.reset(seed=3)[0])
    generator = np.random.default_rng(0)
    # some press hard and stall their engine
    bias = np.linspace(-0.9, 0.9, COUNT)[:, None]
    ended = 0
    for _ in range(60):
        actions = np.clip(bias + 0.2 * generator.standard_normal((COUNT, 1)), -1.0, 1.0).astype(np.float32)
        *found, infos = envs.step(actions)
        *wanted, other = others.step(actions)
        for one, right in zip(found, wanted, strict=True):
            np.testing.assert_allclose(one, right, rtol=1e-12)
        if "final_obs" in other:
            over = infos["_final_obs"]
            np.testing.assert_array_equal(over, other["_final_obs"])
            for number in np.flatnonzero(over):
                np.testing.assert_array_equal(infos["final_obs"][number], other["final_obs"][number])
        ended += int((found[2] | found[3]).sum())
    assert ended > COUNT


def test_without_a_reset_of_its_own() -> None:
    envs = many(autoreset="disabled")
    envs.reset(seed=1)
    hard = np.ones((COUNT, 1))
    hard[0] = -1.0
    for _ in range(25):
        _, _, terminated, truncated, _ = envs.step(hard)
        if (terminated | truncated).any():
            break
    over = terminated | truncated
    assert over.tolist() == [False] + [True] * (COUNT - 1)
    with pytest.raises(cw.UseError, match="5 episodes are over"):
        envs.step(hard)
    envs.reset(options={"reset_mask": over})
    assert (envs.sims.time == 0.0).tolist() == over.tolist()
    envs.step(hard)


def test_a_run_that_ends_is_terminated() -> None:
    d = cw.Driveline("overloaded")
    d.add(cw.Torque("motor", shaft=d.shaft("a", inertia=1e-3, speed=5.0), torque=0.0))
    envs = cw.vector_environment(
        d,
        2,
        1.0,
        actions={"motor.torque": (-8e307, 8e307)},
        observations=["a.speed"],
        reward=lambda moment: np.ones(2),
        period=0.4,
    )
    envs.reset(seed=0)
    seen, _, terminated, _, _ = envs.step(np.array([[0.0], [1.0]]))
    assert terminated.tolist() == [False, True]
    # as a single environment, it shows what was seen last
    assert seen[1] == 5.0
    envs.step(np.zeros((2, 1)))
    assert envs.sims.time.tolist() == [0.8, 0.0]


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"autoreset": "never"}, "give one of next step, same step, disabled"),
        ({"period": -1.0}, "period is -1.0"),
        ({"reward": 3}, "give a function of a Moment"),
        ({"reward": lambda moment: np.full(COUNT, np.nan)}, "return finite numbers"),
        ({"reward": lambda moment: [1.0, 2.0]}, "return an array of 6 numbers"),
        ({"observations": ["engine.sped"]}, "did you mean 'engine.speed'"),
    ],
)
def test_wrong_ones_are_named(how: dict[str, Any], words: str) -> None:
    def tried() -> None:
        envs = many(**how)
        envs.reset()
        envs.step(np.zeros((COUNT, 1)))

    with pytest.raises((cw.ClutchworkError, KeyError), match=words):
        tried()


def test_wrong_actions_are_named() -> None:
    envs = many()
    envs.reset()
    with pytest.raises(cw.UseError, match=r"array \(6, 1\)"):
        envs.step(np.zeros(COUNT))


def test_the_last_period_has_the_events_of_all() -> None:
    """0.3 s less two periods of 0.1 s is less than a period by round-off."""
    seen = []

    def reward_of(moment: Any) -> Any:
        seen.append(moment.events)
        return np.zeros(COUNT)

    d = launch()
    envs = cw.vector_environment(
        d, COUNT, 0.3, actions=ACTIONS, observations=["car.speed"], reward=reward_of, period=0.1
    )
    envs.reset(seed=0)
    for action in (-1.0, -1.0, 1.0):
        envs.step(np.full((COUNT, 1), action))
    assert sorted(seen[-1]) == list(range(COUNT))
    assert (envs.sims.time == 0.3).all()


@pytest.mark.parametrize("seed", [np.int64(3), 3, [3, 4, 5, 6, 7, 8]])
def test_seeds_of_any_kind(seed: Any) -> None:
    envs = many(vary=VARY)
    first, _ = envs.reset(seed=seed)
    envs.step(np.zeros((COUNT, 1)))
    again, _ = envs.reset(seed=3)
    np.testing.assert_array_equal(first, again)
    with pytest.raises(cw.UseError, match="give one, or 6 of them"):
        envs.reset(seed=[1])
    with pytest.raises(cw.UseError, match="give reset_mask alone"):
        envs.reset(options={"values": {}})
