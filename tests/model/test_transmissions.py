"""A `Transmission` as it is written: in Python and in files, its mistakes, what refers to its parts, what changes."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.elements.bases.shift_elements import LINING, PRESSED, RESERVE
from support.transmissions import AODE

MODEL: dict[str, Any] = {
    "shaft": [{"name": "engine", "inertia": 0.2, "speed": "1000 rpm"}, {"name": "wheels", "inertia": 5.0}],
    "thermal": [{"name": "oil", "capacity": "2 kJ/K"}],
    "element": [
        {"name": "drive", "type": "torque", "shaft": "engine", "torque": 50.0},
        {"name": "drag", "type": "damper", "base": "housing", "follower": "gearbox.C", "damping": 1e-3},
        {
            "name": "gearbox",
            "type": "transmission",
            "gearbox": AODE,
            "input": "engine",
            "output": "wheels",
            "inertias": {"C": "200 kg cm2"},
            "gear": "1",
            "heat": "oil",
            "shift": {
                "low": {"pressure": {"type": "step", "height": "-10 bar", "start": "20 ms", "offset": "10 bar"}},
                "overdrive": {
                    "type": "disk_clutch",
                    "outer_diameter": "14 cm",
                    "inner_diameter": 0.11,
                    "area": "30 cm2",
                    "friction": {"type": "stribeck", "static": 0.13, "kinetic": 0.11, "speed": 2.0},
                    "pressure": {"of": "piston", "state": "pressure"},
                },
            },
            "drag": {"reverse": {"peak": 2.0, "speed": "900 rpm"}},
        },
        {"name": "piston", "type": "pressure_actuator", "command": "8 bar", "lag": 0.02},
        {
            "name": "wear",
            "type": "wear",
            "rate": 1e-13,
            "area": 0.003,
            "heat": {"type": "heat_flow", "of": "gearbox.overdrive"},
        },
    ],
    "simulation": {"t_end": 0.2},
}


def model(**changes: Any) -> dict[str, Any]:
    """The model with other fields of its gearbox."""
    made = copy.deepcopy(MODEL)
    made["element"][2] |= changes
    return made


def python(**values: Any) -> cw.Driveline:
    """A gearbox between two shafts."""
    d = cw.Driveline("t")
    a, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("b", inertia=2.0)
    d.add(cw.Transmission("gearbox", **{"gearbox": AODE, "input": a, "output": b, **values}))
    d.add(cw.Torque("drive", shaft=a, torque=50.0))
    return d


def told(d: cw.Driveline) -> list[str]:
    return [str(problem) for problem in d.check()]


def test_a_file_holds_it_all_and_reads_back(tmp_path: Path) -> None:
    d = cw.Driveline.from_dict(MODEL)
    run = d.simulate()
    assert run["gearbox.overdrive.pressure"][-1] > 5e5
    assert run["wear.depth"][-1] > 0.0
    # what slips heats the oil, none of it got lost
    assert run["oil.temperature"][-1] > 300.0
    for name in ("t.toml", "t.json"):
        d.save(tmp_path / name)
        again = cw.Driveline.load(tmp_path / name)
        assert again.to_dict() == d.to_dict()
        assert again.simulate().rows.tobytes() == run.rows.tobytes()


def test_a_gearbox_file_is_found_beside_the_model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    cw.Gearbox.from_dict(AODE).save(tmp_path / "four.toml")
    cw.Driveline.from_dict(model()).save(Path("model.toml"))
    text = Path("model.toml").read_text()
    start, end = text.index("[element.gearbox]"), text.index("[element.shift.low]")
    text = text[:start] + text[end:]
    Path("model.toml").write_text(text.replace('gear = "1"', 'gear = "1"\ngearbox = "four.toml"'))
    d = cw.Driveline.load(Path("model.toml"))
    expected = cw.Driveline.from_dict(MODEL).simulate()
    assert d.simulate().rows.tobytes() == expected.rows.tobytes()
    # saved elsewhere, the path leads back; a saved System holds the gearbox itself
    Path("other").mkdir()
    d.save(Path("other", "model.toml"))
    assert "../four.toml" in Path("other", "model.toml").read_text()
    assert cw.Driveline.load(Path("other", "model.toml")).simulate().rows.tobytes() == expected.rows.tobytes()
    d.assemble().save("s.cwsystem")
    (tmp_path / "four.toml").unlink()
    assert cw.System.load("s.cwsystem").gearboxes[0].gears["1"] == ("gearbox.forward", "gearbox.low")


def test_python_and_files_are_the_same() -> None:
    d = cw.Driveline("driveline")
    engine, wheels = d.shaft("engine", inertia=0.2, speed="1000 rpm"), d.shaft("wheels", inertia=5.0)
    oil = d.thermal("oil", capacity=2e3)
    piston = cw.PressureActuator("piston", command=8e5, lag=0.02)
    law = cw.Stribeck(static=0.13, kinetic=0.11, speed=2.0)
    plates = {"outer_diameter": "14 cm", "inner_diameter": 0.11, "area": "30 cm2"}
    box = cw.Transmission(
        "gearbox",
        gearbox=cw.Gearbox.from_dict(AODE),
        input=engine,
        output=wheels,
        inertias={"C": 0.02},
        gear="1",
        heat=oil,
        shift={
            "low": {"pressure": cw.Step(height="-10 bar", start="20 ms", offset="10 bar")},
            "overdrive": {"type": "disk_clutch", **plates, "friction": law, "pressure": (piston, "pressure")},
        },
        drag={"reverse": {"peak": 2.0, "speed": "900 rpm"}},
    )
    d.add(cw.Torque("drive", shaft=engine, torque=50.0))
    d.add(cw.Damper("drag", base=d.housing, follower=box.part("C"), damping=1e-3))
    d.add(box)
    d.add(piston)
    d.add(cw.Wear("wear", rate=1e-13, area=0.003, heat=cw.HeatFlow(box.part("overdrive"))))
    expected = cw.Driveline.from_dict(MODEL)
    assert d.simulate(0.2).rows.tobytes() == expected.simulate().rows.tobytes()
    for one, other in zip(d.to_dict()["element"], expected.to_dict()["element"], strict=True):
        assert one == other


def test_it_can_be_hashed_copied_and_sent() -> None:
    d = python(shift={"low": {"friction": cw.Stribeck(static=0.2, kinetic=0.1, speed=1.0)}}, gear="1")
    rows = d.simulate(0.1).rows.tobytes()
    hash(d.elements[0])
    for other in (copy.deepcopy(d), pickle.loads(pickle.dumps(d))):
        assert other.simulate(0.1).rows.tobytes() == rows
    system = d.assemble()
    assert pickle.loads(pickle.dumps(system)).gearboxes == system.gearboxes


def test_elements_that_nobody_describes_hold_what_is_promised() -> None:
    box = cw.Gearbox.from_dict(AODE)
    d = python(gear="1", torque=250.0)
    run = d.simulate(0.01)
    for name, found in box.capacities().items():
        element: Any = d.elements[0].part(name)
        assert element.friction == LINING
        assert element.gain * PRESSED * LINING.static == pytest.approx(RESERVE * found.torque * 250.0, rel=1e-12)
        assert run[f"gearbox.{name}.pressure"][0] == (PRESSED if name in box.gears["1"] else 0.0)
    assert run.gears().sequence == ("1",)


def test_the_gear_at_the_start_turns_all_members() -> None:
    for ends in ({"a": 240.0}, {"b": 100.0}):
        d = cw.Driveline("t")
        a, b = d.shaft("a", inertia=0.2, speed=ends.get("a")), d.shaft("b", inertia=2.0, speed=ends.get("b"))
        d.add(cw.Transmission("gearbox", gearbox=AODE, input=a, output=b, gear="1"))
        run = d.simulate(0.01)
        assert run["a.speed"][0] == pytest.approx(240.0, rel=1e-12)
        assert run["b.speed"][0] == pytest.approx(100.0, rel=1e-12)
        assert not run.events


def test_changes_by_the_names_of_parts() -> None:
    d = python(gear="1", drag={"reverse": {"peak": 2.0, "speed": 100.0}})
    system = d.assemble()
    made = system.changed(
        {
            "gearbox.low.gain": 2e-3,
            "gearbox.low.friction.kinetic": 0.05,
            "gearbox.low.pressure": "9 bar",
            "gearbox.C.inertia": "300 kg cm2",
            "gearbox.reverse.drag.peak": 1.0,
            "gearbox.torque": 300.0,
        }
    )
    assert made.source is not None
    box: Any = made.source.elements[0]
    assert (box.part("low").gain, box.part("low").friction.kinetic, box.part("C").inertia) == (2e-3, 0.05, 0.03)
    assert box.part("reverse.drag").peak == 1.0
    # capacities that nobody gave follow
    assert box.part("forward").gain == pytest.approx(300.0 / 400.0 * d.elements[0].part("forward").gain)
    assert cw.simulate(made, 0.01)["gearbox.low.pressure"][0] == 9e5
    with pytest.raises(cw.ModelError, match=r"did you mean 'gearbox.low.gain'"):
        system.changed({"gearbox.low.gian": 1.0})
    with pytest.raises(cw.ModelError, match=r"shift.low.gain = -1.0 m3: must be > 0 m3"):
        system.changed({"gearbox.low.gain": -1.0})


def test_all_mistakes_at_once() -> None:
    shift = {
        "low": {"gain": -1.0, "presure": 1e5},
        "direct": {"type": "brake"},
        "forward": {"type": "clutsh"},
        "over": {},
        "reverse": {"type": "planetary"},
    }
    found = told(python(shift=shift, inertias={"D": 1.0}, drag={"reverse": {"speed": 0.0}}))
    path = 'cw.Transmission("gearbox"): '
    wanted = [
        "shift.over is not a shift element of 'four speeds'",
        "inertias.D is not a member of 'four speeds'",
        "shift.low.presure is an unknown key; did you mean 'pressure'?",
        "shift.low.gain = -1.0 m3: must be > 0 m3",
        "shift.direct.type = 'brake': acts against the housing, and this element joins two members",
        "shift.forward.type = 'clutsh': is an unknown type; did you mean 'clutch'?",
        "shift.reverse.type = 'planetary': is an unknown type",
        "drag.reverse.peak is missing",
        "drag.reverse.speed = 0.0 rad/s: must be > 0 rad/s",
    ]
    assert all(any(text.startswith(path) and words in text for text in found) for words in wanted), "\n".join(found)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"inertias": {"D": 1.0}}, "inertias.D"),
        ({"inertias": {"C": -1.0}}, "inertias.C = -1.0 kg m2: must be >= 0 kg m2"),
        ({"inertias": {"C": "1 kg"}}, "inertias.C = '1 kg'"),
        ({"inertias": 3.0}, "inertias = 3.0: must be a table of numbers in [kg m2] by name"),
        ({"shift": {"low": 3.0}}, "shift.low = 3.0: must be a table"),
        ({"efficiencies": {"P1": 1.5}}, "efficiencies.P1 = 1.5: must be > 0 and <= 1"),
        ({"gear": "7"}, "gear '7' is not a gear of 'four speeds'"),
        ({"gear": 7}, "gear = 7: must be a string; write '7'"),
        ({"gearbox": "ford-aod"}, "gearbox 'ford-aod' is not in the catalogue; did you mean 'ford-aode'?"),
        ({"gearbox": "none.toml"}, "does not exist"),
        ({"gearbox": 3}, "is not a gearbox: 3"),
        ({"gearbox": {**AODE, "gears": {"1": ["forward"]}}}, 'gear "1"'),
    ],
)
def test_mistakes_in_python_and_in_files(changes: dict[str, Any], words: str) -> None:
    found = told(python(**changes))
    assert any(text.startswith('cw.Transmission("gearbox"): ') and words in text for text in found), found
    with pytest.raises(cw.ModelError) as caught:
        cw.Driveline.from_dict(model(**changes))
    assert 'element "gearbox" (transmission): ' in str(caught.value)
    assert words.replace("cw.", "") in str(caught.value)


def test_a_line_of_a_file_is_named(tmp_path: Path) -> None:
    d = cw.Driveline.from_dict(MODEL)
    d.save(tmp_path / "t.toml")
    lines = (tmp_path / "t.toml").read_text().splitlines()
    place = next(number for number, line in enumerate(lines) if line.startswith("outer_diameter"))
    lines[place] = "outer_diameter = -1.0"
    (tmp_path / "t.toml").write_text("\n".join(lines))
    with pytest.raises(cw.ModelError, match=f"line {place + 1}: .*shift.overdrive.outer_diameter"):
        cw.Driveline.load(tmp_path / "t.toml")


def test_members_without_inertia_are_named() -> None:
    found = told(python(inertia=0.0))
    assert found, "two members of the Ravigneaux set are free"
    for text in found:
        assert text.startswith('shaft "gearbox.')
        assert "give it inertia > 0 kg m2 where 'gearbox' is written" in text
    # enough of them have some
    assert told(python(inertia=0.0, inertias={"S1": 0.01, "S2": 0.01})) == []
