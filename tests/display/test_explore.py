"""`run.explore`: the same curves in a page that needs no network."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw

from .conftest import example, two_discs

pytest.importorskip("plotly")


def curves(figure: Any) -> dict[str, Any]:
    return {trace.name: trace for trace in figure.data if trace.name}


def test_the_curves_are_those_of_the_run(six_speed: cw.Trajectory) -> None:
    figure = six_speed.explore("F1.torque", "*.speed", ["F2.torque", "F2.slip"])
    found = curves(figure)
    names = ["F1.torque", *(name for name in six_speed.names if name.endswith(".speed")), "F2.torque", "F2.slip"]
    assert list(found) == names
    for name in names:
        trace, unit = found[name], six_speed.units[name]
        factor, shown = (1e-3, "kN m") if name == "F1.torque" else (1.0, unit)
        assert np.array_equal(trace.x, six_speed.time)
        np.testing.assert_allclose(trace.y, factor * six_speed[name], rtol=1e-14)
        assert trace.hovertemplate == f"{name}: %{{y:.6g}} {shown}<extra></extra>"
    # panels are linked
    axes = list(figure.select_xaxes())
    assert len({axis.matches for axis in axes[1:]} | {"x"}) == 1
    assert {tuple(axis.range) for axis in axes} == {(0.0, 4.0)}


def test_events_are_marks_with_what_happened(six_speed: cw.Trajectory) -> None:
    figure = six_speed.explore("F1.torque")
    texts = [text for trace in figure.data if not trace.name for text in trace.text]
    changes = six_speed.events.changes()
    assert len(texts) == len(changes)
    for event in changes:
        (text,) = (text for text in texts if f"at {event.time:.6f} s" in text)
        assert text.startswith(event.element)
        assert f"torque {event.torque_before:.6g} to {event.torque_after:.6g} N m" in text
    assert sorted(shape.x0 for shape in figure.layout.shapes) == sorted(set(changes.times.tolist()))
    assert not any(trace.name is None for trace in six_speed.explore("F1.torque", events=False).data)


def test_what_is_shown_where_nothing_is_named() -> None:
    run = example("car_launch")
    found = set(curves(run.explore()))
    assert {"engine.speed", "car.speed", "clutch.torque", "clutch.normal_force", "flywheel.temperature"} <= found


def test_a_page_is_one_file_with_all_that_it_needs(discs: cw.Trajectory, tmp_path: Path) -> None:
    discs.explore("c1.torque", tmp_path / "new" / "run.html")
    page = (tmp_path / "new" / "run.html").read_text(encoding="utf-8")
    assert len(page) > 3_000_000
    # no script comes from elsewhere
    assert re.findall(r"<script[^>]*src=", page) == []
    assert "c1.torque" in page


@pytest.mark.parametrize("name", ["$x$", "a<b>", "a & b", "100 %{y}", "größe"])
def test_odd_names_are_shown_as_they_are(name: str, tmp_path: Path) -> None:
    figure = two_discs(name).simulate(2.5).explore(f"{name}.torque", f"{name}.state", path=tmp_path / "p.html")
    words = [figure.data[0].name, figure.data[0].hovertemplate, figure.data[-1].text[0]]
    for word in words:
        for sign in ("$", "<b>"):
            assert sign not in word
    # what stands before the colon is the name, without a place for a number
    assert "%" not in words[1].partition(": ")[0]


def test_states_are_words(discs: cw.Trajectory) -> None:
    trace = curves(discs.explore("c1.state"))["c1.state"]
    assert list(trace.text) == discs["c1.state"].tolist()
    assert trace.hovertemplate.startswith("c1.state: %{text}")


def test_many_points_are_thinned_without_losing_peaks(six_speed: cw.Trajectory) -> None:
    run = six_speed.at(np.linspace(0.0, 4.0, 300_001))
    few = curves(run.explore("F1.torque", "w1.speed"))["F1.torque"]
    assert len(few.x) <= 20_004
    assert (few.y.min(), few.y.max()) == (1e-3 * run["F1.torque"].min(), 1e-3 * run["F1.torque"].max())
    whole = curves(run.explore("F1.torque", points=None))["F1.torque"]
    assert len(whole.x) == len(run)
    # on the graphics card
    assert whole.type == "scattergl"
    near = curves(run.explore("F1.torque", zoom=(2.73, 2.75)))["F1.torque"]
    assert len(near.x) > 1600


def test_the_figure_is_plain_data(discs: cw.Trajectory) -> None:
    assert json.loads(discs.explore("c1.torque").to_json())["data"]


@pytest.mark.parametrize(
    ("given", "named", "words"),
    [
        (["p.png"], {}, r"path 'p\.png' has the ending '\.png'; write it to a path that ends in \.html"),
        ([], {"points": 3}, "points is 3: give a whole number of at least 100, or None"),
        ([], {"points": "all"}, "points is 'all'"),
        ([], {"zom": 3}, "unknown field 'zom'; did you mean 'zoom'"),
        ([], {"lockup": None}, "unknown field 'lockup'"),
    ],
)
def test_mistakes(discs: cw.Trajectory, given: list[Any], named: dict[str, Any], words: str) -> None:
    with pytest.raises(cw.UseError, match=words):
        discs.explore(*given, **named)
    with pytest.raises(cw.UnknownName, match=r"did you mean 'c1\.torque'"):
        discs.explore("c1.torqe")


def test_curves_keep_their_corners(six_speed: cw.Trajectory) -> None:
    """Plotly would leave out points of a line, which are seen as a polygon when somebody zooms."""
    lines = [trace for trace in six_speed.explore("F1.torque", "*.speed", "F1.state").data if trace.type == "scatter"]
    assert lines
    assert all(trace.line.simplify is False for trace in lines if trace.mode == "lines")
