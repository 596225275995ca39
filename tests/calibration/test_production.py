"""Production: limits that hold are those of all samples, means do not depend on the order, tables may scatter."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.calibration import scatter as scattering
from support.engagement import BOTH, SPEED, discs, least_torque

SEVERAL = {
    "load.inertia": (0.79, 0.9),
    "c1.friction.kinetic": (0.08, 0.12),
    "engine.inertia": (0.19, 0.21),
    "c1.gain": (4.9e-4, 5.1e-4),
}


def test_limits_hold_only_where_all_samples_were_run(monkeypatch):
    monkeypatch.setattr(scattering, "MOST_ROUNDS", 1)
    found = least_torque(1.0, scatter=SEVERAL, samples=32)
    assert not found.feasible
    assert not found.solved
    assert "limits are broken in samples of production" in str(found)
    (held,) = found.limits
    assert held.broken
    # those that break it most are among its samples
    assert held.after[1] > 1.01
    assert "by 0." in found.message


def test_an_interrupted_search_does_not_speak_for_all_samples():
    def stop(done, most):
        if done >= 3:
            raise KeyboardInterrupt

    with pytest.raises(cw.CalibrationInterrupted) as caught:
        least_torque(1.0, scatter=SEVERAL, samples=64, progress=stop)
    found = caught.value.calibration
    assert not found.whole
    assert not found.feasible
    assert "samples of production only" in str(found)
    assert "samples of production that were not run" in found.message


def test_the_mean_does_not_depend_on_the_order_and_is_that_of_before_too():
    means = []
    for names in (list(SEVERAL), list(SEVERAL)[::-1]):
        found = cw.calibrate(
            discs(),
            5.0,
            free={"pressure": cw.together("c1.pressure.values", factor=(0.3, 3.0))},
            scatter={name: SEVERAL[name] for name in names},
            minimise=cw.at("c1.torque", 0.1),
            subject_to=cw.limit(cw.at("c1.torque", 0.1), lower=16.0),
        )
        means.append(found.goal)
        # torque is pressure times what scatters, so both means are of the same samples
        assert found.goal[1] / found.goal[0] == pytest.approx(found["pressure"], rel=1e-9)
    assert means[0] == pytest.approx(means[1], rel=1e-9)
    # four that scatter by a fifth and less: nine even samples, without a corner, are close to the mean of many
    assert found.goal[1] == pytest.approx(np.mean(found.verify(256).goals), rel=0.02)


def test_a_slope_is_limited_in_every_sample_of_a_table_that_scatters():
    model = cw.Driveline("two discs")
    engine, load = model.shaft("engine", inertia=0.2, speed=SPEED), model.shaft("load", inertia=0.8)
    pressure = cw.Table([(0.0, 4e5), (0.5, 4e5), (1.0, 4e5), (5.0, 4e5)])
    lining = cw.Coulomb(static=0.12, kinetic=0.1)
    model.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=5e-4, pressure=pressure))
    found = cw.calibrate(
        model,
        5.0,
        free={"c1.pressure.values[1]": (1e4, 9e5)},
        scatter={"valve": cw.together("c1.pressure.values", factor=(0.9, 1.1))},
        samples=8,
        minimise=cw.at("c1.torque", 0.1),
        subject_to=cw.limit(cw.slope("c1.pressure"), upper=2e5),
    )
    assert found.solved, found.message
    assert 1.1 * (4e5 - found["c1.pressure.values[1]"]) / 0.5 == pytest.approx(2e5, rel=1e-6)


def test_samples_that_the_model_refuses_are_told_and_do_not_lose_the_rest():
    lining = {"c1.friction.static": (0.0999, 0.14), "c1.friction.kinetic": (0.09, 0.1)}
    # the corner with less static than kinetic friction is no lining
    with pytest.raises(cw.CalibrationError, match="narrow the scatter"):
        least_torque(1.0, scatter=lining, samples=32)
    more = {**lining, **{name: SEVERAL[name] for name in ("load.inertia", "engine.inertia")}}
    found = least_torque(1.0, scatter=more, samples=32)
    assert not found.feasible
    assert "the model is refused there: narrow the scatter" in found.message


def test_starts_that_the_model_refuses_do_not_lose_the_good_one():
    found = cw.calibrate(
        discs(),
        5.0,
        free={
            "c1.friction.static": (0.1, 0.2),
            "c1.friction.kinetic": (0.05, 0.15),
            "pressure": cw.together("c1.pressure.values", factor=(0.3, 3.0)),
        },
        minimise=cw.at("c1.torque", 0.1),
        subject_to=[cw.limit(cw.lock("c1"), upper=1.0)],
        starts=4,
    )
    assert found.solved, found.message
    assert found.goal[1] == pytest.approx(SPEED * BOTH, rel=1e-6)
