"""What a controller must know of the gearbox in a driveline, measured at its model."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import HOUSING, wiring
from clutchwork.base import UseError, dataclass, listed
from clutchwork.base.errors import expect
from clutchwork.base.frozen import Frozen
from clutchwork.declare.calls import explained
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.run.simulation import Assembles, model_of
from clutchwork.shifts.actuators import ElementActuator
from clutchwork.shifts.fill_test import FULL, fill_test
from clutchwork.shifts.given import refuse_prefix
from clutchwork.stepping.simulator import Simulator

CALL = "cw.shifts.plant_of"
# Pa, that stands for an element behind a piston which is filled and carries nothing; 0 lets it go
LEAST = 1.0
# Pa, at which capacities are read
LOW, HIGH = 5e5, 1e6
# nodes turn together where their rows differ by less
ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Plant:
    """Shift elements and inertias of a gearbox as its controller sees them.

    Parameters:
        capacity: torque of each element while it slips, per pressure above the one at which it touches [N m/Pa]; behind
        valves and pistons its largest torque over 1 MPa, which stands for the full command
        touch: pressure at which each element touches [Pa]
        inertias: of each member with all that is fixed to it [kg m2]; the output is left out
        actuators: what stands before elements that are not pressed directly
        behind: inertia that a converter, springs or clutches join to the input, such as that of an engine, as the
        input sees it [kg m2]
    """

    capacity: Mapping[str, float]
    touch: Mapping[str, float]
    inertias: Mapping[str, float]
    actuators: Mapping[str, ElementActuator] = Frozen()
    behind: float = 0.0


@explained(CALL, system="driveline", box="box")
def plant_of(system: Assembles | System, box: Gearbox, prefix: str = "gearbox") -> Plant:
    """Measure capacities and inertias of a gearbox in a Driveline or its System.

    Use it to give a `ShiftController` what a control unit is calibrated with. Capacities are read at two pressures, so
    they are those of any element whose capacity is linear in its pressure; valves and pistons before it are measured by
    `cw.shifts.fill_test`. UseError for elements that no pressure closes, or a prefix that names no Transmission.
    """
    expect(CALL, "box", box, Gearbox, "give a cw.Gearbox, such as cw.Gearbox.load('zf-8hp70')")
    system = model_of(CALL, system)
    refuse_prefix(CALL, system, box, prefix)
    actuators = fill_test(system, box, prefix)
    names = [e.name for e in box.elements if e.kind in ("clutch", "brake") and e.name not in actuators]
    low, high = (_capacities(system, prefix, names, pressure) for pressure in (LOW, HIGH))
    slope = {name: (high[name] - low[name]) / (HIGH - LOW) for name in names}
    flat = [name for name in names if slope[name] <= 0.0]
    if flat:
        raise UseError(CALL, [f"pressure does nothing for {listed(flat)}; give them a gain"])
    sliding = _sliding(system, prefix)
    touch = {name: max(0.0, LOW - low[name] / slope[name]) for name in names} | dict.fromkeys(actuators, LEAST)
    capacity = {name: slope[name] * sliding.get(name, 1.0) for name in names}
    capacity |= {name: one.most / FULL for name, one in actuators.items()}
    return Plant(capacity, touch, _inertias(system, box, prefix), actuators, _behind(system, box, prefix))


def _capacities(system: System, prefix: str, names: list[str], pressure: float) -> dict[str, float]:
    sim = Simulator(system)
    sim.set({f"{prefix}.{name}.pressure": pressure for name in names})
    return {name: float(sim[f"{prefix}.{name}.capacity"]) for name in names}


def _sliding(system: System, prefix: str) -> dict[str, float]:
    """Coefficient while it slips slowly over the one at rest, by element."""
    found = {}
    for branch in wiring(system).contacts:
        law = branch.component.friction
        static = getattr(law, "static", None)
        kinetic = law.sliding() if law is not None else None
        if isinstance(static, int | float) and kinetic and branch.name.startswith(f"{prefix}."):
            found[branch.name.removeprefix(f"{prefix}.")] = kinetic / static
    return found


def _inertias(system: System, box: Gearbox, prefix: str) -> dict[str, float]:
    """Inertia of each member and of what gears fix to it."""
    nodes, rows = wiring(system).nodes, _rows(system)
    names = [node.name for node in nodes]
    found = dict.fromkeys((member for member in box.members if member != box.output), 0.0)
    left = set(range(len(nodes)))
    for member in found:
        for node, ratio in _fixed(rows, names.index(f"{prefix}.{member}")).items():
            if node in left:
                found[member] += nodes[node].inertia * ratio**2
                left.discard(node)
    return found


def _rows(system: System) -> NDArray[np.float64]:
    """Speed of each node over those that are free or prescribed."""
    return np.hstack([system.basis, system.basis_prescribed])


def _fixed(rows: NDArray[np.float64], node: int) -> dict[int, float]:
    """Speed of each node that gears fix to one, over that of this one; empty where it stands still."""
    own = rows[node]
    ratios = rows @ own / (float(own @ own) or 1.0)
    alike = np.max(np.abs(rows - np.outer(ratios, own)), axis=1, initial=0.0) <= ROUND_OFF
    return {int(k): float(ratios[k]) for k in np.flatnonzero(alike & (ratios != 0.0))}


def _behind(system: System, box: Gearbox, prefix: str) -> float:
    """Inertia of what elements outside of the box join to its input, seen there, without what is fixed to it."""
    parts, rows, joins = wiring(system), _rows(system), dict[int, dict[int, float]]()
    for branch in (*parts.elements, *parts.contacts):
        if not branch.name.startswith(f"{prefix}."):
            ends = joins.setdefault(id(branch.component), {})
            ends.update({k: abs(rate) for k, rate in branch.direction.items() if k != HOUSING and rate})
    own = _fixed(rows, [node.name for node in parts.nodes].index(f"{prefix}.{box.input}"))
    # speed of each node over that of the input, with all that joins them stiff
    speeds, fresh = dict(own), list(own)
    while fresh:
        node = fresh.pop()
        for ends in joins.values():
            for other in [k for k in ends if node in ends and k not in speeds]:
                joined = {k: speeds[node] * ends[node] / ends[other] * r for k, r in _fixed(rows, other).items()}
                speeds |= joined
                fresh += joined
    return float(sum(parts.nodes[k].inertia * speed**2 for k, speed in speeds.items() if k not in own))
