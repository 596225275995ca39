"""Shafts that coast in neutral."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from clutchwork.hints.hint import Hint, shown, together
from clutchwork.hints.look import Look
from clutchwork.hints.registry import run_rule
from clutchwork.results.channels import SPEED

NAME = "turns freely"
# share of a run that is worth a word
LONG = 0.1
# share of the highest speed in a run below which a shaft counts as standing
SLOW = 0.01
MOST_NAMED = 5


@run_rule(NAME)
def turns_freely(look: Look) -> Iterator[Hint]:
    """Shafts that contacts have driven, and that turn at the end with no torque on them at all."""
    last = tuple(np.flatnonzero(look.closed[-1]).tolist())
    # the shaft of a single contact that opens turns freely because it was opened
    if len(look.contacts) < 2 or len(last) == len(look.contacts):
        return
    other = np.any(look.closed != look.closed[-1], axis=1)
    if not np.any(other):
        return
    first = int(np.flatnonzero(other)[-1]) + 1
    begin = float(look.time[first])
    if look.end - begin < LONG * look.duration:
        return
    own = _coasting(look, look.motion.untouched(last), first)
    top = float(np.max(np.abs(look.part("speed")), initial=0.0))
    nodes = [k for k in np.argsort(-np.abs(own)).tolist() if abs(own[k]) > max(SLOW * top, 0.0)]
    if nodes:
        yield _hint(look, nodes, begin)


def _coasting(look: Look, free: NDArray[np.float64], row: int) -> NDArray[np.float64]:
    """Share of the speed of each node that nothing acts on."""
    inertia = np.array([float(node.inertia) for node in look.system.nodes])
    if not free.shape[1]:
        return np.zeros(len(inertia))
    mass = free.T @ (inertia[:, None] * free)
    momentum = free.T @ (inertia * look.part("speed")[row])
    made: NDArray[np.float64] = free @ np.linalg.solve(mass, momentum)
    return made


def _hint(look: Look, nodes: list[int], begin: float) -> Hint:
    named = [look.system.nodes[k] for k in nodes]
    speeds = [float(look.part("speed")[-1, k]) for k in nodes]
    named_speeds = [
        f"{node.name} with {shown(speed, SPEED[node.domain])}" for node, speed in zip(named, speeds, strict=True)
    ]
    more = f" and {len(nodes) - MOST_NAMED} more" if len(nodes) > MOST_NAMED else ""
    message = (
        f"from {begin:.4g} s to the end no element and no closed contact acts on this motion, so nothing slows it down:"
        f" {together(named_speeds[:MOST_NAMED])}{more}"
    )
    remedy = "give it drag if it should slow down, such as a Damper or BearingFriction, or keep a contact closed"
    numbers = {f"{node.name} [{SPEED[node.domain]}]": speed for node, speed in zip(named, speeds, strict=True)}
    return Hint(NAME, tuple(node.name for node in named), message, remedy, numbers, begin, look.end)
