"""The launch that is tuned by trial: learning helps on cars that were not seen, and the page tells what comes out."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "tune_launch"


@pytest.fixture(scope="module")
def script() -> ModuleType:
    """The script as a module."""
    pytest.importorskip("matplotlib").use("agg")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(EXAMPLE))
        return importlib.import_module("tune_launch")


@pytest.fixture(scope="module")
def learnt(script: ModuleType) -> np.ndarray:
    """A policy of a short search."""
    policy, history = script.learn(script.environment(), rounds=4, many=12, best=4)
    assert len(history) == 4
    return policy


def test_learning_helps_on_unseen_cars(script: ModuleType, learnt: np.ndarray) -> None:
    env = script.environment()
    before, after = (
        np.array([script.episode(env, policy, seed=1000 + number) for number in range(6)])
        for policy in (script.BEGIN, learnt)
    )
    assert after.mean() > before.mean()
    # nothing stalls
    assert after.min() > -20.0


def test_a_stall_costs_more_than_a_slow_launch(script: ModuleType) -> None:
    env = script.environment()
    nominal = {"clutch.friction.kinetic": 0.30, "car.mass": 1400.0}
    soft = script.episode(env, np.array([0.0, 0.0, 0.0, 0.0]), values=nominal)
    assert env.unwrapped.sim.time == script.T_END
    hard = script.episode(env, np.array([1.0, 0.0, 0.0, 0.0]), values=nominal)
    assert env.unwrapped.sim["engine.speed"] < script.STALL
    assert env.unwrapped.sim.time < script.T_END
    assert hard < soft - 10.0


def test_its_picture(script: ModuleType, learnt: np.ndarray, tmp_path: Path) -> None:
    runs = [script.launch(policy) for policy in (script.BEGIN, learnt)]
    assert all(run["clutch.state"][-1] == "locked" for run in runs)
    script.picture(*runs, tmp_path / "x.png")
    assert (tmp_path / "x.png").stat().st_size > 10_000
