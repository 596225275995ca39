"""The motion that is left in the present locked set, before inputs are chosen: docs/theory/linearisation.md."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import HOUSING
from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.linear.own_states import preference
from clutchwork.results.forms import LOCKED

if TYPE_CHECKING:
    from clutchwork.declare.node import Node
    from clutchwork.linear.instant import Instant

# what is left of a row after elimination, beside the row, that counts as round-off
ROUND_OFF = 1e-10
# a pivot is at least this part of the largest number of its row
LEAST_PIVOT = 0.1


class Local:
    """The matrix of local derivatives in its parts: docs/theory/linearisation.md (2)."""

    def __init__(self, instant: Instant) -> None:
        counts, matrix = instant.system.counts, instant.local
        nd, ns, nc = counts["elements"] + counts["contacts"], counts["states"], counts["contacts"]
        self.directions, self.states = nd, ns
        ends = np.cumsum([nd, ns, nc, nc, nc, counts["flows"], counts["transmissions"]])
        parts = np.split(matrix, ends, axis=0)
        self.torque, self.rate, self.capacity, self.most, self.least, self.flow, self.ratio, self.ratio_slope = parts

    def split(self, part: Array) -> tuple[Array, Array, Array, Array]:
        """Derivatives by rates, by states, by signals, and the value."""
        nd, ns = self.directions, self.states
        return part[:, :nd], part[:, nd : nd + ns], part[:, nd + ns : -1], part[:, -1]


class Motion:
    """What the present locked set leaves, over base columns: speeds that stay, states, prescribed speeds, signals."""

    def __init__(self, instant: Instant) -> None:
        system = self.system = instant.system
        self.instant, self.local = instant, Local(instant)
        self.D = np.vstack([system.element_rate, system.contact_rate])
        self.delta = np.vstack([system.element_rate_prescribed, system.contact_rate_prescribed])
        self.held = np.flatnonzero(instant.modes == LOCKED)
        self.ties = Ties(instant, self.local.ratio[:, -1], self.D, self.delta)
        # a change of a ratio moves speeds as a prescribed speed does
        B, beta = self.ties.beside(system.contact_rate[self.held], system.contact_rate_prescribed[self.held])
        self.free: Free = free_motion(B, beta, preference(instant))
        self.M = self.ties.mass(system.mass)
        Z, Zp, Zt = self.free.Z, *np.split(self.free.Zp, [self.delta.shape[1]], axis=1)
        self.nx, self.np = Z.shape[1], Zp.shape[1]
        self.ns, self.ni = self.local.states, len(system.inputs)
        self.mass = Z.T @ self.M @ Z
        self.mass_p = Z.T @ (self.M @ Zp + system.mass_prescribed)
        self.algebraic = system.massless[self.free.kept] != 0
        self.inertial = ~self.algebraic
        self.x, self.s, self.p, self.i = np.split(
            np.eye(self.nx + self.ns + self.np + self.ni), np.cumsum([self.nx, self.ns, self.np])
        )
        self.ratios = self.local.split(self.local.ratio)[1] @ self.s + self.local.split(self.local.ratio)[2] @ self.i
        self.speeds = Z @ self.x + Zp @ self.p + Zt @ (self.ties.rate[:, None] * self.ratios)
        self.tied = Zt
        self.rates = self.D @ self.speeds + self.delta @ self.p
        self.node_speeds = system.basis @ self.speeds + system.basis_prescribed @ self.p

    def kept_node(self, place: int) -> Node:
        """The shaft of one of the speeds that stay."""
        name = self.system.independent[self.free.kept[place]]
        return next(node for node in self.system.nodes if node.name == name)

    @property
    def prescribed_accelerations(self) -> Array:
        """Slopes of the prescribed speeds at the instant."""
        now = self.instant.part("acceleration")
        made = [
            sum(factor * now[node] for node, factor in motion.direction.items() if node != HOUSING)
            for motion in self.instant.wiring.motions
        ]
        return np.array(made, dtype=float)

    def tied_slopes(self) -> Array:
        """Effect of a change of the base columns on the accelerations of the ties, apart from all other slopes.

        docs/theory/linearisation.md (10)
        """
        ties, (_, by_state, by_signal, now) = self.ties, self.local.split(self.local.ratio_slope)
        held = by_state @ self.s + by_signal @ self.i
        second = self.rates[ties.second]
        slopes: Array = ties.acceleration[:, None] * self.ratios + now[:, None] * second + ties.rate[:, None] * held
        return slopes

    def follow(self, part: Array) -> Array:
        """Derivatives of local quantities over the base columns."""
        by_rate, by_state, by_signal, _ = self.local.split(part)
        return by_rate @ self.rates + by_state @ self.s + by_signal @ self.i

    def solved(self) -> Array:
        """Base columns with the algebraic speeds over the others: docs/theory/linearisation.md (6)."""
        push = (self.D @ self.free.Z).T @ self.follow(self.local.torque)
        columns = np.flatnonzero(self.algebraic)
        made = np.eye(push.shape[1])
        if columns.size:
            made[columns] = -np.linalg.solve(push[np.ix_(columns, columns)], push[columns])
            made[:, columns] = 0.0
        return made

    def momentum_shift(self) -> Array:
        """What a prescribed speed takes off the speeds that stay, so that no slope of it is left.

        docs/theory/linearisation.md (5)
        """
        shift = np.zeros((self.nx, self.np))
        kept = np.flatnonzero(self.inertial)
        if kept.size and self.np:
            shift[kept] = np.linalg.solve(self.mass[np.ix_(kept, kept)], self.mass_p[kept])
            shift[np.abs(shift) < 1e-13] = 0.0
        return shift


@dataclass(frozen=True, eq=False)
class Free:
    """Speeds over those that are kept and the prescribed ones: v = Z x + Zp p, with B v + beta p = 0 for all x: (4)."""

    kept: NDArray[np.intp]  # independent speeds that stay, in the order of preference
    Z: Array
    Zp: Array
    ties: Array  # rows over the prescribed speeds that must stay zero: contacts lock these to each other


def free_motion(B: Array, beta: Array, preference: Sequence[int]) -> Free:
    """Eliminate one speed per independent row of B v + beta p = 0; those that come early in `preference` stay."""
    n, prescribed = B.shape[1], beta.shape[1]
    rank_of = np.empty(n, dtype=int)
    rank_of[np.asarray(preference, dtype=int)] = np.arange(n)
    rows, sizes = np.hstack([B, beta]).astype(float), np.max(np.abs(B), axis=1, initial=0.0)
    left, pivots = list(range(len(rows))), dict[int, int]()
    while left:
        row = max(left, key=lambda i: float(np.max(np.abs(rows[i, :n]), initial=0.0) / (sizes[i] or 1.0)))
        largest = float(np.max(np.abs(rows[row, :n]), initial=0.0))
        if largest <= ROUND_OFF * sizes[row]:
            break
        candidates = np.flatnonzero(np.abs(rows[row, :n]) >= LEAST_PIVOT * largest)
        column = int(max(candidates, key=lambda c: rank_of[c]))
        rows[row] /= rows[row, column]
        for other in range(len(rows)):
            if other != row:
                rows[other] -= rows[other, column] * rows[row]
                rows[other, column] = 0.0
        pivots[column] = row
        left.remove(row)
    kept = np.array([i for i in preference if i not in pivots], dtype=int)
    Z, Zp = np.zeros((n, len(kept))), np.zeros((n, prescribed))
    Z[kept, np.arange(len(kept))] = 1.0
    for column, row in pivots.items():
        Z[column], Zp[column] = -rows[row, kept], -rows[row, n:]
    ties = [rows[i, n:] for i in left if np.max(np.abs(rows[i, n:]), initial=0.0) > ROUND_OFF]
    return Free(kept, Z, Zp, np.array(ties).reshape(len(ties), prescribed))


class Ties:
    """Rows of ratios that vary over speeds and prescribed speeds, and what is known of them at the instant: (10)."""

    def __init__(self, instant: Instant, ratio: Array, D: Array, delta: Array) -> None:
        first = self.first = np.asarray(instant.system.transmission_element, dtype=int)
        second = self.second = first + 1
        self.followers = np.asarray(instant.system.transmission_speed, dtype=int)
        self.ratio = ratio
        self.row = D[first] - self.ratio[:, None] * D[second]
        self.shift = delta[first] - self.ratio[:, None] * delta[second]
        self.torque = instant.part("element_torque")[first]
        self.rate = self._over(instant, "speed")
        self.acceleration = self._over(instant, "acceleration")

    def _over(self, instant: Instant, part: str) -> Array:
        """Second rate of each, or its time derivative."""
        moving, branches = instant.part(part), instant.wiring.elements
        found = [
            sum(factor * moving[node] for node, factor in branches[way].direction.items() if node != HOUSING)
            for way in self.second
        ]
        return np.array(found, dtype=float)

    def beside(self, B: Array, beta: Array) -> tuple[Array, Array]:
        """Rows of locked contacts and of these, over speeds; over prescribed speeds and changes of the ties."""
        held, ties = len(B), len(self.first)
        changes = np.vstack([np.zeros((held, ties)), -np.eye(ties)])
        return np.vstack([B, self.row]), np.hstack([np.vstack([beta, self.shift]), changes])

    def mass(self, mass: Array) -> Array:
        """The mass matrix without the units that stand for speeds that follow."""
        made = mass.copy()
        places = self.followers[self.followers >= 0]
        made[places, places] = 0.0
        return made
