"""What a fit tells, draws and hands on."""

from __future__ import annotations

import json
from dataclasses import FrozenInstanceError
from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.fit import FitResult, fit_law
from support import rig_data


@pytest.fixture(scope="module")
def result() -> FitResult:
    law = rig_data.true_law(cw.Karnopp)
    return fit_law(law, **rig_data.measured(law).arguments)


def test_it_prints_a_table(result: FitResult) -> None:
    text = str(result)
    assert text.splitlines()[0].startswith("Karnopp: 960 samples, ")
    for word in (
        "parameter",
        "95 % from",
        "rad/s",
        "not determined",
        "band is not determined: no sample depends on it",
    ):
        assert word in text


def test_parameters_by_name(result: FitResult) -> None:
    assert result["speed"].value == result.law.speed  # type: ignore[attr-defined]
    assert result["speed"].lower < result["speed"].value < result["speed"].upper
    with pytest.raises(KeyError, match="did you mean 'speed'"):
        result["sped"]


def test_it_is_frozen(result: FitResult) -> None:
    with pytest.raises(FrozenInstanceError):
        result.rms = 0.0  # type: ignore[misc]


def test_correlations(result: FitResult) -> None:
    found = result.correlation
    assert found == pytest.approx(found.T)
    assert np.diag(found) == pytest.approx(1.0)
    assert np.all(np.abs(found) <= 1.0 + 1e-9)


def test_residuals_are_what_is_left(result: FitResult) -> None:
    left = result.residuals[result.equations]
    assert result.rms == pytest.approx(float(np.sqrt(np.mean(left**2))))
    # at rest the law holds what was measured
    assert np.all(np.abs(result.residuals[~result.equations]) <= 6.0 * result.rms)


def test_its_data_are_plain(result: FitResult) -> None:
    told = json.loads(json.dumps(result.data()))
    assert told["law"] == "karnopp"
    assert told["determined"] is False
    assert [p["name"] for p in told["parameters"]] == [p.name for p in result.parameters]


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_its_picture(result: FitResult, ending: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    figure = result.plot(tmp_path / "new" / f"fit.{ending}")
    assert len(figure.axes) == 4
    assert (tmp_path / "new" / f"fit.{ending}").stat().st_size > 5000


def test_the_fitted_law_runs_in_a_driveline(result: FitResult) -> None:
    d = cw.Driveline()
    drum = d.shaft("drum", inertia=1.0, speed=5.0)
    d.add(cw.Brake("brake", shaft=drum, friction=result.law, gain=1.0, normal_force=20.0))
    assert d.simulate(5.0)["brake.state"][-1] == "locked"


def test_what_is_rarely_wanted_is_told() -> None:
    law = rig_data.true_law(cw.LuGre)
    result = fit_law(law, **rig_data.measured(law).arguments, free=["kinetic"])
    assert result.determined
    assert "too large for passivity" in result.notes
