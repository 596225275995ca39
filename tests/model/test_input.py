"""Hostile and careless input: refused in words, at once, without the content of other files."""

from __future__ import annotations

import csv
import json
import os
import re
from itertools import pairwise
from time import process_time
from xml.sax.saxutils import escape

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.base.errors import MOST_LINES, ModelFileError, near
from clutchwork.base.quote import MOST_NAMES, listed, printable, quote, shortened
from clutchwork.command.main import main
from clutchwork.declare.options import MOST_ROWS, Options
from clutchwork.files import model_file
from support import samples
from support.fuzz import mutate

LINING = cw.Coulomb(static=0.12, kinetic=0.1)


def _two(**more):
    d = cw.Driveline("two")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    values = {"base": load, "follower": engine, "friction": LINING, "gain": 5e-4, "pressure": 1e5} | more
    return d, cw.Clutch("c", **values)


def _mistakes(tmp_path, text, name="model.toml"):
    (tmp_path / name).write_text(text)
    with pytest.raises(cw.ModelError) as caught:
        cw.Driveline.load(tmp_path / name)
    return str(caught.value)


# --- model files ---


@pytest.mark.parametrize("number", ["9" * 400, "-" + "9" * 400, "0x" + "f" * 4000, "1e400"])
def test_numbers_beyond_all_floats(tmp_path, number):
    said = _mistakes(tmp_path, f'[[shaft]]\nname = "a"\ninertia = {number}\n')
    assert "must be finite" in said
    assert len(said) < 500


def test_integers_too_long_to_be_read(tmp_path):
    assert "is not valid TOML" in _mistakes(tmp_path, f'[[shaft]]\nname = "a"\ninertia = {"9" * 5000}\n')
    assert "is not valid JSON" in _mistakes(
        tmp_path, '{"shaft": [{"name": "a", "inertia": ' + "9" * 5000 + "}]}", "m.json"
    )


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("m.json", "[" * 100_000),
        ("m.json", '{"shaft": ' * 5_000),
        ("m.toml", "a = " + "[" * 100_000),
        ("m.toml", 'shaft = [{name = "a", inertia = ' + "{value = " * 400 + "1" + "}" * 400 + "}]"),
        ("m.json", '{"shaft": [{"name": "a", "inertia": ' + '{"value": ' * 900 + "1" + "}" * 900 + "}]}"),
    ],
)
def test_deep_nesting(tmp_path, name, text):
    said = _mistakes(tmp_path, text, name)
    assert "nested too deeply" in said or "holds a table" in said
    assert len(said) < 1000


@pytest.mark.parametrize(
    "text",
    [
        "\n\n" + ".".join(["a"] * 200_000) + " = 1",
        "name = 'x'\n\n[[ " + ' . "b" . '.join(["a"] * 50_000) + "]]",
        "name = 'x'\n\nx = {b = 1, " + " .'c'.".join(["a"] * 50_000) + " = 1}",
    ],
    ids=["key", "head", "inline"],
)
def test_a_long_dotted_key_is_refused_at_once_with_its_line(tmp_path, text):
    started = process_time()
    assert "line 3" in _mistakes(tmp_path, text, "m.toml")
    (tmp_path / "box.toml").write_text(text)
    with pytest.raises(cw.ModelError, match="more than 16 dotted parts"):
        cw.Gearbox.load(tmp_path / "box.toml")
    assert process_time() - started < 1.0


def test_elements_in_a_long_chain(tmp_path):
    links = [{"name": f"p{k}", "type": "pressure_actuator", "command": f"p{k + 1}", "lag": 0.1} for k in range(500)]
    data = {"shaft": [{"name": "a", "inertia": 1.0}], "element": [*links, {**links[0], "name": "p500", "command": 1e5}]}
    with pytest.raises(cw.ModelError, match="nested too deeply"):
        cw.Driveline.from_dict(data)


@pytest.mark.parametrize("kind", [[], {}, 3, ["clutch"], None])
def test_types_that_are_no_text(kind):
    for data in (
        {"element": [{"name": "x", "type": kind}]},
        {"element": [{"name": "x", "type": "brake", "friction": {"type": kind}}]},
        {"element": [{"name": "x", "type": "brake", "pressure": {"type": kind}}]},
        {"element": [{"name": "x", "type": "brake", "pressure": {"of": "x", "type": kind}}]},
    ):
        with pytest.raises(cw.ModelError):
            cw.Driveline.from_dict(data)


def test_powers_of_units_stay_small():
    for text in ("1 h99", "1 mm-99999", "1 " + "km9 " * 40, " " * 100_000 + "x", "1" + " " * 100_000 + "x"):
        with pytest.raises(cw.ModelError):
            cw.Driveline.from_dict({"shaft": [{"name": "a", "inertia": text}]})


def test_large_files_are_not_read(tmp_path, monkeypatch):
    monkeypatch.setattr(model_file, "MOST_BYTES", 100)
    assert "more than 100" in _mistakes(tmp_path, "#" * 101)
    assert "has no shaft" in _mistakes(tmp_path, "#" * 100)


@pytest.mark.parametrize("name", ["/dev/zero", "/dev/stdin", "pipe.toml", "folder.toml"])
def test_models_are_regular_files(tmp_path, name):
    os.mkfifo(tmp_path / "pipe.toml")
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(ModelFileError, match=r"cannot be read: (is not a regular file|Is a directory)"):
        cw.Driveline.load(tmp_path / name)


def test_many_mistakes_are_counted_and_some_shown():
    data = {"shaft": [{"name": f"s{k}", "inertia": "x"} for k in range(1000)]}
    with pytest.raises(cw.ModelError) as caught:
        cw.Driveline.from_dict(data)
    assert len(caught.value.problems) == 1000
    assert str(caught.value).count("\n") == MOST_LINES + 1
    assert f"and {1000 - MOST_LINES} more" in str(caught.value)


def test_a_mistake_stands_with_its_line(tmp_path):
    text = (
        'name = "x"\n[[shaft]]\nname = "a"\ninertia = -1.0\n'
        '[[element]]\nname = "t"\ntype = "torque"\nshaft = "a"\n'
        "torque = {type = 'sine'}\ndescription = '''\n[[element]]\n'''\n"
        '[[element]]\nname = "b"\ntype = "gear"\ninput = "a"\noutput = "nobody"\n'
    )
    lines = _mistakes(tmp_path, text).split("\n")
    for words in (
        'line 4: shaft "a": inertia = -1.0',
        'line 9: element "t" (torque): torque.amplitude is missing',
        'line 10: element "t" (torque): description is an unknown key',
        "line 17: element \"b\" (gear): output = 'nobody'",
    ):
        assert any(words in line for line in lines), words


# --- values and names in messages ---


def test_values_are_shown_short():
    for value in (10**400, 10**9000, "x" * 10**6, [[[[[[1]]]]]], list(range(10**6)), {"a": "b" * 999}):
        assert len(quote(value)) < 400


def test_texts_are_shown_safely():
    assert printable("a\x1b[31m\n\ud800\u202e") == "a\\x1b[31m\\n\\ud800\\u202e"
    assert printable("größe 🙂, $x$") == "größe 🙂, $x$"
    assert shortened("a" * 1000).count("a") < 400
    assert listed(map(str, range(1000))).endswith(f"and {1000 - MOST_NAMES} more")
    assert near("a" * 10**6, ["a" * 10**6]) == ""


@pytest.mark.parametrize("name", ["a\nb", "a\tb", "\x1b[31m", "\x00", "\u202e", "\ud800", " a", "", "x" * 201, 3, None])
def test_names_that_cannot_be_printed(name):
    d = cw.Driveline("d")
    d.shaft(name, inertia=1.0)
    d.thermal(name, capacity=1.0)
    d.add(cw.Torque(name, shaft=d.nodes[0], torque=1.0))
    assert [p.quantity for p in d.check()] == ["name"] * 3
    assert all(str(problem).isprintable() for problem in d.check())
    other = cw.Driveline(name)
    other.shaft("a", inertia=1.0)
    assert [(p.path, p.quantity) for p in other.check()] == [("driveline", "name")]


@pytest.mark.parametrize("name", ["a,b", 'a"b', "$x$", "$", "_a", "\\frac{1}{2}", "a/b", "=1+1", "größe", "%s{0}"])
def test_odd_names_work_everywhere(tmp_path, capsys, name):
    d = cw.Driveline(name)
    shaft, other = d.shaft(name, inertia=1.0, speed=5.0), d.shaft("other", inertia=1.0)
    d.add(cw.Clutch(f"{name} c", base=other, follower=shaft, friction=LINING, gain=1.0, pressure=10.0))
    d.add(cw.Torque(f"{name} t", shaft=shaft, torque=1.0))
    d.add(cw.Torque(f"{name} u", shaft=other, torque=-1.0))
    run = d.simulate(1.0, dt=0.5)
    run.to_csv(tmp_path / "run.csv")
    run.events.to_csv(tmp_path / "events.csv")
    with (tmp_path / "run.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["time [s]", *(f"{n} [{run.units[n]}]" if run.units[n] else n for n in run.names)]
    assert {len(row) for row in rows} == {len(run.names) + 1}
    figure = run.plot(tmp_path / "run.svg")
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    labels = [text.get_text().strip() for legend in legends for text in legend.get_texts()]
    assert name in labels
    # drawn as it is, not as a formula
    drawn = re.findall(r"<text[^>]*>([^<]*)</text>", (tmp_path / "run.svg").read_text().replace("&quot;", '"'))
    assert escape(name) in {text.strip() for text in drawn}
    d.save(tmp_path / "model.toml")
    assert main(["run", str(tmp_path / "model.toml"), "--t-end", "0.1", "--ratio", f"{name}/other"]) == 0
    assert name in capsys.readouterr().out


# --- work without end ---


def test_runs_that_could_never_end_are_refused():
    d, clutch = _two(pressure=cw.Pulse(height=1e5, period=1e-9, width=5e-10))
    d.add(clutch)
    with pytest.raises(
        cw.OptionError, match=r"c\.pressure has a period of 1e-09 s, more than max_steps = 10000000 times"
    ):
        d.simulate(1.0)
    assert d.simulate(1e-8).status == "done"
    d, clutch = _two(pressure=cw.Sampled(lambda time, readings: 1e5, 1e-9))
    d.add(clutch)
    with pytest.raises(cw.OptionError, match="give a longer period"):
        d.simulate(1.0)
    with pytest.raises(cw.OptionError, match="max_steps = 10 times"):
        d.simulate(2e-8, max_steps=10)
    for option in ({"points": 1e9}, {"points": MOST_ROWS + 1}, {"dt": 1e-9}, {"dt": 1e-320}):
        with pytest.raises(cw.OptionError):
            d.simulate(1.0, **option)


# --- what inputs refer to ---


def test_an_actuator_that_was_not_added():
    actuator = cw.PressureActuator("p", command=2e5, lag=0.02)
    d, clutch = _two(pressure=actuator)
    d.add(clutch)
    (problem,) = d.check()
    assert "pressure = 'p': was not added to this driveline; add it with d.add(...)" in str(problem)
    d.add(actuator)
    assert d.check() == []


def test_an_actuator_of_the_same_name():
    d, clutch = _two(pressure=cw.PressureActuator("p", command=2e5, lag=0.02))
    d.add(clutch)
    d.add(cw.PressureActuator("p", command=0.0, lag=0.02))
    (problem,) = d.check()
    assert "is not the one that was added to this driveline under this name" in str(problem)
    # equal ones too: what is changed later on one of them shall count
    d, clutch = _two(pressure=cw.PressureActuator("p", command=2e5, lag=0.02))
    d.add(clutch)
    d.add(cw.PressureActuator("p", command=2e5, lag=0.02))
    assert len(d.check()) == 1


def test_thermal_nodes_shafts_and_contacts_are_found_by_identity():
    d, clutch = _two()
    d.add(clutch)
    air, wall = d.ambient("air"), d.thermal("wall", capacity=10.0)
    other = cw.Driveline()
    twin = other.shaft("engine", inertia=0.2, speed=100.0)
    d.add(cw.Convection("f", hot=wall, cold=air, speed=twin, conductance=[(0.0, 1.0), (1.0, 2.0)]))
    d.add(cw.Wear("w", rate=1e-9, area=1.0, heat=cw.HeatFlow(_two()[1])))
    assert len(d.check()) == 2
    assert all("not the one that was added" in str(problem) for problem in d.check())


def test_parts_of_elements_are_found():
    d = cw.Driveline("parts")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    disk = d.add(cw.DiskClutch("c", base=load, follower=engine, radius=0.1, area=1e-3, pressure=1e5, wear_rate=1e-12))
    spring = cw.DiaphragmSpring("s", force=[(0.0, 5e3), (4e-3, 2e3), (8e-3, 0.0)], travel=0.0, wear=disk.part("wear"))
    d.add(spring)
    assert d.check() == []


# --- checks that go on ---


def test_the_gears_of_a_large_model_are_not_cut_off_silently(tmp_path, capsys):
    d = cw.Driveline("many")
    shafts = [d.shaft(f"s{k}", inertia=1.0) for k in range(15)]
    for k, (a, b) in enumerate(pairwise(shafts)):
        d.add(cw.Clutch(f"c{k}", base=a, follower=b, friction=LINING, gain=1.0, pressure=1.0))
    d.add(cw.Torque("t", shaft=shafts[0], torque=1.0))
    d.add(cw.Torque("u", shaft=shafts[-1], torque=-1.0))
    d.save(tmp_path / "many.json")
    assert main(["check", str(tmp_path / "many.json")]) == 0
    assert "not tried: 6 or more contacts closed at once" in capsys.readouterr().out
    assert main(["check", str(tmp_path / "many.json"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["gears_untried_from"] == 6


def test_contradicting_gears_hide_no_missing_inertia():
    d = cw.Driveline("gears")
    a, b, bare = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0), d.shaft("bare")
    d.add(cw.Gear("g1", input=a, output=b, ratio=2.0))
    d.add(cw.Gear("g2", input=a, output=b, ratio=3.0))
    d.add(cw.Gear("g3", input=a, output=d.shaft("c", inertia=1.0), ratio=0.0))
    d.add(cw.Torque("t", shaft=bare, torque=1.0))
    found = [str(problem) for problem in d.check()]
    assert [words.split(":")[0] for words in found] == [
        'cw.Gear("g3")',
        'cw.Gear("g1") and cw.Gear("g2")',
        'shaft "bare"',
    ]


def test_values_from_which_nothing_can_be_computed():
    d = cw.Driveline("huge")
    shaft, other = d.shaft("a", inertia=1.0, speed=1e200), d.shaft("b", inertia=1.0)
    d.add(
        cw.CentrifugalClutch(
            "c", base=shaft, follower=other, friction=LINING, mass=1.0, radius=1.0, drum_radius=1.0, onset=0.0
        )
    )
    d.add(cw.ThermalPlate("p", thickness=1e-300, area=1e-300, conductivity=1.0, density=1.0, specific_heat=1.0))
    found = d.check()
    assert [problem.path for problem in found] == ['cw.CentrifugalClutch("c")', 'cw.ThermalPlate("p")']
    assert all("too large or too small to compute with" in str(problem) for problem in found)


def test_mutations_are_the_same_on_every_machine():
    from random import Random

    seed = samples.driveline(cw.Clutch).to_dict()
    assert repr(mutate.tree(seed, Random("7"))) == repr(mutate.tree(seed, Random("7")))
    assert np.all([len(mutate.data(b"abc" * 99, Random(str(k)))) for k in range(20)])


def test_options_are_checked_all_at_once():
    with pytest.raises(cw.OptionError) as caught:
        Options(rtol=-1.0, max_steps=2.5, method="rodas", points=1e9, angles="no", dt=0.1, times=[0.0])
    assert len(caught.value.problems) == 6


def test_advice_that_cannot_be_computed():
    d = cw.Driveline("huge")
    elements = [(1e-4, 0.4), (2e-4, 0.6)]
    law = cw.Leuven(static=0.2, kinetic=0.1, speed=1.0, elements=elements, order=1e300)
    d.add(cw.Brake("b", shaft=d.shaft("a", inertia=1.0), friction=law, gain=1.0, pressure=1.0))
    with pytest.warns(cw.ModelWarning, match="too large or too small to compute with"):
        d.check()


def test_minus_zero_is_zero(tmp_path):
    data = {"shaft": [{"name": "a", "inertia": 1.0, "speed": -0.0, "angle": "-0.0 rad"}]}
    d = cw.Driveline.from_dict(data)
    d.save(tmp_path / "model.json")
    assert cw.Driveline.load(tmp_path / "model.json").assemble().to_bytes() == d.assemble().to_bytes()
