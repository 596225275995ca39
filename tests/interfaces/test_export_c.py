"""C and C++ of a model: built without Python, it computes what Python computes."""

from __future__ import annotations

import io
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.assembly.wiring import wiring
from clutchwork.command.main import main
from clutchwork.results.channels import Channels
from clutchwork.run.begin import new_run
from support.project import ROOT

feature = pytest.mark.feature

T_END, DT = 1.2, 0.01
# numbers that a sum in another order may change in the last digits
CLOSE: dict[str, Any] = {"rtol": 1e-12, "atol": 1e-12}
# quick to compile; without optimisation the core inlines nothing by force
FLAGS = ["CXXFLAGS=-O0 -DCLUTCHWORK_HOT=inline", "CFLAGS=-O1 -Wall -Wextra -pedantic -Werror"]

SIMULINK = ROOT / "tests" / "support" / "simulink"

# sets the torque from outside at half time, in C, and gives the piston other pieces of its command
INPUT_C = """
#include <stdio.h>
#include "model.h"
static _Alignas(16) unsigned char memory[MODEL_MEMORY];
int main(void) {
  double row[MODEL_ROW_SIZE];
  cw_run *run = cw_load(model_system, MODEL_SYSTEM_BYTES, memory, sizeof memory);
  if (!run || !model_set_options(run)) return 2;
  cw_advance(run, 0.5, NULL, NULL, 0, 0, NULL);
  if (!cw_set_input(run, MODEL_INPUT_LOAD_TORQUE, -40.0)) return 3;
  double times[] = {0.1, 0.7}, pieces[2][12] = {{2e5, 2e5}, {4e5}};
  if (!cw_set_segments(run, COMMAND, times, pieces[0], 2)) return 5;
  cw_advance(run, 1.0, NULL, NULL, 0, 0, NULL);
  if (cw_row(run, row) != MODEL_STATUS_DONE) return 4;
  printf("%.17g %.17g", row[MODEL_ROW_WHEEL__2__SPEED], model_get_c1_temperature(row));
  return 0;
}
"""


def driveline(*, cooled: bool = True) -> cw.Driveline:
    """A disc clutch that gets warm, behind an actuator, drag beside it, a spring and a gear behind it."""
    d = cw.Driveline('clutch "?" of a */ car')
    engine, plate = d.shaft("engine", inertia=0.2, speed=150.0), d.shaft("plate", inertia=0.02)
    # C cannot spell this name
    wheel, half = d.shaft("wheel (2)", inertia=0.6), d.shaft("half")
    lining = cw.FrictionMap(
        temperatures=(280.0, 400.0, 560.0),
        speeds=(0.0, 100.0, 200.0),
        static=(0.37, 0.39, 0.30),
        kinetic=((0.35, 0.325, 0.31), (0.37, 0.345, 0.33), (0.28, 0.26, 0.245)),
    )
    command = cw.Table([(0.0, 0.0), (0.1, 2.5e5), (1.0, 4e5)])
    piston = d.add(cw.PressureActuator("piston", command=command, lag=0.03, fill_time=0.02))
    clutch = cw.DiskClutch(
        "c1",
        base=engine,
        follower=plate,
        friction=lining,
        radius=0.13,
        area=1e-3,
        pressure=piston,
        drag=0.02,
        thermal_mass=90.0,
    )
    d.add(clutch)
    if cooled:
        d.add(cw.Convection("cooling", hot=clutch.plates, cold=d.ambient("air"), conductance=5.0))
    d.add(cw.Gear("gear", input=plate, output=half, ratio=2.0))
    d.add(cw.SpringDamper("shaft", base=half, follower=wheel, stiffness=4e3, damping=5.0))
    drag = cw.Formula("mu + f*exp(-v/w) + 0.01*tanh(v/w)", mu=0.2, f=0.1, w="50 rpm")
    d.add(cw.Brake("drag", shaft=wheel, friction=drag, gain=1.0, normal_force=2.0))
    d.add(cw.Torque("load", shaft=wheel, torque=cw.Sampled(lambda *_: 0.0, 100.0)))
    return d


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return cw.export_c(driveline(), tmp_path_factory.mktemp("export") / "car", t_end=T_END, dt=DT, rtol=1e-8)


@pytest.fixture(scope="module")
def built(folder: Path) -> Path:
    if any(shutil.which(tool) is None for tool in ("cc", "c++", "make")):
        pytest.skip("needs cc, c++ and make")
    made = subprocess.run(["make", "-j4", "-C", folder, *FLAGS], capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stdout + made.stderr
    return folder


def table(path: Path) -> tuple[list[str], np.ndarray]:
    """What a program prints: heads without units, columns."""
    done = subprocess.run([path], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    head, _, rest = done.stdout.partition("\n")
    return re.findall(r"([^,\]]*?) \[[^]]*\],?", head), np.loadtxt(io.StringIO(rest), delimiter=",").T


def stepped(system: cw.System, instants: Any, rtol: float = 1e-8) -> np.ndarray:
    """Rows of a run that ends a step at every instant, as a controller drives it."""
    run, rows = new_run(system.to_bytes()), []
    run.set_option("rtol", rtol)
    for time in instants:
        run.advance(time, np.empty(0), np.empty((0, run.row_size)))
        rows.append(np.array(run.row()))
    return np.array(rows)


@feature("code: C and C++ of a model that holds the clutch")
def test_the_c_program_computes_what_python_computes(built: Path) -> None:
    """Bit for bit what the core computes on the grid, and every signal that is a number."""
    names, columns = table(built / "model")
    run = driveline().simulate(T_END, dt=DT, rtol=1e-8)
    assert {"c1.temperature", "c1.slip", "c1.power", "c1.heat", "piston.pressure", "shaft.twist"} < set(names)
    assert names[1:] == [name for name in run.names if name != "c1.state"]
    assert 0 in run["c1.mode"]
    np.testing.assert_array_equal(columns[0], run.time)
    for name, column in zip(names[1:], columns[1:], strict=True):
        np.testing.assert_allclose(column, run[name], err_msg=name, **CLOSE)
    for name in ("engine.speed", "c1.torque", "c1.mode", "piston.pressure", "c1.plates.heat"):
        np.testing.assert_array_equal(columns[names.index(name)], run[name], name)


@feature("code: C and C++ of a model that holds the clutch")
def test_the_cpp_program_steps_as_a_controller_does(built: Path) -> None:
    names, columns = table(built / "model_steps")
    system = driveline().assemble()
    channels, rows = Channels(wiring(system)), stepped(system, columns[0])
    for name, column in zip(names[1:], columns[1:], strict=True):
        np.testing.assert_allclose(column, channels[name].evaluate(rows), err_msg=name, **CLOSE)
    run = driveline().simulate(T_END, dt=DT, rtol=1e-8)
    np.testing.assert_allclose(columns[names.index("wheel (2).speed")], run["wheel (2).speed"], atol=1e-5)


@feature("code: C and C++ of a model that holds the clutch")
def test_inputs_are_set_from_outside_in_c(built: Path) -> None:
    system = driveline().assemble()
    names = [item.name for item in system.inputs]
    command = names.index("piston.command")
    (built / "input.c").write_text(INPUT_C.replace("COMMAND", str(command)))
    parts = ["build/model.o", "build/model_system.o", "build/libclutchwork.a", "-lm"]
    compiler = ["cc", "-std=c11", "-I.", "-Icore/include", "input.c", *parts, "-o", "input"]
    subprocess.run(compiler, cwd=built, check=True)
    told = subprocess.run([built / "input"], capture_output=True, text=True, check=True).stdout
    run = new_run(system.to_bytes())
    run.set_option("rtol", 1e-8)
    nothing = np.empty(0), np.empty((0, run.row_size))
    run.advance(0.5, *nothing)
    run.set_input(names.index("load.torque"), -40.0)
    pieces = np.zeros((2, 12))
    pieces[0, :2], pieces[1, 0] = 2e5, 4e5
    run.set_segments(command, np.array([0.1, 0.7]), pieces)
    run.advance(1.0, *nothing)
    row, channels = np.array(run.row()).reshape(1, -1), Channels(wiring(system))
    expected = [channels[name].evaluate(row)[0] for name in ("wheel (2).speed", "c1.temperature")]
    np.testing.assert_array_equal([float(number) for number in told.split()], expected)


def test_the_s_function_steps_as_a_simulator_does(built: Path) -> None:
    """The file as `mex` takes it, beside a stand-in for Simulink's header."""
    parts = ["build/model.o", "build/model_system.o", "build/libclutchwork.a", "-lm"]
    strict = ["-std=c11", "-Wall", "-Wextra", "-Wno-unused-function", "-Werror"]
    folders = ["-I.", "-Icore/include", f"-I{SIMULINK}"]
    subprocess.run(["cc", *strict, *folders, "model_sfun.c", *parts, "-o", "block"], cwd=built, check=True)
    printed = subprocess.run([built / "block"], capture_output=True, text=True, check=True).stdout
    found = np.loadtxt(io.StringIO(printed)).T
    sim = cw.Simulator(driveline(), rtol=1e-8)
    sim.set("load.torque", 0.0)
    names = ["engine.speed", "wheel (2).speed", "c1.temperature", "piston.pressure"]
    rows = [sim[names]]
    for k in range(100):
        sim.set("load.torque", 0.0 if k < 50 else -40.0)
        sim.advance_to((k + 1) * 0.01)
        rows.append(sim[names])
    heads, _ = table(built / "model")
    for name, column in zip(names, np.array(rows).T, strict=True):
        np.testing.assert_allclose(found[heads.index(name) - 1], column, err_msg=name, rtol=1e-9)


# every allocation ends the program; what it computes is in its exit code
ALONE_C = """
#include <stddef.h>
#include "model.h"
void abort(void);
void *malloc(size_t n) { (void)n; abort(); }
void *calloc(size_t n, size_t m) { (void)n, (void)m; abort(); }
void *realloc(void *p, size_t n) { (void)p, (void)n; abort(); }
static _Alignas(16) unsigned char memory[MODEL_MEMORY];
int main(void) {
  double row[MODEL_ROW_SIZE], event[MODEL_EVENT_SIZE];
  cw_run *run = cw_load(model_system, MODEL_SYSTEM_BYTES, memory, sizeof memory);
  if (!run || !model_set_options(run)) return 2;
  if (model_set_param(run, MODEL_PARAM_C1_GAIN, -1.0) || model_set_param(run, MODEL_PARAMS, 1.0)) return 3;
  if (!model_set_param(run, MODEL_PARAM_SHAFT_STIFFNESS, 5e3)) return 4;
  for (int k = 1; k <= 100; ++k) {
    if (cw_advance(run, 0.01 * k, NULL, NULL, 0, 0, NULL) != MODEL_STATUS_DONE) return 5;
    while (cw_take_events(run, event, 1) == 1) continue;
  }
  if (model_set_param(run, MODEL_PARAM_SHAFT_STIFFNESS, 4e3)) return 6;
  if (!model_set_param(run, MODEL_PARAM_SHAFT_DAMPING, 6.0)) return 7;
  return cw_row(run, row) == MODEL_STATUS_DONE && row[MODEL_ROW_C1_MODE] == MODEL_MODE_LOCKED ? 0 : 8;
}
"""
MORE_C = """
#include <clutchwork/c_api.h>
#include "other_model_system.h"
int main(void) { return cw_size(model_system, MODEL_SYSTEM_BYTES) == -1 ? 0 : 1; }
"""
# what the core may need of a C library
NEEDED = {"memcpy", "memmove", "memset", "memcmp", "strcmp", "floor", "fmod", "sqrt", "nearbyint", "ceil", "trunc"}


def test_it_runs_without_a_heap_and_keeps_bounds(built: Path) -> None:
    (built / "alone.c").write_text(ALONE_C)
    parts = ["build/model.o", "build/model_system.o", "build/libclutchwork.a", "-lm"]
    command = ["cc", "-std=c11", "-I.", "-Icore/include", "alone.c", *parts, "-Wl,--gc-sections", "-o", "alone"]
    subprocess.run(command, cwd=built, check=True)
    assert subprocess.run([built / "alone"], check=False).returncode == 0


@pytest.mark.skipif(not shutil.which("nm"), reason="needs binutils")
def test_the_core_needs_little_of_a_c_library(built: Path) -> None:
    lines = subprocess.run(
        ["nm", built / "build" / "libclutchwork.a"], capture_output=True, text=True, check=True
    ).stdout
    words = [line.split() for line in lines.splitlines() if line.strip() and not line.endswith(":")]
    own = {one[-1] for one in words if one[-2] != "U"}
    asked = {one[-1] for one in words if one[-2] == "U"} - own
    assert {name for name in asked if not name.startswith("_")} <= NEEDED


def test_only_what_the_model_needs_is_compiled(folder: Path, built: Path) -> None:
    """And a System that needs more is refused."""
    text = (folder / "core/include/clutchwork/parts.gen.hpp").read_text()
    assert "#define CLUTCHWORK_ALONE" in text
    system = driveline().assemble()
    mask = sum(1 << kind for kind in set(system.arrays["element_kind"].tolist()))
    assert f"CLUTCHWORK_TORQUE {mask:#x}ull" in text
    other = cw.Driveline("other")
    a, b = other.shaft("a", inertia=1.0, speed=1.0), other.shaft("b", inertia=1.0)
    other.add(cw.NonlinearSpring("shaft", base=a, follower=b, torque=[(-0.1, -50.0), (0.1, 50.0)]))
    cw.export_c(other, folder.parent / "other", t_end=1.0)
    for name in ("model_system.c", "model_system.h"):
        shutil.copy(folder.parent / "other" / name, built / f"other_{name}")
    (built / "more.c").write_text(MORE_C)
    text = (built / "other_model_system.c").read_text().replace('"model_system.h"', '"other_model_system.h"')
    (built / "other_model_system.c").write_text(text)
    command = [
        "cc",
        "-I.",
        "-Icore/include",
        "more.c",
        "other_model_system.c",
        "build/libclutchwork.a",
        "-lm",
        "-o",
        "more",
    ]
    subprocess.run(command, cwd=built, check=True)
    assert subprocess.run([built / "more"], check=False).returncode == 0


def test_another_model_takes_the_library(built: Path, tmp_path: Path) -> None:
    """One whose kinds are all there: nothing of the core is compiled, and it computes its own numbers."""
    other = driveline(cooled=False)
    folder = cw.export_c(other, tmp_path / "other", t_end=0.3, dt=DT, rtol=1e-8, signals=["engine.speed"])
    shutil.rmtree(folder / "core")
    where = [f"CORE_DIR={built / 'core'}", f"LIBRARY={built / 'build' / 'libclutchwork.a'}"]
    subprocess.run(["make", "-C", folder, "model", "alone", *FLAGS, *where], capture_output=True, check=True)
    assert not list((folder / "build").glob("c_api.o"))
    _, columns = table(folder / "model")
    np.testing.assert_array_equal(columns[1], other.simulate(0.3, dt=DT, rtol=1e-8)["engine.speed"])


def test_a_whole_core_leaves_nothing_out(tmp_path: Path) -> None:
    folder = cw.export_c(driveline(), tmp_path, t_end=0.3, whole_core=True)
    text = (folder / "core/include/clutchwork/parts.gen.hpp").read_text()
    assert "#define CLUTCHWORK_ALONE" in text
    assert "CLUTCHWORK_TORQUE" not in text


def test_it_needs_no_heap_and_no_library_of_cpp(folder: Path, tmp_path: Path) -> None:
    """Of a bare machine: compiled as freestanding, and ended by any allocation."""
    bare = shutil.copytree(folder, tmp_path / "bare")
    made = subprocess.run(
        ["make", "-C", bare, "alone", *FLAGS, "FREESTANDING=1"], capture_output=True, text=True, check=False
    )
    assert made.returncode == 0, made.stdout + made.stderr
    assert (bare / "build-freestanding" / "c_api.o").is_file()


def test_the_event_is_told(built: Path) -> None:
    told = subprocess.run([built / "model"], capture_output=True, text=True, check=True).stderr
    events = [(e.time, e.element) for e in driveline().simulate(T_END, dt=DT, rtol=1e-8).events]
    found = [(float(line.split()[0]), line.split()[2]) for line in told.splitlines()]
    assert found == events


@feature("code: C and C++ of a model that holds the clutch")
def test_the_folder_holds_all_that_is_needed(folder: Path) -> None:
    """The core with its licence, the layout with units, and nothing that a second export would lose."""
    for name in ("layout", "declared", "registry"):
        assert (folder / f"core/include/clutchwork/{name}.gen.hpp").is_file()
    assert (folder / "core/LICENSE").is_file()
    header = (folder / "model.h").read_text(encoding="utf-8")
    assert "MODEL_ROW_ENGINE_SPEED = 0, /* engine.speed [rad/s] */" in header
    assert "MODEL_OUTSIDE = 1," in header
    assert f"MODEL_INPUTS = {len(driveline().assemble().inputs)}," in header
    assert "MODEL_INPUT_LOAD_TORQUE" in header
    assert "MODEL_PARAM_C1_GAIN" in header
    assert "MODEL_STATUS_DONE = 0," in header


def test_exporting_again_keeps_what_was_edited(tmp_path: Path) -> None:
    folder = cw.export_c(driveline(), tmp_path, t_end=1.0)
    (folder / "main.cpp").write_text("mine")
    before = {path: path.stat().st_mtime_ns for path in (folder / "core").rglob("*.hpp")}
    cw.export_c(driveline().assemble(), tmp_path, t_end=2.0, signals=["c1.slip"])
    assert (folder / "main.cpp").read_text() == "mine"
    assert "MODEL_T_END 2.0" in (folder / "model.h").read_text(encoding="utf-8")
    assert "MODEL_SIGNALS 1\n" in (folder / "model.h").read_text(encoding="utf-8")
    assert {path: path.stat().st_mtime_ns for path in before} == before


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "t_end is missing"),
        ({"t_end": 1.0, "signals": ["c1.slpi"]}, "did you mean 'c1.slip'"),
        ({"t_end": 1.0, "signals": ["c1.state"]}, "use c1.mode"),
        ({"t_end": 1.0, "times": [0.0, 1.0]}, "give dt"),
        ({"t_end": 100.0, "dt": 1e-5}, "use a larger dt"),
    ],
)
def test_what_cannot_be_exported(given: dict[str, Any], words: str, tmp_path: Path) -> None:
    with pytest.raises((ValueError, KeyError), match=words):
        cw.export_c(driveline(), tmp_path / "none", **given)
    assert not (tmp_path / "none").exists()


def test_the_command(root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = str(root / "examples/six_speed/model.toml")
    assert main(["export", model, "--out", str(tmp_path), "--t-end", "1", "--signals", "w1.speed, F1.torque"]) == 0
    assert "make -C" in capsys.readouterr().out
    header = (tmp_path / "model.h").read_text(encoding="utf-8")
    assert "#define MODEL_T_END 1.0" in header
    assert "#define MODEL_SIGNALS 2" in header
    assert main(["export", model, "--out", str(tmp_path), "--signals", "w1.sped"]) == 2
    assert "did you mean" in capsys.readouterr().err
