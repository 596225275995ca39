"""An exported core whose steps of one length have single precision: docs/theory/fixed-steps.md."""

from __future__ import annotations

import io
import platform
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support import six_speed

SPEEDS = ("w1", "w2", "w4", "w8")
END = 4.0
# the core without optimisation, but for the steps, whose instructions are looked at
PLAIN, STEPS = "-O0 -DCLUTCHWORK_HOT=inline", "-O1 -DCLUTCHWORK_HOT=inline"
# what may compute with doubles: instants, the step on the grid in front of it, rows and events
IN_DOUBLE = re.compile(
    r"\b(advance_steps|take_step|finish_step|make_step|emit|emit_inside|emit_end|show_present|fill_row|report|"
    r"report_changes|record|fail|signal_value|since_start|seek|load_inputs|inputs_at|signal_range|load_may_turn|"
    r"place_process_inputs|early|take_down|take_up|take_whole|take_signals|carry|split|decide_start|place|lay_numbers|"
    r"single_size|pack|refresh_loads|is_finite|carry_cursor|move_signals|join_parts)\b"
)
ARITHMETIC = re.compile(r"v?(add|sub|mul|div|sqrt|min|max|round|cvt\w*)(sd|pd)\w*|v?cvt\w+2(sd|pd)")

MAIN = r"""
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "model.h"
static _Alignas(16) unsigned char memory[MODEL_MEMORY], other[MODEL_MEMORY], state[1 << 20];
static double row[MODEL_ROW_SIZE], again[MODEL_ROW_SIZE];

static cw_run *load(void *at, const char *step, double start) {
  cw_run *run = cw_load(model_system, MODEL_SYSTEM_BYTES, at, MODEL_MEMORY);
  if (!run || !model_set_options(run)) exit(2);
  if (!cw_set_option(run, "step", atof(step)) || !cw_set_option(run, "t_start", start)) exit(3);
  return run;
}
static void show(cw_run *run) {
  if (cw_row(run, row) != MODEL_STATUS_DONE) exit(4);
  printf("%.17g", cw_time(run));
  for (int k = 0; k < MODEL_SIGNALS; ++k) printf(",%.17g", model_signals[k].value(row));
  printf("\n");
}

/* The row of the present is the one that was shown last. */
static void show_no_other(cw_run *run) {
  if (cw_row(run, again) != MODEL_STATUS_DONE || memcmp(row, again, sizeof row) != 0) exit(7);
}
/* The last signal, the pressure of F4, gets the value that it has, which is a knot; steps refuse waves. */
static void set(cw_run *run, double time) {
  double value[12] = {1.0, [4] = 1.0, [5] = 2.0};
  if (cw_set_segments(run, MODEL_INPUTS - 1, &time, value, 1)) exit(8);
  if (!cw_set_input(run, MODEL_INPUTS - 1, 2e6)) exit(9);
}

/* model_single STEP START SPAN ROWS HOW: rows on a grid; how "saved": through a saved state after each; "set": a signal
   is set after each; "late": without a row at the start */
int main(int n, char **word) {
  if (n != 6 || cw_size(model_system, MODEL_SYSTEM_BYTES) > MODEL_MEMORY) return 1;
  const double start = atof(word[2]), span = atof(word[3]);
  const int rows = atoi(word[4]);
  cw_run *run = load(memory, word[1], start), *next = load(other, word[1], start);
  for (int k = strcmp(word[5], "late") == 0; k <= rows; ++k) {
    if (cw_advance(run, start + span * k / rows, NULL, NULL, 0, 0, NULL) != MODEL_STATUS_DONE) return 5;
    show(run);
    if (strcmp(word[5], "set") == 0 && k > 0) set(run, cw_time(run)), show_no_other(run);
    if (strcmp(word[5], "saved") != 0) continue;
    const int64_t size = cw_save(run, state, sizeof state);
    if (size < 0 || !cw_restore(next, state, size)) return 6;
    cw_run *was = run;
    run = next, next = was;
    if (k > 0) show_no_other(run);
  }
  return 0;
}
"""


# the largest error of each elementary function, in units of the last place of a single
ELEMENTARY = r"""
#include <clutchwork/run/fixed/torques.hpp>
#include <cstdio>
using namespace clutchwork;
template <class F, class G>
void check(const char *name, double low, double high, F f, G g, double least = 0) {
  double worst = 0;
  for (int i = 0; i <= 20000; ++i) {
    const float x = float(low + (high - low) * i / 20000);
    const double wanted = g(double(x)), size = std::fabs(wanted) > least ? std::fabs(wanted) : least;
    const double off = std::fabs(double(f(Single(x)).v) - wanted) / size * 0x1p23;
    if (!(off <= worst)) worst = off;
  }
  std::printf("%s %g\n", name, worst);
}
#define CHECK(NAME, ...) check(#NAME, __VA_ARGS__)
#define OF(NAME) [](Single x) { return NAME(x); }, [](double x) { return std::NAME(x); }
int main() {
  CHECK(exp, -87, 88, OF(exp)), CHECK(log, 1e-6, 8, OF(log)), CHECK(log, 0.9, 1.1, OF(log));
  CHECK(sin, -100, 100, OF(sin), 1e-3), CHECK(cos, -100, 100, OF(cos), 1e-3);
  CHECK(tanh, -12, 12, OF(tanh)), CHECK(atan, -20, 20, OF(atan)), CHECK(cbrt, 1e-6, 100, OF(cbrt));
  const double powers[] = {-3.0, -0.5, 0.7, 2.5, 9.0};
  for (const double y : powers)
    CHECK(pow, 1e-3, 50, [&](Single x) { return pow(x, Single(y)); },
          [&](double x) { return std::pow(x, double(float(y))); });
  // of a state with a rate of its own, down to where it is a half
  CHECK(share, -39, -0.002, [](Single z) { return fixed::share_of(z); },
        [](double z) { return 1 / z - 1 / std::expm1(z); });
}
"""


def later(start: float) -> cw.Driveline:
    """The shift, as late as asked."""
    pressures = {
        name: cw.Table([(start + time, pressure) for time, pressure in points])
        for name, points in six_speed.SHIFT.items()
    }
    return six_speed.gearbox(pressures)


def export(d: cw.Driveline, folder: Path) -> Path:
    shown = [*(f"{name}.speed" for name in SPEEDS), "F1.pressure", "F4.mode", "F4.slip", "w5.speed"]
    steps = {"method": "fixed", "step": 1e-3, "precision": "single"}
    return cw.export_c(d, folder, t_end=END, dt=2e-3, signals=shown, **steps)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if any(shutil.which(tool) is None for tool in ("cc", "c++", "make")):
        pytest.skip("needs cc, c++ and make")
    folder = export(later(0.0), tmp_path_factory.mktemp("single") / "shift")
    make = ["make", "-j2", "-C", folder, "CFLAGS=-O1"]
    for target, flags in (("build/fixed_steps.o", STEPS), ("model", PLAIN)):
        made = subprocess.run([*make, target, f"CXXFLAGS={flags}"], capture_output=True, text=True, check=False)
        assert made.returncode == 0, made.stdout + made.stderr
    program(folder, folder)
    return folder


def program(folder: Path, core: Path) -> None:
    """The program of these tests for the model in a folder."""
    (folder / "single.c").write_text(MAIN)
    parts = ["single.c", "model.c", "model_system.c", f"{core}/build/libclutchwork.a", "-lm", "-o", "model_single"]
    command = ["cc", "-std=c11", "-O1", "-I.", "-Icore/include", *parts]
    subprocess.run(command, cwd=folder, check=True)


def table(folder: Path, step: float, rows: int, *, start: float = 0.0, how: str = "plain") -> np.ndarray:
    command = [folder / "model_single", repr(step), repr(start), repr(END), str(rows), how]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return np.loadtxt(io.StringIO(done.stdout), delimiter=",").T


@pytest.mark.parametrize("step", [1e-3, 1e-4])
def test_the_shift_is_as_exact_as_in_double(built: Path, step: float) -> None:
    """Within a fifth; with sums that keep nothing the errors are several times as large, most at small steps."""
    system, times = later(0.0).assemble(), np.linspace(0.0, END, 2001)
    exact = cw.simulate(system, END, times=times, rtol=1e-11, atol=1e-11)
    double = cw.simulate(system, END, times=times, method="fixed", step=step)
    single = table(built, step, 2000)

    def error(found: Any) -> float:
        return float(max(np.abs(found(k) - exact[f"{name}.speed"]).max() for k, name in enumerate(SPEEDS)))

    of_double, of_single = error(lambda k: double[f"{SPEEDS[k]}.speed"]), error(lambda k: single[k + 1])
    assert of_single < 1.2 * of_double, (of_single, of_double)


def test_a_stuck_brake_stays_stuck(built: Path) -> None:
    """To the last bit in its slip; and its shaft does not creep by round-off, over 40 000 steps."""
    columns = table(built, 1e-4, 400)
    mode, slip, speed = columns[-3:]
    assert np.all(mode == 0)
    assert np.all(slip == 0.0)
    # round-off of speeds of 200 rad/s
    assert np.abs(speed).max() < 1e-4


def test_a_day_later_it_is_the_same(built: Path, tmp_path: Path) -> None:
    """Instants are not rounded: after a day, where a single has hundredths of a second, the shift is the same."""
    start = 86400.0
    folder = export(later(start), tmp_path)
    program(folder, built)
    first, second = table(built, 1e-3, 40), table(folder, 1e-3, 40, start=start)
    np.testing.assert_array_equal(second[0], start + first[0])
    # round-off of the instants in double
    np.testing.assert_allclose(second[1:5], first[1:5], rtol=0.0, atol=2e-4)


def five(names: list[str], speed: float, **law: float) -> cw.Driveline:
    """Five clutches between the same shafts, up to where they let go together."""
    d = cw.Driveline("five")
    a, b = d.shaft("a", inertia=0.3, speed=speed), d.shaft("b", inertia=2.0, speed=speed)
    for i, name in enumerate(names):
        pressure = cw.Table([(0.0, 2e5), (3.0, 6e4 / (1 + i))])
        friction = cw.Exponential(**{**six_speed.LAW, **law})
        d.add(cw.Clutch(name, base=a, follower=b, friction=friction, gain=2e-3 * 3.0**-i, pressure=pressure))
    d.add(cw.SpeedTorque("engine", shaft=a, torque=[(0.0, 60.0), (500.0, 50.0)]))
    d.add(cw.ResistingTorque("load", shaft=b, torque=55.0, speed=0.5))
    return d


def test_contacts_that_depend_on_each_other_share_as_in_double(built: Path, tmp_path: Path) -> None:
    """Within the round-off of a slip."""
    names = [f"c{i}" for i in range(5)]
    d = five(names, 20.0)
    shown = ["a.speed", "b.speed", *(f"{name}.torque" for name in names)]
    steps: dict[str, Any] = {"method": "fixed", "step": 1e-3}
    folder = cw.export_c(d, tmp_path, t_end=END, dt=2e-3, signals=shown, precision="single", **steps)
    program(folder, built)
    columns, run = table(folder, 1e-3, 400), d.simulate(END, times=np.linspace(0.0, END, 401), **steps)
    assert {event.before for event in run.events} == {"locked"}
    for name, column in zip(shown, columns[1:], strict=True):
        # a torque that holds has the round-off of a slip over the length of a step
        np.testing.assert_allclose(column, run[name], rtol=0.0, atol=1e-4 * np.abs(run[name]).max(), err_msg=name)


def test_a_fast_shaft_breaks_away_in_the_same_step(built: Path, tmp_path: Path) -> None:
    """Slips are compared with their own round-off, not with that of speeds of 500 rad/s."""
    names = [f"c{i}" for i in range(5)]
    # without more torque at rest slips begin slowly
    d = five(names, 500.0, static=six_speed.LAW["slow"])
    steps: dict[str, Any] = {"method": "fixed", "step": 1e-3}
    shown = [f"{name}.mode" for name in names]
    folder = cw.export_c(d, tmp_path, t_end=END, dt=2e-3, signals=shown, precision="single", **steps)
    program(folder, built)
    modes, run = table(folder, 1e-3, 4000)[1:], d.simulate(END, times=np.linspace(0.0, END, 4001), **steps)
    for name, column in zip(names, modes, strict=True):
        double, single = (np.flatnonzero(np.diff(mode)) for mode in (run[f"{name}.mode"], column))
        assert len(double) > 0
        assert len(double) == len(single), (name, double, single)
        assert np.abs(double - single).max() <= 1, (name, double, single)


def test_elementary_functions(built: Path) -> None:
    """Within two units of the last place."""
    (built / "elementary.cpp").write_text(ELEMENTARY)
    flags = ["-std=c++20", "-O1", "-ffp-contract=off", "-I.", "-Icore/include"]
    subprocess.run(["c++", *flags, "elementary.cpp", "-o", "elementary"], cwd=built, check=True)
    told = subprocess.run([built / "elementary"], capture_output=True, text=True, check=True).stdout
    worst = [(float(line.split()[1]), line.split()[0]) for line in told.splitlines()]
    assert len(worst) == 14
    # the difference of two numbers of which each is seven times as large
    assert worst.pop()[0] < 16.0
    assert max(worst)[0] < 2.0, worst


def test_saved_states_and_calls_change_no_bit(built: Path) -> None:
    """And a row of the present is the same behind them, with the signals that nobody has set."""
    for how in ("saved", "set"):
        np.testing.assert_array_equal(table(built, 1e-3, 40, how=how), table(built, 1e-3, 40))
    np.testing.assert_array_equal(table(built, 1e-3, 400)[:, ::10], table(built, 1e-3, 40))


def test_a_start_that_is_no_single_and_a_signal_that_waits(built: Path, tmp_path: Path) -> None:
    """A row at the start, which decides it twice, loses nothing of a speed; a pulse that has not begun is saved so."""
    pulse = cw.Pulse(offset=2e6, height=-1e5, period=1.0, width=0.5, start=1.0)
    folder = export(six_speed.gearbox({**six_speed.SHIFT, "F4": pulse}, {"w1": 100.1}), tmp_path)
    program(folder, built)
    plain = table(folder, 1e-3, 40)
    np.testing.assert_array_equal(table(folder, 1e-3, 40, how="saved"), plain)
    np.testing.assert_array_equal(table(folder, 1e-3, 40, how="late"), plain[:, 1:])


@pytest.mark.skipif(platform.machine() != "x86_64" or not shutil.which("objdump"), reason="reads code of x86")
def test_nothing_is_computed_with_doubles(built: Path) -> None:
    """But instants, and what the caller gets in double."""
    command = ["objdump", "-dC", "--no-show-raw-insn", built / "build" / "fixed_steps.o"]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    where, found, seen = "", set(), set()
    for line in text.splitlines():
        if head := re.match(r"[0-9a-f]+ <(.*)>:$", line):
            where = head[1]
            seen.add(where)
        elif (code := re.match(r"\s+[0-9a-f]+:\s+(\S+)", line)) and ARITHMETIC.fullmatch(code[1]):
            found.add(where)
    # events before the first step are those of the phases between events
    single = {name for name in found if "Single" in name or "fixed::" in name}
    assert any("fixed::predict" in name for name in seen)
    assert [name for name in single if not IN_DOUBLE.search(name)] == []


@pytest.mark.skipif(not shutil.which("nm"), reason="needs binutils")
def test_its_readme_names_what_it_needs_of_a_c_library(built: Path) -> None:
    command = ["nm", built / "build" / "libclutchwork.a"]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    words = [line.split() for line in text.splitlines() if line.strip() and not line.endswith(":")]
    asked = {one[-1] for one in words if one[-2] == "U"} - {one[-1] for one in words if one[-2] != "U"}
    needed = {name for name in asked if not name.startswith("_")}
    assert "fmodf" in needed
    assert needed <= set(re.findall(r"\w+", (built / "README.md").read_text())) | {"ceil", "trunc", "ceilf", "truncf"}


def test_what_single_precision_refuses(tmp_path: Path) -> None:
    """By name, all at once."""
    d = cw.Driveline("refused")
    a, b = d.shaft("a", inertia=1.0, speed=5.0), d.shaft("b", inertia=1.0)
    d.add(cw.Torque("drive", shaft=a, torque=cw.Sine(amplitude=10.0, frequency=1.0)))
    d.add(cw.Backlash("play", base=a, follower=b, gap=0.1))
    d.add(cw.PrescribedSpeed("dyno", shaft=d.shaft("c", inertia=1.0), speed=5.0))
    with pytest.raises(ValueError, match="precision is 'single'") as refused:
        cw.export_c(d, tmp_path / "none", t_end=1.0, precision="single")
    words = str(refused.value)
    assert all(word in words for word in ("method='fixed'", "'play'", "'drive.torque'", "'dyno.speed'")), words
    with pytest.raises(ValueError, match="'double' or 'single'"):
        cw.export_c(d, tmp_path / "none", t_end=1.0, precision="half")
    assert not (tmp_path / "none").exists()
