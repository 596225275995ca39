"""Every option of the table, through every door: it reaches the run, and a bad value is refused with its bound."""

from __future__ import annotations

import math
import pickle
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.declare.layout import METHODS
from clutchwork.declare.options import OPTIONS, SIMULATION, Method
from clutchwork.declare.setting import Setting
from clutchwork.files.model_file import toml
from clutchwork.run import simulation
from clutchwork.run.begin import new_run

ROOT = Path(__file__).resolve().parents[2]
CORE = {name: row for name, row in OPTIONS.items() if row.core}
T_END = 0.25


def driveline() -> cw.Driveline:
    d = cw.Driveline("two discs")
    engine = d.shaft("engine", inertia=0.2, speed=100.0)
    load = d.shaft("load", inertia=0.8)
    lining = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("c1", base=load, follower=engine, friction=lining, gain=1.0, normal_force=100.0))
    return d


def sample(row: Setting) -> Any:
    """A value that differs from the default."""
    spec = row.spec
    if spec.what == "numbers":
        return [0.0, 0.125, 0.125]
    if spec.choices:
        return next(word for word in spec.choices if word != row.default)
    if spec.flag:
        return not row.default
    if spec.whole:
        return row.default // 2
    return 0.125 if spec.unit == "s" else row.default / 8.0


def bad(row: Setting) -> list[tuple[Any, str]]:
    """Values that are refused, with the bound."""
    spec = row.spec
    if spec.what == "numbers":
        return [([0.2, 0.1], "must not decrease")]
    if spec.choices:
        return [("none", f"must be one of {', '.join(spec.choices)}")]
    if spec.flag:
        return [(2, "must be (true or false|True or False)")]
    if spec.whole:
        high = (row.most + 1, f"must be at most {row.most:.0f}")
        return [(0, "must be at least 1"), (2.5, "must be a whole number"), high]
    if spec.at_least is not None:
        if spec.at_least == 0.0:
            return [(-1.0, "must be a finite number of at least 0"), (math.nan, "must be a finite number")]
        return [(0.5 * spec.at_least, f"must be at least {spec.at_least:g}"), (math.nan, "must be a finite number")]
    return [(0.0, "finite number above 0"), (-1.0, "finite number above 0"), (math.inf, "finite number above 0")]


def plain(value: Any) -> str:
    """A value in TOML."""
    return toml({"table": {"x": value}}).rpartition(" = ")[2].strip()


def in_file(row: Setting, value: Any) -> str:
    """A value in a model file; a time is in milliseconds."""
    if row.spec.unit != "s" or not isinstance(value, list | float):
        return plain(value)
    if isinstance(value, list):
        return f'{{values = {[1e3 * instant for instant in value]}, unit = "ms"}}'
    return f'"{1e3 * value} ms"'


def write(path: Path, name: str, text: str) -> Path:
    d = driveline()
    if name != "t_end":
        d.simulation["t_end"] = T_END
    d.save(path)
    lines = path.read_text(encoding="utf-8").rstrip("\n").split("\n")
    head = [] if "[simulation]" in lines else ["", "[simulation]"]
    path.write_text("\n".join([*lines, *head, f"{name} = {text}"]) + "\n", encoding="utf-8")
    return path


def flag(name: str, row: Setting, value: Any) -> list[str]:
    """A value on the command line; a time is in milliseconds."""
    word = name.replace("_", "-")
    if row.spec.flag:
        return [f"--{word}" if value else f"--no-{word}"]
    if isinstance(value, list):
        return [f"--{word}={','.join(map(str, value))}"]
    in_ms = row.spec.unit == "s" and math.isfinite(value)
    return [f"--{word}", f"{1e3 * value} ms" if in_ms and value > 0 else str(value)]


def used(run: cw.Trajectory, name: str) -> Any:
    value = run.t_end if name == "t_end" else getattr(run.options, name)
    return value.tolist() if isinstance(value, np.ndarray) else value


# the doors: each runs a driveline with one option


def by_name(name: str, value: Any, _: Path) -> cw.Trajectory:
    return driveline().simulate(**{"t_end": T_END, name: value})


def by_settings(name: str, value: Any, _: Path) -> cw.Trajectory:
    d = driveline()
    d.simulation.update({"t_end": T_END, name: value})
    return d.simulate()


def by_file(name: str, value: Any, folder: Path) -> cw.Trajectory:
    text = in_file(SIMULATION[name], value)
    return cw.Driveline.load(write(folder / "model.toml", name, text)).simulate()


def by_saved_file(name: str, value: Any, folder: Path) -> cw.Trajectory:
    d = driveline()
    d.simulation.update({"t_end": T_END, name: value})
    d.save(folder / "model.json")
    cw.Driveline.load(folder / "model.json").save(folder / "again.toml")
    return cw.Driveline.load(folder / "again.toml").simulate()


def by_system(name: str, value: Any, folder: Path) -> cw.Trajectory:
    d = driveline()
    d.simulation.update({"t_end": T_END, name: value})
    return cw.simulate(pickle.loads(pickle.dumps(d.assemble())))


def by_saved_system(name: str, value: Any, folder: Path) -> cw.Trajectory:
    d = driveline()
    d.simulation.update({"t_end": T_END, name: value})
    d.assemble().save(folder / "model.system")
    return cw.simulate(cw.System.load(folder / "model.system"))


def by_options(name: str, value: Any, _: Path) -> cw.Trajectory:
    given = {} if name == "t_end" else {name: value}
    return driveline().simulate(value if name == "t_end" else T_END, options=cw.Options(**given))


def by_command_line(name: str, value: Any, folder: Path) -> cw.Trajectory:
    """The trajectory that `clutchwork run` makes."""
    path, seen = write(folder / "model.toml", "t_end", str(T_END)), []
    plain = simulation.simulate

    def record(*args: Any, **named: Any) -> cw.Trajectory:
        seen.append(plain(*args, **named))
        return seen[0]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(simulation, "simulate", record)
        assert main(["run", str(path), "--quiet", *flag(name, SIMULATION[name], value)]) == 0
    return seen[0]


DOORS = (
    by_name,
    by_options,
    by_settings,
    by_file,
    by_saved_file,
    by_system,
    by_saved_system,
    by_command_line,
)


@pytest.mark.parametrize("door", DOORS, ids=lambda door: door.__name__)
@pytest.mark.parametrize("name", SIMULATION)
def test_every_option_reaches_the_run(name: str, door: Callable[..., cw.Trajectory], tmp_path: Path) -> None:
    value = sample(SIMULATION[name])
    run = door(name, value, tmp_path)
    assert (used(run, name), type(used(run, name))) == (value, type(value))
    assert run.t_end == (value if name == "t_end" else T_END)
    for other, row in OPTIONS.items():
        assert other == name or getattr(run.options, other) == row.default


@pytest.mark.parametrize("name", CORE)
def test_every_option_of_the_core_reaches_it(name: str) -> None:
    """A saved state of the core holds its options."""
    data = driveline().assemble().to_bytes()
    given, plain = new_run(data), new_run(data)
    default = cw.Options().core_options()[name]
    for option, number in cw.Options(**{name: sample(CORE[name])}).core_options().items():
        given.set_option(option, number)
    assert given.save() != plain.save()
    given.set_option(name, default)
    assert given.save() == plain.save()


BAD = [(name, value, words) for name, row in SIMULATION.items() for value, words in bad(row)]


@pytest.mark.parametrize(("name", "value", "words"), BAD)
def test_a_bad_value_is_refused_with_the_bound(name: str, value: Any, words: str, tmp_path: Path) -> None:
    for door in (by_name, by_options):
        with pytest.raises(cw.OptionError, match=rf"\A{name} .*{words}"):
            door(name, value, tmp_path)
    d = driveline()
    d.simulation[name] = value
    (problem,) = d.check()
    assert re.search(rf"\Ad\.simulation: {name} = .*: .*{words}", str(problem))
    for refused in (d.simulate, d.assemble, lambda: d.save(tmp_path / "x.toml"), d.to_dict):
        with pytest.raises(cw.ModelError, match=words):
            refused()
    path = write(tmp_path / "model.toml", name, plain(value))
    with pytest.raises(cw.ModelError, match=words) as caught:
        cw.Driveline.load(path)
    (problem,) = caught.value.problems
    assert path.read_text(encoding="utf-8").split("\n")[problem.line - 1].startswith(f"{name} = ")


@pytest.mark.parametrize(("name", "value", "words"), [case for case in BAD if not SIMULATION[case[0]].spec.flag])
def test_a_bad_value_on_the_command_line(
    name: str, value: Any, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, row = write(tmp_path / "model.toml", "t_end", "1.0"), SIMULATION[name]
    try:
        code: Any = main(["run", str(path), *flag(name, row, value)])
    except SystemExit as stopped:
        code = stopped.code
    told = capsys.readouterr().err
    assert code == 2
    assert re.search(words, told) or (row.spec.choices and all(word in told for word in row.spec.choices))


@pytest.mark.parametrize("name", CORE)
@given(value=st.one_of(st.floats(), st.integers(-3, 5).map(float), st.sampled_from([1e-300, 1e-14, 1e15, 1e300])))
def test_the_core_refuses_what_the_table_refuses(name: str, value: float) -> None:
    row, run = CORE[name], RUN
    spec = row.spec
    allowed = value in range(2) if spec.flag else value in range(len(spec.choices))
    if not spec.flag and not spec.choices:
        allowed = row.fault(value) is None or (spec.optional and value == row.unset)
    if allowed:
        run.set_option(name, value)
    else:
        with pytest.raises(ValueError, match=f"option {name} is unknown or cannot be"):
            run.set_option(name, value)


RUN = new_run(driveline().assemble().to_bytes())


@pytest.mark.parametrize("name", CORE)
def test_the_bounds_themselves_are_allowed(name: str) -> None:
    row = CORE[name]
    for value in (row.least, row.most, row.number(row.default)):
        RUN.set_option(name, value)
    for value in (math.nextafter(row.least, -1.0), math.nextafter(row.most, math.inf), math.nan):
        if value != row.unset:
            with pytest.raises(ValueError, match=name):
                RUN.set_option(name, value)


def test_the_core_knows_no_other_option() -> None:
    for name in {*SIMULATION, "rtoll", ""} - {*CORE}:
        with pytest.raises(ValueError, match="is unknown"):
            RUN.set_option(name, 1.0)


def test_what_is_typed_by_hand_agrees_with_the_table() -> None:
    assert get_args(Method) == tuple(METHODS) == OPTIONS["method"].spec.choices
    assert list(METHODS.values()) == list(range(len(METHODS)))
    text = (ROOT / "cpp/include/clutchwork/c_api.h").read_text(encoding="utf-8")
    words = re.search(r"/\* Settings by name: (.*?)\*/", text, re.DOTALL)
    assert words is not None
    for name, row in CORE.items():
        assert re.search(rf"\b{name}\b", words[1])
        assert row.spec.unit != "s" or re.search(rf"\b{name} \[s\]", words[1])
        for number, word in enumerate(row.spec.choices):
            assert f"{number} {word}" in words[1]


def test_what_is_given_overrules_the_settings_one_by_one(tmp_path: Path) -> None:
    d = driveline()
    d.simulation.update({"t_end": 0.5, "rtol": 1e-7, "method": "dopri5", "dt": 0.25})
    d.save(tmp_path / "model.toml")
    loaded = cw.Driveline.load(tmp_path / "model.toml")
    run = loaded.simulate()
    assert (run.t_end, run.options) == (0.5, cw.Options(rtol=1e-7, method="dopri5", dt=0.25))
    run = loaded.simulate(0.25, rtol=1e-8)
    assert (run.t_end, run.options) == (0.25, cw.Options(rtol=1e-8, method="dopri5", dt=0.25))
    run = loaded.simulate(options=cw.Options(atol=1e-9), max_steps=1000)
    assert (run.t_end, run.options) == (0.5, cw.Options(atol=1e-9, max_steps=1000))
    assert cw.simulate(loaded).options == cw.simulate(loaded.assemble()).options == loaded.simulate().options


def test_a_grid_that_is_given_replaces_that_of_the_settings() -> None:
    d = driveline()
    d.simulation.update({"t_end": 0.5, "dt": 0.25})
    assert d.simulate(times=[0.0, 0.125]).time.tolist() == [0.0, 0.125]
    assert d.simulate(dt=None).options.dt is None
    d.simulation.update({"dt": None, "times": np.array([0.0, 0.125])})
    assert d.simulate(dt=0.5).time.tolist() == [0.0, 0.5]
    with pytest.raises(cw.OptionError, match="not both"):
        d.simulate(dt=0.5, times=[0.0])
    assert d.simulate(0.0625).time.tolist() == [0.0]
    d.simulation["dt"] = 0.25
    (problem,) = d.check()
    assert "times" in str(problem)
    assert "not both" in str(problem)


def test_options_are_loaded_when_they_are_first_used() -> None:
    code = "import sys, clutchwork; assert not any('option' in name for name in sys.modules if 'clutchwork' in name)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_settings_of_a_system_may_be_replaced() -> None:
    d = driveline()
    d.simulation["t_end"] = 0.5
    system = d.assemble()
    d.simulation["t_end"] = 0.25
    assert cw.simulate(system).t_end == 0.5
    assert cw.simulate(replace(system, settings={"t_end": 0.125, "rtol": 1e-7})).options.rtol == 1e-7
    with pytest.raises(cw.UseError, match="did you mean 'rtol'"):
        cw.simulate(replace(system, settings={"t_end": 0.125, "rtoll": 1e-7}))


def test_unknown_settings_are_mistakes_of_the_model() -> None:
    d = driveline()
    d.simulation.update({"t_end": 1.0, "max_stps": 3, "rtoll": 1e-3})
    assert [re.search("mean '(.*?)'", str(problem))[1] for problem in d.check()] == ["max_steps", "rtol"]
    with pytest.raises(cw.ModelError, match="2 problems"):
        d.simulate()


@pytest.mark.parametrize("times", ["all", [], 3.0, [[0.0, 1.0], [2.0, 3.0]], [0.0, "x"], [0.0, math.nan], [-1.0, 0.0]])
def test_times_that_are_no_row_of_instants(times: Any) -> None:
    d = driveline()
    d.simulation.update({"t_end": 1.0, "times": times})
    assert len(d.check()) == 1
    with pytest.raises(cw.OptionError):
        driveline().simulate(1.0, times=times)


def test_a_missing_end_time_names_both_remedies(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    d = driveline()
    for refused in (d.simulate, lambda: cw.simulate(d), lambda: cw.simulate(d.assemble())):
        with pytest.raises(cw.OptionError, match=r"t_end is missing: give .* to the call in s, or .*\[simulation\]"):
            refused()
    d.save(tmp_path / "model.toml")
    for line in (["run"], ["export", "--out", str(tmp_path / "c")]):
        assert main([*line, str(tmp_path / "model.toml")]) == 2
        assert "t_end is missing: give --t-end, or t_end in the [simulation] table" in capsys.readouterr().err


@pytest.mark.parametrize("name", CORE)
def test_every_option_of_the_core_reaches_exported_c(name: str, tmp_path: Path) -> None:
    row = CORE[name]
    path = write(tmp_path / "model.toml", "t_end", str(T_END))
    value = sample(row)
    words = ["--" + name.replace("_", "-"), value] if row.spec.choices else flag(name, row, value)
    assert main(["export", str(path), "--out", str(tmp_path / "c"), *words]) == 0
    settings = (tmp_path / "c" / "model.c").read_text(encoding="utf-8")
    for known, number in cw.Options(**{name: value}).core_options().items():
        assert re.search(rf'cw_set_option\(run, "{known}", ({number!r}|INFINITY)\)', settings)


def test_a_number_on_the_command_line_has_a_unit_that_fits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "model.toml", "t_end", "1.0")
    for text, words in (("1 kg", "does not fit"), ("fast", "is not a number"), ("1 sec onds", "s")):
        with pytest.raises(SystemExit):
            main(["run", str(path), "--max-step", text])
        assert words in capsys.readouterr().err
