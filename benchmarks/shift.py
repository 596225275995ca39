"""The shift benchmark: hand-written floor, SciPy and CVODE against the generic core."""

from __future__ import annotations

import importlib
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import clutchwork as cw
from benchmarks.core import Prepared
from benchmarks.report import Row
from benchmarks.timing import cpu, ratio, rounds, wall
from support import six_speed

ROOT = Path(__file__).resolve().parents[1]
SHIFT = ROOT.parent / "shared" / "benchmarks" / "shift"
T_END = 4.0


def floor(folder: Path) -> Callable[[str], float]:
    """Compile floor.cpp; a function that gives the seconds of one of its methods at rtol 1e-6."""
    program = folder / "floor"
    subprocess.run(
        ["g++", "-O3", "-std=c++20", "-pthread", "-w", str(SHIFT / "floor.cpp"), "-o", str(program)], check=True
    )

    def seconds(method: str) -> float:
        text = subprocess.run([str(program)], cwd=SHIFT, capture_output=True, text=True, check=True).stdout
        found = re.search(rf"^{method}\s+rtol 1e-06 med ([\d.]+) us", text, re.MULTILINE)
        if not found:
            raise RuntimeError(f"floor.cpp printed no line for {method}")
        return 1e-6 * float(found[1])

    return seconds


def peer(module: str) -> Any:
    """One of the given peers, imported by path; None when what it needs is not installed."""
    if str(SHIFT) not in sys.path:
        sys.path.insert(0, str(SHIFT))
    try:
        return importlib.import_module(module)
    except ImportError:
        return None


def error(times: np.ndarray, reference: np.ndarray, system: Any) -> float:
    """Largest speed error on the grid of reference.csv [rad/s]."""
    run = cw.simulate(system, T_END, times=times, rtol=1e-6, atol=1e-8)
    return max(
        float(np.max(np.abs(run[f"{w}.speed"] - reference[:, i]))) for i, w in enumerate(("w1", "w2", "w4", "w8"))
    )


def everything(system: Any) -> None:
    """Every signal on a 1 ms grid, from Python."""
    run = cw.simulate(system, T_END, dt=1e-3, rtol=1e-6, atol=1e-8)
    for name in run.names:
        _ = run[name]


def peers(ours: float) -> Iterator[Row]:
    """SciPy and CVODE, each with the runs of their own script."""
    for module, method in (("run_scipy", "LSODA"), ("run_cvode", "BDF"), ("run_cvode", "Adams")):
        script = peer(module)
        name = f"shift: {'SciPy' if 'scipy' in module else 'CVODE'} {method}"
        if script is None:
            yield Row(name, "not installed")
            continue
        taken = cpu(lambda s=script, m=method: s.simulate(m), 3)
        yield Row(name, f"{1e3 * taken:.0f} ms = {taken / ours:.0f} x ours", ">= 500 x ours", taken / ours >= 500)


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    prepared = {m: Prepared(system, T_END, m) for m in ("rodas5p", "dopri5")}
    full = Prepared(system, T_END, angles=1.0, work=1.0)
    contestants = {m: p.measure(100) for m, p in prepared.items()} | {"full": full.measure(100)}
    here = SHIFT.is_dir()
    with tempfile.TemporaryDirectory() as folder:
        if here:
            compiled = floor(Path(folder))
            contestants |= {"floor": lambda: compiled("Rodas5P"), "floor dopri5": lambda: compiled("DP5")}
        taken = rounds(contestants, 2 if quick else 7)
    ours = sorted(taken["rodas5p"])[len(taken["rodas5p"]) // 2]
    count = prepared["rodas5p"].statistics()
    yield Row("shift: Rodas5P, core alone", f"{1e6 * ours:.0f} us, {count['steps']} steps")
    if here:
        found = ratio(taken["rodas5p"], taken["floor"])
        yield Row("shift: Rodas5P / floor.cpp Rodas5P", f"{found:.2f}", "<= 1.0", found <= 1.0)
        yield Row("shift: DOPRI5 / floor.cpp DOPRI5", f"{ratio(taken['dopri5'], taken['floor dopri5']):.2f}")
    else:
        yield Row("shift: Rodas5P / floor.cpp Rodas5P", "floor.cpp not at hand", "<= 1.0")
    yield Row("shift: with angles and work integrals / without", f"{ratio(taken['full'], taken['rodas5p']):.2f}")
    if here:
        yield from peers(ours)
        data = np.loadtxt(SHIFT / "reference.csv", delimiter=",", skiprows=1)
        worst = error(data[:, 0], data[:, 1:5], system)
        yield Row("shift: largest speed error at rtol 1e-6", f"{worst:.1e} rad/s", "<= 1e-5 rad/s", worst <= 1e-5)
    grid = wall(lambda: cw.simulate(system, T_END, dt=1e-3, rtol=1e-6, atol=1e-8), 15)
    yield Row("shift: from Python, 1 ms grid", f"{1e3 * grid:.2f} ms", "<= 3 ms", grid <= 3e-3)
    grid = wall(lambda: everything(system), 7)
    yield Row("shift: the same, every signal looked at", f"{1e3 * grid:.2f} ms")
    assembly = wall(lambda: six_speed.gearbox(six_speed.SHIFT).assemble(), 5)
    yield Row("six-speed gearbox: build and assemble", f"{1e3 * assembly:.1f} ms")
    yield stiffness(quick)


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
