"""Numbers of a driveline are found again from a measured response; what it does not determine is said."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.fit import FitError, fit_response

TRUE = {"orifice_area": 2e-6, "preload": 400.0, "contact_rate": 1e7}
GUESS = {"orifice_area": 3e-6, "preload": 250.0, "contact_rate": 6e6}
FREE = [f"piston.{name}" for name in TRUE]
TIMES = np.arange(0.0, 0.4, 0.005)


def _bench(**values: float) -> cw.Driveline:
    d = cw.Driveline("bench")
    piston = cw.ClutchActuator(
        "piston",
        supply_pressure=cw.Step(height=8e5, start=0.02),
        piston_area=6e-3,
        spring_rate=1.5e5,
        kiss_stroke=2e-3,
        **values,
    )
    d.add(piston)
    plates = cw.Coulomb(static=0.12, kinetic=0.1)
    d.add(cw.Brake("brake", shaft=d.shaft("disc", inertia=0.2), friction=plates, gain=0.1, normal_force=piston))
    return d


def _record(noise: float, seed: int = 1, signal: str = "piston.pressure") -> Any:
    run = _bench(**TRUE).simulate(TIMES[-1], times=TIMES, rtol=1e-9)
    return {signal: run[signal] + np.random.default_rng(seed).normal(0.0, noise, len(TIMES))}


def test_a_step_response_gives_orifice_spring_and_slope() -> None:
    found = fit_response(_bench(**GUESS), TIMES, _record(2e3), FREE, confidence=0.999)
    assert found.determined, found.message
    for name, value in TRUE.items():
        one = found[f"piston.{name}"]
        assert one.lower < value < one.upper, one
        assert one.upper / one.lower < 1.2
    assert found.rms["piston.pressure"] == pytest.approx(2e3, rel=0.2)
    assert found.r2 > 0.999
    # what the calibration is for
    made = cw.ClutchActuator(
        "p", supply_pressure=8e5, piston_area=6e-3, spring_rate=1.5e5, kiss_stroke=2e-3,
        **{name.partition(".")[2]: value for name, value in found.values.items()},
    )  # fmt: skip
    true = _bench(**TRUE).elements[0]
    assert made.kiss_pressure == pytest.approx(true.kiss_pressure, rel=0.01)
    assert made.fill_time(8e5) == pytest.approx(true.fill_time(8e5), rel=0.01)


def test_without_noise_the_values_are_exact() -> None:
    found = fit_response(_bench(**GUESS), TIMES, _record(0.0), FREE)
    assert [found[f"piston.{name}"].value for name in TRUE] == pytest.approx(list(TRUE.values()), rel=1e-6)


def test_what_no_sample_depends_on_is_said() -> None:
    found = fit_response(_bench(**TRUE), TIMES, _record(2e3), [*FREE[:1], "disc.inertia"])
    assert not found.determined
    assert "disc.inertia is not determined: no sample depends on it" in found.message
    assert found["piston.orifice_area"].determined
    assert "not determined" in str(found)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"free": ["piston.orifise_area"]}, "has no 'piston.orifise_area'|is None"),
        ({"free": ["pistn.preload"]}, "did you mean 'piston'"),
        ({"free": []}, "is empty"),
        ({"time": TIMES[::-1]}, "does not rise"),
        ({"measured": {"piston.pressure": [1.0]}}, "has 1 samples for 80 instants"),
        ({"bounds": {"piston.preload": (500.0, 600.0)}}, "start between them"),
    ],
)
def test_wrong_input_is_refused(changes: dict[str, Any], words: str) -> None:
    given: dict[str, Any] = {"time": TIMES, "measured": _record(0.0), "free": FREE} | changes
    with pytest.raises(FitError, match=words):
        fit_response(_bench(**GUESS), given.pop("time"), given.pop("measured"), given.pop("free"), **given)
