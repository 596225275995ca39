"""Properties of every driveline, over random ones (hypothesis draws the seeds)."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from clutchwork import _core
from support import random_drivelines
from support.runs import switches

SEEDS = st.integers(0, 2**32 - 1)
# a run of 2 s takes some thousand steps: more is a failure, not work
BUDGET = {"max_steps": 200_000}
FINE = {"rtol": 1e-9, "atol": 1e-11, **BUDGET}
FLIP = {"forward": "backward", "backward": "forward"}


@given(SEEDS)
def test_energy_closes_and_friction_never_makes_power(seed: int) -> None:
    run = random_drivelines.describe(seed).driveline().simulate(random_drivelines.T_END, **FINE)
    assert run.status == "done", run.message
    # 1e-8: asked for
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    for i in range(3):
        power = run[f"c{i}.power"]
        # round-off of a slip at the very instant of its zero
        assert np.max(power) <= 1e-12 * np.max(np.abs(power))


@given(SEEDS)
def test_a_contact_never_carries_more_than_its_capacity(seed: int) -> None:
    run = random_drivelines.describe(seed).driveline().simulate(random_drivelines.T_END, **FINE)
    for i in range(3):
        torque, capacity = np.abs(run[f"c{i}.torque"]), run[f"c{i}.capacity"]
        # a multiplier has the error of the run, at the instant of break-away and where a load returns from zero
        assert np.all(torque <= capacity * (1 + 1e-9) + 1e-8 * np.max(capacity))
        assert np.all(run[f"c{i}.slip"][run[f"c{i}.mode"] == 0] == 0.0)
        assert np.all(run[f"c{i}.torque"][run[f"c{i}.mode"] == 2] == 0.0)


@given(SEEDS)
def test_turning_the_other_way_is_the_mirror_image(seed: int) -> None:
    """Signs are the only difference, and floating point is symmetric: the same bits."""
    description = random_drivelines.describe(seed)
    runs = [
        x.driveline().simulate(random_drivelines.T_END, dt=0.02, **BUDGET)
        for x in (description, description.mirrored())
    ]
    mirrored = [(t, c, FLIP.get(a, a), FLIP.get(b, b)) for t, c, a, b in switches(runs[1], opening=True)]
    assert switches(runs[0], opening=True) == mirrored
    for i in range(len(description.inertia)):
        assert np.array_equal(runs[0][f"s{i}.speed"], -runs[1][f"s{i}.speed"])


def loaded(run: Any) -> list[tuple[float, str, str]]:
    """Changes of mode in which torque is at stake.

    Where a clutch carries nothing when its pressure vanishes and returns, round-off decides whether it slips.
    """
    return [
        (e.time, e.element, e.after) for e in run.events.changes() if abs(e.torque_before) + abs(e.torque_after) > 1e-6
    ]


@given(SEEDS)
def test_names_and_order_do_not_matter(seed: int) -> None:
    """Shafts and elements in another order: the same events and speeds."""
    description = random_drivelines.describe(seed)
    order = tuple(int(i) for i in np.random.default_rng(seed).permutation(len(description.inertia)))
    runs = [
        x.simulate(random_drivelines.T_END, dt=0.02, rtol=1e-11, atol=1e-11, **BUDGET)
        for x in (description.driveline(), description.driveline(order))
    ]
    lists = [random_drivelines.sequence(loaded(run)) for run in runs]
    assert lists[0] == lists[1]
    for i in range(len(description.inertia)):
        one, two = (run[f"s{i}.speed"] for run in runs)
        assert np.max(np.abs(one - two)) <= 1e-6 * (1 + np.max(np.abs(one)))


@given(SEEDS, st.floats(0.01, 1.9))
def test_save_and_restore_are_bit_equal(seed: int, split: float) -> None:
    data = random_drivelines.describe(seed).driveline().assemble().to_bytes()
    times = np.linspace(split, 2.0, 20)
    one, other = _core.Run(data), _core.Run(data)
    for run in (one, other):
        run.set_option("max_steps", BUDGET["max_steps"])
    empty = np.zeros((0, len(one.row())))
    one.advance(split, np.zeros(0), empty, 0, False)
    other.restore(one.save())
    # saving does not disturb either
    rows = [np.zeros((20, len(one.row()))) for _ in range(2)]
    one.events()
    one.advance(2.0, times, rows[0], 0, False)
    other.advance(2.0, times, rows[1], 0, False)
    assert np.array_equal(rows[0], rows[1])


@given(SEEDS)
def test_units_scale(seed: int) -> None:
    """Twice all inertias, torques and capacities is the same motion."""
    d = random_drivelines.describe(seed)
    doubled = random_drivelines.Description(
        d.seed,
        tuple(2 * x for x in d.inertia),
        d.speed,
        tuple(random_drivelines.Link(**{**vars(c), "gain": 2 * c.gain}) for c in d.clutches),
        tuple(random_drivelines.Elastic(k.base, k.follower, 2 * k.stiffness, 2 * k.damping) for k in d.shafts),
        tuple(random_drivelines.Drive(x.shaft, 2 * x.offset, 2 * x.amplitude, x.frequency) for x in d.drives),
        tuple(random_drivelines.Load(x.shaft, 2 * x.torque, x.speed) for x in d.loads),
    )
    runs = [x.driveline().simulate(1.0, dt=0.02, **FINE) for x in (d, doubled)]
    for i in range(len(d.inertia)):
        # not bit for bit: the absolute tolerance of spring torques does not scale with them
        one, two = (run[f"s{i}.speed"] for run in runs)
        assert np.max(np.abs(one - two)) <= 1e-6 * (1 + np.max(np.abs(one)))
