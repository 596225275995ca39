"""What no fit can use is refused, with the remedy."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
import clutchwork.fit.law
from clutchwork.declare.schema import Spec
from clutchwork.fit import FitError, fit_law
from support import rig_data

LAW = cw.Stribeck(static=0.15, kinetic=0.1, speed=2.0)


MAP = rig_data.true_law(cw.FrictionMap)


def good() -> dict[str, Any]:
    return dict(rig_data.measured(LAW).arguments)


def spoilt(name: str, place: int, number: float) -> dict[str, Any]:
    data = good()
    data[name] = data[name].copy()
    data[name][place] = number
    return data


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (spoilt("torque", 7, float("nan")), "torque is nan at sample 7"),
        (spoilt("slip", 3, float("inf")), "slip is inf at sample 3"),
        (spoilt("time", 5, -1.0), "time does not rise at sample 5"),
        (spoilt("load", 4, -2.0), "load is -2 N m at sample 4"),
        ({**good(), "load": 0.0}, "load is always zero"),
        ({**good(), "load": "high"}, "load is 'high'"),
        ({**good(), "slip": 0.0 * good()["slip"]}, "slip is always zero"),
        ({**good(), "torque": 0.0 * good()["torque"]}, "torque is always zero"),
        ({**good(), "torque": good()["torque"][:-1]}, "torque has 959 values, time has 960"),
        ({**good(), "torque": good()["torque"].reshape(-1, 2)}, "torque has 2 dimensions"),
        ({**good(), "slip": ["a"] * 960}, "slip contains something that is not a number"),
        ({name: row[:3] for name, row in good().items()}, "time has 3 values"),
        ({name: row[:43] for name, row in good().items()}, "samples give 4 equations for 4 parameters"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_samples(data: dict[str, Any], words: str) -> None:
    with pytest.raises(FitError, match=words) as caught:
        fit_law(cw.Stribeck(static=0.15, kinetic=0.1, speed=2.0, viscous=1e-3), **data)
    assert caught.value.remedy


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"free": ["statik"]}, "did you mean 'static'"),
        ({"free": []}, "free names no parameter"),
        ({"free": ["static", "static"]}, "twice"),
        ({"free": ["exponent"]}, "does not let vary"),
        ({"free": ["shape"]}, "which is not a fittable parameter of Stribeck"),
        ({"bounds": {"speeds": (0.0, 1.0)}}, "did you mean 'speed'"),
        ({"bounds": {"speed": (3.0, 4.0)}}, "start within the bounds"),
        ({"bounds": {"speed": (4.0, 3.0)}}, r"bounds of speed are swapped: \(4, 3\); give \(3, 4\)"),
        ({"rest": -1.0}, "rest is -1"),
        ({"rest": 100.0}, "lower `rest`"),
        ({"confidence": 95.0}, "confidence is 95"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_settings(settings: dict[str, Any], words: str) -> None:
    with pytest.raises(FitError, match=words):
        fit_law(LAW, **good(), **settings)


def test_laws() -> None:
    with pytest.raises(FitError, match="not a friction law"):
        fit_law("stribeck", **good())  # type: ignore[arg-type]
    with pytest.raises(FitError, match=r"start values that do not fit.*static"):
        fit_law(cw.Stribeck(static=0.1, kinetic=0.2, speed=2.0), **good())


@pytest.mark.parametrize(
    ("law", "temperature", "words"),
    [
        (LAW, 300.0, "temperature is given, and Stribeck does not depend on it; remove it"),
        (replace(MAP, temperature=None), None, "temperature is missing, and FrictionMap depends on it"),
        (replace(MAP, temperature=cw.Step(height=50.0, start=0.5)), None, "a fit runs no signals; give the measured"),
        (MAP, "warm", "temperature is 'warm'; give a number in .K"),
        (MAP, [300.0] * 3, "temperature has 3 values, time has 960"),
        (MAP, float("nan"), "temperature is nan at sample 0"),
        (MAP, -20.0, "temperature is -20 at sample 0; give it in kelvin"),
        (replace(MAP, extrapolation="error"), 270.0, "temperature is 270 to 270 K, the table of the law 280 to 500"),
        (replace(MAP, extrapolation="error", speeds=(0.0, 1.0, 2.0)), 300.0, "slip is 0 to 12 rad/s, the table"),
    ],
    ids=lambda value: "" if not isinstance(value, str) else value,
)
def test_temperatures(law: Any, temperature: Any, words: str) -> None:
    with pytest.raises(FitError, match=words):
        fit_law(law, **good(), temperature=temperature)


def test_experiments_stay_inside_a_table_that_must_not_be_left() -> None:
    law = replace(rig_data.true_law(cw.FrictionTable), extrapolation="error")
    slow = {name: row[:400] for name, row in rig_data.measured(law).arguments.items()}
    slow["slip"] = np.minimum(np.abs(slow["slip"]), 40.0) * np.sign(slow["slip"])
    result = fit_law(law, **slow, free=["kinetic"])
    assert result["kinetic[3]"].reason == "no sample depends on it"
    asked = float(result["kinetic[3]"].experiment.partition("slip near ")[2].partition(" rad/s")[0])
    assert 50.0 / 1.5 < asked < 100.0 / 1.5


def test_inputs_that_no_fit_can_give(monkeypatch: pytest.MonkeyPatch) -> None:
    wet = [(["wetness"], Spec("signal", "1", "wetness of the lining"))]
    monkeypatch.setattr(clutchwork.fit.law, "inputs", lambda cls: iter(wet))
    with pytest.raises(FitError, match="wetness drives Stribeck, and a fit supports no signal other than"):
        fit_law(LAW, **good())


def test_bounds_are_kept() -> None:
    result = fit_law(LAW, **good(), bounds={"speed": (2.0, 2.5), "static": (None, 0.15)}, free=["static", "speed"])
    assert 2.0 <= result["speed"].value <= 2.5
    assert result["static"].value <= 0.15


def test_one_name_may_stand_for_a_list() -> None:
    result = fit_law(LAW, **good(), free="speed")
    assert [p.name for p in result.parameters] == ["speed"]
    assert np.isfinite(result["speed"].value)


def test_nothing_heavy_is_loaded_before_a_fit() -> None:
    code = (
        "import sys, clutchwork.fit.command, clutchwork.fit.law;"
        "print([name for name in ('scipy', 'matplotlib', 'pandas') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_without_scipy_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    with pytest.raises(ImportError, match=r'pip install "clutchwork\[fit\]"'):
        fit_law(LAW, **good())


def test_names_of_the_package() -> None:
    assert {"fit_law", "fit_csv", "FitResult"} <= set(dir(clutchwork.fit))
    with pytest.raises(AttributeError, match="did you mean 'fit_law'"):
        clutchwork.fit.fit_lw  # noqa: B018


def test_all_mistakes_of_a_call_are_named_at_once() -> None:
    wrong: dict[str, Any] = {"load": "much", "loss": "huge", "rest": -1.0, "confidence": 2.0, "free": ["statik"]}
    with pytest.raises(FitError) as found:
        fit_law(LAW, **{**good(), **wrong})
    assert [one.quantity for one in found.value.problems] == ["load", "loss", "free", "rest", "confidence"]
    assert "did you mean 'static'?" in str(found.value)


def test_no_samples_are_not_said_to_be_zero() -> None:
    with pytest.raises(FitError, match=r"^time has 0 values"):
        fit_law(LAW, [], [], [], load=5.0)
