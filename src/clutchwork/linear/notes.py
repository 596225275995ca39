"""What is undecided at an instant, and which side a linear system takes: docs/theory/linearisation.md."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from clutchwork.declare.layout import MODES
from clutchwork.linear.shares import dependent

if TYPE_CHECKING:
    from clutchwork.linear.motion import Motion

# a torque within this part of the capacity is at it
AT_CAPACITY = 1e-9
# N m
IDLE = 1e-9


def notes(motion: Motion) -> Iterator[str]:
    """One sentence for each."""
    instant, system = motion.instant, motion.system
    for event in instant.events:
        yield f"{event.element} goes from {event.before} to {event.after} at this instant: the motion after it is used"
    if not instant.events:
        names = [
            item.name for item in system.inputs if item.name not in instant.held and _is_knot(item.signal, instant.time)
        ]
        for name in names:
            yield f"{name} has a knot at this instant: the motion after it is used"
    yield from _slips_at_rest(motion)
    yield from _at_capacity(motion)
    yield from _without_load(motion)


def _is_knot(signal: object, time: float) -> bool:
    pieces, period = list(signal.segments()), signal.repeats()  # type: ignore[attr-defined]
    starts = np.array([piece.start for piece in pieces[0 if period else 1 :]])
    if period:
        at = time % period
        away = np.minimum(np.abs(starts % period - at), period - np.abs(starts % period - at))
    else:
        away = np.abs(starts - time)
    return time > 0.0 and bool(np.any(away <= 1e-12 * max(1.0, time)))


def _slips_at_rest(motion: Motion) -> Iterator[str]:
    instant, first = motion.instant, motion.system.counts["elements"]
    speed = instant.part("speed")
    tolerance = 1e-9 * (1.0 + float(np.max(np.abs(speed), initial=0.0)))
    for number, branch in enumerate(instant.wiring.contacts):
        mode = MODES[int(instant.modes[number])]
        slip = sum(factor * speed[node] for node, factor in branch.direction.items() if node >= 0)
        acts = motion.local.torque[first + number].any()
        if (
            mode in ("forward", "backward")
            and acts
            and abs(slip) <= tolerance
            and branch.component.friction is not None
        ):
            law = branch.component.friction
            if law.sticks:
                yield f"{branch.name} has no slip but is not locked: it is taken as slipping {mode}"
            elif not law.own_states():
                yield f"{branch.name} has no slip: its law {type(law).__name__} is taken on the side {mode}"


def _at_capacity(motion: Motion) -> Iterator[str]:
    instant = motion.instant
    B = motion.system.contact_rate[motion.held]
    # a freewheel has no capacity, and those that share a load reach it together
    shared = dependent(B) if len(B) and np.all(np.abs(B).max(axis=1) > 0.0) else np.zeros(len(B), dtype=bool)
    for number, number_shared in zip(motion.held, shared, strict=True):
        contact = motion.system.contacts[number]
        torque, capacity = (float(instant.part(part)[number]) for part in ("contact_torque", "contact_capacity"))
        if contact.one_way and abs(torque) <= IDLE:
            yield f"{contact.name} is locked without load: it is taken as locked, though it could overrun the other way"
        if contact.one_way or number_shared:
            continue
        if abs(torque) >= (1.0 - AT_CAPACITY) * capacity:
            yield f"{contact.name} is at its capacity, {capacity:g} N m: it is taken as locked"


def _without_load(motion: Motion) -> Iterator[str]:
    instant, capacity = motion.instant, motion.local.capacity
    names = [
        contact.name
        for number, contact in enumerate(motion.system.contacts)
        if MODES[int(instant.modes[number])] == "open" and capacity[number, -1] == 0.0 and capacity[number, :-1].any()
    ]
    if len(names) == 1:
        yield f"{names[0]} is open, its load exactly zero: it is taken as open, though any load would close it"
    elif names:
        yield f"{', '.join(names)} are open, their loads exactly zero: any load would close one, they are taken as open"
