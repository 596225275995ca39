"""What a model must agree with: tighter runs, its twins, itself saved, loaded, continued and given out otherwise."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.declare.layout import STATUSES
from support.any_model import rows
from support.any_model.model import driveline, refused
from support.any_model.seen import Fault
from support.any_model.twins import TWINS
from support.any_model.values import Plain, Rng

TIGHT: Plain = {"rtol": 1e-9, "atol": 1e-11}
TIGHTER: Plain = {"rtol": 1e-10, "atol": 1e-12}
# instants at which runs are compared
GRID = 14
# how far twins may be apart, of the largest speed of a node; and beside what tolerances change
APART, NOISE = 3e-5, 100.0
# what a run at its own tolerance may miss
COARSE = 1e-3


def run(made: Plain, **options: Any) -> Any:
    """A run of plain data, with other options than its own."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return driveline(made).simulate(**options)


def grid(made: Plain) -> list[float]:
    """Instants of the comparison."""
    begin, end = _begin(made), made["simulation"]["t_end"]
    return [*(float(t) for t in begin + (end - begin) * np.linspace(0.037, 0.97, GRID - 1)), end]


def _begin(made: Plain) -> float:
    return float(made["simulation"].get("t_start", 0.0))


def apart(one: Any, other: Any, sign: float = 1.0) -> tuple[float, str]:
    """How far the speeds of two runs are apart, of their size, and whose they are."""
    sizes = {node.name: float(np.abs(one[f"{node.name}.speed"]).max(initial=0.0)) for node in one.wiring.nodes}
    most, worst, whose = max(sizes.values(), default=0.0), 0.0, ""
    for name, size in sizes.items():
        if f"{name}.speed" not in other:
            continue
        a, b = one[f"{name}.speed"], sign * other[f"{name}.speed"]
        error = float(np.abs(a - b).max(initial=0.0)) / (size + 1e-3 * most + 1e-4)
        if error > worst:
            at = int(np.argmax(np.abs(a - b)))
            worst, whose = error, f"{name}.speed {a[at]:.9g} and {b[at]:.9g} at {one.time[at]:.9g} s"
    return worst, whose


def faults(made: Plain, base: Any, seed: int, depth: int, only: str = "") -> Iterator[Fault]:
    """What does not agree with a run of a model; `only`: the kind of fault that is looked for."""
    times = grid(made)
    tight, tighter = (run(made, times=times, **options) for options in (TIGHT, TIGHTER))
    ended = [one for one in (tight, tighter) if one.status != "done"]
    if ended:
        yield Fault("tight status", ended[0].status, ended[0].message[:200])
        return
    noise, whose = apart(tight, tighter)
    # of twins, each by numbers of its own, so that one can be looked at alone
    twins = {name: np.random.default_rng([seed, 75, number]) for number, name in enumerate(TWINS)}
    words = {f"{sort} {name} {status}".strip(): name for name in TWINS for sort, status in _sorts()}
    if only in words:
        yield from _twin(words[only], made, tight, noise, times, twins[words[only]])
        return
    if noise > APART:
        yield Fault("sensitive", "", f"rtol 1e-9 and 1e-10 are {noise:.1e} apart: {whose}")
    missed, whose = apart(base.at(times), tight)
    if missed > max(COARSE, 1e3 * base.options.rtol, NOISE * noise):
        yield Fault("tolerance", "", f"rtol {base.options.rtol:g} and 1e-9 are {missed:.1e} apart: {whose}")
    yield from _same(made, base, times, np.random.default_rng([seed, 74]))
    if depth < 2:
        return
    yield from (fault._replace(kind=f"tight {fault.kind}") for fault in rows.faults(run(made, **TIGHT)))
    for name, rng in twins.items():
        yield from _twin(name, made, tight, noise, times, rng)


def _sorts() -> list[tuple[str, str]]:
    return [("twin", ""), *(("twin status", status) for status in STATUSES)]


def _twin(name: str, made: Plain, tight: Any, noise: float, times: list[float], rng: Rng) -> Iterator[Fault]:
    other = TWINS[name](made, rng)
    if other is None or refused(other):
        return
    settings, late = other["simulation"], _begin(other) - _begin(made)
    instants = [min(t + late, settings["t_end"]) for t in times]
    found = run(other, times=instants, **TIGHT)
    # an explicit method spends any budget where the motion is stiff
    if found.status == "too_many_steps" and settings.get("method") == "dopri5":
        return
    if found.status != "done":
        yield Fault("twin status", f"{name} {found.status}", found.message[:200])
        return
    error, whose = apart(tight, found, -1.0 if name == "mirrored" else 1.0)
    if error > max(APART, NOISE * noise):
        yield Fault("twin", name, f"{error:.1e} apart (noise {noise:.1e}): {whose}")


def _same(made: Plain, base: Any, times: list[float], rng: Rng) -> Iterator[Fault]:
    """What must be the same: other output, no work, saved and loaded, continued."""
    again, asked = base.at(times), run(made, times=times)
    if not np.array_equal(again.rows, asked.rows):
        yield Fault("bits", "of a grid", f"{np.abs(again.rows - asked.rows).max():.3g}")
    less = run(made, times=times, work=False, angles=False)
    missed, whose = apart(again, less) if less.status == "done" else (np.inf, less.message)
    if missed > max(COARSE, 1e3 * base.options.rtol):
        yield Fault("bits", "without work and angles", f"{missed:.1e} apart: {whose}")
    with TemporaryDirectory() as folder:
        yield from _saved(made, base, Path(folder), again)
    steps = run(made, output="steps")
    places = np.unique(steps.time)[:-1]
    yield from _continued(made, steps, float(rng.choice(places)), exact=True)
    yield from _continued(made, steps, float(rng.uniform(places[0], places[-1])), exact=False)


def _saved(made: Plain, base: Any, folder: Path, again: Any) -> Iterator[Fault]:
    try:
        driveline(made).save(folder / "m.toml")
        loaded = cw.Driveline.load(folder / "m.toml").simulate(times=again.time)
        if not np.array_equal(loaded.rows, again.rows):
            yield Fault("bits", "of a saved model", apart(again, loaded)[1])
    except cw.ClutchworkError as error:
        yield Fault("lost", "model", str(error)[:300])
    try:
        base.save(folder / "r.run")
        read = cw.load_run(folder / "r.run")
        same = all(np.array_equal(getattr(read, name), getattr(base, name)) for name in ("rows", "time"))
        if not same or read.status != base.status or list(read.events) != list(base.events):
            yield Fault("bits", "of a saved run", "rows, events or status differ")
    except (cw.ClutchworkError, ValueError) as error:
        yield Fault("lost", "run", str(error)[:300])


def _continued(made: Plain, steps: Any, at: float, *, exact: bool) -> Iterator[Fault]:
    """From a state: at a step to the last bit, in between to the tolerance."""
    try:
        found = run(made, start=steps.state(at=at), output="steps")
    except cw.ClutchworkError as refusal:
        yield Fault("state", "refused", f"at {at!r} s: {str(refusal)[:200]}")
        return
    if found.status != "done":
        yield Fault("state", found.status, f"at {at!r} s: {found.message[:200]}")
        return
    differ = int((found.rows[-1] != steps.rows[-1]).sum())
    error, whose = apart(*(one.at([one.t_end]) for one in (steps, found)))
    if exact and differ:
        words = f"at {at!r} s: {differ} numbers of the last row, speeds by {error:.2g} of their size"
        yield Fault("bits", "after a state at a step", words)
    if error > max(COARSE, 1e4 * steps.options.rtol):
        yield Fault("state", "other motion", f"at {at!r} s {error:.1e} apart: {whose}")
