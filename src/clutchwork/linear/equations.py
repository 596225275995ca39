"""The linear equations of a System at an instant, in its locked set: docs/theory/linearisation.md."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.base import dataclass
from clutchwork.base.arrays import Array
from clutchwork.linear.columns import StateColumns, columns
from clutchwork.linear.motion import Motion
from clutchwork.linear.own_states import own_states
from clutchwork.linear.shares import Holding, torque_change

if TYPE_CHECKING:
    from clutchwork.linear.chosen import Excitation


@dataclass(frozen=True)
class StateName:
    """One state of the linear system, and where it stands at the instant."""

    name: str
    unit: str
    value: float
    rate: float  # per second


@dataclass(frozen=True, eq=False)
class Equations:
    """States with A and B, and derivatives of the output row over states, inputs and the slopes of the inputs."""

    states: tuple[StateName, ...]
    A: Array
    B: Array
    row: Array  # one line for each number of the row


def equations(motion: Motion, given: Sequence[Excitation], angles: Sequence[int], heats: Sequence[int]) -> Equations:
    """The equations for these inputs.

    Parameters: angles, nodes whose angle is wanted; heats, states of ambients that are wanted.
    """
    made = columns(motion, given, angles, heats)
    over, n, scale = motion.solved() @ made.base, made.n, made.scale
    rates, drift = _rates(motion, made, over)
    row = _row(motion, made, over, rates)
    values = _values(motion, made)
    states = tuple(
        StateName(name, unit, float(value), float(rate))
        for (name, unit), value, rate in zip(made.names, values, scale * drift, strict=True)
    )
    row[:, :n] /= scale
    return Equations(states, scale[:, None] * rates[:, :n] / scale, scale[:, None] * rates[:, n:], row)


def _rates(motion: Motion, made: StateColumns, over: Array) -> tuple[Array, Array]:
    """Rates of the states over states and inputs, docs/theory/linearisation.md (7), and their values at the instant."""
    instant, local = motion.instant, motion.local
    kept, accelerations = made.speeds, motion.prescribed_accelerations
    directions = (motion.D @ motion.free.Z)[:, kept]
    push = directions.T @ (motion.follow(local.torque) @ over)
    now = directions.T @ local.torque[:, -1]
    if len(motion.ties.first):
        pushed, pulled = _of_ties(motion)
        push, now = push + pushed[kept] @ over, now + pulled[kept]
    for place in made.driven:
        pull = motion.mass_p[kept, made.given[place].motion]
        push[:, made.n + place] -= pull
        now -= pull * accelerations[made.given[place].motion]
    mass = motion.mass[np.ix_(kept, kept)]
    driven = np.zeros((len(made.driven), over.shape[1]))
    driven[np.arange(len(made.driven)), [made.n + place for place in made.driven]] = 1.0
    rates = [
        np.linalg.solve(mass, push) if len(kept) else push,
        (motion.follow(local.rate) @ over)[made.own],
        (motion.node_speeds @ over)[made.nodes],
        driven,
    ]
    drift = [
        np.linalg.solve(mass, now) if len(kept) else now,
        local.rate[made.own, -1],
        instant.part("speed")[made.nodes],
        np.array([accelerations[made.given[place].motion] for place in made.driven]),
    ]
    return np.vstack(rates), np.concatenate(drift)


def _of_ties(motion: Motion) -> tuple[Array, Array]:
    """What ratios that vary add to the torques of the speeds that stay, over the base columns, and its value."""
    ties, local, free = motion.ties, motion.local, motion.free
    inertia = free.Z.T @ (motion.M @ motion.tied)
    by_state = local.split(local.ratio)[1] @ motion.follow(local.rate)
    slopes = motion.tied_slopes() + ties.rate[:, None] * by_state
    turned = (motion.D[ties.second] @ free.Z).T @ (ties.torque[:, None] * motion.ratios)
    return -turned - inertia @ slopes, -inertia @ (local.ratio_slope[:, -1] * ties.rate)


def _row(motion: Motion, made: StateColumns, over: Array, rates: Array) -> Array:
    """Derivatives of the output row over states, inputs and slopes of inputs: docs/theory/linearisation.md (9)."""
    system, local, n = motion.system, motion.local, made.n
    count = len(made.given)
    base = np.hstack([over, np.zeros((len(over), count))])
    slopes = np.hstack([over[:, :n] @ rates, over[:, n:]])
    ties = motion.ties
    speed = motion.speeds @ base
    acceleration = motion.speeds @ slopes + motion.tied @ (motion.tied_slopes() @ base)
    torque = motion.follow(local.torque) @ base
    # effect of the change of a ratio on the torque along its second way
    torque[ties.second] -= ties.torque[:, None] * (motion.ratios @ base)
    load = motion.M @ acceleration + system.mass_prescribed @ (motion.p @ slopes) - motion.D.T @ torque
    elements = system.counts["elements"]
    contact = torque[elements:]
    held, tied = np.split(torque_change(_holding(motion, base), load), [len(motion.held)])
    contact[motion.held] += held
    torque[ties.first] += tied
    torque[ties.second] -= ties.ratio[:, None] * tied
    given = motion.p @ base, motion.p @ slopes
    parts = {
        "speed": system.basis @ speed + system.basis_prescribed @ given[0],
        "angle": np.hstack([made.angles, np.zeros((len(made.angles), count))]),
        "acceleration": system.basis @ acceleration + system.basis_prescribed @ given[1],
        "state": motion.s @ base,
        "element_torque": torque[:elements],
        "contact_torque": contact,
        "contact_capacity": motion.follow(local.capacity) @ base,
        "flow": motion.follow(local.flow) @ base,
        "input": motion.i @ base,
    }
    row = np.zeros((motion.instant.wiring.row_size, base.shape[1]))
    for name, lines in parts.items():
        row[motion.instant.wiring.columns[name]] = lines
    return row


def _holding(motion: Motion, base: Array) -> Holding:
    """The locked contacts, and how the capacity of each changes."""
    instant, held = motion.instant, motion.held
    branches = motion.local.torque[motion.system.counts["elements"] :, -1]
    most, least = motion.local.most[held], motion.local.least[held]
    # transmissions hold any torque
    ties = len(motion.ties.first)
    endless, still = np.full((2, ties), np.inf), np.zeros((2, ties, base.shape[1]))
    return Holding(
        np.vstack([motion.system.contact_rate[held], motion.ties.row]),
        np.concatenate([(instant.part("contact_torque") - branches)[held], motion.ties.torque]),
        np.hstack([np.stack([most[:, -1], -least[:, -1]]), endless]),
        np.concatenate([np.stack([motion.follow(most) @ base, -(motion.follow(least) @ base)]), still], axis=1),
    )


def _values(motion: Motion, made: StateColumns) -> Array:
    """Values of the states at the instant, as they are shown."""
    instant, shown = motion.instant, own_states(motion.instant.wiring)
    names = [node.name for node in motion.system.nodes]
    places = [names.index(motion.kept_node(int(k)).name) for k in made.speeds]
    prescribed = instant.part("input")[motion.system.prescribed_input]
    moved = [one.motion for one in made.given if one.motion >= 0 and not one.accelerates]
    shift = motion.momentum_shift()[made.speeds][:, moved] @ prescribed[moved]
    own = [shown[k].offset + shown[k].scale * instant.part("state")[k] for k in made.own]
    driven = [prescribed[made.given[place].motion] for place in made.driven]
    speeds = instant.part("speed")[places] + shift
    return np.concatenate([speeds, np.array(own), instant.part("angle")[made.nodes], np.array(driven)])
