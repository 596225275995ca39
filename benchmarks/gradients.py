"""Derivatives of the six-speed shift over plain runs, from Python: values and derivatives at a new point each time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

import clutchwork as cw
from benchmarks import coupled
from benchmarks.report import Row
from benchmarks.timing import cpu, ratio, rounds
from support import six_speed

T_END = 4.0
TOLERANCES: dict[str, Any] = {"rtol": 1e-6, "atol": 1e-8}
ONE = ["F2.friction.static"]
EIGHT = [f"{name}.{number}" for name in ("F1", "F2", "F4") for number in ("friction.static", "gain")]
EIGHT += [f"{name}.friction.slow" for name in ("F1", "F2")]
# ordinates of the pressure of the oncoming clutch
HUNDRED = [f"F1.pressure.values[{knot}]" for knot in range(1, 101)]
# so many are followed back
LAW = [f"friction.{field}" for field in six_speed.LAW]
MANY = [f"{name}.{number}" for name in six_speed.CLUTCHES for number in ("gain", *LAW)]
MANY += ["shaft.stiffness", "shaft.damping"]
# model, numbers, most plain runs
ASKED: dict[str, tuple[str, list[str], float | None]] = {
    "one number": ("shift", ONE, 2.0),
    "eight numbers": ("shift", EIGHT, 4.0),
    "100 numbers": ("fine", HUNDRED, 15.0),
    "followed back, 17 numbers": ("shift", MANY, 6.0),
    "coupled clutches, one number": ("coupled", ["clutch1.gain"], None),
}


def system() -> cw.System:
    """The shift, with a pressure of a hundred points, which is never zero: there it has no derivative."""
    instants, values = zip(*six_speed.SHIFT["F1"], strict=True)
    fine = np.linspace(0.0, T_END, 100)
    points = list(zip(fine.tolist(), np.maximum(np.interp(fine, instants, values), 2e4).tolist(), strict=True))
    return six_speed.gearbox({**six_speed.SHIFT, "F1": points}).assemble()


def moving(f: Any, call: Callable[[Any, Any], object]) -> Callable[[], object]:
    """A call at a point of its own each time, as an optimiser makes it."""
    rng = np.random.default_rng(0)
    return lambda: call(f, f.x0 * (1 + 1e-6 * rng.standard_normal(len(f.x0))))


def calls() -> dict[str, Callable[[], object]]:
    """Runs with derivatives by name, and the plain ones of their models by theirs."""
    models = {"shift": six_speed.gearbox(six_speed.SHIFT).assemble(), "fine": system()}
    models["coupled"] = coupled.driveline().assemble()
    found = dict[str, Callable[[], object]]()
    for name, model in models.items():
        end = coupled.T_END if name == "coupled" else T_END
        found[name] = partial(cw.simulate, model, end, times=[end], **TOLERANCES)
        for asked, (of_model, by, _) in ASKED.items():
            if of_model == name:
                of = "J4.speed" if name == "coupled" else "w8.speed"
                f = cw.differentiable(model, end, of=of, by=by, **TOLERANCES)
                found[asked] = moving(f, lambda f, x: f.gradient(x))
    return found


def compared(how: str, taken: Callable[[str, str], float]) -> Iterator[Row]:
    """A line for each of what is asked, with its target.

    Parameters: how, what is compared; taken, the ratio of two calls by their names.
    """
    for name, (model, _, most) in ASKED.items():
        found = taken(name, model)
        target, met = ("", None) if most is None else (f"<= {most:g}", found <= most)
        yield Row(f"gradient, {name}: {how} / run", f"{found:.1f}", target, met)


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    known = calls()
    for call in known.values():
        call()
    taken = rounds({name: partial(cpu, call, 10) for name, call in known.items()}, 3 if quick else 9)
    yield from compared("values and derivatives", lambda name, plain: ratio(taken[name], taken[plain]))
