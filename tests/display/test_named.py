"""`run.plot("c1.torque", ...)`: what is drawn is what the run says, with its unit, for any names."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.plot.curves import WORDS, thinned
from clutchwork.plot.panels import SCALES
from support import random_drivelines

from .conftest import LINING, NAMES, example, two_discs

# unit that is shown -> unit of the run and factor
SHOWN = {shown: (unit, factor) for unit, _, shown, factor in SCALES}
ODD = ["$x$", "a<b>", "a & b", "_under", "größe Ω", "100 %", "a[1]", "x*y", "{0}", "\\alpha", "c.png"]


def drawn(figure: Any) -> dict[str, tuple[str, np.ndarray, np.ndarray]]:
    """Unit, times and values in SI of every curve, by its label."""
    found = {}
    for axes in figure.axes:
        _, _, unit = axes.get_ylabel().rpartition(", ")
        _, factor = SHOWN.get(unit, (unit, 1.0))
        for line in axes.get_lines():
            label = str(line.get_label()).strip()
            if not re.fullmatch(r"_child\d+", label):
                found[label] = (SHOWN.get(unit, (unit, 1.0))[0], line.get_xdata(), line.get_ydata() / factor)
    return found


def check(run: cw.Trajectory, figure: Any, names: list[str]) -> None:
    """Each of some signals is drawn once, with its unit and its values."""
    found = drawn(figure)
    assert set(found) == set(names)
    for name in names:
        unit, time, values = found[name]
        assert unit == run.units[name] or run.units[name] in ("1", "")
        assert np.array_equal(time, run.time)
        if run.units[name]:
            # a factor of the unit costs a last digit
            np.testing.assert_allclose(values, run[name], rtol=1e-14, atol=1e-300)


def plottable(run: cw.Trajectory) -> list[str]:
    """All signals; a mode is drawn as its state."""
    return [name for name in run.names if not name.endswith(".mode")]


@pytest.mark.parametrize("name", NAMES)
def test_every_signal_of_every_example(name: str) -> None:
    run = example(name)
    figure = run.plot("*")
    check(run, figure, plottable(run))
    # a panel for each unit
    assert len(figure.axes) == len({run.units[name] for name in plottable(run)})


@pytest.mark.parametrize("seed", range(8))
def test_every_signal_of_random_drivelines(seed: int) -> None:
    run = random_drivelines.describe(seed).driveline().simulate(random_drivelines.T_END)
    check(run, run.plot("*"), plottable(run))
    for unit in {unit for unit in run.units.values() if unit}:
        names = [name for name in run.names if run.units[name] == unit]
        assert set(drawn(run.plot(unit=unit))) == set(names)


@pytest.mark.parametrize(("name", "ending"), list(zip(ODD, ["png", "svg", "pdf"] * 4, strict=False)))
def test_odd_names_are_drawn_as_they_are(name: str, ending: str, tmp_path: Path) -> None:
    run = two_discs(name).simulate(2.5)
    figure = run.plot(f"{name}.torque", [f"{name}.slip", f"{name}.heat"], f"{name}.state", tmp_path / f"new/p.{ending}")
    assert set(drawn(figure)) == {f"{name}.{what}" for what in ("torque", "slip", "heat", "state")}
    content = (tmp_path / "new" / f"p.{ending}").read_bytes()
    assert content.startswith({"png": b"\x89PNG", "pdf": b"%PDF", "svg": b"<?xml"}[ending])
    texts = [text for axes in figure.axes if axes.get_legend() for text in axes.get_legend().get_texts()]
    # with the unit, where a panel has two axes
    heads = ("torque", "state", "slip [rad/s]", "heat [J]")
    assert {text.get_text().strip() for text in texts} == {f"{name}.{head}" for head in heads}
    assert not any(text.get_parse_math() for text in texts)
    assert f"{name} locks" in [text.get_text() for text in figure.axes[0].texts]


def test_names_wildcards_and_units(discs: cw.Trajectory) -> None:
    check(discs, discs.plot("engine.speed", "c1.torque"), ["engine.speed", "c1.torque"])
    check(discs, discs.plot("*.speed"), ["engine.speed", "load.speed"])
    check(discs, discs.plot("c?.torque"), ["c1.torque"])
    check(discs, discs.plot("c1.*", unit="N m"), ["c1.torque", "c1.capacity"])
    check(discs, discs.plot(unit=["rad/s", "J"]), ["engine.speed", "load.speed", "c1.slip", "c1.work", "c1.heat"])
    check(discs, discs.plot("c1.torque", "c1.*", unit="N m"), ["c1.torque", "c1.capacity"])


def test_units_stand_at_every_axis(discs: cw.Trajectory) -> None:
    figure = discs.plot("c1.torque", "c1.capacity", "c1.pressure", "c1.heat", "c1.state", "load.speed")
    assert [axes.get_ylabel() for axes in figure.axes] == [
        *("torque, N m", "pressure, MPa", "heat, J", "state", "speed, rad/s")
    ]
    assert figure.axes[-1].get_xlabel() == "time, s"
    assert {axes.get_xlim() for axes in figure.axes} == {(0.0, 2.5)}
    assert set(WORDS) >= {unit for unit in discs.units.values() if unit}


def test_states_are_words(discs: cw.Trajectory) -> None:
    (axes,) = discs.plot("c1.state").axes
    (line,) = (line for line in axes.get_lines() if line.get_label() == "c1.state")
    names = {tick: label.get_text() for tick, label in zip(axes.get_yticks(), axes.get_yticklabels(), strict=True)}
    assert [names[value] for value in line.get_ydata()] == discs["c1.state"].tolist()


def test_a_list_is_a_panel_with_two_axes(discs: cw.Trajectory) -> None:
    figure = discs.plot(["c1.torque", "c1.slip"], ["c1.heat"], "engine.speed", "load.speed")
    assert [axes.get_ylabel() for axes in figure.axes] == ["torque, N m", "heat, J", "speed, rad/s", "slip, rad/s"]
    check(discs, figure, ["c1.torque", "c1.slip", "c1.heat", "engine.speed", "load.speed"])
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels == ["c1.torque [N m]", "c1.slip [rad/s]"]
    with pytest.raises(cw.UseError, match=r"has 3 units, a panel has two axes; give a list for each of N m, rad/s, J"):
        discs.plot(["c1.torque", "c1.slip", "c1.heat"])


def test_a_zoom_is_computed_anew(discs: cw.Trajectory) -> None:
    figure = discs.plot("load.speed", "c1.torque", zoom=(1.6999, 1.7001))
    time, values = drawn(figure)["load.speed"][1:]
    assert figure.axes[0].get_xlim() == (1.6999, 1.7001)
    assert time[0] == 1.6999
    assert time[-1] == 1.7001
    # 1 N m s of impulse until 0.2 s, then 10 N m on 0.8 kg m2, until both turn with 20 rad/s
    expected = np.minimum((1.0 + 10.0 * (time - 0.2)) / 0.8, 20.0)
    np.testing.assert_allclose(values, expected, rtol=1e-7)
    # both limits at the lock-up, to which the torque drops
    torque = drawn(figure)["c1.torque"][2]
    assert torque[np.searchsorted(time, discs.events[-1].time)] == pytest.approx(10.0)
    assert torque[-1] == pytest.approx(0.0, abs=1e-9)


def marked(figure: Any) -> list[float]:
    """Instants that are marked in the first panel."""
    lines = [line for line in figure.axes[0].get_lines() if re.fullmatch(r"_child\d+", str(line.get_label()))]
    return sorted(float(line.get_xdata()[0]) for line in lines if line.get_xdata()[0] == line.get_xdata()[-1])


def test_events_are_marked_as_asked(six_speed: cw.Trajectory) -> None:
    run = six_speed
    changes = sorted(set(run.events.changes().times.tolist()))
    assert marked(run.plot("F1.torque")) == changes
    assert marked(run.plot("F1.torque", events=False)) == []
    mine = sorted(set(run.events.of("F1").changes().times.tolist()))
    assert marked(run.plot("F1.torque", events="F1")) == mine
    assert marked(run.plot("F1.torque", events=["F1"])) == mine
    assert marked(run.plot("F1.torque", events=run.events.of("F1"))) == mine
    assert marked(run.plot("F1.torque", events=run.events[0])) == [run.events[0].time]
    assert marked(run.plot("F1.torque", zoom=(2.5, 3.0))) == [t for t in changes if 2.5 <= t <= 3.0]
    with pytest.raises(cw.UnknownName, match="no contact 'F9'"):
        run.plot("F1.torque", events="F9")
    with pytest.raises(cw.UseError, match="events is 3: give True, False, names of contacts"):
        run.plot("F1.torque", events=3)


def test_the_marks_of_a_crowd_are_left_out_unless_they_are_asked_for() -> None:
    run = example("hill_starts")
    assert len(run.events.changes()) > 30
    assert marked(run.plot("clutch.torque")) == []
    assert len(marked(run.plot("clutch.torque", events="clutch"))) > 5


@pytest.mark.parametrize("path", ["out.png", "deep/out.svg", "out.pdf", Path("out.PNG")])
def test_where_it_is_written(discs: cw.Trajectory, path: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for given in ((path,), ("c1.torque", path)):
        discs.plot(*given)
        assert Path(path).stat().st_size > 1000
        Path(path).unlink()
    discs.plot("c1.torque", path=path)
    assert Path(path).exists()


@pytest.mark.parametrize(
    ("given", "named", "words"),
    [
        (["out.jpg"], {}, r"path 'out\.jpg' has the ending '\.jpg'; write it to a path that ends in \.png, \.svg or"),
        ([], {"path": "out"}, r"path 'out' has no ending; write it to a path that ends in"),
        (["out.html"], {}, r"ends in \.png, \.svg or \.pdf; run\.explore\(\.\.\.\) writes pages"),
        (["a.png", "b.png"], {}, r"there are 2 paths: a\.png, b\.png; give one"),
        ([], {"path": 3}, "3 is not a path; give a string, such as 'run.png'"),
        ([3], {}, "3 is not a signal; give the name of a signal, a wildcard such as 'c1.*', or a list of names"),
        ([["c1.torque", 3]], {}, "is not a signal"),
        ([[]], {}, r"\[\] is not a signal"),
        ([], {"unit": "Nm"}, r"unit 'Nm': no signal has it; did you mean 'N m'\? units are"),
        ([], {"unit": 3}, "unit 3: no signal has it"),
        (["c1.torque"], {"unit": "J"}, "none of these signals is in J; leave out the unit"),
        (["c1.torque"], {"zoom": 3}, r"zoom is 3: give two times in s, such as zoom=\(0, 2\.5\)"),
        (["c1.torque"], {"zoom": ("a", 2)}, "zoom is .*: give two times in s"),
        (["c1.torque"], {"zoom": (1.0, 9.0)}, "zoom is from 1 to 9 s: they must rise and lie between 0 and 2.5 s"),
        (["c1.torque"], {"zoom": (2.0, 1.0)}, "they must rise"),
        (["c1.torque"], {"zoom": (0.0, float("nan"))}, "give two times"),
        (["c1.torque"], {"lokup": 3}, r"unknown field 'lokup'; did you mean 'lockup'\?"),
        (["c1.torque"], {"lockup": "c1"}, "lockup is 'c1': it must be an event"),
    ],
)  # fmt: skip
def test_mistakes(discs: cw.Trajectory, given: list[Any], named: dict[str, Any], words: str) -> None:
    with pytest.raises(cw.UseError, match=words):
        discs.plot(*given, **named)


def test_unknown_signals_get_near_names_all_at_once(discs: cw.Trajectory) -> None:
    with pytest.raises(cw.UnknownName) as caught:
        discs.plot("c1.torqe", "engin.speed", "c1.slip", "c9.*")
    lines = str(caught.value).splitlines()
    assert len(lines) == 3
    assert "no signal 'c1.torqe'; did you mean 'c1.torque'?" in lines[0]
    assert "no signal 'engin.speed'; did you mean 'engine.speed'?" in lines[1]
    assert lines[2].startswith("no signal matches 'c9.*'")
    with pytest.raises(cw.UnknownName, match=r"load\.angle was not computed: run with angles=True"):
        two_discs().simulate(0.1, angles=False).plot("load.angle")


def test_an_element_or_a_quantity_alone_gets_a_wildcard(discs: cw.Trajectory) -> None:
    with pytest.raises(cw.UnknownName, match=r"no signal 'c1'; did you mean 'c1\.\*'\?"):
        discs.plot("c1")
    with pytest.raises(cw.UnknownName, match=r"no signal 'torque'; did you mean '\*\.torque'\?"):
        discs.plot("torque")


def test_lockup_is_of_the_picture_without_names(discs: cw.Trajectory) -> None:
    with pytest.raises(cw.UseError, match="lockup is of the picture without names of signals; give zoom"):
        discs.plot("c1.torque", lockup=discs.events[-1])
    with pytest.raises(cw.UseError, match=r"lockup is at 1\.7 s, outside of the zoom from 0 to 1 s"):
        discs.plot(zoom=(0.0, 1.0), lockup=discs.events[-1])


def test_measured_samples_are_points(discs: cw.Trajectory, tmp_path: Path) -> None:
    times, values = np.linspace(0.0, 2.5, 26), np.linspace(0.0, 20.0, 26)
    rows = "\n".join(f"{t},{x * 30 / np.pi}" for t, x in zip(times, values, strict=True))
    (tmp_path / "m.csv").write_text(f"time,speed [rpm]\n{rows}\n")
    forms = [(times, values), (times.tolist(), values.tolist()), cw.Table(list(zip(times, values, strict=True)))]
    forms += [cw.Column(str(tmp_path / "m.csv"), "speed"), pytest.importorskip("pandas").Series(values, index=times)]
    for measured in forms:
        for names in ((), ("load.speed",), (["load.speed", "c1.torque"],)):
            figure = discs.plot(*names, measured={"load.speed": measured})
            found = drawn(figure)
            assert set(found) >= {"load.speed", "load.speed, measured"}
            unit, time, points = found["load.speed, measured"]
            assert unit == "rad/s"
            np.testing.assert_allclose(time, times)
            np.testing.assert_allclose(points, values, rtol=1e-12)
            (line,) = (x for a in figure.axes for x in a.get_lines() if x.get_label() == "load.speed, measured")
            assert line.get_linestyle() == "None"


@pytest.mark.parametrize(
    ("measured", "words"),
    [
        (3, "measured is 3: give samples by signal"),
        ({"c1.torque": 3}, "measured 'c1.torque': is 3; give a pair of arrays"),
        ({"c1.torque": ([0.0, 1.0], [1.0])}, "has 2 times for 1 values"),
        ({"c1.torque": ([], [])}, "has 0 times"),
        ({"c1.torque": (["a"], [1.0])}, "give a pair of arrays"),
        ({"c1.torque": cw.Constant(1.0)}, "has 0 times"),
        ({"c1.torque": cw.Column("missing.csv", "x")}, "missing.csv"),
    ],
)
def test_measured_samples_that_cannot_be_used(discs: cw.Trajectory, measured: Any, words: str) -> None:
    with pytest.raises(cw.UseError, match=words):
        discs.plot("load.speed", measured=measured)


def test_times_of_pandas(discs: cw.Trajectory) -> None:
    pandas = pytest.importorskip("pandas")
    durations = pandas.Series([1.0, 2.0], index=pandas.to_timedelta([0.5, 1.5], unit="s"))
    assert drawn(discs.plot(measured={"load.speed": durations}))["load.speed, measured"][1].tolist() == [0.5, 1.5]
    dates = pandas.Series([1.0, 2.0], index=pandas.to_datetime(["2020-01-01", "2020-01-02"]))
    with pytest.raises(cw.UseError, match=r"measured 'load\.speed': is"):
        discs.plot(measured={"load.speed": dates})


def test_a_column_in_another_unit_than_the_signal_is_refused(discs: cw.Trajectory, tmp_path: Path) -> None:
    (tmp_path / "m.csv").write_text("time,p [bar]\n0,1\n1,2\n")
    column = cw.Column(str(tmp_path / "m.csv"), "p")
    with pytest.raises(cw.UseError, match=r"measured 'c1\.torque'"):
        discs.plot(measured={"c1.torque": column})
    figure = discs.plot(measured={"c1.pressure": column})
    assert drawn(figure)["c1.pressure, measured"][2].tolist() == pytest.approx([1e5, 2e5])
    with pytest.raises(cw.UnknownName, match=r"no signal 'c1\.presura'"):
        discs.plot(measured={"c1.presura": column})


def test_a_run_that_stopped_early_is_drawn_as_far_as_it_came() -> None:
    with pytest.warns(cw.StoppedEarly):
        run = two_discs().simulate(2.5, max_steps=3, output="steps")
    check(run, run.plot("c1.torque"), ["c1.torque"])
    end = float(run.time[-1])
    assert run.plot("c1.torque", zoom=(0.0, 0.5 * end)).axes[0].get_xlim() == (0.0, 0.5 * end)
    run.plot()


def test_a_picture_of_nothing_is_refused(discs: cw.Trajectory) -> None:
    empty = dataclasses.replace(discs, time=discs.time[:0], rows=discs.rows[:0])
    with pytest.raises(cw.UseError, match="no instant was computed"):
        empty.plot()
    with pytest.raises(cw.UseError, match="no instant was computed"):
        empty.plot("c1.torque")


@pytest.mark.parametrize("count", [10, 1000, 12345])
def test_thinned_curves_keep_their_peaks(count: int) -> None:
    rng = np.random.default_rng(count)
    time, values = np.sort(rng.random(count)), rng.standard_normal(count)
    t, y = thinned(time, values, 400)
    assert len(t) <= 404
    assert (t[0], t[-1]) == (time[0], time[-1])
    assert (y.min(), y.max()) == (values.min(), values.max())
    assert np.all(np.diff(t) >= 0.0)
    # every point is one of the curve
    assert np.array_equal(values[np.searchsorted(time, t)], y)
    # each stretch of the curve keeps its own peaks
    for part in np.array_split(np.arange(count), 20):
        if not len(part):
            continue
        inside = (t >= time[part[0]]) & (t <= time[part[-1]])
        assert y[inside].max() >= np.sort(values[part])[-max(1, len(part) // 10)]


def test_names_may_hold_what_a_wildcard_is_made_of() -> None:
    d = two_discs("c*")
    d.add(cw.Clutch("cx", base=d.nodes[0], follower=d.nodes[1], friction=LINING, gain=1e-4, pressure=1e5))
    run = d.simulate(0.5)
    # the name itself counts
    check(run, run.plot("c*.torque"), ["c*.torque"])
    check(run, run.plot("c?.torque"), ["c*.torque", "cx.torque"])


@pytest.mark.parametrize(("given", "millimetres"), [("single column", 88.0), ("double column", 180.0), (75, 75.0)])
def test_a_picture_has_the_width_that_is_asked_for(discs: cw.Trajectory, given: Any, millimetres: float) -> None:
    for figure in (
        discs.plot("*.speed", "c1.torque", width=given),
        discs.plot(width=given),
        cw.compare({"a": discs, "b": discs}, "*.speed", width=given),
    ):
        assert figure.get_figwidth() * 25.4 == pytest.approx(millimetres)
        figure.draw_without_rendering()
        # no legend beside or below the picture
        legends = [axes.get_legend().get_window_extent() for axes in figure.axes if axes.get_legend()]
        assert all(box.x1 <= figure.bbox.x1 and box.y1 <= figure.bbox.y1 for box in legends)


@pytest.mark.parametrize("given", ["narrow", 20.0, True, float("inf")])
def test_a_width_that_is_none(discs: cw.Trajectory, given: Any) -> None:
    with pytest.raises(cw.UseError, match=r"width is .*give 'single column', 'double column', or at least 75 mm"):
        discs.plot("c1.torque", width=given)


def test_settings_of_matplotlib_that_were_changed_stay(discs: cw.Trajectory) -> None:
    import matplotlib
    from matplotlib import cycler

    own = {
        "font.size": 11.0,
        "axes.labelsize": 12.0,
        "lines.linewidth": 3.0,
        "axes.prop_cycle": cycler(color=["k", "r"]),
    }
    plain = discs.plot("engine.speed").axes[0]
    with matplotlib.rc_context(own):
        axes = discs.plot("engine.speed", "load.speed").axes[0]
    assert [line.get_color() for line in axes.get_lines()[:2]] == ["k", "r"]
    assert axes.get_lines()[0].get_linewidth() == 3.0
    assert (axes.yaxis.label.get_size(), plain.yaxis.label.get_size()) == (12.0, 8.0)
    # what was not changed has the look of all pictures
    assert not axes.spines["top"].get_visible()
