"""Energy through every joint of a driveline: what each element gives to each shaft, docs/theory/energy.md.

The core integrates the work of whole elements. What goes through their ends, and through gears, follows from the same
torques and speeds at the same Gauss points, on a repetition of the run at these instants. Where speeds jump, impulses
follow from the balance of every node.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from numbers import Real
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.assembly.wiring import HOUSING, Branch, GearRow, Wiring
from clutchwork.base import OptionError, UseError, dataclass, quote
from clutchwork.base.arrays import Array
from clutchwork.base.memoize import memoize
from clutchwork.declare.quantity import QuantityError, has_unit, in_si
from clutchwork.results import reactions
from clutchwork.results.channels import LOCKED
from clutchwork.results.energy import EnergyBalance, balance
from clutchwork.results.events import Events

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded


# Gauss points on [0, 1], as in run/power.hpp
POINTS = np.array([0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263])
WEIGHTS = np.array([0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693])
# numbers that are held at once
MOST_NUMBERS = 20_000_000


@dataclass(frozen=True)
class Joint:
    """Where an element acts on a shaft: energy goes from the element into the node."""

    element: str
    node: int


@dataclass(frozen=True, eq=False)
class Flows:
    """Energies of a window of a run, in J."""

    begin: float  # s
    end: float  # s
    balance: EnergyBalance
    joints: Mapping[Joint, float]  # from the element into the node
    kinetic: Mapping[int, float]  # change, per node


def flows(run: Recorded, begin: float, end: float) -> Flows:
    """Energies between two instants: left limits, but from before the impulses of the start.

    Parameters: begin and end [s].
    """
    wiring = run.wiring
    window = [e for e in run.events if begin <= e.time < end or e.time == end == run.time[-1]]
    jumps = sorted({e.time for e in window if e.energy_before != e.energy_after})
    joints, matrix = _joints(wiring)
    edges, first = np.array([begin, end, *jumps, *jumps]), True
    total, kinetic, ends = np.zeros(len(joints)), np.zeros(len(wiring.nodes)), np.zeros((0, wiring.row_size))
    for times, weights in _gauss(_steps(run), begin, end, wiring.row_size):
        # all in one repetition; of an instant that is asked for more than once the first is the left limit
        wanted = np.sort(np.concatenate([times, edges])) if first else times
        rows = run.repeat(wanted).rows
        total += weights @ _powers(wiring, joints, matrix, rows[np.searchsorted(wanted, times)])
        if first:
            left, right = (np.searchsorted(wanted, edges, side) for side in ("left", "right"))
            ends = rows[left[:2]]
            kinetic = _kinetic(wiring, ends)
            for number in range(2, 2 + len(jumps)):
                before, after = rows[left[number]], rows[right[number] - 1]
                if edges[number] == run.options.t_start:
                    before = _before_start(run, after)
                    kinetic += _kinetic(wiring, np.array([before, after]))
                total += _jump(wiring, joints, before, after)
        first = False
    found = dict(zip(joints, total.tolist(), strict=True))
    stored = dict(enumerate(kinetic.tolist()))
    return Flows(begin, end, balance(wiring, ends, Events(window), run.options.t_start), found, stored)


def _gauss(steps: Array, begin: float, end: float, row_size: int) -> Iterator[tuple[Array, Array]]:
    """Instants and weights over all steps of a window, so many at once as fit into memory."""
    cuts = np.unique(np.concatenate([[begin, end], steps[(steps > begin) & (steps < end)]]))
    most = max(1, MOST_NUMBERS // (len(POINTS) * row_size))
    for first in range(0, len(cuts) - 1, most):
        some = cuts[first : first + most + 1]
        widths = np.diff(some)
        times = some[:-1, None] + widths[:, None] * POINTS
        yield times.ravel(), (widths[:, None] * WEIGHTS).ravel()


@memoize
def _steps(run: Recorded) -> Array:
    """Ends of the steps of the solver [s]; the run is repeated once for them."""
    times: Array = run.repeat(None).time
    return times


def _joints(wiring: Wiring) -> tuple[list[Joint], Array]:
    """All joints, and the torques at them over an output row."""
    made = reactions.multipliers(wiring)
    torques: dict[Joint, Array] = {}

    def add(name: str, node: int, vector: Array) -> None:
        if node != HOUSING:
            joint = Joint(name, node)
            torques[joint] = torques.get(joint, np.zeros(wiring.row_size)) + vector

    for part, branches in (("element_torque", wiring.elements), ("contact_torque", wiring.contacts)):
        for index, branch in enumerate(branches):
            own = np.zeros(wiring.row_size)
            own[wiring.columns[part].start + index] = 1.0
            for node, factor in branch.direction.items() if not branch.hidden else ():
                add(branch.component.name, node, factor * own)
    for index, row in enumerate(wiring.gears):
        for node, factor in row.ports.values():
            add(row.name, node, factor * made[index])
    for index, branch in enumerate(wiring.motions, len(wiring.gears)):
        for node, factor in branch.direction.items():
            add(branch.name, node, factor * made[index])
    return list(torques), np.array(list(torques.values())).reshape(-1, wiring.row_size)


def _powers(wiring: Wiring, joints: list[Joint], matrix: Array, rows: Array) -> Array:
    """Power from each element into each node, per row."""
    speeds = rows[:, wiring.columns["speed"]]
    # what no torque depends on may be infinite
    used = np.flatnonzero(np.any(matrix, axis=0))
    return (rows[:, used] @ matrix[:, used].T) * speeds[:, [joint.node for joint in joints]]


def _kinetic(wiring: Wiring, rows: Array) -> Array:
    """Change of the kinetic energy of every node between two rows."""
    before, after = rows[:, wiring.columns["speed"]]
    change: Array = 0.5 * _inertia(wiring) * (after - before) * (after + before)
    return change


def _inertia(wiring: Wiring) -> Array:
    return np.array([node.inertia for node in wiring.nodes])


def _before_start(run: Recorded, after: Array) -> Array:
    """The output row before the impulses of the start."""
    system, before, speeds = run.system, after.copy(), run.wiring.columns["speed"]
    given = [float(after[speeds] @ _direction(run.wiring, branch)) for branch in run.wiring.motions]
    before[run.wiring.columns["contact_work"]] = 0.0
    # at a later start speeds have followed what is prescribed: docs/theory/reduction.md (13)
    change = np.array(given) - system.input_value[system.prescribed_input]
    later = np.where(system.prescribed_sums, 0.0, change) if run.options.t_start else np.zeros(len(given))
    begun = system.initial_speed + system.initial_by_prescribed @ later
    before[speeds] = system.basis @ begun + system.basis_prescribed @ np.array(given)
    return before


def _direction(wiring: Wiring, branch: Branch) -> Array:
    return wiring.spread((branch,))[:, 0]


def _jump(wiring: Wiring, joints: list[Joint], before: Array, after: Array) -> Array:
    """Energy of the impulses that make the jump of all speeds.

    Those of contacts that did work follow from it; those of rigid parts and locked contacts are the smallest ones.
    """
    old, new = before[wiring.columns["speed"]], after[wiring.columns["speed"]]
    mean = 0.5 * (new + old)
    wanted = _inertia(wiring) * (new - old)
    work = after[wiring.columns["contact_work"]] - before[wiring.columns["contact_work"]]
    shares = list[tuple[str, Array]]()
    rigid = [(row.name, _over_nodes(wiring, row)) for row in wiring.gears]
    rigid += [(branch.name, _direction(wiring, branch)) for branch in wiring.motions]
    locked = after[wiring.columns["contact_mode"]] == LOCKED
    for number, branch in enumerate(wiring.contacts):
        along = _direction(wiring, branch)
        if work[number]:
            shares.append((branch.name, work[number] / float(along @ mean) * along))
        elif locked[number]:
            rigid.append((branch.name, along))
    if rigid:
        directions = np.array([along for _, along in rigid]).T
        left = wanted - sum(impulse for _, impulse in shares)
        sizes = np.linalg.lstsq(directions, left, rcond=1e-12)[0]
        shares += [(name, size * along) for (name, along), size in zip(rigid, sizes, strict=True)]
    place = {joint: number for number, joint in enumerate(joints)}
    total = np.zeros(len(joints))
    for name, impulse in shares:
        for node in np.flatnonzero(impulse):
            total[place[Joint(name, int(node))]] += impulse[node] * mean[node]
    return total


def _over_nodes(wiring: Wiring, row: GearRow) -> Array:
    column = np.zeros(len(wiring.nodes))
    for node, factor in row.ports.values():
        if node != HOUSING:
            column[node] += factor
    return column


def window(run: Recorded, start: Any, end: Any, call: str) -> tuple[float, float]:
    """The window that is meant [s]: the whole run where nothing is given; UseError where it is none."""
    if not run.options.work:
        raise OptionError(["the energies of elements need the work integrals: run with work=True"])
    if len(run) < 2:
        raise UseError(call, ["the run has less than two instants, so there is nothing to sum over"])
    first, last = float(run.time[0]), float(run.time[-1])
    begin, stop = (_time(*item, call) for item in (("start", start, first), ("end", end, last)))
    if not first <= begin < stop <= last:
        bound = f"they must rise and lie between {first:g} and {last:g} s, which the run covers"
        raise UseError(call, [f"start is {begin:g} s and end is {stop:g} s: {bound}"])
    return begin, stop


def _time(name: str, given: Any, otherwise: float, call: str) -> float:
    if given is None:
        return otherwise
    try:
        value = in_si(given, "s") if has_unit(given) else given
    except QuantityError as bad:
        raise UseError(call, [f"{name} is {quote(given)}: {bad.message}; give a time in s"]) from None
    if isinstance(value, bool) or not isinstance(value, Real):
        raise UseError(call, [f"{name} is {quote(given)}: give a time in s"])
    return float(value)
