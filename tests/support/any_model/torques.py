"""Torques of every row: in balance, within what contacts hold, taking power, as their laws say."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.assembly.wiring import Branch
from clutchwork.declare.node import Work
from clutchwork.model.parts import is_stop
from support.any_model.seen import Array, Fault, Seen
from support.any_model.signals import sides

# round-off of torques that balance, of the largest at the nodes that are joined rigidly
BALANCE = 1e-6
# the same where a ratio follows an angle, which rows give to the tolerance
VARYING = 1e-5
# of a torque at its capacity
CAPACITY = 1e-6
# of the sum of all torques: round-off of the largest, which a decision concedes to what holds little beside it, and as
# much of the row
ROUND_OFF = 2e-11
# of a speed beside the largest one there
SPEED = 1e-8
FORWARD, BACKWARD, LOCKED, OPEN = 1, -1, 0, 2
# elements that lose power and keep a little of it in a state, or that the wind drives
BRISTLES = {"tyre", "torque_converter"}
WINDY = {"air_drag"}


def balance(seen: Seen) -> Iterator[Fault]:
    """At each node inertia times acceleration is the sum of torques; without inertia the sum is zero."""
    left = seen.part("acceleration") * seen.inertia - seen.part("element_torque") @ seen.elements.T
    left = left - seen.part("contact_torque") @ seen.contacts.T
    if seen.rigid.shape[1]:
        # what rows of gears and prescribed motions can take
        axes, sizes, _ = np.linalg.svd(seen.rigid)
        taken = axes[:, : int(np.sum(sizes > 1e-12 * sizes.max(initial=1e-300)))]
        left = left - (left @ taken) @ taken.T
    varies = any("ratio" in branch.component.hooks for branch in seen.wiring.elements)
    share = max(VARYING if varies else BALANCE, 10.0 * seen.rtol)
    bad = np.abs(left) - share * (seen.terms + 1e-3 * seen.terms.max(initial=0.0)) - 1e-9 - seen.turning[:, None]
    for number, node in enumerate(seen.wiring.nodes):
        of = f"{'node' if node.inertia else 'massless'} {_at(seen, number)}"
        name, size = f"{node.name}: ", seen.terms[:, number]
        words = lambda at, name=name, n=number, size=size: f"{name}{left[at, n]:.3g} of {size[at]:.3g} N m are left"  # noqa: E731
        yield from seen.worst("balance", of, bad[:, number], words)


def _at(seen: Seen, number: int) -> str:
    """Kinds of what acts at a node along a ratio, or by its load."""
    there = set()
    for branch in (*seen.wiring.elements, *seen.wiring.contacts):
        if number in branch.direction and (branch.component.work == Work(0) or "bound" in branch.component.hooks):
            there.add(seen.kind(branch))
    return "+".join(sorted(there))


def sticking(seen: Seen) -> Iterator[Fault]:
    """A locked contact has no slip and holds no more than its capacity; signs of slip are those of the mode."""
    for number, branch in enumerate(seen.wiring.contacts):
        yield from _locked(seen, number, branch)
        if getattr(branch.component.friction, "sticks", True):
            yield from _slipping(seen, number, branch)


def _locked(seen: Seen, number: int, branch: Branch) -> Iterator[Fault]:
    of, component = seen.kind(branch), branch.component
    scale, slip = seen.scale(branch), seen.speed @ seen.contacts[:, number]
    torque, capacity = (seen.part(name)[:, number] for name in ("contact_torque", "contact_capacity"))
    locked = seen.part("contact_mode")[:, number] == LOCKED
    still = max(SPEED * scale + (1e-7 if is_stop(component) else 1e-9), seen.zero)
    creeping = np.where(locked, np.abs(slip), 0.0) - still
    words = lambda at: f"{branch.name} locked with slip {slip[at]:.3g} of {scale:.3g}"  # noqa: E731
    yield from seen.worst("creeps", of, creeping, words)
    # what a fault has shut holds all
    if is_stop(component) or getattr(component, "fault", "none") == "cannot_unlock":
        return
    held = capacity * (1.0 + CAPACITY)
    beyond = np.maximum(-torque - held, torque - np.maximum(held, _ahead(component)))
    noise = 1e-7 + 1e-8 * np.abs(torque).max(initial=0.0) + ROUND_OFF * seen.all_torques + seen.turning
    over = np.where(locked, beyond, 0.0) - noise
    yield from seen.worst(
        "capacity", of, over, lambda at: f"{branch.name} holds {torque[at]:.6g} of {capacity[at]:.6g} N m"
    )


def _ahead(component: Any) -> float:
    """What a freewheel holds beside its friction."""
    return float(getattr(component, "holding", np.inf)) if component.one_way else 0.0


def _slipping(seen: Seen, number: int, branch: Branch) -> Iterator[Fault]:
    of, component = seen.kind(branch), branch.component
    scale, slip = seen.scale(branch), seen.speed @ seen.contacts[:, number]
    mode, torque = (seen.part(name)[:, number] for name in ("contact_mode", "contact_torque"))
    # a slip ends where it is as large as its tolerance, but for round-off
    own = component.tolerance + 1e-13 * scale if hasattr(component, "tolerance") else 0.0
    tolerance = max(SPEED * scale, own, 1e-7)
    tolerance = max(tolerance, component.friction.band if component.friction is not None else 0.0)
    if not is_stop(component):
        for sign, word in ((FORWARD, "forward"), (BACKWARD, "backward")):
            wrong = np.where(mode == sign, -sign * slip, 0.0) - tolerance
            words = lambda at, word=word: f"{branch.name} is {word} with slip {slip[at]:.3g}"  # noqa: E731
            yield from seen.worst("mode", of, wrong, words)
    still = np.where(mode == OPEN, np.abs(torque), 0.0) - 1e-9
    yield from seen.worst("open", of, still, lambda at: f"{branch.name} is open with {torque[at]:.3g} N m")


def drives(seen: Seen) -> Iterator[Fault]:
    """Friction takes power and never gives any; so do dampers."""
    rate, torque, mode = seen.speed @ seen.contacts, seen.part("contact_torque"), seen.part("contact_mode")
    for number, branch in enumerate(seen.wiring.contacts):
        # where a torque turns around within a step, the row shows a load before it and a torque behind
        turns = seen.chatters and "bound" in branch.component.hooks
        if not turns and not is_stop(branch.component) and getattr(branch.component.friction, "sticks", True):
            power = np.where(mode[:, number] == LOCKED, 0.0, rate[:, number] * torque[:, number])
            # within its tolerance a contact counts as at rest, and goes the way it is driven
            near = SPEED * seen.scale(branch) + 1e-7 + getattr(branch.component, "tolerance", 0.0)
            slack = np.abs(torque[:, number]) * near
            # a load is a difference of all torques
            if "bound" in branch.component.hooks:
                slack = slack + ROUND_OFF * seen.all_torques * np.abs(rate[:, number])
                slack = np.where(seen.runs_away, np.inf, slack)
            # where the load turns around the step ends on its interpolant, which is good to some tolerances
            share = max(1e-7, 10.0 * seen.rtol) if "bound" in branch.component.hooks else 1e-7
            yield from _gives(seen, branch, power, slack, share)
    rate, torque = seen.speed @ seen.elements, seen.part("element_torque")
    for numbers in seen.numbers(Work.LOSS):
        branch = seen.wiring.elements[numbers[0]]
        if branch.component.kind not in BRISTLES | WINDY:
            powers = rate[:, numbers] * torque[:, numbers]
            yield from _gives(seen, branch, powers.sum(axis=1), 1e-7 * np.abs(powers).sum(axis=1))


def _gives(seen: Seen, branch: Branch, power: Array, slack: Array, share: float = 1e-7) -> Iterator[Fault]:
    bad = power - slack - 1e-7 - share * np.abs(power).max(initial=0.0)
    yield from seen.worst("drives", seen.kind(branch), bad, lambda at: f"{branch.name} gives {power[at]:.3g} W")


def laws(seen: Seen) -> Iterator[Fault]:
    """Springs, dampers and torques that are signals are what they say; the twist of a spring is that of its ends."""
    torque, rate = seen.part("element_torque"), seen.speed @ seen.elements
    for number, branch in enumerate(seen.wiring.elements):
        own, passive = torque[:, number], branch.component.passive()
        if passive is not None:
            wanted = -passive.damping * rate[:, number]
            if passive.stiffness and branch.states:
                spring = seen.part("state")[:, branch.states[0][2]]
                wanted = wanted - spring
                yield from _twist(seen, number, branch, spring / passive.stiffness)
        elif isinstance(branch.component, cw.Torque) and isinstance(branch.component.torque, cw.Signal | float | int):
            wanted = _nearest(own, np.array([sides(branch.component.torque, t) for t in seen.time]))
        else:
            continue
        bad = np.abs(own - wanted) - 1e-7 * (np.abs(wanted) + np.abs(wanted).max(initial=0.0)) - 1e-9
        words = lambda at, b=branch, o=own, w=wanted: f"{b.name}: {o[at]:.6g} for {w[at]:.6g} N m"  # noqa: E731
        yield from seen.worst("law", seen.kind(branch), bad, words)


def flanks(seen: Seen) -> Iterator[Fault]:
    """Elastic flanks push where they are pressed, as their spring where they close, and not inside of their gap."""
    torque, rate = seen.part("element_torque"), seen.speed @ seen.elements
    for number, branch in enumerate(seen.wiring.elements):
        part = branch.component
        if not isinstance(part, cw.ElasticBacklash | cw.ElasticGap):
            continue
        state = seen.part("state")[:, branch.states[0][2]]
        backlash = isinstance(part, cw.ElasticBacklash)
        side = np.sign(state) if backlash else -np.ones(len(state))
        depth = side * state - (0.5 * part.gap if backlash else 0.0)
        push, spring = -side * torque[:, number], part.stiffness * np.maximum(depth, 0.0)
        closes = side * rate[:, number] >= 0.0
        missing = np.where(closes, spring - push, -push)
        wrong = np.maximum(missing, np.where(depth < 0.0, np.abs(push), 0.0))
        # the border of the gap is known as states are
        near = part.stiffness * 1e-9 * max(1.0, float(np.abs(state).max(initial=0.0)))
        bad = wrong - 1e-7 * (spring + np.abs(push)) - near - 1e-9
        words = lambda at, b=branch, p=push, d=depth: f"{b.name} pushes with {p[at]:.6g} N m {d[at]:.3g} rad deep"  # noqa: E731
        yield from seen.worst("flank", seen.kind(branch), bad, words)


def _nearest(own: Array, both: Array) -> Array:
    """Of the values around each instant the one that is nearest."""
    found: Array = both[np.arange(len(both)), np.argmin(np.abs(own[:, None] - both), axis=1)]
    return found


def _twist(seen: Seen, number: int, branch: Branch, twist: Array) -> Iterator[Fault]:
    angle = seen.part("angle") @ seen.elements[:, number]
    drift, moved = float(np.ptp(twist - angle)), float(np.ptp(angle))
    if drift > 1e-3 * max(1e-6, moved) + 100.0 * seen.rtol * float(np.abs(angle).max(initial=0.0)):
        yield Fault("twist", seen.kind(branch), f"{branch.name} leaves its ends by {drift:.3g} of {moved:.3g} rad")
