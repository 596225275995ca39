"""Losses by which samples that are off count less: the values stay right, the intervals hold."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import least_squares

import clutchwork as cw
from clutchwork.fit import FitError, Record, fit_law, fit_records
from clutchwork.fit.losses import LOSSES, Penalty
from support import measured_discs as two
from support import rig_data

ROBUST = [name for name in LOSSES if name != "linear"]
LAW = rig_data.true_law(cw.Stribeck)
TRUE = {"static": 0.15, "kinetic": 0.1, "speed": 2.0}


def spoilt(seed: int, share: float) -> dict[str, Any]:
    """Samples of which a share is off by several times the torque, all to one side."""
    data, rng = rig_data.measured(LAW, seed).arguments, np.random.default_rng(seed + 100)
    off = rng.random(len(data["torque"])) < share
    data["torque"] = data["torque"] + off * rng.uniform(1.0, 6.0, len(off))
    return data


@pytest.mark.parametrize("kind", ROBUST)
def test_values_hold_whatever_a_share_of_the_samples_says(kind: str) -> None:
    start = rig_data.start_law(LAW, ["static", "kinetic", "speed"])
    for seed in range(4):
        data = spoilt(seed, 0.05)
        plain = fit_law(start, **data, free=list(TRUE))
        result = fit_law(start, **data, free=list(TRUE), loss=kind)
        assert result.determined, result.message
        for name in TRUE:
            true = getattr(LAW, name)
            assert result[name].value == pytest.approx(true, rel=0.02)
            assert abs(result[name].value - true) < abs(plain[name].value - true)
        assert f"(loss {kind!r})" in result.notes


@pytest.mark.parametrize("kind", ROBUST)
def test_intervals_hold_the_truth_as_often_as_they_say(kind: str) -> None:
    found = []
    for seed in range(60):
        result = fit_law(LAW, **rig_data.measured(LAW, seed).arguments, free=list(TRUE), loss=kind)
        found.append([p.lower <= getattr(LAW, p.name) <= p.upper for p in result.parameters])
    # of 180 intervals at 95 %: by chance fewer than 162 are right once in 2000 times, were they independent
    assert np.mean(found) >= 0.9


def test_without_anything_off_it_is_as_good_as_squares() -> None:
    data = rig_data.measured(LAW).arguments
    plain, robust = (fit_law(LAW, **data, free=["kinetic"], loss=kind)["kinetic"] for kind in ("linear", "huber"))
    assert robust.value == pytest.approx(plain.value, rel=1e-4)
    # 95 % efficient
    assert robust.upper - robust.lower == pytest.approx(plain.upper - plain.lower, rel=0.1)


@pytest.mark.parametrize("kind", ROBUST)
def test_it_is_the_loss_of_scipy(kind: str) -> None:
    rng = np.random.default_rng(3)
    x, y = rng.standard_normal((40, 2)), rng.standard_t(1.5, 40)

    def residuals(p: Any) -> Any:
        return x @ p - y

    known = least_squares(residuals, [0.0, 0.0], loss=kind, f_scale=0.7, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    own = Penalty(kind).searched(np.full(40, 0.7))
    found = least_squares(residuals, [0.0, 0.0], loss=own, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    assert found.x == pytest.approx(known.x, rel=1e-6)
    assert 0.5 * np.sum(Penalty(kind).costs(residuals(found.x), 0.7)) == pytest.approx(known.cost, rel=1e-9)


@pytest.mark.parametrize("kind", ROBUST)
def test_records_with_samples_that_are_off(kind: str) -> None:
    one, rng = two.record(), np.random.default_rng(5)
    off = rng.random(len(two.TIMES)) < 0.06
    measured = {name: values + 40.0 * off for name, values in one.measured.items()}
    free = ["c1.friction.kinetic", "load.inertia"]
    plain = fit_records(two.guess(), Record(two.TIMES, measured), [*free, "c1.friction.static", "engine.inertia"])
    found = fit_records(
        two.guess(), Record(two.TIMES, measured), [*free, "c1.friction.static", "engine.inertia"], loss=kind
    )
    assert found.determined, found.message
    for name in free:
        assert found[name].value == pytest.approx(two.TRUE[name], rel=0.03)
        assert found[name].upper - found[name].lower < plain[name].upper - plain[name].lower


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"loss": "soft"}, "loss is 'soft'; give one of 'linear', 'soft_l1'.*did you mean 'soft_l1'"),
        ({"loss": "huber", "loss_width": 0.0}, "loss_width is 0"),
        ({"loss": "huber", "loss_width": "wide"}, "loss_width is 'wide'"),
    ],
)
def test_mistakes(given: dict[str, Any], words: str) -> None:
    with pytest.raises(FitError, match=words):
        fit_law(LAW, **rig_data.measured(LAW).arguments, **given)
