"""The page in a notebook: what Python reads back is what is run, in a browser too."""

from __future__ import annotations

import json
import re
from base64 import b64encode

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.page.static import WIDGET, built, missing

pytest.importorskip("anywidget")
pytestmark = pytest.mark.skipif(bool(missing()), reason="make wasm page was not run here")


def run():
    d = cw.Driveline("two")
    a, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("b", inertia=0.8)
    law, pressure = cw.Coulomb(static=0.12, kinetic=0.1), cw.Table([(0.0, 0.0), (0.2, 2e5), (2.5, 2e5)])
    d.add(cw.Clutch("c1", base=a, follower=b, friction=law, gain=5e-4, pressure=pressure))
    return d.simulate(2.5)


def test_what_was_changed_comes_back_as_a_system():
    widget = run().widget(drag="c1.pressure", sliders=["c1.gain"])
    assert widget.knots == {"c1.pressure": [[0.0, 0.0], [0.2, 2e5], [2.5, 2e5]]}
    assert widget.values == {"c1.gain": 5e-4}
    before = cw.simulate(widget.system, 2.5)
    # as a reader does who drags a knot and turns a slider
    widget.knots = {"c1.pressure": [[0.0, 0.0], [0.1, 3e5], [2.5, 3e5]]}
    widget.values = {"c1.gain": 6e-4}
    after = cw.simulate(widget.system, 2.5)
    assert before.events.of("c1")[0].time == pytest.approx(1.7, rel=1e-9)
    # 16 N m s over the torque, and half of the ramp
    assert after.events.of("c1")[0].time == pytest.approx(16.0 / 18.0 + 0.05, rel=1e-9)


def test_a_value_between_stops_is_the_nearest_one_in_python_too():
    """An inertia of a rigid train has stops: the page shows the nearest, and so does what Python reads back."""
    d = cw.Driveline("rigid")
    a, b = d.shaft("a", inertia=0.2), d.shaft("b", inertia=0.8, speed=10.0)
    d.add(cw.Gear("g", input=a, output=b, ratio=2.0))
    widget = d.simulate(0.1).widget(drag=[], sliders=["a.inertia=0.1:0.5", "b.inertia=0.1:0.9"])
    stops = {one["name"]: one["values"] for one in json.loads(widget.page)["sliders"]}
    assert not any(one["direct"] for one in json.loads(widget.page)["sliders"])
    assert widget.values == {"a.inertia": 0.2, "b.inertia": 0.8}
    widget.values = {"a.inertia": 0.3333}
    nearest = min(stops["a.inertia"], key=lambda stop: abs(stop - 0.3333))
    # the other one stays
    assert widget.values == {"a.inertia": nearest, "b.inertia": 0.8}
    assert {node.name: node.inertia for node in widget.system.source.nodes} == {"a": nearest, "b": 0.8}


def test_what_python_sets_has_known_names():
    widget = run().widget(drag="c1.pressure", sliders=["c1.gain"])
    for name, value, said in [
        ("values", {"c1.gian": 6e-4}, "'c1.gian' is no slider of this widget; did you mean 'c1.gain'"),
        ("values", {"c1.gain": "6e-4"}, "not a finite number in m3"),
        ("values", {"c1.gain": float("nan")}, "not a finite number in m3"),
        ("knots", {"c1.presure": [[0.0, 1e5]]}, "'c1.presure' is no table of this widget; did you mean 'c1.pressure'"),
        ("knots", {"c1.pressure": [0.0, 1e5]}, "give knots"),
    ]:
        before = getattr(widget, name)
        with pytest.raises(cw.UseError, match=re.escape(said)):
            setattr(widget, name, value)
        assert getattr(widget, name) == before


def test_its_page_is_that_of_the_file():
    widget = run().widget(drag="c1.pressure", show=["a.speed"])
    data = json.loads(widget.page)
    assert [table["name"] for table in data["tables"]] == ["c1.pressure"]
    assert np.frombuffer(widget.core[:4], dtype=np.uint8).tolist() == [0, 97, 115, 109]
    assert ":root" in widget.css
    # notebooks make a view of the style of any widget that has one, and fail where it is a text
    assert "style" not in widget.keys


def test_wrong_names_are_explained():
    with pytest.raises(cw.UseError, match="drag is 3"):
        run().widget(drag=3)
    with pytest.raises(cw.ClutchworkError, match="did you mean"):
        run().widget(drag="c1.presure")


@pytest.fixture(scope="module")
def shown(browse, tmp_path_factory):
    """What a browser made of two widgets on one page."""
    folder = tmp_path_factory.mktemp("widget")
    widget = run().widget(drag="c1.pressure", sliders=["c1.gain"])
    traits = {name: getattr(widget, name) for name in ("page", "css", "knots", "values")}
    (folder / "traits.json").write_text(
        json.dumps({**traits, "core": b64encode(widget.core).decode()}), encoding="utf-8"
    )
    (folder / "widget.js").write_bytes(built(WIDGET))
    return browse("widget.mjs", "chromium", folder)


def test_two_widgets_work_beside_each_other(shown):
    assert (shown["errors"], shown["asked"]) == ([], [])
    start, dragged, typed = shown["start"], shown["dragged"], shown["typed"]
    assert dragged[0]["knots"] != start[0]["knots"] != typed[0]["knots"] != dragged[0]["knots"]
    assert dragged[0]["picture"] != start[0]["picture"]
    assert dragged[0]["saves"] > start[0]["saves"]
    # the other one is as it was
    assert typed[1] == start[1]


def test_the_knots_that_python_reads_are_those_that_were_dragged(shown):
    knots = shown["dragged"][0]["knots"]["c1.pressure"]
    start = shown["start"][0]["knots"]["c1.pressure"]
    # 20 px to the right and 30 px up: later and higher, and no other knot moved
    assert knots[1][0] > start[1][0]
    assert knots[1][1] > start[1][1]
    assert [knots[0], *knots[2:]] == [start[0], *start[2:]]


def test_what_python_sets_is_run_and_shown(shown):
    before, after = shown["typed"][1], shown["received"][1]
    assert after["knots"]["c1.pressure"] == [[0.0, 0.0], [0.2, 1e5], [2.5, 1e5]]
    assert after["picture"] != before["picture"]
    # half of the pressure locks it after 16 N m s / 5 N m + 0.1 s, which this run does not see
    assert "c1 never locks" in after["label"]


def test_each_widget_has_the_theme_around_it(shown):
    def light(one):
        return sum(map(int, re.findall(r"\d+", one["ground"])[:3])) > sum(map(int, re.findall(r"\d+", one["text"])[:3]))

    assert [light(one) for one in shown["start"]] == [True, False]
    assert [light(one) for one in shown["dark"]] == [False, False]
    assert shown["dark"][0]["picture"] != shown["received"][0]["picture"]
    # a notebook that says nothing: what the reader prefers
    assert [light(one) for one in shown["unsaid"]] == [True, True]
    assert [light(one) for one in shown["preferred"]] == [False, False]
    assert shown["unsaid"][1]["picture"] != shown["preferred"][1]["picture"]
    # VS Code and Colab, where the reader prefers the dark
    assert {name: [light(one) for one in both] for name, both in shown["said"].items()} == {
        "data-vscode-theme-kind vscode-light": [True, True],
        "data-vscode-theme-kind vscode-dark": [False, False],
        "theme light": [True, True],
        "theme dark": [False, False],
    }


def test_a_widget_that_is_taken_away_hears_nothing_and_may_come_back(shown):
    assert shown["listeners"] == [[0, 0], [2, 1]]
    assert shown["again"] == 3
