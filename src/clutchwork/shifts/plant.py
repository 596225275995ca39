"""What a controller must know of the gearbox in a driveline, measured at its model."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.assembly.wiring import HOUSING, wiring
from clutchwork.base.classes import dataclass
from clutchwork.base.errors import UseError, expect
from clutchwork.base.frozen import Frozen
from clutchwork.base.quote import listed
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.run.simulation import Assembles, model_of
from clutchwork.shifts.actuators import ElementActuator
from clutchwork.shifts.fill_test import FULL, fill_test
from clutchwork.stepping.simulator import Simulator

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

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
        behind: inertia that a converter, springs or clutches join to the input, such as that of an engine [kg m2]
    """

    capacity: Mapping[str, float]
    touch: Mapping[str, float]
    inertias: Mapping[str, float]
    actuators: Mapping[str, ElementActuator] = Frozen()
    behind: float = 0.0


def plant_of(system: Assembles | System, box: Gearbox, prefix: str = "gearbox") -> Plant:
    """Measure capacities and inertias of a gearbox in a Driveline or its System.

    Use it to give a `ShiftController` what a control unit is calibrated with. Capacities are read at two pressures, so
    they are those of any element whose capacity is linear in its pressure; valves and pistons before it are measured by
    `cw.shifts.fill_test`. UseError for elements that no pressure closes.
    """
    expect("cw.shifts.plant_of", "box", box, Gearbox, "give a cw.Gearbox, such as cw.Gearbox.load('zf-8hp70')")
    system = model_of("cw.shifts.plant_of", system)
    actuators = fill_test(system, box, prefix)
    names = [e.name for e in box.elements if e.kind in ("clutch", "brake") and e.name not in actuators]
    low, high = (_capacities(system, prefix, names, pressure) for pressure in (LOW, HIGH))
    slope = {name: (high[name] - low[name]) / (HIGH - LOW) for name in names}
    flat = [name for name in names if slope[name] <= 0.0]
    if flat:
        raise UseError("cw.shifts.plant_of", [f"pressure does nothing for {listed(flat)}; give them a gain"])
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
    rows = np.hstack([system.basis, system.basis_prescribed])
    nodes = [node.name for node in system.nodes]
    inertia = np.array([node.inertia for node in wiring(system).nodes])
    found = dict.fromkeys((member for member in box.members if member != box.output), 0.0)
    left = set(range(len(nodes)))
    for member in found:
        own = rows[nodes.index(f"{prefix}.{member}")]
        size = float(own @ own)
        for node in sorted(left):
            ratio = float(rows[node] @ own) / size if size else 0.0
            if ratio and np.allclose(rows[node], ratio * own, rtol=0.0, atol=ROUND_OFF):
                found[member] += float(inertia[node]) * ratio**2
                left.discard(node)
    return found


def _behind(system: System, box: Gearbox, prefix: str) -> float:
    """Inertia of what elements outside of the box join to its input, without what turns with that."""
    parts, joins = wiring(system), dict[int, set[int]]()
    for branch in (*parts.elements, *parts.contacts):
        if not branch.name.startswith(f"{prefix}."):
            joins.setdefault(id(branch.component), set()).update(k for k in branch.direction if k != HOUSING)
    rows = np.hstack([system.basis, system.basis_prescribed])
    own = rows[[node.name for node in parts.nodes].index(f"{prefix}.{box.input}")]
    fixed = {k for k, row in enumerate(rows) if row.any() and np.linalg.matrix_rank(np.array([own, row])) == 1}
    joined, fresh = set(fixed), set(fixed)
    while fresh:
        fresh = {k for nodes in joins.values() if nodes & fresh for k in nodes} - joined
        joined |= fresh
    return float(sum(parts.nodes[k].inertia for k in joined - fixed))
