"""What cannot be fitted is refused in words, all of it at once; what samples leave open is named."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.fit import FitError, Record, fit_records
from support import measured_discs as two

ONE = two.record()
NAN = {"load.speed": np.where(np.arange(126) == 3, np.nan, 1.0)}


@pytest.mark.parametrize(
    ("record", "words"),
    [
        (replace(ONE, measured={"load.spede": ONE.measured["load.speed"]}), "did you mean 'load.speed'"),
        (replace(ONE, measured={"c1.mode": two.TIMES}), "has words, no numbers"),
        (replace(ONE, measured={}), "measured is empty"),
        (replace(ONE, measured={"load.speed": [1.0, 2.0]}), "has 2 samples for 126 instants"),
        (replace(ONE, measured=NAN), r"load.speed is nan at sample 3, 0.06 s; remove samples"),
        (replace(ONE, measured={"load.speed": ["a"] * 126}), "is not a number"),
        (replace(ONE, time=two.TIMES[::-1]), "time does not rise at sample 1, 2.48 s; sort the samples by time"),
        (replace(ONE, time=[0.0], measured={"load.speed": [1.0]}), "does not rise; give at least two instants"),
        (replace(ONE, time=two.TIMES - 1.0), "begins at -1 s, and the run at 0 s; count time from the begin"),
        (replace(ONE, units={"load.speed": "rmp"}), r"unknown unit 'rmp'.*give it in \[rad/s\]"),
        (replace(ONE, units={"load.speed": "bar"}), "has a unit that does not fit"),
        (replace(ONE, units={"loaad.speed": "rpm"}), "did you mean 'load.speed'"),
        (replace(ONE, deviation={"load.speed": -0.1}), r"deviation of load.speed is -0.1; give a number above zero"),
        (replace(ONE, time=np.append(two.TIMES[:-1], np.inf)), "time is from 0 to inf s; give finite instants"),
        (replace(ONE, deviation={"load.speed": np.inf}), r"deviation of load.speed is inf; give a number above zero"),
        (replace(ONE, measured={"load.spede": two.TIMES}), r"'load.speed'\? give the name of one"),
        (replace(ONE, inputs={"c1.presure": 1e5}), "did you mean 'c1.pressure'"),
        (replace(ONE, inputs={"c1.presure": two.TIMES}, units={"c1.presure": "bar"}), "did you mean 'c1.pressure'"),
        (replace(ONE, inputs={"c1.pressure": [1e5]}), "c1.pressure has 1 samples for 126 instants"),
        (replace(ONE, start={"load.speedd": 1.0}), "did you mean 'load.speed'"),
        (replace(ONE, start={"load.inertia": -1.0}), 'load" inertia = -1.0 kg m2 must be >= 0 kg m2'),
    ],
)
def test_a_record_that_cannot_be_used_is_refused(record: Record, words: str) -> None:
    with pytest.raises(FitError, match=words):
        fit_records(two.discs(), record, ["engine.inertia"])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"free": []}, "free is empty"),
        ({"free": ["c1.gian"]}, "has no 'c1.gian'; did you mean 'c1.gain'"),
        ({"free": ["engin.inertia"]}, "did you mean 'engine'"),
        ({"free": ["c1.pressure"]}, "c1.pressure is a table; take c1.pressure.values"),
        ({"free": ["c1.pressure.values[4]"]}, r"counted from 1, c1.pressure.values\[1\] to"),
        ({"free": ["c1.locked"]}, "is a choice"),
        ({"bounds": {"load.inertia": (1.0, 2.0)}}, r"of load.inertia are 1 to 2 \[kg m2\], its start value is 0.8"),
        ({"bounds": {"load.inertai": (0.1, 2.0)}}, "which is not free; did you mean 'load.inertia'"),
        ({"bounds": {"load.inertia": (2.0, 0.1)}}, r"are swapped: \(2, 0.1\); give \(0.1, 2\)"),
        ({"bounds": {"load.inertia": 1.0}}, r"give a pair: \(lower, upper\)"),
        ({"records": []}, "records are empty"),
        ({"records": [ONE.measured["load.speed"]]}, r"give each as a Record\(time, measured\)"),
        ({"starts": 0}, "starts is 0; give a whole number of at least 1"),
        ({"confidence": 95.0}, "confidence is 95.0; give a number between 0 and 1"),
        ({"records": replace(ONE, start={"load.inertia": 1.0})}, r"record 1 sets it; give own=\['load.inertia'\]"),
        (
            {"records": Record([0.0, 1.0], {"load.speed": [0.0, 1.0]}), "free": ["c1.gain", "engine.speed"]},
            "are 2 for 2",
        ),
    ],
)
def test_what_cannot_be_searched_for_is_refused(changes: dict[str, Any], words: str) -> None:
    given: dict[str, Any] = {"records": ONE, "free": ["load.inertia"]} | changes
    with pytest.raises(FitError, match=words):
        fit_records(two.discs(), given.pop("records"), given.pop("free"), **given)


def test_what_a_call_lacks_is_named() -> None:
    with pytest.raises(cw.UseError, match=r"fit_records: 1 problem\n  free is missing; give one, such as free=\['c1"):
        fit_records(two.discs(), ONE)  # type: ignore[call-arg]


def test_a_range_of_ordinates_is_free() -> None:
    found = fit_records(two.guess(), ONE, ["c1.pressure.values[2:]"])
    assert [one.name for one in found.parameters] == ["c1.pressure.values[2]", "c1.pressure.values[3]"]


def test_a_driven_signal_is_not_free() -> None:
    driven = replace(ONE, inputs={"c1.pressure": 4e5}, name="bench")
    with pytest.raises(FitError, match=r"c1.pressure.values is free, and bench drives c1.pressure; take it out"):
        fit_records(two.discs(), driven, ["c1.pressure.values"])


def test_all_mistakes_are_named_at_once() -> None:
    poor = replace(ONE, measured={"load.spede": two.TIMES, "engine.speed": [1.0]}, units={"engine.speed": "rmp"})
    with pytest.raises(FitError) as caught:
        fit_records(two.discs(), [poor, replace(ONE, time=two.TIMES[::-1])], ["load.inertia"])
    # time that falls is so for all signals of a record
    assert len(caught.value.problems) == 3
    text = str(caught.value)
    for part in ("3 problems", "record 1: measured has no signal 'load.spede'", "record 2: time does not rise"):
        assert part in text
    assert "sort the samples by time" in text


def test_a_wrong_record_hides_no_wrong_name() -> None:
    poor = replace(ONE, measured={"load.spede": two.TIMES}, start={"load.inertia": 1.0})
    free = ["c1.gian", "c1.locked", "engine.inertia", "load.inertia"]
    bounds = {"engine.inertia": (2.0, 1.0), "c1.gian": (1e-4, 1e-3), "c1.gain": (1e-4, 1e-3)}
    with pytest.raises(FitError) as caught:
        fit_records(two.discs(), poor, free, bounds=bounds, starts=0, loss="hubre")
    for part in (
        "starts is 0",
        "did you mean 'huber'",
        "load.inertia is free, and record 1 sets it",
        "measured has no signal 'load.spede'",
        "free has no 'c1.gian'; did you mean 'c1.gain'",
        "c1.locked is a choice",
        "bounds of engine.inertia are swapped",
        "bounds are given for 'c1.gain', which is not free",
    ):
        assert part in str(caught.value)
    assert len(caught.value.problems) == 8


def test_a_wrong_name_hides_no_wrong_bound() -> None:
    with pytest.raises(FitError) as caught:
        fit_records(two.discs(), ONE, ["c1.gian", "load.inertia"], bounds={"load.inertia": (2.0, 1.0)})
    assert len(caught.value.problems) == 2
    assert "bounds of load.inertia are swapped" in str(caught.value)


def test_a_run_that_ends_early_is_refused() -> None:
    d = cw.Driveline("speed that grows without bound")
    fan = d.shaft("fan", inertia=1.0, speed=1.0)
    d.add(cw.QuadraticTorque("push", shaft=fan, nominal_torque=10.0, nominal_speed=1.0))
    record = Record([0.0, 0.5, 1.0], {"fan.speed": [1.0, 1.5, 2.0]})
    with pytest.raises(FitError, match="the run of record 1 ends early with the start values"):
        fit_records(d, record, ["fan.inertia"])


def test_a_combination_that_the_samples_do_not_tell_apart_is_named() -> None:
    """Without a known load inertias and torques grow together."""
    free = ["c1.gain", "engine.inertia", "load.inertia"]
    short = two.TIMES < 1.4
    record = Record(two.TIMES[short], {name: values[short] for name, values in ONE.measured.items()})
    found = fit_records(two.guess(), record, free)
    assert not found.determined
    assert {one.name for one in found.undetermined} == set(free)
    assert "the samples determine only a combination of c1.gain, engine.inertia, load.inertia" in found.message
    assert "c1.gain +1 %, engine.inertia +1 %, load.inertia +1 %" in found.message
    # with the load that is known from 1.4 s on they do
    ratio = two.TRUE["c1.friction.static"] / two.TRUE["c1.friction.kinetic"]
    known = two.guess().changed({"c1.friction.static": ratio * two.GUESS["c1.friction.kinetic"]})
    assert fit_records(known, ONE, free).determined
    # with another ratio the break-away is elsewhere
    wrong = fit_records(two.guess(), ONE, free)
    assert not wrong.determined
    assert "the residuals are not noise: over the time of load.speed" in wrong.message


def test_what_no_sample_depends_on_keeps_its_start_value() -> None:
    short = two.TIMES < 1.4
    record = Record(two.TIMES[short], {"load.speed": ONE.measured["load.speed"][short]})
    found = fit_records(two.discs(), record, ["c1.friction.kinetic", "c1.friction.static"])
    assert found["c1.friction.static"].reason == "no sample depends on it"
    assert found["c1.friction.static"].value == pytest.approx(0.13, rel=1e-9)
    assert found["c1.friction.kinetic"].determined


def test_a_number_on_its_bound_is_not_determined() -> None:
    found = fit_records(two.discs(), ONE, ["load.inertia"], bounds={"load.inertia": (0.2, 0.801)})
    high = fit_records(two.discs(), ONE, ["c1.friction.kinetic"], bounds={"c1.friction.kinetic": (0.05, 0.1001)})
    assert found.determined or "lies on its bound 0.2 to 0.801" in found.message
    assert high.determined or "lies on its bound 0.05 to 0.1001" in high.message


def test_a_search_that_the_driveline_stops_says_so() -> None:
    """A kinetic coefficient does not rise above the static one, which is held too low here."""
    low = two.discs().assemble().changed({"c1.friction.static": 0.09, "c1.friction.kinetic": 0.08})
    found = fit_records(low, ONE, ["c1.friction.kinetic"])
    assert found["c1.friction.kinetic"].value <= 0.09
    assert "the driveline refuses better values" in found.notes
