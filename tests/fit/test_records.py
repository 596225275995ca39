"""Numbers of a driveline are found again from measured runs, through locking and breaking away."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.fit import Record, fit_records
from support import measured_discs as two
from support import six_speed


def test_two_discs_that_lock_and_break_away():
    found = fit_records(two.guess(), two.record(), list(two.TRUE), confidence=0.999)
    assert [event.after for event in found.run.events.of("c1")][:2] == ["locked", "backward"]
    assert found.determined, found.message
    assert not found.notes
    for name, true in two.TRUE.items():
        assert found[name].lower < true < found[name].upper, found[name]
        # 0.3 rad/s of noise on 100 rad/s; the static coefficient shows in the break-away alone
        assert found[name].upper / found[name].lower < 1.2
    assert found.rms["engine.speed"] == pytest.approx(0.3, rel=0.2)
    assert found.correlation.shape == (4, 4)
    assert np.diag(found.correlation) == pytest.approx(1.0)


def test_without_noise_the_values_are_exact():
    found = fit_records(two.guess(), two.record(noise=0.0), list(two.TRUE))
    assert dict(found.values) == pytest.approx(two.TRUE, rel=1e-6)


def test_a_shift_gives_two_frictions_and_an_inertia():
    """The 3-4 shift of the six-speed gearbox: one element breaks away, the other locks.

    The first one is nearly open when it breaks away, so that its coefficient shows little.
    """
    box = six_speed.gearbox(six_speed.SHIFT).assemble()
    true = {"F1.friction.fast": 0.065, "F2.friction.static": 0.16, "w8.inertia": 5.77}
    times = np.linspace(0.0, 4.0, 401)
    run = cw.simulate(box, 4.0, times=times, rtol=1e-9, atol=1e-11)
    assert [event.after for event in (*run.events.of("F2"), *run.events.of("F1"))] == ["forward", "locked"]
    rng = np.random.default_rng(3)
    measured = {name: run[name] + rng.normal(0.0, 0.03, 401) for name in ("w1.speed", "w8.speed")}
    start = {name: factor * true[name] for name, factor in zip(true, (0.85, 1.1, 1.2), strict=True)}
    found = fit_records(box.changed(start), Record(times, measured), list(true), confidence=0.999)
    assert found.determined, found.message
    for name, value in true.items():
        assert found[name].lower < value < found[name].upper, found[name]
    assert found["F1.friction.fast"].value == pytest.approx(0.065, rel=0.01)


@pytest.mark.parametrize("alike", [0.0, 0.6])
def test_intervals_hold_the_truth_as_often_as_they_say(alike):
    """40 draws of noise, white and with neighbours that are alike, which count less."""
    free, inside = ["c1.friction.kinetic", "load.inertia", "engine.speed"], []
    true = [0.1, 0.8, 100.0]
    for seed in range(40):
        measured = two.samples(two.discs(), 0.5, seed, alike)
        found = fit_records(two.discs(), Record(two.TIMES, measured), free)
        inside += [one.lower < value < one.upper for one, value in zip(found.parameters, true, strict=True)]
    # of 120 intervals at 95 %: by chance fewer than 106 are right once in 2000 times, were they independent
    assert np.mean(inside) >= 0.88


def test_initial_values_that_may_be_negative_are_found():
    found = fit_records(two.discs(speed=-20.0), two.record(speed=-35.0), ["engine.speed", "load.speed"])
    assert found.determined, found.message
    assert found["engine.speed"].value == pytest.approx(-35.0, abs=0.2)
    assert found["load.speed"].lower < 0.0 < found["load.speed"].upper


def test_several_records_share_some_numbers_and_have_others_for_themselves():
    speeds = {"slow": 60.0, "usual": 100.0, "fast": 130.0}
    records = [
        replace(two.record(seed=seed, speed=speed), name=name) for seed, (name, speed) in enumerate(speeds.items())
    ]
    free = ["c1.friction.kinetic", "load.inertia"]
    found = fit_records(two.guess(), records, [*free, "engine.inertia"], own=["engine.speed"])
    assert found.determined, found.message
    for name, speed in speeds.items():
        one = found[f"engine.speed ({name})"]
        assert one.lower < speed < one.upper
    assert set(found.values) == {*free, "engine.inertia"}
    assert [record.values["engine.speed"] for record in found.records] == pytest.approx(list(speeds.values()), abs=0.3)
    alone = fit_records(two.guess(), records[1], [*free, "engine.inertia"], own=["engine.speed"])
    # three records say more than one
    for name in free:
        width = found[name].upper - found[name].lower
        assert width < 0.8 * (alone[name].upper - alone[name].lower)
    text = str(found)
    for part in ("3 records, 756 samples", "engine.speed (fast)", "kg m2"):
        assert part in text
    assert json.loads(json.dumps(found.data()))["parameters"][0]["name"] == "c1.friction.kinetic"


def test_what_drove_each_record_is_given():
    """Pressures of two runs as samples: the one of the driveline itself is another one."""
    records = []
    for seed, pressure in enumerate((3e5, 5e5)):
        one = two.record(seed=seed, pressure=pressure)
        applied = np.interp(two.TIMES, [0.0, two.RISE], [0.0, pressure])
        records.append(replace(one, inputs={"c1.pressure": 1e-5 * applied}, units={"c1.pressure": "bar"}))
    found = fit_records(two.guess(pressure=1e5), records, list(two.TRUE), confidence=0.999)
    assert found.determined, found.message
    for name, true in two.TRUE.items():
        assert found[name].lower < true < found[name].upper, found[name]


def test_ordinates_and_knots_of_a_table_are_found():
    free = ["c1.pressure.values", "c1.pressure.times[2]"]
    start = two.discs().assemble().changed({"c1.pressure.points": [(0.0, 0.0), (0.3, 3.5e5), (2.5, 4.2e5)]})
    found = fit_records(start, two.record(), free, confidence=0.999)
    assert found["c1.pressure.values[2]"].value == pytest.approx(4e5, rel=0.03)
    assert found["c1.pressure.times[2]"].value == pytest.approx(0.2, abs=0.03)
    # the table as a whole is what a System is changed by
    (points,) = found.values.values()
    made = start.changed(dict(found.values))
    run = cw.simulate(made, 2.5, times=two.TIMES)
    np.testing.assert_allclose(run["load.speed"], found.run["load.speed"], atol=1e-3)
    assert points[1][0] == found["c1.pressure.times[2]"].value


def test_several_starts_end_at_the_same_values():
    found = fit_records(two.guess(), two.record(), list(two.TRUE), starts=3)
    assert "of 3 starts end at these values" in found.notes
    assert found.values["load.inertia"] == pytest.approx(0.8, rel=0.02)


def test_noise_that_differs_by_sample_counts_by_its_deviation():
    """Every second sample is worthless, and said to be."""
    one = two.record(noise=0.0)
    rng = np.random.default_rng(7)
    poor = np.where(np.arange(len(two.TIMES)) % 2, 0.1, 30.0)
    measured = {name: values + poor * rng.normal(size=len(values)) for name, values in one.measured.items()}
    weighed = Record(two.TIMES, measured, deviation=dict.fromkeys(measured, poor))
    free = ["c1.friction.kinetic", "load.inertia"]
    good = fit_records(two.discs(), weighed, free, confidence=0.999)["load.inertia"]
    plain = fit_records(two.discs(), replace(weighed, deviation={}), free)["load.inertia"]
    assert good.lower < 0.8 < good.upper
    assert good.upper - good.lower < 0.1 * (plain.upper - plain.lower)


def test_a_picture_has_a_panel_for_each_signal_of_each_record(tmp_path):
    found = fit_records(two.discs(), [two.record(seed=1), two.record(seed=2)], ["load.inertia"])
    figure = found.plot(tmp_path / "fit.png")
    assert len(figure.axes) == 4
    assert (tmp_path / "fit.png").stat().st_size > 10_000
