"""The states and inputs of a linear system as columns, and what all base quantities are over them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.linear.own_states import apart, followers, own_states, wound_up
from clutchwork.results.channels import ANGLE, PLACE, SPEED

if TYPE_CHECKING:
    from clutchwork.linear.chosen import Excitation
    from clutchwork.linear.motion import Motion


@dataclass(frozen=True, eq=False)
class StateColumns:
    """States in their order - speeds, own states, angles, prescribed speeds - then inputs."""

    names: tuple[tuple[str, str], ...]  # of the states, with units
    scale: Array  # what is shown of a state is scale * state
    given: Sequence[Excitation]
    speeds: NDArray[np.intp]  # places among the speeds that stay
    own: NDArray[np.intp]  # numbers among the states of the core
    nodes: NDArray[np.intp]  # nodes whose angles are states
    driven: tuple[int, ...]  # places of the inputs that are accelerations
    base: Array  # base columns over states and inputs
    angles: Array  # of all nodes over states and inputs, zero where not wanted

    @property
    def n(self) -> int:
        """Number of states."""
        return len(self.names)


def columns(motion: Motion, given: Sequence[Excitation], angles: Sequence[int], heats: Sequence[int]) -> StateColumns:
    """The columns for these inputs.

    Parameters: angles, nodes whose angle is wanted; heats, states of ambients that are wanted.
    """
    wiring, shown = motion.instant.wiring, own_states(motion.instant.wiring)
    _, wound, kept, over = _turned(motion, given, angles)
    plain = [k for k, s in enumerate(shown) if k not in wound and (s.counts or k in heats)]
    own = np.array(sorted([*plain, *(int(wound[k]) for k in kept if k < len(wound))]), dtype=int)
    nodes = np.array([angles[k - len(wound)] for k in kept if k >= len(wound)], dtype=int)
    speeds = np.flatnonzero(motion.inertial)
    driven = tuple(place for place, one in enumerate(given) if one.accelerates)
    shift = motion.momentum_shift()
    names = [
        *_speed_names(motion, given, speeds, shift),
        *((shown[k].name, shown[k].unit) for k in own),
        *((f"{wiring.nodes[k].name}.{PLACE[wiring.nodes[k].domain]}", ANGLE[wiring.nodes[k].domain]) for k in nodes),
        *(wiring.inputs[given[place].signal] for place in driven),
    ]
    n = len(names)
    base = np.zeros((motion.nx + motion.ns + motion.np + motion.ni, n + len(given)))
    x, s, p, i = np.split(base, np.cumsum([motion.nx, motion.ns, motion.np]))
    x[speeds, np.arange(len(speeds))] = 1.0
    place_of = {int(k): len(speeds) + place for place, k in enumerate(own)}
    s[own, [place_of[int(k)] for k in own]] = 1.0
    angle_of = {int(k): len(speeds) + len(own) + place for place, k in enumerate(nodes)}
    turned = [place_of[int(wound[k])] if k < len(wound) else angle_of[angles[k - len(wound)]] for k in kept]
    s[np.ix_(wound, np.array(turned, dtype=int))] = over[: len(wound)]
    turning = np.zeros((len(wiring.nodes), n + len(given)))
    turning[np.ix_(np.asarray(angles, dtype=int), np.array(turned, dtype=int))] = over[len(wound) :]
    for place, one in enumerate(given):
        column = n - len(driven) + driven.index(place) if one.accelerates else n + place
        i[one.signal, column] = 1.0
        if one.motion >= 0:
            p[one.motion, column] = 1.0
            if not one.accelerates:
                x[:, column] -= shift[:, one.motion]
    scale = np.ones(n)
    scale[len(speeds) : len(speeds) + len(own)] = [shown[k].scale for k in own]
    return StateColumns(tuple(names), scale, given, speeds, own, nodes, driven, base, turning)


def _turned(
    motion: Motion, given: Sequence[Excitation], angles: Sequence[int]
) -> tuple[Array, NDArray[np.intp], NDArray[np.intp], Array]:
    """Twists and wanted angles: their rates, the numbers of the twists, which of them stay, and all over those."""
    by_rate, by_state, by_signal, _ = motion.local.split(motion.local.rate)
    wound = wound_up(motion.instant, by_rate, by_state, by_signal)
    moving = sorted({one.motion for one in given if one.motion >= 0})
    used = [*range(motion.nx), *(motion.nx + motion.ns + place for place in moving)]
    rates = np.vstack([by_rate[wound] @ motion.rates, motion.node_speeds[np.asarray(angles, dtype=int)]])[:, used]
    # what turns with others at this ratio does so at no other
    found = followers(rates) if not len(motion.ties.first) else apart(len(rates))
    return rates, wound, found.kept, found.over_kept


def _speed_names(
    motion: Motion, given: Sequence[Excitation], speeds: NDArray[np.intp], shift: Array
) -> list[tuple[str, str]]:
    """Names of the speeds that stay; one that a prescribed speed takes along by inertia is told apart."""
    moved = [one.motion for one in given if one.motion >= 0 and not one.accelerates]
    made = []
    for place in speeds:
        node = motion.kept_node(int(place))
        ending = "speed_free" if shift[place, moved].any() else "speed"
        made.append((f"{node.name}.{ending}", SPEED[node.domain]))
    return made
