"""Derivatives of the six-speed shift over plain runs, from Python: values and derivatives at a new point each time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import clutchwork as cw
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
# most plain runs
TARGETS = {"one number": 2.0, "eight numbers": 4.0, "100 numbers": 15.0, "followed back, 17 numbers": 6.0}


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


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    plain, fine = six_speed.gearbox(six_speed.SHIFT).assemble(), system()
    asked = {"one number": (plain, ONE), "eight numbers": (plain, EIGHT), "100 numbers": (fine, HUNDRED)}
    asked["followed back, 17 numbers"] = (plain, MANY)
    of, calls = "w8.speed", dict[str, Callable[[], object]]()
    for name, (model, by) in asked.items():
        f = cw.differentiable(model, T_END, of=of, by=by, **TOLERANCES)
        calls[name] = moving(f, lambda f, x: f.gradient(x))
    for name, model in (("plain", plain), ("plain, fine", fine)):
        calls[name] = lambda model=model: cw.simulate(model, T_END, times=[T_END], **TOLERANCES)  # type: ignore[misc]
    for call in calls.values():
        call()
    taken = rounds({name: lambda call=call: cpu(call, 10) for name, call in calls.items()}, 3 if quick else 9)  # type: ignore[misc]
    for name, most in TARGETS.items():
        found = ratio(taken[name], taken["plain, fine" if name == "100 numbers" else "plain"])
        yield Row(f"gradient, {name}: values and derivatives / run", f"{found:.1f}", f"<= {most:g}", found <= most)
