"""The public face: names, a fast import, the refusal of a stale core."""

from __future__ import annotations

import inspect
import pydoc
import subprocess
import sys
from dataclasses import MISSING
from functools import cached_property

import pytest

import clutchwork as cw
from clutchwork.declare.docs import described, parameters, words
from clutchwork.declare.schema import Role, specs
from support import samples

ALL = samples.declared(*Role)
PROPERTIES = (property, cached_property)

# the public interface beside elements, laws and signals: a name that comes or goes is a line in CHANGELOG.md
PUBLIC = [
    *("ClutchworkError", "Domain", "Driveline", "Element", "EnergyBalance", "Event", "Events", "FaultWarning"),
    *("Gearbox", "HeatFlow", "Hint", "Hints", "Interrupted", "Law", "Loss", "Losses"),
    *("ModelError", "ModelWarning", "Node", "OptionError", "Options", "Problem", "Rate", "Signal", "SimulationError"),
    *("Simulator", "Simulators", "State", "StateError"),
    *("Bearing", "Churning", "Oil", "OilPump", "OpenPlates", "Seal"),
    *("StoppedEarly", "SupplyPower", "System", "ThermalNode", "Trajectory", "UnknownName", "UseError"),
    *(
        "compare",
        "diagram",
        "draw",
        "export_c",
        "export_fmu",
        "export_ssp",
        "FMU",
        "FMUError",
        "fit",
        "rig",
        "shifts",
        "simulate",
    ),
    *(
        "OutputWarning",
        "Sweep",
        "SweepInterrupted",
        "at",
        "catalogue",
        "break_away",
        "integral",
        "lock",
        "maximum",
        "minimum",
        "peak",
    ),
    *("sweep", "times", "variants"),
    *("Differentiable", "Gradient", "NoGradient", "differentiable", "squared_jerk", "to_jax", "to_torch"),
    *("Calibration", "CalibrationError", "CalibrationInterrupted", "calibrate", "limit", "together"),
    *("jerk", "rms_jerk", "slope", "squared_slope"),
    *("Design", "design", "discrete", "log_uniform", "lognormal", "normal", "triangular", "truncated_normal"),
    "uniform",
    *("SobolIndices", "Study", "StudyError", "StudyInterrupted", "sobol_indices", "study"),
    *("Moment", "Moments", "environment", "vector_environment"),
    *("Linear", "linearise", "linearize"),
    *("load_run", "read_columns"),
    "drive_cycle",
]


def _python(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)


def test_dir_lists_the_public_names_alone():
    assert cw.__all__ == sorted([*PUBLIC, *(cls.__name__ for cls in ALL)])
    assert dir(cw) == sorted([*cw.__all__, "__version__"])
    assert all(getattr(cw, name) is not None for name in dir(cw))


def _help(thing):
    return pydoc.plain(pydoc.render_doc(thing))


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_help_starts_with_the_words_of_a_class_and_lists_every_parameter(cls):
    shown = [line.removeprefix(" |  ") for line in _help(cls).splitlines()]
    first = shown.index(words(cls).splitlines()[0])
    # a blank line, the class, its signature, a blank line
    assert first == 5
    table = shown[shown.index("Parameters:", first) + 1 :]
    assert table[: table.index("")] == [f"    {name} {text}" for name, text in parameters(cls)]
    for item, spec in specs(cls):
        (line,) = [line for line in table if line.startswith(f"    {item.name} (")]
        told = described(item, spec)
        assert line.endswith(f"): {told.meaning}")
        assert f"[{told.unit}]" in line or not told.unit
        assert told.bound in line
        assert told.default in line


def test_all_of_a_disc_clutch_is_shown():
    assert len(list(parameters(cw.DiskClutch))) == 29
    assert "    surfaces (whole number [1] > 0, default 4): number of friction surfaces\n" in cw.DiskClutch.__doc__
    assert (
        "    normal_force (signal [N], default none): force on the discs (instead of `pressure`)\n"
        in cw.DiskClutch.__doc__
    )
    assert (
        "    direction (choice: bidirectional, unidirectional; default bidirectional): slips" in cw.DiskClutch.__doc__
    )


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_signature_is_that_of_the_parameters(cls):
    found = inspect.signature(cls).parameters
    public = [name for name, _ in parameters(cls)]
    assert [name for name in found if name in public] == public
    # where a model file is, a column of a CSV file must know
    assert set(found) - set(public) <= {"folder"}
    defaults = {item.name: item.default for item, _ in specs(cls)}
    for name, parameter in found.items():
        if name in defaults:
            assert parameter.default is (parameter.empty if defaults[name] is MISSING else defaults[name])


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_dir_of_an_element_lists_its_fields_and_properties(cls):
    place = () if cls.role in (Role.LAW, Role.SIGNAL) else ("x",)
    made = cls(*place, **samples.fields(cls, samples.nodes()))
    assert {*dir(made)} == {*(name for name, _ in parameters(type(made))), *dir(cls)}
    offered = [name for name in dir(cls) if not isinstance(inspect.getattr_static(cls, name), PROPERTIES)]
    # what is made of others hands them out by name
    assert offered == (["part"] if cls.role is Role.COMPOSITE else [])
    # help() shows no attribute that dir() hides
    hooks = [
        name
        for name in ("parts", "rows", "sums", "problems", "segments", "states", "kind", "role")
        if hasattr(cls, name)
    ]
    assert not [line for line in _help(cls).splitlines() if line.split(" |  ")[-1].split("(")[0].split(" ")[0] in hooks]
    assert "__dataclass" not in _help(cls)


def test_unknown_name_gets_a_near_match():
    with pytest.raises(AttributeError, match="did you mean 'Clutch'"):
        _ = cw.Clutsh


def test_import_takes_numpy_and_the_core_alone():
    code = """
import sys
import clutchwork
heavy = ("pydantic", "matplotlib", "pandas", "scipy", "xarray", "tomllib", "argparse")
print([name for name in heavy if name in sys.modules])
"""
    done = _python(code)
    assert done.stdout.strip() == "[]", done.stderr


def _refused(code, words):
    done = _python(code)
    assert done.returncode == 1
    assert "ImportError" in done.stderr
    assert words in done.stderr
    assert "pip install -e ." in done.stderr


@pytest.mark.parametrize(
    ("core", "words"),
    [
        ("types.SimpleNamespace(schema_hash=lambda: 1)", "was built from other declarations; build it"),
        ("types.SimpleNamespace(layout='another')", "was built from other declarations; build it"),
        ("None", "cannot be loaded"),
    ],
)
def test_missing_core_or_one_of_another_layout_is_refused_at_import(core, words):
    _refused(f"import sys, types; sys.modules['clutchwork._core'] = {core}; import clutchwork", words)


ONE = "types.SimpleNamespace(layout={layout}, schema=_core.schema, supported=lambda: {here})"


@pytest.mark.parametrize(
    ("module", "words"),
    [
        ("None", "derivatives of runs are computed by a compiled module of their own, which cannot be loaded"),
        (ONE.format(layout="'another'", here=True), "derivatives of clutchwork were built from other declarations"),
        (ONE.format(layout="_core.layout", here=False), "derivatives of clutchwork were built for another processor"),
    ],
)
def test_runs_need_no_derivatives_and_gradients_say_what_is_missing(module, words):
    code = f"""
import sys, types
from clutchwork import _core
sys.modules["clutchwork._derivatives"] = {module}
import clutchwork as cw
d = cw.Driveline()
d.add(cw.Damper("x", base=d.housing, follower=d.shaft("a", inertia=1.0, speed=1.0), damping=1.0))
run = d.simulate(1.0)
print("simulated")
run.gradient("a.speed", "x.damping")
"""
    done = _python(code)
    assert done.returncode == 1
    assert "ImportError" in done.stderr
    assert words in done.stderr
    assert "make" in done.stderr.partition(words)[2]
    assert done.stdout.strip() == "simulated"


SPRING = """
import sys, types
from clutchwork import _core
stale = types.SimpleNamespace(layout=_core.layout, schema=_core.schema.replace(OLD, NEW), schema_hash=lambda: 1)
sys.modules["clutchwork._core"] = stale
for name in [name for name in sys.modules if name.startswith("clutchwork") and name != "clutchwork._core"]:
    del sys.modules[name]
import clutchwork as cw
d = cw.Driveline()
d.add(cw.Damper("x", base=d.housing, follower=d.shaft("a", inertia=1.0), damping=1.0))
d.assemble()
print("assembled")
d.add(cw.Spring("y", base=d.housing, follower=d.nodes[0], stiffness=1.0))
d.assemble()
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("torque spring stiffness:param[N m/rad]", "torque spring rate:param[N m/rad]"),
        ("torque spring ", "torque springs "),
        ("initial_twist:param[rad] 1\ntorque spring_damper", "initial_twist:param[rad] 2\ntorque spring_damper"),
    ],
)
def test_a_core_built_from_another_declaration_is_refused_where_that_is_assembled(old, new):
    code = SPRING.replace("OLD", repr(old)).replace("NEW", repr(new))
    _refused(code, "was built from other declarations; build it in the project folder")
    _refused(code, "it has no spring with these fields")
    assert _python(code).stdout.strip() == "assembled"


def test_an_import_reads_no_declaration_before_it_is_used():
    code = """
import sys
import clutchwork as cw
print([name for name in sys.modules if ".elements." in name or ".laws." in name])
cw.Clutch, cw.LuGre
print(sorted(name.rpartition(".")[2] for name in sys.modules if ".elements." in name or ".laws." in name))
"""
    first, second = _python(code).stdout.splitlines()
    assert first == "[]"
    assert "'clutch'" in second
    assert "'disk_clutch'" not in second


def test_a_star_brings_every_name():
    names: dict[str, object] = {}
    exec("from clutchwork import *", names)
    assert set(cw.__all__) <= set(names)


def test_housing_is_where_nothing_moves():
    assert cw.Driveline().housing.fixed
