"""A run, and what the checks of its rows need of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import HOUSING, Branch
from clutchwork.declare.node import Work

Array = NDArray[np.float64]

# a torque before a jam that is so many times that behind it has no bound
BEYOND = 1e9


class Fault(NamedTuple):
    """A kind of fault, whose it is, and in words how much."""

    kind: str
    of: str
    words: str

    @property
    def key(self) -> str:
        """What faults of one cause have in common."""
        return f"{self.kind} {self.of}".strip()


class Seen:
    """A run and what the checks need of it, found once."""

    def __init__(self, run: Any) -> None:
        # a run that ends where no torques balance shows none that do in its last row, one that a jump has taken out of
        # a table shows what is beyond
        rows = slice(-1 if run.status in ("unbalanced", "out_of_table") else None)
        self.run, self.wiring, self.rows, self.time = run, run.wiring, run.rows[rows], run.time[rows]
        if run.status == "zeno" and self.chatters:
            # one that a sign of a slip ends stops between two decisions
            whole = self.time < self.time[-1]
            if whole.any():
                self.rows, self.time = self.rows[whole], self.time[whole]
        self.inertia = np.array([node.inertia for node in self.wiring.nodes])
        self.rtol = float(run.options.rtol)

    def part(self, name: str) -> Array:
        """Columns of a part of the rows."""
        found: Array = self.rows[:, self.wiring.columns[name]]
        return found

    @cached_property
    def speed(self) -> Array:
        """Speeds of all nodes."""
        return self.part("speed")

    @cached_property
    def fastest(self) -> Array:
        """The largest speed of each node over the run, at least a little."""
        own: Array = np.abs(self.speed).max(axis=0, initial=0.0)
        # round-off of the others reaches those at rest
        return own + 1e-5 * own.max(initial=0.0) + 1e-4

    @cached_property
    def zero(self) -> float:
        """The slip that counts as zero: docs/theory/contacts.md (14), with its round-off."""
        return 1.001e-10 * (1.0 + float(np.abs(self.speed).max(initial=0.0)))

    def scale(self, branch: Branch) -> float:
        """The largest speed at the ends of a branch."""
        ends = [self.fastest[node] * abs(factor) for node, factor in branch.direction.items() if node != HOUSING]
        return max(ends, default=1.0)

    @cached_property
    def runs_away(self) -> NDArray[np.bool_]:
        """Rows at an instant at which the torque of a gear grows beyond all bounds, on either side: there it jams."""
        jams = [one for one in self.run.events if one.cause == "jam"]
        found: NDArray[np.bool_] = np.isin(
            self.time, [one.time for one in jams if abs(one.torque_before) > BEYOND * (1.0 + abs(one.torque_after))]
        )
        return found

    @cached_property
    def elements(self) -> Array:
        """Directions of torque elements over the nodes, a column each."""
        found: Array = self.wiring.spread(self.wiring.elements)
        return found

    @cached_property
    def contacts(self) -> Array:
        """Directions of contacts over the nodes."""
        found: Array = self.wiring.spread(self.wiring.contacts)
        return found

    @cached_property
    def rigid(self) -> Array:
        """Directions of gear rows and prescribed motions."""
        wiring = self.wiring
        gears = np.zeros((len(wiring.nodes), len(wiring.gears)))
        for column, row in enumerate(wiring.gears):
            for node, factor in row.ports.values():
                if node != HOUSING:
                    gears[node, column] += factor
        return np.hstack([gears, wiring.spread(wiring.motions)])

    @cached_property
    def terms(self) -> Array:
        """Size of all torques at each node, rows by nodes; nodes that are joined rigidly share the largest."""
        size: Array = np.abs(self.part("element_torque")) @ np.abs(self.elements).T
        size = size + np.abs(self.part("contact_torque")) @ np.abs(self.contacts).T
        size = size + np.abs(self.part("acceleration")) * self.inertia
        reached = (np.abs(self.rigid) > 0).astype(float)
        joined = np.eye(len(self.inertia)) + reached @ reached.T
        groups = np.linalg.matrix_power(joined, max(1, len(self.inertia))) > 0
        return np.max(np.where(groups[None], size[:, None, :], 0.0), axis=2)

    def numbers(self, work: Work) -> list[list[int]]:
        """Places of the ways of each torque element whose work is of a sort."""
        groups: dict[str, list[int]] = {}
        for number, branch in enumerate(self.wiring.elements):
            if branch.component.work == work and not branch.hidden:
                groups.setdefault(branch.component.name, []).append(number)
        return list(groups.values())

    @cached_property
    def all_torques(self) -> Array:
        """Size of all torques of each row: what is a difference of them is no better than their round-off."""
        found: Array = sum(np.abs(self.part(name)).sum(axis=1) for name in ("element_torque", "contact_torque"))
        return found

    @cached_property
    def turning(self) -> Array:
        """Torque by which each row may be beyond a sign that is taken at its word, where hardly anything slips."""
        found: Array = np.zeros(len(self.time))
        for number, branch in enumerate(self.wiring.contacts):
            if "chatters" not in getattr(branch.component.friction, "hooks", ()):
                continue
            near = np.abs(self.speed @ self.contacts[:, number]) <= 1e-6 * (1.0 + self.scale(branch))
            found = found + np.where(near, 2.0 * self.part("contact_capacity")[:, number], 0.0)
        return found

    @cached_property
    def chatters(self) -> bool:
        """Whether a sign of a slip is taken at its word: torques turn around within steps, and rows at those instants
        may show either side."""
        laws = (branch.component.friction for branch in self.wiring.contacts)
        return any("chatters" in getattr(law, "hooks", ()) for law in laws)

    @cached_property
    def kinds(self) -> dict[str, str]:
        """Kind of every element of the model by name."""
        return {element.name: element.kind for element in self.run.system.source.elements}

    def kind(self, branch: Branch) -> str:
        """Kind of the element of the model that a branch belongs to, with its own where it is a part."""
        words = branch.component.name.split(".")
        wholes = (".".join(words[:count]) for count in range(len(words), 0, -1))
        own = branch.component.kind
        of = next((self.kinds[whole] for whole in wholes if whole in self.kinds), own)
        return own if own == of else f"{of}/{own}"

    def worst(self, kind: str, of: str, bad: Array, words: Callable[[int], str]) -> Iterator[Fault]:
        """A fault where any of the rows is bad: of the worst one, in words, with its time and how many are."""
        if bad.max(initial=0.0) > 0.0:
            at = int(np.argmax(bad))
            yield Fault(kind, of, f"{words(at)} at {self.time[at]:.9g} s, {int((bad > 0.0).sum())} rows")


Check = Callable[[Seen], Iterator[Fault]]
