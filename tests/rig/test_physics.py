"""What the experiments must show, against closed forms and the figures of the literature."""

from __future__ import annotations

import runpy
from dataclasses import replace
from math import atan, pi, sqrt
from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw
from clutchwork import rig
from clutchwork.rig.bench import friction, position
from clutchwork.rig.experiments.judder import Judder
from clutchwork.rig.experiments.stall import Stall

# creep [m] that an independent code found, drift test of the spec
FIRST_SET = {"tanh": 3.5e-3, "regularised_stribeck": 4.6e-3, "lugre": 8.0e-4, "dahl": 1.5e-3}
SECOND_SET = {0.1: {"lugre": 412e-6, "tanh": 5602e-6}, 0.3: {"lugre": 1678e-6, "elastoplastic": 84e-6, "tanh": 7644e-6}}
STILL = ("elastoplastic", "mykhalevych", "stribeck", "coulomb")


def test_creep_of_the_first_set() -> None:
    table = rig.drift([*FIRST_SET, *STILL, "gms", "leuven"]).table
    for law, creep in FIRST_SET.items():
        assert table.value(law, "creep") == pytest.approx(creep, rel=0.05)
    for law in STILL:
        assert abs(table.value(law, "creep")) < 1e-8
    # Maxwell-slip laws move in the first periods, then no more
    for law in ("gms", "leuven"):
        assert abs(table.value(law, "creep")) < 1e-6
        assert abs(table.value(law, "late creep")) < 1e-8


def test_forms_of_mykhalevych_in_the_drift_test() -> None:
    law = rig.PRESETS["first"].law("mykhalevych")
    forms = {reset: replace(law, reset=reset) for reset in ("saturate", "clip", "literal")}
    table = rig.drift(forms | {"passive": replace(law, passive=True)}).table
    for form in ("saturate", "clip", "passive"):
        assert abs(table.value(form, "creep")) < 1e-8
    assert table.value("literal", "creep") == pytest.approx(-1.7e-2, rel=0.05)


@pytest.mark.parametrize("swing", SECOND_SET)
def test_creep_of_the_second_set(swing: float) -> None:
    table = rig.drift(list(SECOND_SET[swing]), preset="second", swing=swing).table
    for law, creep in SECOND_SET[swing].items():
        assert table.value(law, "creep") == pytest.approx(creep, rel=0.05)


@pytest.mark.parametrize("law", ["stribeck", "lugre", "elastoplastic", "gms", "leuven", "coefficient_table"])
def test_steady_friction_is_the_stribeck_curve(law: str) -> None:
    table = rig.steady(law).table
    # the table is linear between points a quarter of the Stribeck speed apart; states settle over 100 deflections
    tolerance = 5e-3 if law == "coefficient_table" else 1e-6
    assert table[law] == pytest.approx(table["curve"], rel=tolerance)


def test_the_steady_friction_of_the_regularised_law_falls_to_zero_with_the_speed() -> None:
    table = rig.steady("regularised_stribeck").table
    assert table["regularised_stribeck"][0] == pytest.approx(np.tanh(0.3), rel=1e-2)


def test_stick_slip_of_coulomb_has_the_period_of_the_closed_form() -> None:
    result = rig.stick_slip("coulomb")
    run, (spring, mass, belt) = result["coulomb"], (100.0, 1.0, 0.002)
    drop, omega = 0.3 / spring, sqrt(spring / mass)
    sticking, slipping = 2 * drop / belt, (pi + 2 * atan(belt / omega / drop)) / omega
    # the period is read from samples 2.5 ms apart
    assert result.table.value("coulomb", "period") == pytest.approx(sticking + slipping, rel=1e-3)
    assert result.table.value("coulomb", "sticks") == pytest.approx(sticking / (sticking + slipping), abs=0.06)
    assert result.table.value("coulomb", "largest") == pytest.approx(
        1.0 + 0.3 * (sqrt(1 + (belt / omega / drop) ** 2) - 1)
    )
    # it sticks exactly, between two slips
    assert np.count_nonzero(run["friction.slip"] == 0.0) > 1000
    assert [event.after for event in run.events.changes()][:3] == ["backward", "locked", "backward"]


def test_laws_without_stick_settle_to_steady_sliding() -> None:
    table = rig.stick_slip(["tanh", "regularised_stribeck"]).table
    assert all(value == 0.0 for value in table["sticks"])
    assert all(np.isnan(float(value)) for value in table["period"])


@pytest.mark.parametrize("law", ["stribeck", "exponential", "elastoplastic"])
def test_judder_grows_below_the_limit_and_dies_out_above(law: str) -> None:
    result = rig.judder(law)
    # the exponential law has a slope of its own
    slope = 60.0 / 3.0 * np.exp(-1.5) if law == "exponential" else Judder().limit(result.preset)
    damping = np.array(result.table["damping"], dtype=float)
    measured = np.array(result.table[law], dtype=float)
    theory = 0.5 * (slope - damping) / result.preset.mass
    # amplitudes of some percent of the slip bend the slope by as much
    assert measured == pytest.approx(theory, rel=0.03, abs=0.05)
    assert np.array_equal(measured > 0.0, damping < slope)


def test_judder_ends_in_a_cycle_that_touches_sticking() -> None:
    late = rig.judder("stribeck")["stribeck"]
    slip = late["friction.slip"][late.time > 0.8 * late.time[-1]]
    assert np.count_nonzero(slip == 0.0) > 10
    assert np.min(slip) < -8.0


def test_without_slope_there_is_no_judder() -> None:
    growth = rig.judder("coulomb").table["coulomb"]
    assert all(float(rate) < -7.0 for rate in growth)


def test_minor_loops_close_with_memory_and_not_without() -> None:
    table = rig.memory(["gms", "mykhalevych", "lugre", "dahl"]).table
    for column in ("minor loop open by", "forgotten by"):
        # the relative tolerance of the run is 1e-8
        assert abs(table.value("gms", column)) < 1e-8
        assert abs(table.value("mykhalevych", column)) < 1e-8
        assert abs(table.value("lugre", column)) > 0.05
        assert abs(table.value("dahl", column)) > 0.05


@pytest.mark.parametrize("law", ["coulomb", "dahl", "lugre", "gms", "mykhalevych"])
@pytest.mark.parametrize("case", ["elastic", "sliding"])
def test_the_area_of_a_loop_is_its_heat(law: str, case: str) -> None:
    result = rig.hysteresis(law, samples=4000)
    run, n = result[law, case], 4000
    x, force = position(run)[-n - 1 :], friction(run)[-n - 1 :]
    area = np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(x))
    # trapezoids over 4000 samples, which cut the jumps of a law without deflection
    assert result.table.value(law, f"{case} heat per cycle") == pytest.approx(area, rel=2e-3)
    assert result.table.value(law, f"{case} cycle to cycle") < 2e-3


def test_the_heat_of_coulomb_is_four_amplitudes() -> None:
    table = rig.hysteresis("coulomb").table
    assert table.value("coulomb", "sliding heat per cycle") == pytest.approx(4 * 0.7 * 2e-3, rel=1e-6)


def test_break_away_falls_with_the_rate_where_the_law_has_states() -> None:
    table = rig.breakaway(["stribeck", "gms", "lugre"], fastest=1.0, points=5).table
    assert table["stribeck"] == pytest.approx([1.0] * 5, rel=1e-6)
    for law in ("gms", "lugre"):
        forces = np.array(table[law], dtype=float)
        assert np.all(np.diff(forces) < 0.0)
        assert 0.7 < forces[-1] < forces[0] < 1.0


def test_friction_lags_where_the_law_has_states() -> None:
    table = rig.lag(["gms", "lugre", "stribeck", "mykhalevych"]).table
    assert table.value("gms", "gap at 20 Hz") > table.value("gms", "gap at 1 Hz") > 0.01
    assert table.value("lugre", "gap at 1 Hz") > 0.05
    assert all(abs(float(table.value(law, "gap at 20 Hz"))) < 1e-9 for law in ("stribeck", "mykhalevych"))


def test_the_naive_law_stalls_with_a_diagnosis_and_the_others_go_through() -> None:
    result = rig.stall()
    naive, smooth, exact = (result[law] for law in ("naive_sign", "mykhalevych", "stribeck"))
    assert naive.status == "chatter"
    assert "'clutch'" in naive.message
    assert "stribeck" in naive.message
    assert smooth.finished
    assert exact.finished
    # it stalls where the exact law locks
    lock = next(event for event in exact.events if event.after == "locked")
    assert result.table.value("naive_sign", "slip gone at") == pytest.approx(lock.time, abs=1e-3)
    # the torque passes through zero while the clutch stays locked
    assert [event.after for event in exact.events.changes()] == ["locked"]
    torque = exact["clutch.torque"][exact.time > lock.time]
    assert np.max(torque) > 100.0
    assert torque[-1] < -20.0
    # a thousandth of the heat goes into the elastic wind-up and its vibration
    assert smooth["clutch.heat"][-1] == pytest.approx(exact["clutch.heat"][-1], rel=2e-3)


def test_the_launch_of_the_examples_is_that_of_the_rig(root: Path) -> None:
    written = cw.Driveline.load(root / "examples" / "launch" / "model.toml").to_dict()
    built = (
        Stall().driveline(rig.Bench("stribeck", rig.PRESETS["clutch"].law("stribeck"), rig.PRESETS["clutch"])).to_dict()
    )
    for part in ("shaft", "element"):
        assert written[part] == built[part]


def test_the_program_of_the_launch_checks_itself(
    root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib")
    runpy.run_path(str(root / "examples" / "launch" / "launch.py"))["main"](tmp_path)
    assert "chatter at" in capsys.readouterr().out
    assert (tmp_path / "stall.png").exists()
