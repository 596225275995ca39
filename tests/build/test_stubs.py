"""The type stub that the build writes: what a strict type checker accepts of a user's code, and what it refuses."""

from __future__ import annotations

import ast
import inspect
import re
import subprocess
import sys
from itertools import pairwise

import pytest

import clutchwork as cw
from clutchwork.declare.docs import parameters
from clutchwork.declare.schema import Role, specs
from support import project, samples

ALL = samples.declared(*Role)

HEAD = """from typing import Any

import clutchwork as cw
import pint

d = cw.Driveline("two")
shaft: cw.Node = d.shaft("engine", inertia=0.2, speed=100.0)
node: cw.ThermalNode = d.thermal("plates", capacity=1e3)
law: cw.Law = cw.Stribeck(static=0.12, kinetic=0.1, speed=1.0)
clutch = cw.DiskClutch("c", base=d.housing, follower=shaft, radius=0.1, normal_force=cw.Ramp(height=1e6, duration=0.1))
"""
# values by the sort of the field
VALUES = {
    "named": '{"sun": 0.1}',
    "elements": '{"B": {"gain": 1.0}}',
    "port": "shaft",
    "thermal": "node",
    "law": "law",
    "signal": "cw.Step(height=1.0)",
    "alternative": "1.0",
}

RIGHT = """
same: cw.DiskClutch = d.add(clutch)
radius: float = same.effective_radius
pack: cw.ThermalNode | None = same.plates
worn: cw.Element | cw.ThermalNode | cw.Node = same.part("wear")
assert isinstance(worn, cw.Wear)
word: str = same.direction
d.add(cw.Wear("w", rate=1e-12, area=1e-3, heat=cw.HeatFlow(same)))
d.add(cw.DiaphragmSpring("s", force=[(0.0, 5e3), (8e-3, 0.0)], travel=0.0, wear=worn))
run: cw.Trajectory = d.simulate(2.0, rtol=1e-8, progress=None)
status: str = cw.simulate(d, 1.0, options=cw.Options(dt=1e-2), method="dopri5").status
system: cw.System = d.assemble(["engine"])
torque = run["c.torque"]
found: list[cw.Problem] = d.check()
tables = cw.Table([(0, 1), (1, 2)]), cw.Column("a.csv", "p [bar]"), cw.Sampled(lambda time, readings: 0.0, 0.1)
ureg: Any = pint.UnitRegistry()
united = cw.Clutch("u", base=shaft, follower=shaft, friction=law, gain="500 cm3", pressure=2 * ureg.bar)
gain: float = united.gain
table = cw.Table([(0, "0 bar"), ("200 ms", 2 * ureg.bar), (1.0, 2e5)])
hot = d.thermal("hot", capacity="2 kJ/K", temperature="90 degC"), d.shaft("u", speed="955 rpm")
short = cw.simulate(d, "2 s", dt="1 ms", times=None), d.simulate("2 s", max_step=2 * ureg.s)
grid = cw.FrictionMap(temperatures=["20 degC", 400.0], speeds=[0, 1], kinetic=[[0.1, 0.2]], static=[0.2, 0.2])
names: tuple[str, object, object] = (cw.__version__, cw.rig.drift, cw.fit.fit_law)
"""

# each line is a mistake, with words of what is said of it
WRONG = {
    "cw.Clutsch": '"Clutsch"; maybe "Clutch"',
    "cw.Clutch(supportt=1.0)": '"supportt"',
    "cw.near": '"near"',
    "cw.import_module": '"import_module"',
    "cw.REGISTRY": '"REGISTRY"',
    "cw.rig.drif": '"drif"',
    "cw.fit.fit_lw": '"fit_lw"',
    "clutch.raduis": '"raduis"; maybe "radius"',
    "clutch.radius = 0.1": "read-only",
    "clutch.parts": '"parts"',
    "clutch.sums": '"sums"',
    "clutch.kind": '"kind"',
    'cw.DiskClutch("c", base=shaft, follower=shaft, direction="forward")': '"direction"',
    'cw.DiskClutch("c", base=shaft, follower=shaft, radius=[0.1])': '"radius"',
    'cw.DiskClutch("c", base=shaft)': '"follower"',
    "cw.Coulomb(0.1, 0.1)": "positional",
    "d.add(law)": '"add"',
    'd.shaft("x", inerta=1.0)': '"inerta"',
    "cw.Options(rtoll=1e-3)": 'did you mean "rtol"',
    "d.simulate(1.0, rtoll=1e-3)": 'did you mean "rtol"',
    "cw.simulate(d, 1.0, methid='auto')": 'did you mean "method"',
    "cw.simulate(d, 1.0, method='euler')": '"method"',
}


def _call(cls, **more):
    """A call of a declaration with a value for every parameter."""
    given = {item.name: _value(item, spec) for item, spec in specs(cls)} | more
    place = [] if cls.role in (Role.LAW, Role.SIGNAL) else ['"x"']
    return f"cw.{cls.__name__}({', '.join([*place, *(f'{name}={value}' for name, value in given.items())])})"


def _value(item, spec):
    if spec.what in VALUES:
        return VALUES[spec.what]
    if "Sequence[Sequence[" in str(item.type) and spec.example is None:
        return "((0.1, 0.2), (0.3, 0.4))"
    if spec.what == "formula" and spec.example is None:
        return '"0.2"'
    return "lambda time, readings: 0.0" if spec.what == "function" else repr(samples.value(item.name, spec, {}))


@pytest.fixture(scope="module")
def checked(tmp_path_factory):
    """What mypy says of each line of a user's file, by its number."""
    folder = tmp_path_factory.mktemp("typed")
    copy = project.copy(folder / "project")
    project.write_stubs(copy, copy / "src/clutchwork")
    lines = [*HEAD.splitlines(), *RIGHT.splitlines(), *map(_call, ALL)]
    # a formula may have numbers of any name
    wrong = [*WRONG, *(_call(cls, nonsense="1.0") for cls in ALL if not getattr(cls, "takes_numbers", False))]
    user = folder / "user.py"
    user.write_text("\n".join([*lines, *wrong]) + "\n")
    command = [
        sys.executable,
        "-m",
        "mypy",
        "--strict",
        "--cache-dir",
        str(folder / "cache"),
        "--no-error-summary",
        user,
    ]
    result = subprocess.run(
        command, capture_output=True, text=True, check=False, cwd=folder, env={"MYPYPATH": str(copy / "src")}
    )
    assert not result.stderr, result.stderr
    said = re.findall(r"^user\.py:(\d+): error: (.*)$", result.stdout, re.MULTILINE)
    elsewhere = [line for line in result.stdout.splitlines() if not line.startswith("user.py:")]
    return len(lines), wrong, {int(number): words for number, words in said}, elsewhere


def test_right_use_of_every_declaration_passes(checked):
    right, _, said, elsewhere = checked
    assert {number: words for number, words in said.items() if number <= right} == {}
    # the package itself is clean with its stub
    assert not [line for line in elsewhere if ": error:" in line]


def test_every_mistake_is_an_error(checked):
    right, wrong, said, _ = checked
    expected = {**WRONG, **{line: '"nonsense"' for line in wrong if line not in WRONG}}
    missed = {line: said.get(right + 1 + place, "") for place, line in enumerate(wrong)}
    assert {line: words for line, words in missed.items() if expected[line] not in words} == {}


@pytest.fixture(scope="module")
def stub(tmp_path_factory):
    """The stub, as a tree, of the sources as they are."""
    folder = tmp_path_factory.mktemp("stubs")
    project.write_stubs(project.ROOT, folder)
    return ast.parse((folder / "__init__.pyi").read_text())


def _classes(stub):
    return {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}


def test_public_names_are_those_of_the_package(stub):
    (public,) = [node.value for node in stub.body if isinstance(node, ast.Assign)]
    assert ast.literal_eval(public) == cw.__all__
    imported = {name.asname for node in stub.body if isinstance(node, ast.ImportFrom) for name in node.names} - {None}
    assert imported | set(_classes(stub)) == set(cw.__all__)


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_a_class_has_the_docstring_and_the_parameters_of_its_declaration(cls, stub):
    node = _classes(stub)[cls.__name__]
    assert ast.get_docstring(node) == cls.__doc__
    found = [item for item in node.body if isinstance(item, ast.AnnAssign)]
    given = [p for p in inspect.signature(cls).parameters.values() if p.name != "name"]
    assert [item.target.id for item in found] == [p.name for p in given]
    assert [_default(item.value) for item in found] == [_shown(p.default) for p in given]


def _default(value):
    """A default of the stub as code, which stands inside of `field` where a parameter may be positional."""
    if isinstance(value, ast.Call) and value.func.id == "field":
        value = {word.arg: word.value for word in value.keywords}.get("default")
    return "" if value is None else ast.unparse(value)


def _shown(default):
    return "" if default is inspect.Parameter.empty else ast.unparse(ast.parse(repr(default), mode="eval"))


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_hovering_over_a_field_says_what_it_is(cls, stub):
    body = _classes(stub)[cls.__name__].body
    after = {
        item.target.id: following.value.value
        for item, following in pairwise(body)
        if isinstance(item, ast.AnnAssign) and isinstance(following, ast.Expr)
    }
    assert after == {name: text for name, text in parameters(cls) if name != "name"}
