"""`run.gears`: gears by name, with freewheels, dog clutches, neutral and shifts between them; tables that show them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.base.errors import UnknownName
from clutchwork.command.main import main
from support.transmissions import AODE, MIXED


def pressed(*points: tuple[float, float]) -> dict[str, Any]:
    return {"pressure": cw.Table(points)}


def shifted(**values: Any) -> cw.Driveline:
    """First gear, then second by swapping a brake, then all open."""
    d = cw.Driveline("t")
    turbine, wheels = d.shaft("turbine", inertia=0.1, speed=250.0), d.shaft("wheels", inertia=12.0)
    shift = {
        "forward": pressed((0, 1e6), (1.4, 1e6), (1.4, 0)),
        "low": pressed((0, 1e6), (0.4, 1e6), (0.5, 0)),
        "overdrive": pressed((0, 0), (0.4, 0), (0.8, 8e5), (1.4, 8e5), (1.4, 0)),
    }
    box = {"gearbox": AODE, "gear": "1", "torque": 250.0, "shift": shift, **values}
    d.add(cw.Transmission("gearbox", input=turbine, output=wheels, **box))
    d.add(cw.Torque("engine", shaft=turbine, torque=150.0))
    d.add(cw.QuadraticTorque("road", shaft=wheels, nominal_torque=-100.0, nominal_speed=100.0))
    return d


def test_gears_one_after_another() -> None:
    run = shifted().simulate(1.6)
    found = run.gears("gearbox")
    assert [one.gear for one in found] == ["1", None, "2", "neutral"]
    assert [(one.begin, one.end) for one in found] == [
        (0.0, found[1].begin),
        (found[0].end, found[2].begin),
        (found[1].end, 1.4),
        (1.4, 1.6),
    ]
    ratios = cw.Gearbox.from_dict(AODE).ratios
    for one in found:
        if one.gear in ratios:
            inside = (run.time > one.begin) & (run.time < one.end)
            ratio = run["gearbox.in.speed"][inside] / run["gearbox.ring.speed"][inside]
            assert ratio == pytest.approx(ratios[one.gear], rel=1e-9)
    assert found.sequence == ("1", "2", "neutral")
    assert (found.at(0.1), found.at(1.2), found.at(1.5)) == ("1", "2", "neutral")
    # a grid of the output changes nothing
    coarse = shifted().simulate(1.6, dt=0.4).gears()
    assert [one.gear for one in coarse] == [one.gear for one in found]
    assert coarse[1].begin == pytest.approx(found[1].begin, abs=1e-12)


def test_freewheels_count_where_they_hold() -> None:
    """The freewheel holds the ring in first gear and is overrun in second; in third the dog clutch is in."""
    d = cw.Driveline("t")
    a, b = d.shaft("a", inertia=0.1, speed=200.0), d.shaft("b", inertia=5.0)
    shift = {
        "B": pressed((0, 1e6), (1.2, 1e6), (1.2, 0)),
        "K": pressed((0, 0), (0.3, 0), (0.5, 1e6), (1.2, 1e6), (1.2, 0)),
        "D": {"command": cw.Step(height=1.0, start=1.3), "speed": 1e3},
    }
    d.add(cw.Transmission("box", gearbox=MIXED, input=a, output=b, gear="1", torque=200.0, shift=shift))
    d.add(cw.Torque("engine", shaft=a, torque=150.0))
    run = d.simulate(2.0)
    assert run.gears().sequence[:2] == ("1", "2")
    ends = [one for one in run.gears() if one.gear == "2"]
    assert "box.F" not in ends[0].closed
    assert run.gears().at(1.95) == "3"
    assert "box.D" in run.gears()[-1].closed


def test_they_survive_files(tmp_path: Path) -> None:
    run = shifted().simulate(1.6)
    run.save(tmp_path / "r.cwrun")
    assert str(cw.load_run(tmp_path / "r.cwrun").gears()) == str(run.gears())
    assert len(run.gears().to_pandas()) == 4
    assert ">neutral</td>" in run.gears()._repr_html_()


def test_tables_say_gears(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shifted().save(tmp_path / "m.toml")
    assert main(["run", str(tmp_path / "m.toml"), "--t-end", "1.6"]) == 0
    said = capsys.readouterr().out
    assert "gearbox: 1" in said
    assert "gearbox: 2" in said
    assert main(["check", str(tmp_path / "m.toml")]) == 0
    said = capsys.readouterr().out
    assert "gearbox: R" in said
    assert "-2.0000" in said


def test_unknown_gearboxes() -> None:
    run = shifted().simulate(0.01)
    with pytest.raises(UnknownName, match="no gearbox 'gearbx'; did you mean 'gearbox'"):
        run.gears("gearbx")
    d = cw.Driveline("none")
    d.shaft("a", inertia=1.0)
    with pytest.raises(UnknownName, match=r"the model has no cw\.Transmission"):
        d.simulate(0.1).gears()
