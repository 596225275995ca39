"""What the samples do not determine is named, with the reason and with what would help."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.fit import FitError, FitResult, UndeterminedError, fit_law
from clutchwork.fit.sliding import coefficients
from support import rig_data

START = cw.Stribeck(static=0.2, kinetic=0.08, speed=1.0)


def slid(law: Any, slip: Any, load: float = 20.0, noise: float = 0.02) -> dict[str, Any]:
    """Samples of a law without states at given slips."""
    slip = np.asarray(slip, dtype=float)
    torque = np.sign(slip) * coefficients(law, np.abs(slip))[0] * load
    torque += noise * np.random.default_rng(3).standard_normal(len(slip))
    return {"time": 0.01 * np.arange(len(slip)), "slip": slip, "torque": torque, "load": load}


def joined(*parts: dict[str, Any]) -> dict[str, Any]:
    """One record after the other."""
    made = {name: np.concatenate([part[name] for part in parts]) for name in ("slip", "torque")}
    return {"time": 0.01 * np.arange(len(made["slip"])), **made, "load": parts[0]["load"]}


def open_names(result: FitResult) -> list[str]:
    return [parameter.name for parameter in result.undetermined]


def test_a_stribeck_speed_without_slip_near_it() -> None:
    law = cw.Stribeck(static=0.15, kinetic=0.1, speed=0.05)
    fast = slid(law, np.geomspace(5.0, 50.0, 200))
    result = fit_law(START, **fast)
    assert open_names(result) == ["static", "speed"]
    assert result["kinetic"].value == pytest.approx(0.1, rel=0.01)
    assert "to determine it" in result["speed"].experiment
    assert "no samples within a factor 2" in result["speed"].experiment
    # what it asks for is enough
    slow = slid(law, np.geomspace(0.01, 0.5, 100))
    assert fit_law(START, **joined(fast, slow)).determined


def test_a_static_coefficient_without_break_away_has_only_a_lower_end() -> None:
    law = cw.Coulomb(static=0.15, kinetic=0.1)
    result = fit_law(cw.Coulomb(static=0.2, kinetic=0.2), **slid(law, np.linspace(1.0, 5.0, 50)))
    assert open_names(result) == ["static"]
    assert result["static"].reason == "no sample depends on it"
    assert "from rest until it slides" in result["static"].experiment
    assert result["static"].lower == pytest.approx(result["kinetic"].value)
    assert result["static"].upper == np.inf


def test_torque_that_was_held_at_rest_bounds_the_static_coefficient() -> None:
    law = cw.Coulomb(static=0.15, kinetic=0.1)
    moving = slid(law, np.linspace(5.0, 1.0, 50), noise=0.001)
    held = {"slip": np.zeros(20), "torque": np.linspace(0.0, 0.13 * 20.0, 20)}
    result = fit_law(cw.Coulomb(static=0.2, kinetic=0.2), **joined(moving, held))
    assert open_names(result) == ["static"]
    # up to the noise: what was held without slipping is no more than the static torque
    assert result["static"].lower == pytest.approx(0.13, abs=2e-3)
    assert result["static"].upper == np.inf


def test_a_break_away_determines_it() -> None:
    law = cw.Coulomb(static=0.15, kinetic=0.1)
    result = fit_law(cw.Coulomb(static=0.2, kinetic=0.2), **rig_data.measured(law).arguments)
    assert result.determined
    assert result["static"].value == pytest.approx(0.15, rel=0.01)


def test_a_break_away_between_two_samples_is_not_believed() -> None:
    law = cw.Coulomb(static=0.15, kinetic=0.1)
    data = rig_data.measured(law, noise=0.0)
    # the last samples at rest are missing: the torque seems to break away far too low
    keep = ~((data.slip == 0.0) & (np.abs(data.torque) > 0.09 * rig_data.LOAD))
    result = fit_law(law, data.time[keep], data.slip[keep], data.torque[keep], rig_data.LOAD)
    assert open_names(result) == ["static"]


def test_two_parameters_of_which_only_a_combination_shows() -> None:
    law = cw.Exponential(static=0.2, slow=0.15, fast=0.1, speed=50.0)
    start = cw.Exponential(static=0.2, slow=0.14, fast=0.08, speed=40.0)
    # far below its speed the fall is a straight line: only (slow - fast)/speed shows
    poor = slid(law, np.linspace(0.1, 1.0, 200), noise=3e-3)
    result = fit_law(start, **poor, free=["slow", "fast", "speed"])
    assert open_names(result) == ["speed"]
    assert result["slow"].value == pytest.approx(0.15, rel=0.01)
    assert "fast" in result["speed"].direction
    assert abs(result.correlation[1, 2]) > 0.99
    # the search ended elsewhere; the interval at that place alone would miss the truth
    assert abs(result["fast"].value - 0.1) > 0.02
    assert result["fast"].lower < 0.1 < result["fast"].upper
    # what it asks for is in the right place, and enough
    asked = float(result["speed"].experiment.partition("slip near ")[2].partition(" rad/s")[0])
    assert 20.0 < asked < 200.0
    rich = joined(poor, slid(law, np.geomspace(asked / 1.5, asked * 1.5, 60), noise=3e-3))
    assert fit_law(start, **rich, free=["slow", "fast", "speed"]).determined


def test_exactly_lost_directions_are_told_as_such() -> None:
    # at one slip alone, without noise, a curve has one value
    law = cw.Exponential(static=0.2, slow=0.15, fast=0.1, speed=2.0)
    start = cw.Exponential(static=0.2, slow=0.14, fast=0.09, speed=2.0)
    result = fit_law(start, **slid(law, np.full(50, 1.0), noise=0.0), free=["slow", "fast"])
    assert open_names(result) == ["slow", "fast"]
    assert result["slow"].reason == "the samples determine only a combination of slow, fast"


def test_stiffness_does_not_show_in_steady_sliding() -> None:
    law = rig_data.true_law(cw.LuGre)
    time = np.linspace(0.0, 4.0, 200)
    data = rig_data.run(law, time, 2.0 + 1.5 * np.sin(2.0 * np.pi * 0.5 * time))
    torque = data.torque + 0.02 * np.random.default_rng(3).standard_normal(200)
    result = fit_law(law, data.time, data.slip, torque, data.load, free=["kinetic", "stiffness"])
    assert open_names(result) == ["stiffness"]
    assert "back and forth" in result["stiffness"].experiment


def test_a_parameter_at_its_bound() -> None:
    law = cw.Stribeck(static=0.15, kinetic=0.1, speed=2.0)
    data = slid(law, np.linspace(0.05, 30.0, 300))
    # a sensor that loses torque with speed asks for less than no viscous friction
    data["torque"] -= 0.005 * data["slip"]
    result = fit_law(cw.Stribeck(static=0.2, kinetic=0.1, speed=1.0, viscous=1e-3), **data)
    assert open_names(result) == ["viscous"]
    assert result["viscous"].reason == "it lies on its bound >= 0"
    assert result.law.viscous == 0.0  # type: ignore[attr-defined]


def test_the_band_of_a_karnopp_law_leaves_no_trace() -> None:
    law = rig_data.true_law(cw.Karnopp)
    result = fit_law(law, **rig_data.measured(law).arguments)
    assert open_names(result) == ["band"]
    assert "hold it at a known value" in result["band"].experiment


def test_a_wrong_law_is_seen_in_its_residuals() -> None:
    law = cw.Stribeck(static=0.15, kinetic=0.1, speed=2.0, viscous=2e-3)
    data = slid(law, np.linspace(0.1, 20.0, 300), noise=0.01)
    result = fit_law(
        cw.Exponential(static=0.16, slow=0.15, fast=0.1, speed=1.0), **data, free=["slow", "fast", "speed"]
    )
    assert result.alike > 0.5
    assert "the law lacks an effect" in result.notes


def test_noise_of_the_slip_above_rest_is_recognised() -> None:
    law = rig_data.true_law(cw.Stribeck)
    data = rig_data.measured(law)
    noisy = data.slip + 0.03 * np.random.default_rng(5).standard_normal(len(data.slip))
    result = fit_law(law, data.time, noisy, data.torque, data.load, free=["kinetic"])
    assert "the noise of the slip reversed the sign of" in result.notes
    assert 0.06 < result.rest < 0.2
    assert result["kinetic"].value == pytest.approx(law.kinetic, rel=0.02)
    with pytest.raises(FitError, match=r"leave out `rest`, or give 0\.0"):
        fit_law(law, data.time, noisy, data.torque, data.load, free=["kinetic"], rest=1e-3)
    given = fit_law(law, data.time, noisy, data.torque, data.load, free=["kinetic"], rest=0.05)
    assert "give `rest` above the noise" in given.notes


def test_an_open_result_can_be_made_an_error() -> None:
    law = cw.Coulomb(static=0.15, kinetic=0.1)
    result = fit_law(law, **slid(law, np.linspace(1.0, 5.0, 50)))
    with pytest.raises(UndeterminedError, match="static is not determined") as caught:
        result.raise_for_status()
    assert caught.value.result is result
    sound = fit_law(law, **slid(law, np.linspace(1.0, 5.0, 50)), free=["kinetic"])
    assert sound.raise_for_status() is sound
    assert sound.message == ""


def test_changes_that_go_together_are_shares_of_the_values() -> None:
    """Of a coefficient that went far from its start value, as with a load in kN m."""
    slip = 40.0 * np.sin(0.009 * np.pi * np.arange(400)) + 5.0
    law = cw.Stribeck(static=0.13, kinetic=0.1, speed=3.0, viscous=1e-4)
    start = cw.Stribeck(static=0.2, kinetic=0.08, speed=2.0, viscous=3e-4)
    poor = slid(law, slip, load=300.0, noise=0.6)
    result = fit_law(start, **poor | {"load": 0.3})
    shares = [float(one) for one in re.findall(r"([+-][\d.]+) %", " ".join(p.direction for p in result.undetermined))]
    assert shares
    assert max(map(abs, shares)) < 100.0
    assert "the samples hardly change when these change together: " in result.message
