"""Every law of the registry is found again from samples that determine it, within its intervals."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import Role, specs
from clutchwork.fit import fit_law
from clutchwork.fit.adjustable import default_free
from clutchwork.fit.ordinates import ordinates
from support import rig_data, samples

# so rarely does a right interval miss: 1 in 1000, over some 80 parameters with fixed noise
SURE = 0.999
# the band in which a Karnopp law locks leaves no trace in the torque over a measured slip
TRACELESS = {"band"}


def value(law: Any, name: str) -> float:
    """A parameter, or the ordinate behind a name such as `kinetic[2]`."""
    field = name.partition("[")[0]
    return float(getattr(law, field)) if field == name else ordinates(law, field)[name]


@pytest.mark.parametrize("cls", samples.declared(Role.LAW), ids=lambda cls: cls.__name__)
def test_every_law_is_found_again(cls: Any) -> None:
    law = rig_data.true_law(cls)
    ends = {item.name for item, spec in specs(cls) if getattr(law, item.name) in (spec.at_least, spec.at_most)}
    free = [name for name in default_free(law) if name not in TRACELESS | ends]
    numbers = [name for name in free if isinstance(getattr(law, name), float)]
    result = fit_law(rig_data.start_law(law, numbers), **rig_data.measured(law).arguments, free=free, confidence=SURE)
    assert result.determined, result.message
    missed = [p for p in result.parameters if not p.lower <= value(law, p.name) <= p.upper]
    assert missed == []
    assert result.rms == pytest.approx(rig_data.NOISE, rel=0.15)
    assert result.r2 > 0.999


@pytest.mark.parametrize(
    ("cls", "free", "repeats"), [(cw.Stribeck, None, 200), (cw.Dahl, ["kinetic", "stiffness"], 30)]
)
def test_intervals_hold_the_truth_as_often_as_they_say(cls: Any, free: list[str] | None, repeats: int) -> None:
    law, found = rig_data.true_law(cls), []
    for seed in range(repeats):
        result = fit_law(law, **rig_data.measured(law, seed).arguments, free=free)
        found.append([p.lower <= value(law, p.name) <= p.upper for p in result.parameters])
    share = np.mean(found, axis=0)
    # 95 % within three standard deviations of a binomial distribution
    assert np.all(np.abs(share - 0.95) < 3.0 * np.sqrt(0.95 * 0.05 / repeats)), share


def test_without_noise_the_values_are_exact() -> None:
    law = rig_data.true_law(cw.Stribeck)
    start = rig_data.start_law(law, ["static", "kinetic", "speed", "viscous"])
    result = fit_law(start, **rig_data.measured(law, noise=0.0).arguments)
    for parameter in result.parameters:
        # the ties to the start values weigh a millionth
        assert parameter.value == pytest.approx(value(law, parameter.name), rel=1e-6)
    assert result.determined


def test_what_is_not_free_stays() -> None:
    law = rig_data.true_law(cw.Stribeck)
    result = fit_law(
        replace(law, kinetic=0.08, speed=3.0), **rig_data.measured(law).arguments, free=["kinetic", "speed"]
    )
    assert [p.name for p in result.parameters] == ["kinetic", "speed"]
    assert (result.law.static, result.law.viscous) == (law.static, law.viscous)  # type: ignore[attr-defined]
    assert result["kinetic"].lower <= law.kinetic <= result["kinetic"].upper


def test_torque_on_the_follower_is_turned() -> None:
    law = rig_data.true_law(cw.Stribeck)
    data = rig_data.measured(law)
    along = fit_law(law, **data.arguments)
    against = fit_law(law, **{**data.arguments, "torque": -data.torque})
    assert against["kinetic"].value == along["kinetic"].value
    assert "sign was reversed" in against.notes
    assert "sign" not in along.notes


def test_the_torque_of_a_trajectory_can_be_fitted() -> None:
    law = cw.Exponential(static=0.16, slow=0.15, fast=0.1, speed=20.0)
    d = cw.Driveline("engagement")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=law, gain=1.0, normal_force=100.0))
    run = d.simulate(1.0, dt=0.01)
    slips = run["c1.slip"] != 0.0
    columns = {"time": run.time[slips], "slip": run["c1.slip"][slips], "torque": run["c1.torque"][slips]}
    start = cw.Exponential(static=0.2, slow=0.12, fast=0.12, speed=5.0)
    result = fit_law(start, **columns, load=100.0, free=["slow", "fast", "speed"])
    # the solver's tolerance of 1e-6
    assert result["speed"].value == pytest.approx(20.0, rel=1e-4)
    assert result["slow"].value == pytest.approx(0.15, rel=1e-4)


@pytest.mark.parametrize("cls", [cw.FrictionTable, cw.TemperatureTable, cw.FrictionMap])
@pytest.mark.parametrize("settings", [{"interpolation": "smooth"}, {"extrapolation": "nearest"}], ids=str)
def test_tables_of_all_sorts_are_found_again(cls: Any, settings: dict[str, str]) -> None:
    law = replace(rig_data.true_law(cls), **settings)
    result = fit_law(rig_data.start_law(law, []), **rig_data.measured(law).arguments, confidence=SURE)
    assert result.determined, result.message
    assert [p for p in result.parameters if not p.lower <= value(law, p.name) <= p.upper] == []


def test_one_temperature_determines_what_belongs_to_it() -> None:
    law = replace(rig_data.true_law(cw.FrictionMap), temperature=400.0)
    time, slip, torque, load = slid_at(law, 400.0)
    result = fit_law(rig_data.start_law(law, []), time, slip, torque, load)
    names = {p.name for p in result.parameters if p.determined}
    assert names == {"static[2]", "kinetic[2][1]", "kinetic[2][2]", "kinetic[2][3]"}
    assert all(result[name].lower <= value(law, name) <= result[name].upper for name in names)
    assert result["kinetic[3][2]"].reason == "no sample depends on it"
    assert "at 500 K (no samples within a factor 2 and 10 K of that)" in result["kinetic[3][2]"].experiment
    assert "from rest at 280 K until it slides" in result["static[1]"].experiment
    # the argument stands in for what the law holds
    again = fit_law(rig_data.start_law(replace(law, temperature=None), []), time, slip, torque, load, temperature=400.0)
    assert [p.value for p in again.parameters] == [p.value for p in result.parameters]


def slid_at(law: Any, temperature: float) -> tuple[Any, Any, Any, Any]:
    """A record at one temperature: time, slip, torque, load."""
    data = rig_data.rested(law, temperatures=[temperature, temperature])
    noise = rig_data.NOISE * np.random.default_rng(4).standard_normal(len(data.time))
    return data.time, data.slip, data.torque + noise, data.load


def test_static_coefficients_of_tables_stay_above_the_kinetic_ones() -> None:
    law = rig_data.true_law(cw.FrictionTable)
    data = rig_data.measured(law)
    slides = data.slip != 0.0
    # a static coefficient that breaks away too low
    torque = np.where(slides, data.torque, 0.8 * data.torque)
    result = fit_law(law, data.time, data.slip, torque, data.load)
    kinetic = [y for _, y in result.law.kinetic]  # type: ignore[attr-defined]
    assert result.law.static > max(kinetic)  # type: ignore[attr-defined]
    assert result.faults == ()
    # nor does a kinetic one rise above a static one that is held
    low = replace(law, static=0.301)
    held = fit_law(low, data.time, data.slip, 1.1 * data.torque, data.load, free=["kinetic"])
    assert max(y for _, y in held.law.kinetic) < 0.301  # type: ignore[attr-defined]
    assert held.faults == ()


def test_translation_has_its_units() -> None:
    law = rig_data.true_law(cw.Stribeck)
    result = fit_law(law, **rig_data.measured(law).arguments, translation=True)
    assert (result["speed"].unit, result["viscous"].unit) == ("m/s", "s/m")
    assert " N," in str(result)


def test_shares_that_sum_to_one_stay_so() -> None:
    law = rig_data.true_law(cw.GMS)
    result = fit_law(law, **rig_data.measured(law).arguments, free=["elements"])
    assert sum(share for _, share in result.law.elements) == pytest.approx(1.0, abs=1e-12)  # type: ignore[attr-defined]
    assert [p.name for p in result.parameters] == [f"elements[{i}]" for i in range(1, 5)]


def test_a_record_that_begins_in_motion_is_not_taken_as_relaxed() -> None:
    law = rig_data.true_law(cw.LuGre)
    time = np.linspace(0.0, 1.0, 80)
    data = rig_data.run(law, np.append(-1.0, time) + 1.0, np.append(2.0, 2.0 + np.sin(6.0 * time)))
    torque, slip, load = data.torque[1:], data.slip[1:], data.load[1:]
    fitted = fit_law(law, time, slip, torque, load, free=["kinetic"]).fitted
    assert fitted == pytest.approx(torque, abs=1e-6)
