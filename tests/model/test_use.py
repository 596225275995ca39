"""Mistakes of use are named where they happen: wrong keywords, values by place, options, names in results."""

from __future__ import annotations

import pickle
import warnings
from dataclasses import MISSING, replace

import pytest

import clutchwork as cw
from clutchwork.base.errors import FileError, ModelFileError, UnknownName
from clutchwork.command.main import main
from clutchwork.declare.schema import REGISTRY, Role, specs
from clutchwork.model.temperatures import COLDEST
from support import samples

DECLARED = samples.declared(*Role)
LINING = cw.Coulomb(static=0.12, kinetic=0.1)


def _name(value):
    return getattr(value, "__name__", str(value))


def _driveline(**more):
    d = cw.Driveline("two")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    values = {"friction": LINING, "pressure": 1e6} | more
    d.add(cw.Clutch("c1", base=load, follower=engine, gain=5e-4, **values))
    return d


# --- constructors ---


def _sample(cls):
    """Arguments that make one of a class."""
    if cls.role in (Role.LAW, Role.SIGNAL):
        return (), samples.fields(cls, {})
    element = samples.driveline(cls).elements[0]
    return ("x",), {item.name: getattr(element, item.name) for item, _ in specs(cls)}


@pytest.mark.parametrize("cls", DECLARED, ids=_name)
def test_a_wrong_keyword_of_a_constructor(cls):
    args, named = _sample(cls)
    cls(*args, **named)
    for item, _ in specs(cls):
        if item.name in named and len(item.name) > 3:
            wrong = item.name[0] + item.name[2] + item.name[1] + item.name[3:]
            if wrong == item.name:
                continue
            given = {wrong if name == item.name else name: value for name, value in named.items()}
            with pytest.raises(cw.UseError) as caught:
                cls(*args, **given)
            (problem,) = caught.value.problems
            assert f"unknown field {wrong!r}; did you mean {item.name!r}?" in problem
            assert str(caught.value).startswith(f"cw.{cls.__name__}(")


@pytest.mark.parametrize("cls", DECLARED, ids=_name)
def test_all_that_is_missing_is_named_at_once(cls):
    needed = [item.name for item, _ in specs(cls) if item.default is MISSING]
    if cls.role not in (Role.LAW, Role.SIGNAL):
        needed = ["name", *needed]
    if not needed:
        cls()
        return
    with pytest.raises(cw.UseError) as caught:
        cls()
    assert {problem.split(" is missing")[0] for problem in caught.value.problems} == set(needed)
    assert "[*]" not in str(caught.value)


@pytest.mark.parametrize("cls", DECLARED, ids=_name)
def test_values_by_place_are_told_their_keywords(cls):
    args, named = _sample(cls)
    by_place = [item.name for item, _ in specs(cls) if not item.kw_only]
    values = args + tuple(named.pop(name, None) for name in by_place)
    needed = [item.name for item, _ in specs(cls) if item.default is MISSING and item.name not in by_place]
    with pytest.raises(cw.UseError) as caught:
        cls(*values, 1.0)
    (problem,) = [words for words in caught.value.problems if "positional" in words]
    assert all(word in problem for word in by_place)
    if needed:
        assert f"such as {needed[0]}=..." in problem
    assert len(caught.value.problems) == 1


def test_all_mistakes_of_a_call_come_at_once():
    with pytest.raises(cw.UseError) as caught:
        cw.Clutch("c", gian=1.0, pressures=2.0, nonsense=3.0)
    words = [problem.split(";")[0] for problem in caught.value.problems]
    assert words == [
        "unknown field 'gian'",
        "unknown field 'pressures'",
        "unknown field 'nonsense'",
        "base is missing",
        "follower is missing",
        "friction is missing",
    ]
    assert isinstance(caught.value, TypeError)
    assert isinstance(caught.value, cw.ClutchworkError)


def test_shafts_and_masses():
    d = cw.Driveline()
    for call, words in (
        (lambda: d.shaft("a", inertai=1.0), "unknown field 'inertai'; did you mean 'inertia'?"),
        (
            lambda: d.shaft("a", 0.2),
            "1 positional value too many: only name is positional; give them by keyword, such as inertia",
        ),
        (lambda: d.shaft("a", mass=0.2), "unknown field 'mass'; known fields: name, inertia, speed, angle"),
        (lambda: d.shaft(), "name is missing"),
        (lambda: d.mass("m", inertia=1.0), "known fields: name, mass, speed, position"),
        (lambda: d.thermal("t"), "capacity is missing"),
        (lambda: d.ambient("t", temperatures=1.0), "did you mean 'temperature'?"),
        (lambda: d.assemble(independents=()), "did you mean 'independent'?"),
        (lambda: d.shaft("a", name="b"), "name is given twice"),
        (lambda: d.add("clutch"), "is not an element; add one such as cw.Clutch"),
        (lambda: d.add_node("a"), "is not a shaft or mass"),
        (lambda: d.add_thermal("a"), "is not a thermal node"),
        (lambda: cw.Driveline(names="x"), "cw.Driveline(): 1 problem"),
        (lambda: cw.Driveline("a", "b"), "only name is positional"),
        (lambda: cw.Driveline.load(), "path is missing; give one, such as path='model.toml'"),
        (lambda: cw.Driveline.load(3), "3 is not a path; give a string, such as 'model.toml'"),
        (lambda: cw.Node("a", inertai=1.0), "did you mean 'inertia'?"),
        (lambda: cw.HeatFlow(element=1.0), "unknown field 'element'; known fields: of"),
        (lambda: cw.simulate(d, 1.0, options=1e-6), "options is 1e-06: it must be cw.Options(...)"),
        (lambda: d.simulate(1.0, 1e-6), "too many: only t_end is positional"),
    ):
        with pytest.raises(cw.UseError) as caught:
            call()
        assert words in str(caught.value)
    assert d.nodes == ()


def test_an_error_inside_a_call_stays_what_it_is():
    class Odd:
        def assemble(self):
            raise TypeError("of its own")

    with pytest.raises(TypeError, match=r"^of its own$"):
        cw.simulate(Odd(), 1.0)


def test_a_list_of_all_fields_is_given_once_and_only_where_it_helps():
    with pytest.raises(cw.UseError) as caught:
        cw.Clutch("c", bas=1, gaain=2, zzz=3, qqqq=4)
    words = str(caught.value)
    assert words.count("known fields: ") == 1
    assert "unknown field 'bas'; did you mean 'base'?\n" in words
    assert "unknown field 'qqqq'\n" in words
    with pytest.raises(cw.UseError) as caught:
        cw.Clutch("c", bas=1)
    assert "known fields" not in str(caught.value)


# --- runs ---


def test_options():
    d = _driveline()
    for options, words in (
        ({"rtoll": 1e-3}, "unknown option 'rtoll'; did you mean 'rtol'?"),
        ({"max_stps": 1, "methods": "auto"}, "unknown option 'methods'; did you mean 'method'?"),
        ({"progress_": print}, "did you mean 'progress'?"),
    ):
        with pytest.raises(cw.UseError) as caught:
            cw.simulate(d, 1.0, **options)
        assert words in str(caught.value)
        assert len(caught.value.problems) == len(options)
    with pytest.raises(cw.UseError, match="did you mean 'rtol'"):
        cw.Options(rtoll=1.0)
    for options, words in (
        ({"max_steps": 2.5}, "max_steps is 2.5: it must be a whole number"),
        ({"max_events": True}, "max_events is True: it must be a whole number"),
        ({"points": 0}, "points is 0: it must be at least 1"),
        ({"rtol": "1e-6"}, "rtol is '1e-6': it has no unit; remove the quotes"),
        ({"dt": "fine"}, "dt is 'fine': it is not a number; write a number in [s], or a string such as '2 s'"),
        ({"work": 1}, "work is 1: it must be True or False"),
        ({"method": ["auto"]}, "method is ['auto']: it must be one of auto, rodas5p, dopri5"),
        ({"times": "all"}, "times are 'all': they must be a sequence of numbers [s]"),
        ({"max_steps": 10**400}, "it must be at most"),
        ({"dt": 10**400}, "it must be a finite number above 0"),
    ):
        with pytest.raises(cw.OptionError) as caught:
            d.simulate(1.0, **options)
        assert words in str(caught.value)
        assert isinstance(caught.value, ValueError)
    assert d.simulate(0.01, max_steps=1e4, points=10.0).status == "done"
    for end in (0.0, "2 bar", -1.0, True):
        with pytest.raises(cw.OptionError, match="t_end is"):
            d.simulate(end)


def test_what_is_no_model(tmp_path):
    with pytest.raises(
        cw.UseError, match=r"'model\.toml' is not a model; load a file with cw\.Driveline\.load\('model\.toml'\)"
    ):
        cw.simulate("model.toml", 2)
    with pytest.raises(cw.UseError, match=r"Driveline\.load"):
        cw.simulate(tmp_path, 2)
    with pytest.raises(cw.UseError, match="is not a model; give a Driveline or a System"):
        cw.simulate(3.0, 2)
    with pytest.raises(cw.OptionError, match="t_end is missing"):
        cw.simulate(_driveline())


def test_a_function_as_signal():
    d = _driveline(pressure=lambda time, readings: 1e5)
    (problem,) = d.check()
    assert "a function is a controller: give cw.Sampled(function, period), with the period in s" in str(problem)


def test_plots():
    run = _driveline().simulate(0.1)
    with pytest.raises(cw.UseError, match="unknown field 'lokup'; did you mean 'lockup'"):
        run.plot(lokup=None)
    with pytest.raises(cw.UseError, match="lockup is 'c1': it must be an event"):
        run.plot(lockup="c1")


def test_names_of_contacts_and_signals():
    run = _driveline().simulate(1.0)
    assert len(run.events.of("c1")) > 0
    locks = [event for event in run.events if event.element == "c1" and event.after == "locked"]
    assert list(run.events.of("c1", after="locked")) == locks
    assert list(run.events.of(after="locked", cause="slip zero", before="forward")) == [
        event for event in run.events if (event.before, event.after, event.cause) == ("forward", "locked", "slip zero")
    ]
    assert list(run.events.of()) == list(run.events)
    with pytest.raises(cw.UnknownName, match="no after 'lockd'; did you mean 'locked'"):
        run.events.of(after="lockd")
    with pytest.raises(cw.UnknownName, match="no cause 'sun'; cause is one of slip zero, torque limit"):
        run.events.of(cause="sun")
    for events in (run.events, run.events[:0], run.events.changes(), run.events.of("c1"), run.events.at_start()):
        with pytest.raises(UnknownName, match=r"^no contact 'c2'; did you mean 'c1'\? contacts are c1$"):
            events.of("c2")
    with pytest.raises(KeyError):
        run.events.of(3)
    with pytest.raises(UnknownName, match=r"^no signal 'c1.torqe'; did you mean 'c1.torque'\?"):
        run["c1.torqe"]
    with pytest.raises(UnknownName, match="no signal 3"):
        run[3]


# --- files ---


def test_exit_codes_of_files(tmp_path, capsys):
    (tmp_path / "wrong.toml").write_text("shaft = 3")
    (tmp_path / "latin.toml").write_bytes(b'name = "\xe9"')
    assert main(["check", str(tmp_path / "none.toml")]) == 4
    assert main(["run", str(tmp_path / "none.toml")]) == 4
    assert main(["check", str(tmp_path)]) == 4
    assert main(["check", str(tmp_path / "latin.toml")]) == 4
    assert main(["check", str(tmp_path / "wrong.toml")]) == 3
    assert "does not exist; check the path; in its folder: latin.toml, wrong.toml" in capsys.readouterr().err


def test_python_speaks_python_and_files_speak_their_own_words(tmp_path):
    d = _driveline(friction="coulomb", pressure=[1.0], tolerance=-1.0)
    said = "\n".join(map(str, d.check()))
    assert 'cw.Clutch("c1"): friction' in said
    assert "cw.Coulomb" in said
    assert "cw.Sine" in said
    assert "stribeck" not in said
    (tmp_path / "m.toml").write_text('[[element]]\nname = "c1"\ntype = "clutch"\nbase = 3\npressure = [1]\n')
    with pytest.raises(cw.ModelError) as caught:
        cw.Driveline.load(tmp_path / "m.toml")
    assert 'element "c1" (clutch)' in str(caught.value)
    assert "stribeck" in str(caught.value)
    assert "cw." not in str(caught.value)
    assert "d.shaft" not in str(caught.value)
    # what is built on in Python from a file keeps the words of the file
    _driveline().save(tmp_path / "m.toml")
    loaded = cw.Driveline.load(tmp_path / "m.toml")
    loaded.add(cw.Torque("t", shaft=loaded.nodes[0], torque="x"))
    assert 'element "t" (torque)' in str(loaded.check()[0])


@pytest.mark.parametrize("cls", samples.declared(*samples.ELEMENT_ROLES), ids=_name)
def test_mistakes_of_every_element_in_a_file_speak_of_files(cls):
    data = {"shaft": [{"name": "a", "inertia": 1.0}], "element": [{"name": "x", "type": cls.kind, "nonsense": 1}]}
    with pytest.raises(cw.ModelError) as caught:
        cw.Driveline.from_dict(data)
    assert "cw." not in str(caught.value)


def test_errors_can_be_sent_to_other_processes():
    problem = cw.Problem("a", "b", "c")
    for error in (
        cw.ModelError([problem], "m.toml"),
        ModelFileError([problem], "m.toml"),
        cw.UseError("simulate", ["x"]),
        cw.OptionError(["x"]),
        FileError([("path", "x", "y")]),
        UnknownName("no signal"),
    ):
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error)
        assert str(again) == str(error)


# --- temperatures ---


def _warned(d):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert d.check() == []
    return [str(one.message) for one in caught]


def _celsius(value):
    """The same with temperatures as in degrees Celsius."""
    if isinstance(value, cw.Signal):
        return cw.Constant(20.0)
    if isinstance(value, float | int):
        return 20.0
    return [(x - 273.15, y) for x, y in value] if hasattr(value[0], "__len__") else [x - 273.15 for x in value]


TEMPERATURES = [
    (cls, item.name)
    for role in (*samples.ELEMENT_ROLES, Role.LAW)
    for cls in REGISTRY[role].values()
    for item, spec in specs(cls)
    if "K" in (spec.unit, spec.unit_x)
]


@pytest.mark.parametrize(("cls", "name"), TEMPERATURES, ids=_name)
def test_every_temperature_of_the_registry_is_watched(cls, name):
    if cls.role is Role.LAW:
        law = samples.law(cls)
        value = getattr(law, name)
        value = cw.Constant(300.0) if value is None else value
        d = cw.Driveline()
        d.shaft("a", inertia=1.0)
        tables = {n: _celsius(getattr(law, n)) for n in ("static", "kinetic") if name in ("static", "kinetic")}
        law = replace(law, **{name: _celsius(value), **(tables if cls is cw.TemperatureTable else {})})
        law = law if name == "temperature" else replace(law, temperature=300.0)
        d.add(cw.Brake("b", shaft=d.nodes[0], friction=law, gain=1.0, pressure=1.0))
    else:
        d = samples.driveline(cls)
        # a limit needs the temperature that it is one of
        more = {"thermal_mass": 1e3} if name == "temperature_limit" else {}
        d._model.elements[0] = replace(d.elements[0], **{name: _celsius(getattr(d.elements[0], name) or 300.0)}, **more)
    found = _warned(d)
    assert any(f"{name} " in words and "implausibly low" in words for words in found)


@pytest.mark.parametrize("cls", [*samples.declared(*samples.ELEMENT_ROLES), *REGISTRY[Role.LAW].values()], ids=_name)
def test_temperatures_in_kelvin_are_not_warned_of(cls):
    if cls.role is Role.LAW:
        d = cw.Driveline()
        shaft, lining = d.shaft("a", inertia=1.0), d.thermal("lining", capacity=1.0)
        d.add(cw.Brake("b", shaft=shaft, friction=samples.law(cls), gain=1.0, pressure=1.0, heat=lining))
    else:
        d = samples.driveline(cls)
    assert not any("implausibly low" in words for words in _warned(d))


def test_temperatures_of_thermal_nodes():
    d = _driveline()
    d.thermal("plates", capacity=1.0, temperature=20.0)
    d.thermal("fine", capacity=1.0, temperature=COLDEST)
    d.ambient("air", temperature=20.0)
    d.ambient("oil", temperature=cw.Table([(0.0, 300.0), (1.0, 80.0)]))
    found = _warned(d)
    assert [words.partition(":")[0] for words in found] == ['thermal "plates"', 'ambient "air"', 'ambient "oil"']
    assert (
        "temperature = 20 K: is implausibly low; temperatures are in kelvin; did you mean 293.15 K (20 degC)?"
        in found[0]
    )
    assert "temperature reaches down to 80 K" in found[2]
    with pytest.warns(cw.ModelWarning):
        assert len(d.assemble().warnings) == 3


def test_degrees_celsius_as_unit():
    for text in ("20 degC", "20 °C", "20 C"):
        data = {"shaft": [{"name": "a", "inertia": 1.0}], "ambient": [{"name": "air", "temperature": text}]}
        assert cw.Driveline.from_dict(data).thermal_nodes[0].temperature == 293.15


def test_tables_are_pairs_in_a_table():
    with pytest.raises(cw.UseError, match=r"write pairs: cw\.Table\(\[\(0, 0\), \(1, 2e5\)\]\)"):
        cw.Table([0, 1], [0, 2e5])
    d = cw.Driveline()
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=[(0, 0), (1, 2e5)]))
    assert "wrap it: cw.Table([...])" in str(d.check()[0])


def test_a_shaft_of_another_driveline_is_not_its_own_near_match():
    d, other = cw.Driveline(), cw.Driveline()
    d.shaft("engine", inertia=1.0)
    d.add(cw.Torque("t", shaft=other.shaft("engine", inertia=1.0), torque=1.0))
    assert any("belongs to another driveline" in str(p) and "did you mean" not in str(p) for p in d.check())


def test_a_controller_that_returns_nothing_is_told_so():
    d = cw.Driveline()
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=cw.Sampled(lambda *_: None, 0.1)))
    with pytest.raises(cw.SimulationError, match="returned None at 0 s: return a finite number"):
        d.simulate(1.0)
