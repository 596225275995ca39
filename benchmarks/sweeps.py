"""Many variants of the six-speed shift in one call, against the same loop in C++; and numbers changed one at a time."""

from __future__ import annotations

import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import clutchwork as cw
from benchmarks.core import place
from benchmarks.peers.by_c import core_objects
from benchmarks.report import Row
from benchmarks.timing import cpu, ratio, rounds
from support import six_speed

ROOT = Path(__file__).resolve().parents[1]
T_END = 4.0
FIRST, LAST = 0.2, 0.3
NAME = "F1.gain"
MOST_TO_CHANGE = 20e-6  # s
PLAIN: dict[str, Any] = {"angles": False, "work": False}


class Taken(NamedTuple):
    """Time on the wall and of the processors [s]."""

    wall: float
    processor: float


def sweep(system: cw.System, variants: int, threads: int, outputs: Any = "w8.speed", **options: Any) -> Taken:
    """One call from Python."""
    vary = {NAME: np.linspace(FIRST, LAST, variants)}
    started, used = time.perf_counter(), time.process_time()
    found = cw.sweep(system, T_END, vary=vary, outputs=outputs, threads=threads, **options)
    taken = Taken(time.perf_counter() - started, time.process_time() - used)
    assert found.finished.all()
    return taken


class Loop(NamedTuple):
    """The loop in C++: a program and its arguments but for the threads."""

    program: Path
    before: tuple[str, ...]

    def run(self, threads: int, copies: int = 1) -> Taken:
        """Copies of the program side by side; the time of the slowest one."""
        command = [str(self.program), *self.before, str(threads), str(T_END), "0"]
        running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(copies)]
        texts = [one.communicate()[0].split()[:2] for one in running]
        assert all(one.returncode == 0 for one in running), command
        return Taken(*(max(float(text[i]) for text in texts) for i in range(2)))


def loop(folder: Path, system: cw.System, variants: int) -> Loop | None:
    """With the core of this build; None where there is none."""
    objects = core_objects()
    if not objects:
        return None
    program, data = folder / "sweep_loop", folder / "system"
    command = [
        "c++",
        "-O3",
        "-std=c++20",
        "-pthread",
        f"-I{ROOT / 'cpp/include'}",
        str(ROOT / "benchmarks/sweep_loop.cpp"),
    ]
    subprocess.run([*command, *objects, "-o", str(program)], check=True)
    data.write_bytes(system.to_bytes())

    return Loop(program, (str(data), str(place(system, NAME)), str(FIRST), str(LAST), str(variants)))


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    variants, again = (1000, 3) if quick else (10_000, 5)
    with tempfile.TemporaryDirectory() as folder:
        compiled = loop(Path(folder), system, variants)
        yield from measured(system, compiled, variants, again)
    yield from changing(system)


def measured(system: cw.System, compiled: Loop | None, variants: int, again: int) -> Iterator[Row]:
    """Shifts a second, and ratios within rounds."""
    kept = dict[str, list[Taken]]()

    def contestant(name: str, run: Callable[[], Taken], processor: bool) -> Callable[[], float]:
        def seconds() -> float:
            taken = run()
            kept.setdefault(name, []).append(taken)
            return taken.processor if processor else taken.wall

        return seconds

    all_of = [cw.lock("F1"), "F1.heat", cw.peak("shaft.torque"), "w8.speed"]
    contestants = {
        "two": contestant("two", lambda: sweep(system, variants, 2, **PLAIN), True),
        "one": contestant("one", lambda: sweep(system, variants, 1, **PLAIN), False),
        "full": contestant("full", lambda: sweep(system, variants, 2, all_of), True),
    }
    if compiled is not None:
        contestants["loop"] = contestant("loop", lambda: compiled.run(2), True)
        contestants["copy"] = contestant("copy", lambda: compiled.run(1), False)
        contestants["copies"] = contestant("copies", lambda: compiled.run(1, copies=2), False)
    taken = rounds(contestants, again)
    each = min(one.wall for one in kept["two"]) / variants
    yield Row(
        "sweep: shifts from one Python call, two threads",
        f"{1 / each:.0f} a second",
        ">= 35 000 a second",
        each <= 1 / 35_000,
    )
    full = min(one.wall for one in kept["full"]) / variants
    words = "sweep: the same with work, lock-up, heat and peak torque"
    yield Row(words, f"{1 / full:.0f} a second", ">= 20 000 a second", full <= 1 / 20_000)
    if compiled is None:
        yield Row("sweep / the same loop in C++, processor time", "no build at hand", "<= 1.15")
    else:
        found = ratio(taken["two"], taken["loop"])
        yield Row("sweep / the same loop in C++, processor time", f"{found:.2f}", "<= 1.15", found <= 1.15)
    one, two = (min(one.wall for one in kept[name]) for name in ("one", "two"))
    share = one / (2 * two)
    yield Row("sweep: efficiency of two threads", f"{100 * share:.0f} %", ">= 95 %", share >= 0.95)
    if compiled is not None:
        # what the machine gives to two programs that share nothing
        copy, copies = (min(one.wall for one in kept[name]) for name in ("copy", "copies"))
        yield Row("sweep: efficiency of two copies of the loop in C++", f"{100 * copy / copies:.0f} %")


def changing(system: cw.System) -> Iterator[Row]:
    """System.changed with one number."""
    ramp = cw.Table([(t, 0.9 * p) for t, p in six_speed.SHIFT["F1"]])
    changes: dict[str, dict[str, Any]] = {
        "a parameter": {"F1.gain": 0.3},
        "a signal": {"F1.pressure": ramp},
        "an initial speed": {"w1.speed": 3.0},
        "an inertia": {"w1.inertia": 20.0},
        "a ratio": {"row1.ratio": 1.9},
    }
    for what, change in changes.items():
        each = cpu(lambda change=change: system.changed(change), 200)  # type: ignore[misc]
        asked = what in ("a parameter", "a signal", "an inertia")
        met = each <= MOST_TO_CHANGE if asked else None
        yield Row(f"System.changed: {what}", f"{1e6 * each:.0f} us", "<= 20 us" if asked else "", met)
