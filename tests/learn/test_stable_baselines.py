"""The adapter of the guide for Stable-Baselines3: its interface, and episodes as over single environments."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.project import ROOT

stable = pytest.importorskip("stable_baselines3")
GUIDE = (ROOT / "docs" / "guide" / "learn.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def names() -> dict[str, Any]:
    """What the programs of the guide define, up to what learns."""
    found: dict[str, Any] = {}
    plain = re.findall(r"^```python\n(.*?)^```", GUIDE, re.DOTALL | re.MULTILINE)
    (many,) = (block for block in plain if "def reward_of_all" in block)
    own = re.findall(r"^```py\n(.*?)^```", GUIDE, re.DOTALL | re.MULTILINE)
    for block in (plain[0], many.partition("\nenvs =")[0], own[0], own[1].partition("\nmodel =")[0]):
        exec(compile(block, "docs/guide/learn.md", "exec"), found)
    return found


def single(names: dict[str, Any]) -> Any:
    """One of the environments that stand side by side."""
    observed = {"engine.speed": (0.0, 300.0), "gearbox.speed": (0.0, 300.0), "clutch.slip": (-300.0, 300.0)}
    return cw.environment(
        names["car"](), 2.0, period=0.02, actions={"actuator.command": (0.0, 4e5)}, observations=observed,
        reward=lambda moment: float(names["reward_or_stall"](moment)), ends=names["stalls"],
        vary={"clutch.friction.kinetic": (0.27, 0.33), "car.inertia": (0.6, 0.85)},
    )  # fmt: skip


def test_episodes_are_those_of_single_environments(names: dict[str, Any]) -> None:
    from stable_baselines3.common.vec_env import DummyVecEnv

    ours, theirs = names["side_by_side"](3), DummyVecEnv([lambda: single(names)] * 3)
    assert (ours.observation_space, ours.action_space) == (theirs.observation_space, theirs.action_space)
    for envs in (ours, theirs):
        envs.seed(7)
    assert np.array_equal(ours.reset(), theirs.reset())
    draw = np.random.default_rng(1)
    ended = 0
    for _ in range(150):
        actions = draw.uniform(-1.0, 1.0, (3, 1))
        one, other = ours.step(actions), theirs.step(actions)
        assert np.array_equal(one[0], other[0])
        np.testing.assert_allclose(one[1], other[1], rtol=1e-6)  # they keep 32 bits
        assert np.array_equal(one[2], other[2])
        for n in np.flatnonzero(one[2]):
            ended += 1
            assert np.array_equal(one[3][n]["terminal_observation"], other[3][n]["terminal_observation"])
            assert one[3][n]["TimeLimit.truncated"] == other[3][n]["TimeLimit.truncated"]
    assert ended >= 3
    assert ours.env_is_wrapped(object) == [False] * 3
    assert ours.get_attr("num_envs", [0, 2]) == [3, 3]
    ours.close()


def test_a_learner_takes_it(names: dict[str, Any]) -> None:
    model = stable.PPO("MlpPolicy", names["side_by_side"](8), n_steps=20, batch_size=80, seed=1, device="cpu")
    model.learn(320)
    assert model.num_timesteps == 320
    assert -40.0 < names["score"](model, 2) < 0.0
