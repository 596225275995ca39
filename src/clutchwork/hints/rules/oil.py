"""Circuits of oil: a pump without a relief valve, ports that are swapped, a pump that gets too little."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.declare import Component
from clutchwork.hints.hint import Hint, shown
from clutchwork.hints.registry import model_rule, run_rule

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.hints.look import Look

BURSTS, SWAPPED, STARVED = "no relief valve", "ports swapped", "starved pump"
# absolute pressure of the surroundings, and of an inlet below which a pump is not filled [Pa]:
# docs/theory/hydraulics.md (13)
AMBIENT, FILLED = 101325.0, 20e3
# ports of what oil should flow through from the first one to the second
WAYS = {"relief_valve": ("inlet", "outlet"), "spool_valve": ("supply", "clutch")}


def _of(system: System, *kinds: str) -> Iterator[Any]:
    return (process for process in system.processes if process.kind in kinds)


def _oil(port: object) -> str:
    """Name of the volume at a port; empty for a fixed pressure."""
    return str(port.name) if isinstance(port, Component) and type(port).gathers else ""


def _pump(flow: Any) -> str:
    """Name of the pump that some oil is of."""
    return str(flow.name).removesuffix(".oil")


@model_rule(BURSTS)
def no_relief_valve(system: System) -> Iterator[Hint]:
    """A pump that delivers into a volume that no valve with a set pressure and no open orifice takes oil from."""
    relieved = {_oil(valve.inlet) for valve in _of(system, "relief_valve")}
    relieved |= {
        _oil(valve.clutch) for valve in _of(system, "spool_valve") if valve.feedback and not _oil(valve.exhaust)
    }
    bores = [(_oil(bore.inlet), _oil(bore.outlet)) for bore in _of(system, "orifice")]
    for flow in _of(system, "pump_flow"):
        there = {_oil(flow.outlet)}
        while more := {one for ends in bores if there.intersection(ends) for one in ends} - there:
            there |= more
        # behind an orifice there may be a fixed pressure
        if "" not in there and not there & relieved:
            line = _oil(flow.outlet)
            message = (
                f"delivers into {line}, and nothing lets oil out of that above a pressure, so it rises without limit"
            )
            yield Hint(BURSTS, (_pump(flow), line), message, f"add a cw.ReliefValve with {line} as its inlet")


@model_rule(SWAPPED)
def ports_swapped(system: System) -> Iterator[Hint]:
    """A valve whose second port is the line of a pump, or a pump from a volume into the sump."""
    fed = {_oil(flow.outlet) for flow in _of(system, "pump_flow")} - {""}
    for one in _of(system, *WAYS, "pump_flow"):
        first, second = WAYS.get(one.kind, ("outlet", "inlet"))
        before, after = _oil(getattr(one, first)), _oil(getattr(one, second))
        if one.kind == "pump_flow":
            wrong, why = bool(after) and getattr(one, first) == 0, f"takes oil out of {after} and delivers to the sump"
        else:
            # a spool valve may also fill a line from a fixed pressure, or empty it
            is_way = bool(before) or one.kind != "spool_valve"
            wrong, why = (
                is_way and after in fed and before not in fed,
                f"has {after}, which a pump fills, as its {second}",
            )
        if wrong:
            yield Hint(SWAPPED, (_pump(one),), why, f"swap {first} and {second} if that is not meant")


@run_rule(STARVED)
def starved_pump(look: Look) -> Iterator[Hint]:
    """A pump whose inlet comes so near to vacuum that it delivers less than its displacement."""
    for flow in _of(look.system, "pump_flow"):
        inlet = _oil(flow.inlet)
        if not inlet:
            continue
        pressure = look.fine[f"{inlet}.pressure"]
        low = np.flatnonzero(pressure + AMBIENT < FILLED)
        if len(low):
            begin, end = (float(t) for t in look.time[low[[0, -1]]])
            least = float(np.min(pressure)) + AMBIENT
            down = f"{inlet} comes down to {shown(least, 'Pa')} absolute, below {FILLED / 1e3:.3g} kPa"
            message = f"is not filled between {begin:.4g} and {end:.4g} s: {down}"
            remedy = f"let more oil into {inlet}, or turn the pump slower"
            yield Hint(STARVED, (_pump(flow), inlet), message, remedy, {"pressure [Pa]": least}, begin, end)
