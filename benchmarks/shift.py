"""The shift benchmark: other programs, the hand-written floor and the Python layers against the generic core."""

from __future__ import annotations

import statistics
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import clutchwork as cw
from benchmarks.core import Prepared
from benchmarks.peers import by_c, driver, table
from benchmarks.report import Row
from benchmarks.timing import cpu, ratio, rounds, tenth_of
from clutchwork.results.time_grid import uniform
from support import six_speed

T_END = 4.0
TOLERANCES: dict[str, Any] = {"rtol": 1e-6, "atol": 1e-8}


def error(system: Any) -> float:
    """Largest speed error on the grid of the reference [rad/s]."""
    run = cw.simulate(system, T_END, times=driver.reference()[0], **TOLERANCES)
    return driver.error(np.column_stack([run[f"{name}.speed"] for name in ("w1", "w2", "w4", "w8")]))


def grid(system: Any) -> None:
    """A run of the core alone with a row each millisecond, in memory of its own."""
    run = Prepared(system, T_END, angles=1.0, work=1.0).run
    times = uniform(1e-3, 0.0, T_END)
    rows, at = np.empty((len(times), run.row_size)), 0
    while at < len(times):
        at += run.advance(T_END, times, rows, at, False)[1]
        run.events()


def everything(system: Any) -> None:
    """The output of a run as it is by default, and every signal of it."""
    run = cw.simulate(system, T_END, **TOLERANCES)
    for name in run.names:
        _ = run[name]


def from_python(system: Any) -> dict[str, Callable[[], float]]:
    """What a user calls, as contestants."""
    calls: dict[str, Callable[[], object]] = {
        "one row": lambda: cw.simulate(system, T_END, times=[T_END], **TOLERANCES),
        "default": lambda: everything(system),
        "grid": lambda: cw.simulate(system, T_END, dt=1e-3, **TOLERANCES),
        "assembly": lambda: six_speed.gearbox(six_speed.SHIFT).assemble(),
    }
    return {name: lambda call=call: cpu(call, 15) for name, call in calls.items()}  # type: ignore[misc]


def beside_floor(folder: Path, system: Any, turns: int) -> Iterator[Row]:
    """The core beside floor.cpp, in turns in one process."""
    data, what = folder / "system", "shift: {} / floor.cpp {}"
    data.write_bytes(system.to_bytes())
    try:
        found = by_c.paired(by_c.pair(folder), data, T_END, turns)
    except by_c.NotInstalledError as error:
        yield Row(what.format("Rodas5P", "Rodas5P"), str(error), "<= 0.58")
        return
    for name, goal in (("Rodas5P", 0.58), ("DOPRI5", None)):
        one = found[name.lower()]
        told = [f"{one.ratio:.2f}", f"a tenth below {one.core_tenth / one.floor_tenth:.2f}"]
        if one.floor_instructions:
            told.append(f"instructions {one.core_instructions / one.floor_instructions:.2f}")
        met = None if goal is None else one.ratio <= goal
        yield Row(what.format(name, name), ", ".join(told), "" if goal is None else f"<= {goal:g}", met)


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    prepared, full = Prepared(system, T_END), Prepared(system, T_END, angles=1.0, work=1.0)
    contestants = {"rodas5p": prepared.measure(100), "full": full.measure(100)}
    contestants |= from_python(system)
    contestants["core grid"] = lambda: cpu(lambda: grid(system), 15)
    worst = error(system)
    with tempfile.TemporaryDirectory() as folder:
        field = table.Field(Path(folder), worst)
        contestants |= field.contestants()
        floor = list(beside_floor(Path(folder), system, 300 if quick else 2000))
        # one round warms up what is compiled when it is first called
        taken = {name: times[1:] for name, times in rounds(contestants, 1 + (2 if quick else 7)).items()}
    count = prepared.statistics()
    ours, tenth = (1e6 * of(taken["rodas5p"]) for of in (statistics.median, tenth_of))
    told = f"{ours:.0f} us, a tenth below {tenth:.0f} us, {count['steps']} steps"
    yield Row("shift: Rodas5P, core alone", told)
    yield Row("shift: largest speed error at rtol 1e-6", f"{worst:.1e} rad/s", "<= 1e-5 rad/s", worst <= 1e-5)
    yield from floor
    yield from field.rows(taken, "rodas5p")
    yield Row("shift: with angles and work integrals / without", f"{ratio(taken['full'], taken['rodas5p']):.2f}")
    yield from python(taken)
    found = ratio(taken["grid"], taken["core grid"])
    yield Row("shift: from Python, 1 ms grid / core with these rows", f"{found:.2f} x", "<= 1.1 x", found <= 1.1)
    yield stiffness(quick)


def python(taken: dict[str, list[float]]) -> Iterator[Row]:
    """The lines of what a user calls."""
    found = ratio(taken["one row"], taken["full"])
    yield Row("shift: from Python, frozen System, one row / core", f"{found:.2f} x", "<= 2 x", found <= 2.0)
    middle, tenth = 1e3 * statistics.median(taken["default"]), 1e3 * tenth_of(taken["default"])
    words = f"{middle:.2f} ms, a tenth below {tenth:.2f} ms"
    yield Row("shift: from Python, default output, every signal read", words, "<= 1.5 ms", middle <= 1.5)
    middle = 1e3 * statistics.median(taken["assembly"])
    yield Row("six-speed gearbox: build and assemble", f"{middle:.1f} ms")


def stiffness(quick: bool) -> Row:
    """Run time over the stiffness of the shaft at the same damping ratio."""
    factors = (1.0, 10.0, 100.0, 1000.0)
    contestants = {}
    for factor in factors:
        system = six_speed.gearbox(six_speed.SHIFT, stiffer=factor).assemble()
        contestants[f"{factor:g}"] = Prepared(system, T_END).measure(100)
    taken = rounds(contestants, 2 if quick else 5)
    ratios = [ratio(taken[name], taken["1"]) for name in contestants]
    spread = max(ratios) / min(ratios)
    figures = " ".join(f"{r:.2f}" for r in ratios)
    return Row("shift: stiffness x1 x10 x100 x1000", f"{figures}: {spread:.2f} x", "within 1.4 x", spread <= 1.4)
