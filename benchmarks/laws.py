"""The 3-4 shift with every friction law: run time over exact Coulomb, lock-up, heat."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

import clutchwork as cw
from benchmarks.core import Prepared
from benchmarks.report import Row
from benchmarks.timing import ratio, rounds
from support import six_speed

T_END = 4.0
# slip below which the oncoming clutch counts as locked, whatever its law [rad/s]
AT_REST = 0.05
CURVE: dict[str, Any] = {"static": 0.12, "kinetic": 0.1, "speed": 1.0}
# deflection at which the contacts slide: 1e-4 rad, a steady one of kinetic / stiffness
STIFF: dict[str, Any] = {"stiffness": 1000.0, "damping": 0.1}
STACK = [(2e-5, 0.1), (5e-5, 0.2), (1e-4, 0.3), (2e-4, 0.4)]

LAWS: dict[str, cw.Law] = {
    "Coulomb": cw.Coulomb(static=0.12, kinetic=0.1),
    "Exponential": cw.Exponential(static=0.12, slow=0.12, fast=0.1, speed=1.0),
    "CoefficientTable": cw.CoefficientTable(static=0.12, kinetic=[(0.0, 0.12), (1.0, 0.107), (3.0, 0.1), (400.0, 0.1)]),
    "Stribeck": cw.Stribeck(**CURVE),
    "Karnopp": cw.Karnopp(**CURVE, band=0.01),
    "Tanh": cw.Tanh(kinetic=0.1, speed=0.1),
    "RegularisedStribeck": cw.RegularisedStribeck(**CURVE, width=0.1),
    "Dahl": cw.Dahl(kinetic=0.1, stiffness=1000.0),
    "LuGre": cw.LuGre(**CURVE, **STIFF),
    "ElastoPlastic": cw.ElastoPlastic(**CURVE, **STIFF, elastic=7e-5),
    "Leuven": cw.Leuven(**CURVE, elements=STACK, damping=0.1),
    "GMS": cw.GMS(**CURVE, elements=STACK, damping=0.1),
    "Mykhalevych": cw.Mykhalevych(static=0.12, kinetic=0.1, elastic=1e-4, speed=1.0, viscous=0.5),
}
LIMIT = {"Dahl": 15.0, "LuGre": 10.0, "GMS": 15.0}
# of the exact motion
EXACT: dict[str, Any] = {"rtol": 1e-11, "atol": 1e-12}
SPEEDS = ("w1", "w2", "w4", "w8")


def system(law: cw.Law) -> cw.System:
    """The gearbox with one law in all its contacts."""
    with warnings.catch_warnings():
        # a damping that may give energy away is what these laws are published with
        warnings.simplefilter("ignore", cw.ModelWarning)
        return six_speed.gearbox(six_speed.SHIFT, law=law).assemble()


def locked_at(run: cw.Trajectory) -> float:
    """When the oncoming clutch comes to rest for good [s]."""
    moving = np.flatnonzero(np.abs(run["F1.slip"]) > AT_REST)
    return float(run.time[min(moving[-1] + 1, len(run) - 1)]) if moving.size else 0.0


def errors(system: cw.System, run: cw.Trajectory) -> tuple[float, float]:
    """Errors of the speeds against a run at tight tolerances: the largest, and that at the end [rad/s]."""
    exact = cw.simulate(system, T_END, dt=1e-3, **EXACT)
    gaps = [np.abs(run[f"{w}.speed"] - exact[f"{w}.speed"]) for w in SPEEDS]
    return max(float(np.max(gap)) for gap in gaps), max(float(gap[-1]) for gap in gaps)


def rows(quick: bool = False) -> Iterator[Row]:
    """One line for each law."""
    systems = {name: system(law) for name, law in LAWS.items()}
    prepared = {name: Prepared(made, T_END) for name, made in systems.items()}
    found = rounds({name: p.measure(5) for name, p in prepared.items()}, 3 if quick else 9)
    for name, made in systems.items():
        run = cw.simulate(made, T_END, dt=1e-3, rtol=1e-6, atol=1e-8)
        heat = sum(float(run[f"{contact}.heat"][-1]) for contact in ("F1", "F2", "F4"))
        slower = ratio(found[name], found["Coulomb"])
        worst, last = errors(made, run)
        speeds = f"speeds off by {worst:.0e}, at the end {last:.0e} rad/s"
        measured = f"{slower:.1f} x, {speeds}, at rest {locked_at(run):.3f} s, {1e-3 * heat:.1f} kJ"
        limit = LIMIT.get(name)
        target = f"<= {limit:g} x" if limit else ""
        yield Row(f"shift with {name} / with Coulomb", measured, target, slower <= limit if limit else None)
