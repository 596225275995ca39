"""Motion of every row: ratios, prescribed motions, both limits of an instant, what is integrated, events."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import clutchwork as cw
from clutchwork.assembly.wiring import HOUSING
from clutchwork.declare.node import Work
from support.any_model.seen import Fault, Seen
from support.any_model.signals import sides


def finite(seen: Seen) -> Iterator[Fault]:
    """All numbers are finite."""
    if not np.all(np.isfinite(seen.rows)):
        yield Fault("finite", "", f"{int((~np.isfinite(seen.rows)).sum())} numbers are not")


def times(seen: Seen) -> Iterator[Fault]:
    """Rows rise in time from the start to the end."""
    run, time = seen.run, seen.time
    if np.any(np.diff(time) < 0.0):
        yield Fault("times", "", "times fall")
    if time[0] != run.options.t_start:
        yield Fault("times", "", f"starts at {time[0]:g} s, t_start is {run.options.t_start:g} s")
    if run.status == "done" and time[-1] != run.t_end:
        yield Fault("times", "", f"ends at {time[-1]:g} s, t_end is {run.t_end:g} s")


def ratios(seen: Seen) -> Iterator[Fault]:
    """Rigid rows hold for speeds and accelerations."""
    for row in seen.wiring.gears:
        for part in ("speed", "acceleration"):
            terms = np.array([c * seen.part(part)[:, node] for node, c in row.ports.values() if node != HOUSING])
            size, sum_ = np.abs(terms).max(axis=0, initial=0.0), terms.sum(axis=0)
            bad = np.abs(sum_) - 1e-8 * (size + 1e-3 * size.max(initial=0.0)) - 1e-9
            words = lambda at, r=row, s=sum_, n=size: f"{r.name} misses by {s[at]:.3g} of {n[at]:.3g}"  # noqa: E731
            yield from seen.worst("ratio", f"{part}s", bad, words)


def passes(seen: Seen) -> Iterator[Fault]:
    """What neither stores nor loses passes all power on."""
    rate, torque = seen.speed @ seen.elements, seen.part("element_torque")
    most = np.abs(rate * torque).max(initial=0.0)
    for numbers in seen.numbers(Work(0)):
        branch = seen.wiring.elements[numbers[0]]
        sum_ = (rate[:, numbers] * torque[:, numbers]).sum(axis=1)
        size = np.einsum(
            "tn,ne,te->t", np.abs(seen.speed), np.abs(seen.elements[:, numbers]), np.abs(torque[:, numbers])
        )
        slack = max(1e-5, 100.0 * seen.rtol) * (size + 1e-3 * size.max(initial=0.0)) + 1e-7 + 1e-9 * most
        words = lambda at, b=branch, s=sum_, n=size: f"{b.component.name} keeps {s[at]:.3g} of {n[at]:.3g} W"  # noqa: E731
        yield from seen.worst("passes", seen.kind(branch), np.abs(sum_) - slack, words)


def motions(seen: Seen) -> Iterator[Fault]:
    """Prescribed speeds and accelerations are those of their signals."""
    wholes = {element.name: element for element in seen.run.system.source.elements}
    for branch in seen.wiring.motions:
        whole = wholes.get(branch.component.name, branch.component)
        along = seen.wiring.spread((branch,))[:, 0]
        if isinstance(whole, cw.PrescribedSpeed) and whole.cutoff is None:
            rates, signal = seen.speed, whole.speed
        elif isinstance(whole, cw.PrescribedAcceleration):
            rates, signal = seen.part("acceleration"), whole.acceleration
        else:
            continue
        if not isinstance(signal, cw.Signal | float | int):
            continue
        given, round_off = rates @ along, 1e-14 * np.abs(rates) @ np.abs(along)
        both = np.array([sides(signal, t) for t in seen.time])
        size = np.abs(both).max(axis=1)
        missed = np.abs(given - np.clip(given, both.min(axis=1), both.max(axis=1)))
        bad = missed - 1e-7 * (size + 1e-3 * size.max(initial=0.0)) - 1e-9 - round_off
        words = lambda at, w=whole, g=given, b=both: f"{w.name}: {g[at]:.6g} for {b[at]}"  # noqa: E731
        yield from seen.worst("motion", whole.kind, bad, words)


def steady(seen: Seen) -> Iterator[Fault]:
    """Between both limits of an instant angles stay, and speeds of what has inertia, unless there is an impulse."""
    pairs = np.flatnonzero(np.diff(seen.time) == 0.0)
    # an impact may take less than the round-off of the energy, and so may what locks within a tolerance of its own
    soon = {branch.name for branch in seen.wiring.contacts if getattr(branch.component, "tolerance", 0.0) > 0.0}
    impulses = [event for event in seen.run.events if event.energy_before != event.energy_after]
    small = [e for e in seen.run.events if e.cause in ("impact", "jam") or (e.after == "locked" and e.element in soon)]
    struck = [event.time for event in (*impulses, *small)]
    free = not seen.wiring.motions and not any("ratio" in b.component.hooks for b in seen.wiring.elements)
    for number, node in enumerate(seen.wiring.nodes):
        angle, speed = seen.part("angle")[:, number], seen.speed[:, number]
        turned = np.abs(np.diff(angle)[pairs]).max(initial=0.0)
        if turned > 1e-9 * max(1.0, float(np.abs(angle).max(initial=0.0))):
            yield Fault("angle jumps", "", f"{node.name} by {turned:.3g}")
        for at in pairs if node.inertia and free else ():
            jump, when = abs(speed[at + 1] - speed[at]), seen.time[at]
            if jump > 1e-7 * seen.fastest[number] and not any(abs(t - when) <= 1e-12 * max(1.0, t) for t in struck):
                yield Fault("speed jumps", "", f"{node.name} by {jump:.6g} at {when:.9g} s without an impulse")
                break


def integrals(seen: Seen) -> Iterator[Fault]:
    """Changes of speeds are the integrals of accelerations, those of angles of speeds, as far as rows show it."""
    if seen.chatters:
        return
    step = np.diff(seen.time)
    for part, rate in (("speed", "acceleration"), ("angle", "speed")):
        value, slope = seen.part(part), seen.part(rate)
        rest = 1e-7 * max(1.0, seen.rtol / 1e-6) * np.abs(value).max(initial=0.0) + 1e-12
        # what locks is brought to rest from a slip that counts as zero
        rest += seen.zero if part == "speed" else 0.0
        for number in np.flatnonzero(seen.inertia):
            y, dy = value[:, number], slope[:, number]
            spread = np.abs(np.diff(dy))
            # the slope in between may leave that of both ends by as much as it changes nearby
            around = np.convolve(spread, np.ones(5), mode="same") + spread
            slack = step * around + 1e-4 * np.abs(np.diff(y)) + rest
            slack = slack + max(1e-6, 100.0 * seen.rtol) * (np.abs(y).max(initial=0.0) + 1e-9)
            # an acceleration is no better than the sum of the torques that make it
            if part == "speed":
                slack = slack + step * 1e-10 * seen.terms[1:, number] / seen.inertia[number]
            change, wanted = np.diff(y), 0.5 * step * (dy[1:] + dy[:-1])
            bad = np.where(step > 0.0, np.abs(change - wanted) - slack, 0.0)
            name = seen.wiring.nodes[number].name
            words = lambda at, n=name, c=change, w=wanted: f"{n} changes by {c[at]:.6g} for {w[at]:.6g}"  # noqa: E731
            yield from seen.worst("integral", f"{part}s", bad, words)


def events(seen: Seen) -> Iterator[Fault]:
    """Events are in order, inside of the run, and each contact goes on from where it was."""
    run, last, state = seen.run, -np.inf, dict[str, str]()
    # sprags that roll over, and what opens or closes, change without an event
    silent = {branch.name for branch in seen.wiring.contacts if "holding" in branch.component.hooks}
    for event in run.events:
        if event.time < last or not run.options.t_start <= event.time <= run.t_end:
            yield Fault("event order", "", f"{event.element} at {event.time:.9g} s after {last:.9g} s")
        known = state.get(event.element, event.before)
        if event.element not in silent and known != event.before and "open" not in (known, event.before):
            words = f"{event.element} was {known}, is {event.before} at {event.time:.9g} s"
            yield Fault("event chain", seen.kinds.get(event.element, ""), words)
        last = event.time
        # a fault at the start is told before the first decision, which has no events of its own
        if not (event.cause == "fault" and event.time == run.options.t_start):
            state[event.element] = event.after
