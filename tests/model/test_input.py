"""Hostile and careless input: refused in words, at once, without the content of other files."""

from __future__ import annotations

import csv
import json
import os
import re
import zipfile
from itertools import pairwise
from xml.sax.saxutils import escape

import numpy as np
import pytest

import clutchwork as cw
from clutchwork import archive, column_file, files, model_file
from clutchwork.cli import main
from clutchwork.errors import MOST_LINES, ModelFileError, near
from clutchwork.options import MOST_ROWS, Options
from clutchwork.shown import MOST_NAMES, listed, printable, shortened, shown
from clutchwork.system import SystemFormatError
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
    assert "is no TOML" in _mistakes(tmp_path, f'[[shaft]]\nname = "a"\ninertia = {"9" * 5000}\n')
    assert "is no JSON" in _mistakes(tmp_path, '{"shaft": [{"name": "a", "inertia": ' + "9" * 5000 + "}]}", "m.json")


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
        'line 10: element "t" (torque): description is not known',
        "line 17: element \"b\" (gear): output = 'nobody'",
    ):
        assert any(words in line for line in lines), words


# --- values and names in messages ---


def test_values_are_shown_short():
    for value in (10**400, 10**9000, "x" * 10**6, [[[[[[1]]]]]], list(range(10**6)), {"a": "b" * 999}):
        assert len(shown(value)) < 400


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


# --- CSV files ---


def _column(tmp_path, text, **more):
    data = text if isinstance(text, bytes) else text.encode()
    (tmp_path / "p.csv").write_bytes(data)
    return cw.Column("p.csv", more.pop("column", "p"), folder=str(tmp_path), **more)


@pytest.mark.parametrize("quote", ["", '"'])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("last", ["", "\n", "\n\n\n"])
def test_both_ways_of_reading_agree(tmp_path, quote, end, last):
    rows = [(0.1 * k, 3.7 * k**2) for k in range(500)]
    text = "\n".join(["time, p ,note", *(f"{quote}{t!r}{quote}, {y!r} ,x" for t, y in rows)]) + last
    assert _column(tmp_path, text.replace("\n", end)).points == tuple(rows)


def test_plain_files_are_read_at_once(tmp_path, monkeypatch):
    monkeypatch.setattr(column_file, "_by_cells", None)
    text = "time,p\n" + "".join(f"{k},{k}\n" for k in range(300_000))
    assert len(_column(tmp_path, text).points) == 300_000


def test_the_first_few_bad_cells_are_named(tmp_path):
    text = "time,p,q\n" + "".join(f"{k},{'x' if k > 3 else k},1\n" for k in range(100))
    found = _column(tmp_path, text).problems()
    assert len(found) == column_file.MOST_FAULTS
    assert [words for _, words, _ in found][:2] == [
        "line 6 of 'p.csv': the cell in column 'p' is not a finite number",
        "line 7 of 'p.csv': the cell in column 'p' is not a finite number",
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time,p,p\n0,1,5\n", "has 2 columns 'p'"),
        ("time,time,p\n0,1,5\n", "has 2 columns 'time'"),
        ("time,p\n0,0\n1,2,5\n", "line 3 of 'p.csv' has 3 cells, the first line names 2 columns"),
        ('time,p\n0,0\n1,"2",5\n', "line 3 of 'p.csv' has 3 cells"),
        ("time,p\n0,0\n2,1\n1,1\n", "line 4 of 'p.csv': its time is before that of line 3"),
        ("time,p\n0,0\n1,1_0\n", "is not a finite number"),
        ("time,p\n0,0\n1,1e999\n", "is not a finite number"),
        ("time,p\n0,0\n1\n", "is empty"),
        ("time,p\n0,0\n1e-320,1e300\n", "change too fast"),
        ("time,p\n0,0\n1\0,1\n", "no text"),
        (b"time,p\n0,\xff\n", "no text in UTF-8"),
        ("time,p\n" + "1" * 2_000_000, "has a line of more than"),
        ("time,p\n0," + "1" * 200_000 + "\n", "cannot be read"),
        ("\n0,1\n", "is empty"),
    ],
)
def test_what_is_wrong_with_a_csv_file(tmp_path, text, words):
    assert any(words in message for _, message, _ in _column(tmp_path, text).problems())


def test_a_million_and_more_lines(tmp_path, monkeypatch):
    monkeypatch.setattr(column_file, "MOST_LINES", 1000)
    text = "time,p\n" + "".join(f"{k},{k}\n" for k in range(1000))
    assert _column(tmp_path, text).problems() == []
    assert "more than 1000 lines" in _column(tmp_path, text + "1001,1\n").problems()[0][1]


@pytest.mark.parametrize("path", ["/dev/zero", "/dev/stdin", "pipe", ".", "a\0b", "x" * 5000, "\ud800"])
def test_columns_are_of_regular_files(tmp_path, path):
    os.mkfifo(tmp_path / "pipe")
    (problem,) = cw.Column(path, "p", folder=str(tmp_path)).problems()
    assert "cannot be read" in problem[1]


@pytest.mark.parametrize(
    "content",
    [
        "secret one\nsecret two\n",
        "secret,time\nsecret,secret\n",
        "time,p\n1,secret\nsecret,1\n",
        "secret;secret\n1;2\n",
    ],
)
def test_errors_never_tell_the_content_of_other_files(tmp_path, content, capsys):
    (tmp_path / "other").write_text(content)
    for column, time in (("p", "time"), ("q", "t"), ("time", "time")):
        signal = f'{{type = "column", path = "other", column = "{column}", time = "{time}"}}'
        element = f'[[element]]\nname = "t"\ntype = "torque"\nshaft = "a"\ntorque = {signal}\n'
        (tmp_path / "model.toml").write_text(f'[[shaft]]\nname = "a"\ninertia = 1\n{element}')
        assert main(["check", str(tmp_path / "model.toml")]) in (0, 3)
        # names of columns are told where one that was asked for is there
        said = capsys.readouterr().err
        is_asked = {"p", "time"} & set(content.partition("\n")[0].split(","))
        assert "secret" not in said or ("the columns are" in said and is_asked)


# --- saved systems ---


def _saved(tmp_path):
    d, clutch = _two()
    d.add(clutch)
    d.assemble().save(tmp_path / "system")
    return tmp_path / "system"


def _repacked(path, **changed):
    with zipfile.ZipFile(path) as stored:
        parts = {name: stored.read(name) for name in stored.namelist()}
    archive.write(path, parts | changed)
    return path


def test_a_saved_system_reads_back(tmp_path):
    path = _saved(tmp_path)
    d, clutch = _two()
    d.add(clutch)
    assert cw.System.load(path).to_bytes() == d.assemble().to_bytes()
    assert cw.System.load(_repacked(path)).to_bytes() == cw.System.load(path).to_bytes()


@pytest.mark.parametrize(
    "changed",
    [
        {"content": b""},
        {"content": b"CLUTCHWK" + b"\xff" * 500},
        {"model": b"[" * 100_000},
        {"model": b"{}"},
        {"model": b"\xff"},
        {"independent": b"5"},
        {"independent": b"[5]"},
        {"independent": b'["nobody"]'},
        {"more": b""},
    ],
    ids=str,
)
def test_an_archive_with_other_parts(tmp_path, changed):
    with pytest.raises((SystemFormatError, cw.ModelError)):
        cw.System.load(_repacked(_saved(tmp_path), **changed))


def test_arrays_of_another_model(tmp_path):
    d, clutch = _two()
    d.add(clutch)
    d.shaft("third", inertia=1.0)
    with pytest.raises(SystemFormatError, match="do not fit its model"):
        cw.System.load(_repacked(_saved(tmp_path), content=d.assemble().to_bytes()))


def test_archives_that_unpack_to_much(tmp_path, monkeypatch):
    path = _repacked(_saved(tmp_path), model=b" " * 10_000_000)
    monkeypatch.setattr(archive, "MOST_BYTES", 1_000_000)
    with pytest.raises(SystemFormatError, match="unpacks to more than"):
        cw.System.load(path)
    monkeypatch.setattr(archive, "MOST_BYTES", 100)
    with pytest.raises(SystemFormatError, match="more than 100"):
        cw.System.load(path)


def test_every_byte_of_an_archive_is_checked(tmp_path):
    whole = _saved(tmp_path).read_bytes()
    good = cw.System.load(tmp_path / "system").to_bytes()
    for place in range(0, len(whole), 7):
        (tmp_path / "bad").write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :])
        try:
            assert cw.System.load(tmp_path / "bad").to_bytes() == good
        except SystemFormatError:
            continue


def test_archives_are_regular_files(tmp_path):
    for path in ("/dev/zero", tmp_path, tmp_path / "none"):
        with pytest.raises(SystemFormatError, match="no System can be read"):
            cw.System.load(path)


def test_the_reader_stops_at_its_limit(tmp_path):
    (tmp_path / "x").write_bytes(b"x" * 100)
    assert files.read_regular(tmp_path / "x", 100) == b"x" * 100
    with pytest.raises(files.UnfitFileError):
        files.read_regular(tmp_path / "x", 99)


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
    assert "pressure = 'p': was not added to this driveline; add it: d.add(...)" in str(problem)
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
    disk = d.add(cw.DiskClutch("c", base=load, follower=engine, radius=0.1, pressure=1e5, wear_rate=1e-12))
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
    assert all("no number can be computed" in str(problem) for problem in found)


def test_mutations_are_the_same_on_every_machine():
    from random import Random

    seed = samples.driveline(cw.Clutch).to_dict()
    assert repr(mutate.tree(seed, Random("7"))) == repr(mutate.tree(seed, Random("7")))
    assert np.all([len(mutate.data(b"abc" * 99, Random(str(k)))) for k in range(20)])


def test_options_are_checked_all_at_once():
    with pytest.raises(cw.OptionError) as caught:
        Options(rtol=-1.0, max_steps=2.5, method="rodas", points=1e9, angles="no", dt=0.1, times=[0.0])
    assert len(caught.value.problems) == 6
