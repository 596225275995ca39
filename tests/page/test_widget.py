"""The page in a notebook: what Python reads back is what is run."""

from __future__ import annotations

import json

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.page.static import missing

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


def test_its_page_is_that_of_the_file():
    widget = run().widget(drag="c1.pressure", show=["a.speed"])
    data = json.loads(widget.page)
    assert [table["name"] for table in data["tables"]] == ["c1.pressure"]
    assert np.frombuffer(widget.core[:4], dtype=np.uint8).tolist() == [0, 97, 115, 109]
    assert ":root" in widget.style


def test_wrong_names_are_explained():
    with pytest.raises(cw.UseError, match="drag is 3"):
        run().widget(drag=3)
    with pytest.raises(cw.ClutchworkError, match="did you mean"):
        run().widget(drag="c1.presure")
