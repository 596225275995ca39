"""Bad input: every mistake at once, with path, value, unit, bound, remedy and a near match."""

from __future__ import annotations

import pytest

import clutchwork as cw

GOOD = """
name = "two discs"
[[shaft]]
name = "engine"
inertia = 0.2
speed = 100.0
[[shaft]]
name = "load"
inertia = 0.8
[[element]]
name = "c1"
type = "clutch"
base = "load"
follower = "engine"
gain = 0.1
pressure = {type = "table", points = [[0.0, 0.0], [0.5, 2e5]]}
friction = {type = "coulomb", static = 0.12, kinetic = 0.1}
"""


def _mistakes(tmp_path, text, name="model.toml"):
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(cw.ModelError) as caught:
        cw.Driveline.load(path)
    assert str(path) in str(caught.value)
    return [str(problem) for problem in caught.value.problems]


def test_the_good_one_is_good(tmp_path):
    (tmp_path / "model.toml").write_text(GOOD)
    assert cw.Driveline.load(tmp_path / "model.toml").check() == []


CASES = {
    "misspelt key": (
        "inertia = 0.2",
        "inertai = 0.2",
        "shaft \"engine\": inertai is an unknown key; did you mean 'inertia'?",
    ),
    "misspelt type": (
        'type = "clutch"',
        'type = "clutsh"',
        "element \"c1\": type = 'clutsh': is an unknown type; did you mean 'clutch'?",
    ),
    "class in place of kind": ('"clutch"', '"Clutch"', "did you mean 'clutch'?"),
    "missing type": ('type = "clutch"', "", 'element "c1": type is missing'),
    "missing name": ('name = "c1"', "", "element number 1: name is missing"),
    "unknown shaft": (
        'base = "load"',
        'base = "laod"',
        "base = 'laod': is not a shaft of this model; did you mean 'load'?",
    ),
    "port is no text": ('base = "load"', "base = 3", "base = 3: is not a shaft of this model"),
    "missing port": ('base = "load"', "", 'element "c1" (clutch): base is missing; give a shaft'),
    "missing parameter": ("gain = 0.1", "", "gain is missing; give a value in [m3]: torque per unit of pressure"),
    "missing law": ('friction = {type = "coulomb", static = 0.12, kinetic = 0.1}', "", "friction is missing"),
    "missing pressure": (
        'pressure = {type = "table", points = [[0.0, 0.0], [0.5, 2e5]]}',
        "",
        "give pressure or normal_force",
    ),
    "pressure and force": (
        "gain = 0.1",
        "gain = 0.1\nnormal_force = 3.0",
        "normal_force cannot be given together with 'pressure'",
    ),
    "text for a number": ("gain = 0.1", 'gain = "big"', "gain = 'big': is not a number; write a number in [m3]"),
    "number in quotes": (
        "gain = 0.1",
        'gain = "0.1"',
        "gain = '0.1': has no unit; remove the quotes or add one, such as",
    ),
    "true for a number": ("gain = 0.1", "gain = true", "gain = True: must be a number in [m3]"),
    "list for a number": ("gain = 0.1", "gain = [1]", "gain = [1]: must be a number in [m3]"),
    "nan": ("gain = 0.1", "gain = nan", "gain = nan m3: must be finite"),
    "infinite": ("inertia = 0.8", "inertia = inf", 'shaft "load": inertia = inf kg m2: must be finite'),
    "negative inertia": ("inertia = 0.8", "inertia = -0.8", 'shaft "load": inertia = -0.8 kg m2: must be >= 0 kg m2'),
    "zero gain": ("gain = 0.1", "gain = 0", "gain = 0.0 m3: must be > 0 m3"),
    "wrong unit": (
        "gain = 0.1",
        'gain = "0.1 m2/s"',
        "gain = '0.1 m2/s': has a unit that does not fit; give it in [m3]",
    ),
    "gain of a force at a pressure": ("gain = 0.1", 'gain = "0.1 N m"', "give it in [m3], such as '5e-4 m3'"),
    "unknown unit": ("speed = 100.0", 'speed = "100 rpn"', "unknown unit 'rpn'; did you mean 'rpm'?"),
    "no inertia": (
        "inertia = 0.2",
        "",
        'shaft "engine": inertia is missing at element "c1" (clutch), whose torque jumps; give it inertia > 0',
    ),
    "kinetic above static": (
        "kinetic = 0.1",
        "kinetic = 0.2",
        "friction.static = 0.12: is below the kinetic coefficient at vanishing slip, 0.2",
    ),
    "unknown law": ('"coulomb"', '"culomb"', "friction.type = 'culomb': is an unknown type; did you mean 'coulomb'?"),
    "law without type": ('{type = "coulomb", ', "{", "must be a table with the type of a law"),
    "law key": ("kinetic = 0.1", "kinetik = 0.1", "friction.kinetik is an unknown key; did you mean 'kinetic'?"),
    "table not increasing": (
        "[0.5, 2e5]",
        "[0.5, 2e5], [0.4, 1.0]",
        "pressure.points, point 3 = 0.4 s: comes after 0.5 s",
    ),
    "table with text": (
        "[0.5, 2e5]",
        '[0.5, "x"]',
        "pressure.points, point 2 = 'x': is not a number; write a number in [Pa]",
    ),
    "table with a triple": ("[0.5, 2e5]", "[0.5, 1.0, 2.0]", "point 2 = [0.5, 1.0, 2.0]: must be a pair of numbers"),
    "empty table": ("[[0.0, 0.0], [0.5, 2e5]]", "[]", "pressure.points = []: must be a list of points"),
    "unknown signal": ('"table"', '"tabel"', "pressure.type = 'tabel': is an unknown type; did you mean 'table'?"),
    "unit of a signal": (
        '{type = "table", ',
        '{type = "table", unit = "m", ',
        "pressure.unit = 'm': has a unit that does not fit",
    ),
    "function in a file": (
        '"table"',
        '"sampled", function = "os.system", period = 1.0',
        "pressure.function is not allowed in a model file",
    ),
    "name taken": ('name = "load"', 'name = "engine"', "name = 'engine': is already the name of shaft \"engine\""),
    "reserved name": ('name = "load"', 'name = "housing"', "is already the name of the housing"),
    "one shaft at both ports": ('base = "load"', 'base = "engine"', "base and follower are both attached to 'engine'"),
    "housing alone": (
        'base = "load"\nfollower = "engine"',
        'base = "housing"\nfollower = "housing"',
        "is attached to the housing alone",
    ),
    "unknown table": (
        'name = "two discs"',
        'name = "two discs"\nshafts = 3',
        "file: shafts is an unknown key; did you mean 'shaft'?",
    ),
    "shaft as table": (
        'name = "two discs"',
        'name = "two discs"\nmass = 3',
        "file: mass must be a list of tables; write [[mass]] above each",
    ),
    "unknown setting": (
        'name = "two discs"',
        'name = "x"\nsimulation = {t_end = 1.0, rtoll = 3}',
        "rtoll is an unknown key; did you mean 'rtol'?",
    ),
    "wrong setting": (
        'name = "two discs"',
        'name = "x"\nsimulation = {t_end = -1}',
        "simulation: t_end = -1 s: must be a finite number above 0; it is the end time of the run",
    ),
    "unknown method": (
        'name = "two discs"',
        'name = "x"\nsimulation = {method = "rodas"}',
        "method = 'rodas': must be one of auto, rodas5p, dopri5, fixed; did you mean 'rodas5p'?",
    ),
    "format of the future": (
        'name = "two discs"',
        'name = "x"\nformat = 2',
        "file: format = 2: is an unknown format; this version reads format 1",
    ),
    "no toml": (
        'name = "two discs"',
        "name = two discs",
        "is not valid TOML: Invalid value (at line 2, column 8); fix line 2, column 8",
    ),
    "key twice": ("gain = 0.1", "gain = 0.1\ngain = 0.2", "is not valid TOML: Cannot overwrite a value"),
}


@pytest.mark.parametrize("case", CASES)
def test_mistake(tmp_path, case):
    before, after, words = CASES[case]
    assert before in GOOD
    messages = _mistakes(tmp_path, GOOD.replace(before, after, 1))
    assert any(words in message for message in messages), messages
    # a remedy stands behind each
    assert all(";" in message for message in messages)


def test_single_mistakes_give_single_messages(tmp_path):
    """No mistake draws others after it."""
    for case in ("missing parameter", "nan", "negative inertia", "wrong unit", "unknown law", "table not increasing"):
        before, after, _ = CASES[case]
        assert len(_mistakes(tmp_path, GOOD.replace(before, after, 1))) == 1, case


def test_all_mistakes_come_at_once(tmp_path):
    text = GOOD
    chosen = (
        "misspelt key",
        "negative inertia",
        "nan",
        "kinetic above static",
        "table not increasing",
        "unknown table",
    )
    for case in chosen:
        text = text.replace(*CASES[case][:2], 1)
    text += '[[element]]\nname = "g1"\ntype = "gear"\ninput = "engine"\noutput = "load"\nratio = 2.0\n'
    text += '[[element]]\nname = "g2"\ntype = "gear"\ninput = "engine"\noutput = "load"\nratio = 3.0\n'
    messages = _mistakes(tmp_path, text)
    for case in chosen:
        assert any(CASES[case][2] in message for message in messages), case
    assert any("contradict each other" in message for message in messages)
    assert len(messages) == len(chosen) + 1


def test_json_has_the_same_checks(tmp_path):
    text = '{"shaft": [{"name": "a", "inertia": 1, "inertia": 2}]}'
    assert "key 'inertia' appears twice" in _mistakes(tmp_path, text, "model.json")[0]
    text = '{"shaft": [{"name": "a", "inertia": NaN}]}'
    assert "NaN is not allowed in a model file" in _mistakes(tmp_path, text, "model.json")[0]
    text = '{"shaft": [{"name": "a", "inertia": "1"}]}'
    assert "has no unit" in _mistakes(tmp_path, text, "model.json")[0]
    assert "file: must be a table" in _mistakes(tmp_path, "[1, 2]", "model.json")[0]


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(cw.ModelError, match="does not exist; check the path"):
        cw.Driveline.load(tmp_path / "none.toml")
    assert "must end in .toml or .json" in _mistakes(tmp_path, GOOD, "model.yaml")[0]
    (tmp_path / "latin.toml").write_bytes(b'name = "\xe9"')
    with pytest.raises(cw.ModelError, match="give a TOML or JSON file in UTF-8"):
        cw.Driveline.load(tmp_path / "latin.toml")


@pytest.mark.parametrize(
    ("column", "words"),
    [
        (
            'path = "p.csv", column = "F2"',
            "pressure.column 'p.csv' has no column 'F2'; the columns are time, F1; did you mean 'F1'?",
        ),
        ('path = "q.csv", column = "F1"', "pressure.path 'q.csv' does not exist"),
        ('path = "bad.csv", column = "F1"', "line 3 of 'bad.csv': the cell in column 'F1' is not a finite number"),
        ('path = "p.csv"', "pressure.column is missing"),
        (
            'path = "p.csv", column = "F1", unit = "kg"',
            "pressure.unit = 'kg': has a unit that does not fit; give it in [Pa]",
        ),
    ],
)
def test_csv(tmp_path, column, words):
    (tmp_path / "p.csv").write_text("time,F1\n0,0\n1,2\n")
    (tmp_path / "bad.csv").write_text("time,F1\n0,0\n1,high\n")
    text = GOOD.replace('type = "table", points = [[0.0, 0.0], [0.5, 2e5]]', f'type = "column", {column}')
    (message,) = _mistakes(tmp_path, text)
    assert words in message


def test_a_missing_gear_does_not_blame_the_shafts_at_it(tmp_path):
    text = GOOD + '[[shaft]]\nname = "x"\n[[shaft]]\nname = "y"\n'
    text += '[[element]]\nname = "g"\ntype = "gear"\ninput = "x"\noutput = "load"\n'
    text += '[[element]]\nname = "h"\ntype = "gear"\ninput = "x"\noutput = "y"\nratio = 2.0\n'
    messages = _mistakes(tmp_path, text)
    assert messages == ['element "g" (gear): ratio is missing; give `ratio`, or `teeth_input` and `teeth_output`']


# --- the same in Python ---


def test_foreign_node():
    d, other = cw.Driveline(), cw.Driveline()
    d.shaft("a", inertia=1.0)
    d.add(cw.Damper("x", base=d.housing, follower=other.shaft("a", inertia=1.0), damping=1.0))
    (message,) = map(str, d.check())
    assert message.startswith("cw.Damper(\"x\"): follower = 'a': belongs to another driveline")


def test_shaft_joined_to_a_mass():
    d = cw.Driveline()
    a, m = d.shaft("a", inertia=1.0), d.mass("m", mass=1.0)
    d.add(cw.Damper("x", base=a, follower=m, damping=1.0))
    d.add(cw.RollingWheel("w", shaft=m, mass=a, radius=0.3))
    messages = list(map(str, d.check()))
    assert "connects a shaft and a mass" in messages[0]
    assert "shaft = 'm': must be a shaft" in messages[1]
    assert "mass = 'a': must be a mass" in messages[2]


def test_what_is_no_element():
    with pytest.raises(TypeError, match="is not an element; add one such as"):
        cw.Driveline().add("clutch")


def test_wrong_things_in_python():
    d = cw.Driveline()
    a = d.shaft("a", inertia="heavy", speed=True)
    d.add(cw.Brake("b", shaft="a", friction=0.1, gain=1.0, pressure=[1.0]))
    d.add(cw.SpeedTorque("t", shaft=a, torque=[(0.0, 1.0), (0.0, 2.0)]))
    d.add(cw.Gear("g", input=a, output=a, ratio=0.0, teeth_input=20.5))
    quantities = [problem.quantity for problem in d.check()]
    assert quantities[:7] == ["inertia", "speed", "shaft", "friction", "pressure", "torque, point 2", "teeth_input"]


def test_model_error_holds_the_problems():
    d = cw.Driveline("box")
    d.shaft("a", inertia=-1.0)
    with pytest.raises(cw.ModelError, match="box: 1 problem") as caught:
        d.simulate(1.0)
    (problem,) = caught.value.problems
    assert (problem.path, problem.quantity, problem.value) == ('shaft "a"', "inertia", "-1.0 kg m2")
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    ("gear", "words"),
    [
        ({"ratio": 0.0}, "ratio is zero"),
        ({"ratio": 2.0, "teeth_input": 20, "teeth_output": 40}, "ratio is given twice"),
        ({"teeth_input": 20}, "ratio is missing"),
        ({"teeth_input": 20, "teeth_output": 0}, "teeth_output is zero"),
    ],
)
def test_gears(gear, words):
    d = cw.Driveline()
    d.add(cw.Gear("g", input=d.shaft("a", inertia=1.0), output=d.shaft("b", inertia=1.0), **gear))
    assert words in str(d.check()[0])


@pytest.mark.parametrize("cls", [cw.Planetary, cw.DoublePlanetary])
def test_planetary_teeth(cls):
    d = cw.Driveline()
    sun, ring, carrier = (d.shaft(name, inertia=1.0) for name in ("s", "r", "c"))
    d.add(cls("p", sun=sun, ring=ring, carrier=carrier, teeth_sun=30))
    d.add(cls("q", sun=sun, ring=ring, carrier=carrier, ratio=2.0, teeth_sun=30, teeth_ring=60))
    messages = list(map(str, d.check()))
    assert "ratio is missing" in messages[0]
    assert "ratio is given twice" in messages[1]


@pytest.mark.parametrize("cls", [cw.Planetary, cw.DoublePlanetary])
def test_ring_smaller_than_sun(cls):
    d = cw.Driveline()
    sun, ring, carrier = (d.shaft(name, inertia=1.0) for name in ("s", "r", "c"))
    d.add(cls("p", sun=sun, ring=ring, carrier=carrier, teeth_sun=60, teeth_ring=30))
    assert "teeth_ring is 30, not above teeth_sun = 60" in str(d.check()[0])


def test_pulse_wider_than_its_period():
    d = cw.Driveline()
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=cw.Pulse(height=1.0, period=1.0, width=2.0)))
    assert "torque.width is 2 s, not below period = 1 s" in str(d.check()[0])


def test_temperatures_in_degrees_celsius_are_warned_of():
    """A table that starts at 20 K is meant in degrees Celsius."""
    d = cw.Driveline()
    shaft = d.shaft("a", inertia=1.0)
    law = cw.TemperatureTable(
        static=[(20.0, 0.4), (200.0, 0.3)], kinetic=[(20.0, 0.3), (200.0, 0.2)], temperature=300.0
    )
    d.add(cw.Brake("b", shaft=shaft, friction=law, gain=1.0, pressure=1.0))
    with pytest.warns(cw.ModelWarning, match=r"reaches down to 20 K.*293\.15 K"):
        d.assemble()


def test_a_misspelt_head_is_named_where_its_names_are_used(tmp_path):
    text = """
name = "x"

[[shaft]]
name = "a"
inertia = 1.0

[[element]]
name = "w"
type = "rolling_wheel"
shaft = "a"
mass = "car"
radius = "0.3 km/h"

[[mas]]
name = "car"
mass = 3

[simulation]
t_end = "1 bar"
"""
    path = tmp_path / "model.toml"
    path.write_text(text)
    with pytest.raises(cw.ModelError) as caught:
        cw.Driveline.load(path)
    lines = [problem.line for problem in caught.value.problems]
    # in the order of the file
    assert lines == sorted(lines) == [12, 13, 15, 20]
    words = [str(problem) for problem in caught.value.problems]
    assert "mass = 'car': is not a mass of this model; it stands in [[mas]]: write [[mass]]" in words[0]
    assert words[2] == "file: mas is an unknown key; did you mean 'mass'?"


def test_units_of_signals_in_files():
    def air(temperature):
        data = {"shaft": [{"name": "a", "inertia": 1.0}], "ambient": [{"name": "air", "temperature": temperature}]}
        return cw.Driveline.from_dict(data).thermal_nodes[0].temperature

    assert air({"type": "table", "points": [[0, 20], [1, "30 degC"]], "unit": "degC"}).points == (
        (0.0, 293.15),
        (1.0, 303.15),
    )
    assert air({"type": "constant", "value": 20, "unit": "degC"}).value == 293.15
    assert air({"type": "step", "height": "10 K", "offset": "20 degC"}).offset == 293.15
    for wrong, words in (
        (
            {"type": "step", "height": 10, "offset": 20, "unit": "degC"},
            "give its values as strings, and differences in K",
        ),
        ({"type": "step", "height": "10 degC", "offset": 300.0}, "a difference of 1 degC, or of 1.8 degF, is 1 K"),
    ):
        with pytest.raises(cw.ModelError, match=words):
            air(wrong)
