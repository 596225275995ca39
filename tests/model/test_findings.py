"""Checks look once, and look again as soon as anything changed."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.model import findings as module


@pytest.fixture
def looks(monkeypatch):
    """How often a model was looked at."""
    found, made = [], module._find
    monkeypatch.setattr(module, "_find", lambda *args: found.append(1) or made(*args))
    return found


def _rig(points=((0.0, 3.0), (9.0, 0.0))):
    d = cw.Driveline("rig")
    a, b = d.shaft("a", inertia=1.0, speed=3.0), d.shaft("b", inertia=2.0)
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=50.0, damping=1.0))
    d.add(cw.SpeedTorque("motor", shaft=a, torque=points))
    return d, a, b


def test_check_and_assemble_look_once(looks, root):
    path = root / "examples/six_speed/model.toml"
    d = cw.Driveline.load(path)
    assert d.check() == []
    first = d.assemble().to_bytes()
    assert d.assemble().to_bytes() == first
    assert len(looks) == 1
    assert cw.Driveline.load(path).assemble().to_bytes() == first


def test_what_is_added_after_a_check_is_seen(looks):
    d, a, b = _rig()
    assert d.check() == []
    before = d.assemble()
    d.add(cw.Gear("g", input=a, output=b, ratio=0.0))
    (problem,) = d.check()
    assert problem.quantity == "ratio"
    with pytest.raises(cw.ModelError, match="ratio"):
        d.assemble()
    # what has a mistake is looked at again
    assert len(looks) == 3
    assert before.counts["elements"] == 2


@pytest.mark.parametrize(
    ("add", "named"),
    [
        (lambda d: d.shaft("light"), 'shaft "light": inertia is missing'),
        (lambda d: d.mass("light"), 'mass "light": mass is missing'),
        (lambda d: d.shaft("a", inertia=1.0), "already"),
        (lambda d: d.thermal("a", capacity=1.0), "already"),
        (lambda d: d.ambient("cold", temperature=float("nan")), "must be finite"),
        (lambda d: d.add(cw.Torque("k", shaft=d.nodes[0], torque=1.0)), "already"),
    ],
)
def test_everything_that_can_be_added_is_seen(add, named):
    d, *_ = _rig()
    assert d.check() == []
    d.assemble()
    add(d)
    assert any(named in str(problem) for problem in d.check())


def test_an_added_gear_changes_the_structure():
    d, a, b = _rig()
    assert d.assemble().counts["speeds"] == 2
    d.add(cw.Gear("g", input=a, output=b, ratio=2.0))
    assert d.assemble().counts["speeds"] == 1


@pytest.mark.parametrize("kind", [list, np.array])
def test_a_list_that_its_owner_changes_is_looked_at_again(looks, kind):
    points = kind([[0.0, 3.0], [9.0, 0.0]])
    d, *_ = _rig(points)
    assert d.check() == d.check() == []
    assert len(looks) == 1
    system = d.assemble()
    points[1][0] = -1.0
    (problem,) = d.check()
    assert "comes after" in str(problem)
    assert len(looks) == 2
    # a System does not change with what it was made of
    assert system.model["element"][1]["torque"] == [[0.0, 3.0], [9.0, 0.0]]


def test_a_list_inside_a_law_is_looked_at_again():
    points = [[0.0, 0.12], [20.0, 0.1]]
    d, a, b = _rig()
    law = cw.CoefficientTable(static=0.13, kinetic=points)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1.0, pressure=1.0))
    assert d.check() == []
    points[0][1] = -0.2
    assert any("kinetic" in problem.quantity for problem in d.check())


def test_a_saved_system_holds_the_driveline_as_it_was(tmp_path):
    d, a, _ = _rig()
    system = d.assemble()
    d.add(cw.Torque("more", shaft=a, torque=1.0))
    assert [entry["name"] for entry in system.model["element"]] == ["k", "motor"]
    system.save(tmp_path / "rig.npz")
    assert cw.System.load(tmp_path / "rig.npz").to_bytes() == system.to_bytes()
    assert pickle.loads(pickle.dumps(system)).model == system.model


def test_warnings_come_at_every_check():
    d, _, b = _rig()
    law = cw.LuGre(static=0.2, kinetic=0.1, speed=1.0, stiffness=100.0, damping=5.0)
    d.add(cw.BearingFriction("f", shaft=b, friction=law, torque=1.0))
    for _ in range(2):
        with pytest.warns(cw.ModelWarning):
            assert d.check() == []
    with pytest.warns(cw.ModelWarning):
        assert d.assemble().warnings


def test_forced_choices_do_not_stay():
    d, *_ = _rig()
    assert d.assemble(["b", "a"]).independent == ("b", "a")
    assert set(d.assemble().independent) == {"a", "b"}
    plain = d.assemble().to_bytes()
    d.assemble(["b", "a"])
    assert d.assemble().to_bytes() == plain


def test_columns_of_one_file_are_of_one_state(tmp_path):
    table = tmp_path / "signals.csv"
    table.write_text("time,x,y,word\n0,1,2,3\n1,2,5,4\n")
    data = {
        "shaft": [{"name": "a", "inertia": 1.0}],
        "element": [
            {
                "name": n,
                "type": "torque",
                "shaft": "a",
                "torque": {"type": "column", "path": "signals.csv", "column": n},
            }
            for n in "xy"
        ],
    }
    first = cw.Driveline.from_dict(data, tmp_path).assemble()
    values = [list(item.signal.points) for item in first.inputs]
    assert values == [[(0.0, 1.0), (1.0, 2.0)], [(0.0, 2.0), (1.0, 5.0)]]
    # the next model reads the file anew
    table.write_text("time,x,y,word\n0,7,2,a\n1,8,5,b\n")
    again = cw.Driveline.from_dict(data, tmp_path).assemble()
    assert list(again.inputs[0].signal.points) == [(0.0, 7.0), (1.0, 8.0)]
    table.write_text("time,x,y,word\n1,7,2,3\n0,8,5,4\n")
    with pytest.raises(cw.ModelError, match="its time is before that of line 2"):
        cw.Driveline.from_dict(data, tmp_path)


def _driven_by(signal):
    d = cw.Driveline("driven")
    d.add(cw.Torque("load", shaft=d.shaft("a", inertia=1.0), torque=signal))
    return d


def test_a_file_that_was_corrected_is_read_again(tmp_path):
    late = _driven_by(cw.Column(str(tmp_path / "late.csv"), "w"))
    (problem,) = late.check()
    assert "does not exist" in str(problem)
    (tmp_path / "late.csv").write_text("time,w\n0,1\n1,2\n")
    assert late.check() == []
    (tmp_path / "bad.csv").write_text("time,w\n0,1\n1,two\n")
    bad = _driven_by(cw.Column(str(tmp_path / "bad.csv"), "w"))
    assert len(bad.check()) == 1
    (tmp_path / "bad.csv").write_text("time,w\n0,1\n1,2\n")
    assert bad.check() == []


def test_odd_arrays_and_lists_are_mistakes_and_no_crash():
    d = _driven_by(1.0)
    a = d.shaft("b", inertia=np.array(1.0))
    d.add(cw.Spring("s", base=d.housing, follower=a, stiffness=np.array(100.0)))
    d.simulation["times"] = np.array(5.0)
    assert {problem.quantity for problem in d.check()} == {"inertia", "stiffness", "times"}
    points = [[0.0, 1.0], [1.0, 2.0]]
    endless = _driven_by(cw.Table(points))
    assert endless.check() == []
    points[1][1] = points
    assert len(endless.check()) == 1


def test_a_system_does_not_follow_its_driveline(tmp_path):
    points = [[0.0, 1.0], [1.0, 2.0]]
    d = _driven_by(cw.Table(points))
    d.simulation = {"t_end": 1.0}
    system = d.assemble()
    d.simulation["t_end"], points[1][0] = 2.0, -5.0
    renamed = replace(system, name="renamed")
    renamed.save(tmp_path / "system.npz")
    assert cw.System.load(tmp_path / "system.npz").settings == {"t_end": 1.0}
    with pytest.raises(TypeError):
        system.settings["t_end"] = 3.0
    assert pickle.loads(pickle.dumps(system)).settings == {"t_end": 1.0}
