"""`cw.compare`: several runs in one picture."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw

from .conftest import two_discs
from .test_named import drawn, marked


@pytest.fixture(scope="module")
def soft() -> cw.Trajectory:
    return two_discs(gain=2.5e-4).simulate(3.0)


def lines(figure: Any) -> dict[str, Any]:
    return {str(line.get_label()): line for axes in figure.axes for line in axes.get_lines()}


def test_runs_are_drawn_over_each_other(discs: cw.Trajectory, soft: cw.Trajectory, tmp_path: Path) -> None:
    figure = cw.compare({"hard": discs, "soft": soft}, "c1.torque", "load.speed", path=tmp_path / "p.svg")
    found = drawn(figure)
    assert set(found) == {f"{name}, {run}" for name in ("c1.torque", "load.speed") for run in ("hard", "soft")}
    for label, run in (("hard", discs), ("soft", soft)):
        for name in ("c1.torque", "load.speed"):
            unit, time, values = found[f"{name}, {label}"]
            assert unit == run.units[name]
            assert np.array_equal(time, run.time)
            np.testing.assert_allclose(values, run[name], rtol=1e-14)
    assert figure.axes[0].get_xlim() == (0.0, 3.0)
    assert (tmp_path / "p.svg").stat().st_size > 1000


def test_colours_are_those_of_runs_or_of_signals(discs: cw.Trajectory, soft: cw.Trajectory) -> None:
    runs, names = {"hard": discs, "soft": soft}, ["c1.torque", "c1.capacity"]
    for colour, other in (("run", "signal"), ("signal", "run")):
        look = {label: (line.get_color(), line.get_linestyle()) for label, line in lines(
            cw.compare(runs, *names, colour=colour)).items()}  # fmt: skip
        of = {(run, name): look[f"{name}, {run}"] for run in runs for name in names}
        keys = {"run": 0, "signal": 1}
        for one, its in of.items():
            for two, those in of.items():
                assert (its[0] == those[0]) == (one[keys[colour]] == two[keys[colour]])
                assert (its[1] == those[1]) == (one[keys[other]] == two[keys[other]])


def test_labels(discs: cw.Trajectory, soft: cw.Trajectory) -> None:
    names = ["c1.torque, run 1", "c1.torque, run 2"]
    assert list(drawn(cw.compare(discs, soft, "c1.torque"))) == names
    named = cw.compare(discs, soft, "c1.torque", labels=["hard", "soft"])
    assert list(drawn(named)) == ["c1.torque, hard", "c1.torque, soft"]
    other = two_discs("c9").simulate(1.0)
    assert list(drawn(cw.compare(discs, other, "load.speed"))) == [
        *("load.speed, two discs, c1", "load.speed, two discs, c9")
    ]


def test_models_may_differ(discs: cw.Trajectory) -> None:
    other = two_discs("c9", engine="motor").simulate(1.0)
    runs = {"first": discs, "second": other}
    assert set(drawn(cw.compare(runs))) == {"load.speed, first", "load.speed, second"}
    assert set(drawn(cw.compare(runs, "c*.torque"))) == {"c1.torque, first", "c9.torque, second"}
    with pytest.raises(cw.UnknownName) as caught:
        cw.compare(runs, "c1.torque", "motor.speed", "nothing.speed")
    told = str(caught.value).splitlines()
    assert told[0].startswith("run 'second': no signal 'c1.torque'; did you mean 'c9.torque'?")
    assert told[1].startswith("run 'first': no signal 'motor.speed'")
    assert [line.partition(":")[0] for line in told[2:]] == ["run 'first'", "run 'second'"]


def test_a_name_may_have_another_unit_in_another_model(discs: cw.Trajectory) -> None:
    d = cw.Driveline("along a line")
    block = d.mass("load", mass=1.0, speed=2.0)
    d.add(cw.Damper("d", base=d.housing, follower=block, damping=1.0))
    figure = cw.compare({"turns": discs, "slides": d.simulate(1.0)}, "load.speed")
    assert [axes.get_ylabel() for axes in figure.axes] == ["speed, rad/s", "speed, m/s"]


def test_zoom_events_and_samples(discs: cw.Trajectory, soft: cw.Trajectory) -> None:
    runs = {"hard": discs, "soft": soft}
    figure = cw.compare(runs, "load.speed", zoom=(1.0, 2.75), events=True, measured={"load.speed": ([1, 2], [5, 6])})
    assert figure.axes[0].get_xlim() == (1.0, 2.75)
    # the soft one ends later than the other run
    assert drawn(figure)["load.speed, hard"][1][-1] == 2.5
    assert drawn(figure)["load.speed, soft"][1][-1] == 2.75
    expected = [event.time for run in (discs, soft) for event in run.events.changes() if 1.0 <= event.time <= 2.75]
    assert marked(figure) == expected
    assert drawn(figure)["load.speed, measured"][2].tolist() == [5, 6]
    assert marked(cw.compare(runs, "load.speed")) == []


def test_mistakes(discs: cw.Trajectory, soft: cw.Trajectory) -> None:
    for given, named, words in (
        ((), {}, "there is no run; give what simulate returns"),
        (("c1.torque",), {}, "there is no run"),
        (({"a": 3, "b": discs}, "c1.torque"), {}, "'a' is 3, which is not a run"),
        ((discs, "c1.torque", soft), {}, "is not among the runs; give all runs before the signals"),
        ((discs, soft), {"labels": ["a"]}, "give 2 different strings, one for each run"),
        ((discs, soft), {"labels": ["a", "a"]}, "give 2 different strings"),
        ((discs, soft), {"labels": "ab"}, "give 2 different strings"),
        (({"a": discs},), {"labels": ["a"]}, "labels are given twice"),
        ((discs, soft), {"colour": "signals"}, "colour is 'signals': give 'run' or 'signal'; did you mean 'signal'"),
        ((discs, soft), {"color": "run"}, "unknown field 'color'; did you mean 'colour'"),
        ((discs, soft, "p.jpg"), {}, "ends in .png, .svg or .pdf"),
    ):
        with pytest.raises(cw.UseError) as caught:
            cw.compare(*given, **named)
        assert words in str(caught.value)
    other = cw.Driveline("another")
    other.shaft("x", inertia=1.0)
    with pytest.raises(cw.UseError, match="these runs have no signal of the same name"):
        cw.compare(discs, other.simulate(1.0))
