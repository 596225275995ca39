"""What every row of a result must satisfy, whatever the model: a check of each, and all of them.

A check gets what `Seen` holds of a run and yields faults: the kind of what is wrong, where, and how much.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import clutchwork as cw
from clutchwork.assembly.wiring import HOUSING, Branch
from clutchwork.declare.node import Work
from clutchwork.model.parts import is_stop

Array = NDArray[np.float64]
# round-off of torques that balance, of the largest at the nodes that are joined rigidly
BALANCE = 1e-6
# of a torque at its capacity
CAPACITY = 1e-6
# of a speed beside the largest one there
SPEED = 1e-8
# of energies beside the largest one of the run, at the default tolerance
ENERGY = 1e-4
FORWARD, BACKWARD, LOCKED, OPEN = 1, -1, 0, 2


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
        self.run, self.wiring, self.rows, self.time = run, run.wiring, run.rows, run.time
        self.inertia = np.array([node.inertia for node in self.wiring.nodes])

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

    @cached_property
    def kinds(self) -> dict[str, str]:
        """Kind of every element of the model by name."""
        return {element.name: element.kind for element in self.run.system.source.elements}

    def kind(self, branch: Branch) -> str:
        """Kind of the element of the model that a branch belongs to, with its own where it is a part."""
        name = branch.component.name
        words = name.split(".")
        whole = next((".".join(words[:n]) for n in range(len(words), 0, -1) if ".".join(words[:n]) in self.kinds), name)
        own, of = branch.component.kind, self.kinds.get(whole, branch.component.kind)
        return own if own == of else f"{of}/{own}"

    @cached_property
    def jumps(self) -> set[float]:
        """Instants at which speeds may jump: impulses."""
        return {event.time for event in self.run.events if event.energy_before != event.energy_after}


Check = Callable[[Seen], Iterator[Fault]]


def _worst(bad: Array) -> int:
    return int(np.argmax(bad))


def finite(seen: Seen) -> Iterator[Fault]:
    """All numbers are finite."""
    if not np.all(np.isfinite(seen.rows)):
        yield Fault("finite", "", f"{int((~np.isfinite(seen.rows)).sum())} numbers are not")


def times(seen: Seen) -> Iterator[Fault]:
    """Rows rise in time from the start to the end."""
    run, time = seen.run, seen.time
    if np.any(np.diff(time) < 0.0):
        yield Fault("times", "", "times fall")
    if len(time) and time[0] != run.options.t_start:
        yield Fault("times", "", f"starts at {time[0]:g} s, t_start is {run.options.t_start:g} s")
    if run.status == "done" and time[-1] != run.t_end:
        yield Fault("times", "", f"ends at {time[-1]:g} s, t_end is {run.t_end:g} s")


def balance(seen: Seen) -> Iterator[Fault]:
    """At each node inertia times acceleration is the sum of torques; without inertia the sum is zero."""
    left = seen.part("acceleration") * seen.inertia - seen.part("element_torque") @ seen.elements.T
    left = left - seen.part("contact_torque") @ seen.contacts.T
    if seen.rigid.shape[1]:
        # what rows of gears and prescribed motions can take
        basis = np.linalg.svd(seen.rigid)
        rank = int(np.sum(basis[1] > 1e-12 * max(basis[1].max(initial=0.0), 1e-300)))
        taken = basis[0][:, :rank]
        left = left - (left @ taken) @ taken.T
    # a ratio that varies follows an angle, which rows give to the tolerance
    varies = any("ratio" in branch.component.hooks for branch in seen.wiring.elements)
    share, floor = (
        (max(1e-5, 10.0 * seen.run.options.rtol), 1e-5)
        if varies
        else (max(BALANCE, 10.0 * seen.run.options.rtol), 1e-6)
    )
    bad = np.abs(left) - share * seen.terms - (1e-3 * share + 1e-6 * floor) * seen.terms.max(initial=0.0) - 1e-9
    for number, node in enumerate(seen.wiring.nodes):
        if bad[:, number].max(initial=0.0) > 0.0:
            at = _worst(bad[:, number])
            rows = int((bad[:, number] > 0.0).sum())
            sort = "node" if node.inertia else "massless"
            words = f"{node.name}: {left[at, number]:.3g} of {seen.terms[at, number]:.3g} N m are left at {seen.time[at]:.9g} s, {rows} rows"
            yield Fault("balance", f"{sort} {_at(seen, number)}", words)


def _at(seen: Seen, number: int) -> str:
    """Kinds of what acts along a ratio that is not a gear at a node, which are those that may be out of balance."""
    branches = [*seen.wiring.elements, *seen.wiring.contacts]
    there = {
        seen.kind(b)
        for b in branches
        if number in b.direction and (b.component.work == Work(0) or "bound" in b.component.hooks)
    }
    return "+".join(sorted(there))


def sticking(seen: Seen) -> Iterator[Fault]:
    """A locked contact has no slip and holds no more than its capacity; signs of slip are those of the mode."""
    rate, torque = seen.speed @ seen.contacts, seen.part("contact_torque")
    mode, capacity = seen.part("contact_mode"), seen.part("contact_capacity")
    for number, branch in enumerate(seen.wiring.contacts):
        of = seen.kind(branch)
        nodes = [node for node in branch.direction if node != HOUSING]
        scale = max([seen.fastest[node] * abs(branch.direction[node]) for node in nodes], default=1.0)
        locked, slip = mode[:, number] == LOCKED, rate[:, number]
        tolerance = max(
            SPEED * scale,
            float(getattr(branch.component, "tolerance", 0.0) or 0.0),
            getattr(branch.component.friction, "band", 0.0) or 0.0,
            1e-7,
        )
        creeping = np.where(locked, np.abs(slip), 0.0) - SPEED * scale - (1e-7 if is_stop(branch.component) else 1e-9)
        # what passes a stop or is held by a tolerance may keep a little of its slip
        if creeping.max(initial=0.0) > 0.0:
            at = _worst(creeping)
            yield Fault(
                "creeps",
                of,
                f"{branch.name} locked with slip {slip[at]:.3g} of {scale:.3g} at {seen.time[at]:.9g} s, {int((creeping > 0).sum())} rows",
            )
        size = float(np.abs(torque[:, number]).max(initial=0.0))
        held = capacity[:, number] * (1.0 + CAPACITY)
        beyond = np.maximum(-torque[:, number] - held, torque[:, number] - np.maximum(held, _ahead(branch.component)))
        over = np.where(locked, beyond, 0.0)
        # what a fault has shut holds all
        shut = getattr(branch.component, "fault", "none") == "cannot_unlock"
        if not shut and not is_stop(branch.component) and over.max(initial=0.0) > 1e-7 + 1e-8 * size:
            at = _worst(over)
            words = f"{branch.name} holds {torque[at, number]:.6g} of {capacity[at, number]:.6g} N m at {seen.time[at]:.9g} s, {int((over > 0).sum())} rows"
            yield Fault("capacity", of, words)
        if not getattr(branch.component.friction, "sticks", True):
            continue
        for sign, word in ((FORWARD, "forward"), (BACKWARD, "backward")):
            wrong = np.where(mode[:, number] == sign, -sign * slip, 0.0) - tolerance
            if wrong.max(initial=0.0) > 0.0 and not is_stop(branch.component):
                at = _worst(wrong)
                yield Fault(
                    "mode",
                    of,
                    f"{branch.name} is {word} with slip {slip[at]:.3g} at {seen.time[at]:.9g} s, {int((wrong > 0).sum())} rows",
                )
        still = np.where(mode[:, number] == OPEN, np.abs(torque[:, number]), 0.0)
        if still.max(initial=0.0) > 1e-9:
            yield Fault("open", of, f"{branch.name} is open with {still.max():.3g} N m")


def _ahead(component: Any) -> float:
    """What a freewheel holds beside its friction."""
    return float(getattr(component, "holding", np.inf)) if component.one_way else 0.0


def drives(seen: Seen) -> Iterator[Fault]:
    """Friction takes power and never gives any; so do dampers."""
    rate, torque = seen.speed @ seen.contacts, seen.part("contact_torque")
    mode = seen.part("contact_mode")
    for number, branch in enumerate(seen.wiring.contacts):
        if is_stop(branch.component) or not getattr(branch.component.friction, "sticks", True):
            continue
        power = np.where(mode[:, number] == LOCKED, 0.0, rate[:, number] * torque[:, number])
        nodes = [node for node in branch.direction if node != HOUSING]
        scale = max([seen.fastest[node] * abs(branch.direction[node]) for node in nodes], default=1.0)
        size = np.abs(torque[:, number]) * (SPEED * scale + 1e-7) + 1e-7 + 1e-7 * np.abs(power).max(initial=0.0)
        yield from _gives(seen, branch, power, size)
    rate, torque = seen.speed @ seen.elements, seen.part("element_torque")
    groups: dict[str, list[int]] = {}
    for number, branch in enumerate(seen.wiring.elements):
        groups.setdefault(branch.component.name, []).append(number)
    for numbers in groups.values():
        branch = seen.wiring.elements[numbers[0]]
        if (
            branch.component.work != Work.LOSS
            or (branch.component.states
            and branch.component.kind in BRISTLES)
            or branch.hidden
        ):
            continue
        if branch.component.kind in WINDY:
            continue
        power = (rate[:, numbers] * torque[:, numbers]).sum(axis=1)
        size = 1e-7 * np.abs(rate[:, numbers] * torque[:, numbers]).sum(axis=1) + 1e-9
        yield from _gives(seen, branch, power, size)


# elements that lose power and keep a little of it in a state, or that the wind drives
BRISTLES = {"tyre", "torque_converter"}
WINDY = {"air_drag"}


def _gives(seen: Seen, branch: Branch, power: Array, slack: Array) -> Iterator[Fault]:
    bad = power - slack
    if bad.max(initial=0.0) > 0.0:
        at = _worst(bad)
        yield Fault(
            "drives",
            seen.kind(branch),
            f"{branch.name} gives {power[at]:.3g} W at {seen.time[at]:.9g} s, {int((bad > 0).sum())} rows",
        )


def ratios(seen: Seen) -> Iterator[Fault]:
    """Rigid rows hold for speeds and accelerations; what neither stores nor loses passes all power on."""
    for row in seen.wiring.gears:
        for part, name in ((seen.speed, "speeds"), (seen.part("acceleration"), "accelerations")):
            terms = np.array([factor * part[:, node] for node, factor in row.ports.values() if node != HOUSING])
            size = np.abs(terms).max(axis=0, initial=0.0)
            bad = np.abs(terms.sum(axis=0)) - 1e-8 * (size + 1e-3 * size.max(initial=0.0)) - 1e-9
            if bad.max(initial=0.0) > 0.0:
                at = _worst(bad)
                yield Fault(
                    "ratio",
                    name,
                    f"{row.name}: {name} miss by {terms.sum(axis=0)[at]:.3g} of {size[at]:.3g} at {seen.time[at]:.9g} s, {int((bad > 0).sum())} rows",
                )
    rate, torque = seen.speed @ seen.elements, seen.part("element_torque")
    groups: dict[str, list[int]] = {}
    for number, branch in enumerate(seen.wiring.elements):
        if branch.component.work == Work(0) and not branch.hidden:
            groups.setdefault(branch.component.name, []).append(number)
    for numbers in groups.values():
        branch = seen.wiring.elements[numbers[0]]
        powers = rate[:, numbers] * torque[:, numbers]
        size = np.abs(seen.speed[:, None, :] * seen.elements.T[None, numbers] * torque[:, numbers, None]).sum(
            axis=(1, 2)
        )
        bad = (
            np.abs(powers.sum(axis=1))
            - max(1e-5, 100.0 * seen.run.options.rtol) * (size + 1e-3 * size.max(initial=0.0))
            - 1e-7
        )
        bad = bad - 1e-9 * np.abs(rate * torque).max(initial=0.0)
        if bad.max(initial=0.0) > 0.0:
            at = _worst(bad)
            yield Fault(
                "passes",
                seen.kind(branch),
                f"{branch.component.name} keeps {powers.sum(axis=1)[at]:.3g} of {size[at]:.3g} W at {seen.time[at]:.9g} s, {int((bad > 0).sum())} rows",
            )


def motions(seen: Seen) -> Iterator[Fault]:
    """Prescribed speeds and accelerations are those of their signals."""
    for branch in seen.wiring.motions:
        whole = next((e for e in seen.run.system.source.elements if e.name == branch.component.name), branch.component)
        along = seen.wiring.spread((branch,))[:, 0]
        if isinstance(whole, cw.PrescribedSpeed) and whole.cutoff is None:
            given, signal, what = seen.speed @ along, whole.speed, "speed"
        elif isinstance(whole, cw.PrescribedAcceleration):
            given, signal, what = seen.part("acceleration") @ along, whole.acceleration, "acceleration"
        else:
            continue
        if not isinstance(signal, cw.Signal | float | int):
            continue
        wanted = np.array([sides(signal, t) for t in seen.time])
        nearest = np.clip(given, wanted.min(axis=1), wanted.max(axis=1))
        missed = (
            np.abs(given - nearest)
            - 1e-7 * (np.abs(wanted).max(axis=1) + 1e-3 * np.abs(wanted).max(initial=0.0))
            - 1e-9
        )
        if missed.max(initial=0.0) > 0.0:
            at = _worst(missed)
            yield Fault(
                "motion",
                whole.kind,
                f"{whole.name}: {what} {given[at]:.6g} for {wanted[at]} at {seen.time[at]:.9g} s, {int((missed > 0).sum())} rows",
            )


def sides(signal: Any, time: float) -> tuple[float, float]:
    """Value of a signal just before and at an instant."""
    if not isinstance(signal, cw.Signal):
        return float(signal), float(signal)
    pieces, period = signal.segments(), signal.repeats()
    found = []
    for nudge in (-1e-12, 1e-12):
        at = time + nudge * max(1.0, time)
        if period and at >= pieces[0].start:
            at = pieces[0].start + (at - pieces[0].start) % period
        place = max((k for k, piece in enumerate(pieces) if piece.start <= at), default=-1)
        piece = pieces[place] if place >= 0 or not period else pieces[-1]
        s = at - piece.start if place >= 0 else 0.0
        value = piece.c0 + s * (piece.c1 + s * (piece.c2 + s * piece.c3))
        value += sum(a * np.exp(-decay * s) * np.sin(omega * s + phase) for a, omega, phase, decay in piece.waves)
        found.append(float(value))
    return found[0], found[1]


def energies(seen: Seen) -> Iterator[Fault]:
    """The balance of energies closes, and heat never falls."""
    run = seen.run
    if len(run) < 2:
        return
    found = run.energy
    kinetic = 0.5 * (seen.inertia * seen.speed**2).sum(axis=1)
    # work goes back and forth: what passes counts, not what is left of it
    works = [
        np.abs(np.diff(seen.part(name), axis=0)).sum() for name in ("element_work", "contact_work", "prescribed_work")
    ]
    size = max(found.turnover, float(kinetic.max(initial=0.0)), *works, 1e-6)
    if abs(found.residual) > max(ENERGY, 100 * run.options.rtol) * size:
        yield Fault("energy", _suspects(seen), f"residual {found.residual:.3g} of {size:.3g} J")


def _suspects(seen: Seen) -> str:
    """Kinds that speeds jump at, if any."""
    jumping = {b for b in (seen.kind(b) for b in seen.wiring.elements if b.component.work == Work(0))}
    return "+".join(sorted(jumping))


def heats(seen: Seen) -> Iterator[Fault]:
    """What an element loses, its work less what it stores, never falls."""
    states, torque, work = seen.part("state"), seen.part("element_torque"), seen.part("element_work")
    for number, branch in enumerate(seen.wiring.elements):
        component = branch.component
        if component.work != Work.STORE | Work.LOSS or branch.number:
            continue
        places = [index for *_, index in branch.states]
        stored = np.array(
            [
                component.stored(row, t)
                for row, t in zip(states[:, places].tolist(), torque[:, number].tolist(), strict=True)
            ]
        )
        lost = -work[:, number] - stored
        size = np.abs(np.diff(work[:, number])).sum() + np.abs(stored).max(initial=0.0)
        fall = float((np.maximum.accumulate(lost) - lost).max(initial=0.0))
        if fall > max(1e-4, 100 * seen.run.options.rtol) * size + 1e-9:
            yield Fault("heat", seen.kind(branch), f"{branch.name} gives back {fall:.3g} of {size:.3g} J of heat")


def laws(seen: Seen) -> Iterator[Fault]:
    """Springs and dampers, and torques that are signals, are what they say; of a spring its twist is that of its ends."""
    torque, rate = seen.part("element_torque"), seen.speed @ seen.elements
    states, angle = seen.part("state"), seen.part("angle") @ seen.elements
    for number, branch in enumerate(seen.wiring.elements):
        passive, name = branch.component.passive(), seen.kind(branch)
        wanted = np.zeros(0)
        if passive is not None:
            wanted = -passive.damping * rate[:, number]
            if passive.stiffness and branch.states:
                spring = states[:, branch.states[0][2]]
                wanted = wanted - spring
                twist = spring / passive.stiffness - angle[:, number]
                drift = float(np.ptp(twist))
                slack = 1e-3 * max(1e-6, float(np.ptp(angle[:, number]))) + 100 * seen.run.options.rtol * float(
                    np.abs(angle[:, number]).max(initial=0.0)
                )
                if drift > slack:
                    yield Fault(
                        "twist",
                        name,
                        f"{branch.name}: twist leaves that of its ends by {drift:.3g} of {np.ptp(angle[:, number]):.3g} rad",
                    )
        elif isinstance(branch.component, cw.Torque) and isinstance(branch.component.torque, cw.Signal | float | int):
            both = np.array([sides(branch.component.torque, t) for t in seen.time])
            nearest = np.argmin(np.abs(torque[:, [number]] - both), axis=1)
            wanted = both[np.arange(len(both)), nearest]
        if len(wanted):
            bad = np.abs(torque[:, number] - wanted) - 1e-7 * (np.abs(wanted) + np.abs(wanted).max(initial=0.0)) - 1e-9
            if bad.max(initial=0.0) > 0.0:
                at = _worst(bad)
                yield Fault(
                    "law",
                    name,
                    f"{branch.name}: {torque[at, number]:.6g} for {wanted[at]:.6g} N m at {seen.time[at]:.9g} s, {int((bad > 0).sum())} rows",
                )


def steady(seen: Seen) -> Iterator[Fault]:
    """Between both limits of an instant angles stay, and speeds of what has inertia, unless there is an impulse."""
    pairs = np.flatnonzero(np.diff(seen.time) == 0.0)
    jumping = bool(seen.wiring.motions) or any("ratio" in b.component.hooks for b in seen.wiring.elements)
    for number, node in enumerate(seen.wiring.nodes):
        turned = np.abs(np.diff(seen.part("angle")[:, number])[pairs])
        if turned.max(initial=0.0) > 1e-9 * max(1.0, float(np.abs(seen.part("angle")[:, number]).max(initial=0.0))):
            yield Fault("angle jumps", "", f"{node.name} by {turned.max():.3g}")
        if not node.inertia or jumping:
            continue
        changed = np.abs(np.diff(seen.speed[:, number])[pairs])
        for at in pairs[changed > 1e-7 * seen.fastest[number] + 1e-9]:
            if not any(abs(t - seen.time[at]) <= 1e-12 * max(1.0, t) for t in seen.jumps):
                yield Fault(
                    "speed jumps",
                    "",
                    f"{node.name} from {seen.speed[at, number]:.6g} to {seen.speed[at + 1, number]:.6g} at {seen.time[at]:.9g} s without an impulse",
                )
                break


def smooth(seen: Seen) -> Iterator[Fault]:
    """Changes of speeds are the integrals of accelerations, those of angles of speeds, as far as rows show it."""
    # a sign that is taken at its word turns the torque around at every step
    if any("chatters" in getattr(b.component.friction, "hooks", ()) for b in seen.wiring.contacts):
        return
    step = np.diff(seen.time)
    rest = max(1.0, seen.run.options.rtol / 1e-6)
    for part, rate, name in (("speed", "acceleration", "speeds"), ("angle", "speed", "angles")):
        value, slope = seen.part(part), seen.part(rate)
        for number, node in enumerate(seen.wiring.nodes):
            if not node.inertia:
                continue
            y, dy = value[:, number], slope[:, number]
            near = np.minimum(dy[:-1], dy[1:]), np.maximum(dy[:-1], dy[1:])
            spread = near[1] - near[0]
            # the slope in between may leave that of both ends by as much as it changes nearby
            around = np.convolve(spread, np.ones(5), mode="same") + spread
            slack = (
                step * around
                + 1e-4 * np.abs(np.diff(y))
                + max(1e-6, 100 * seen.run.options.rtol) * (np.abs(y).max(initial=0.0) + 1e-9)
            )
            missed = np.abs(np.diff(y) - 0.5 * step * (dy[1:] + dy[:-1])) - slack
            missed = missed - 1e-7 * rest * np.abs(value).max(initial=0.0)
            missed[step == 0.0] = 0.0
            if missed.max(initial=0.0) > 0.0:
                at = _worst(missed)
                yield Fault(
                    "integral",
                    name,
                    f"{node.name}: {name} change by {np.diff(y)[at]:.6g} for {0.5 * (step * (dy[1:] + dy[:-1]))[at]:.6g} at {seen.time[at]:.9g} s, {int((missed > 0).sum())} rows",
                )


def events(seen: Seen) -> Iterator[Fault]:
    """Events are in order, inside of the run, and each contact goes on from where it was."""
    run = seen.run
    rolls = {branch.name for branch in seen.wiring.contacts if "holding" in branch.component.hooks}
    last, state = -np.inf, dict[str, str]()
    for event in run.events:
        if event.time < last or not run.options.t_start <= event.time <= run.t_end:
            yield Fault("event order", "", f"{event.element} at {event.time:.9g} s after {last:.9g} s")
        last = event.time
        known = state.get(event.element)
        if (
            event.element not in rolls
            and known is not None
            and known != event.before
            and not {known, event.before} & {"open"}
            and event.before != event.after
        ):
            yield Fault(
                "event chain",
                seen.kinds.get(event.element, ""),
                f"{event.element} was {known}, is {event.before} at {event.time:.9g} s",
            )
        state[event.element] = event.after


CHECKS: tuple[Check, ...] = (
    finite,
    times,
    balance,
    sticking,
    drives,
    ratios,
    motions,
    energies,
    heats,
    laws,
    steady,
    smooth,
    events,
)


def faults(run: Any) -> list[Fault]:
    """All that is wrong with the rows of a run."""
    if len(run) < 6:
        return [] if run.status != "done" else [Fault("times", "", "few rows")]
    seen = Seen(run)
    with np.errstate(all="ignore"):
        return [fault for check in CHECKS for fault in check(seen)]
