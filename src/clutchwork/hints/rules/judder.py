"""A clutch whose friction falls with the slip more than the driveline damps."""

from __future__ import annotations

from collections.abc import Iterator
from math import log, pi
from typing import NamedTuple

import numpy as np

from clutchwork.assembly.wiring import Branch
from clutchwork.declare.schema import inputs
from clutchwork.hints.hint import Hint, shown
from clutchwork.hints.look import Look, RowSpan
from clutchwork.hints.registry import run_rule
from clutchwork.model.pools import coefficients
from clutchwork.results.channels import SPEED, TORQUE

NAME = "judder"
# growth of a small vibration over a stretch of slipping that is seen
GROWTH = log(20.0)
# share of the slip over which the slope is taken
STEP = 1e-3
# bisections for the slope that the damping makes up for
HALVINGS = 30


class Falling(NamedTuple):
    """Where friction falls over the slip: slip, minus the slope of its torque, what is locked."""

    slip: float
    slope: float
    locked: tuple[int, ...]


@run_rule(NAME)
def judder(look: Look) -> Iterator[Hint]:
    """A contact whose torque falls over its slip so steeply that vibrations of the driveline grow while it slips."""
    # springs in series through a shaft without inertia vibrate in another way
    if not np.any(look.system.massless):
        for contact, branch in enumerate(look.contacts):
            law = branch.component.friction
            if law.sticks and not branch.component.one_way and not inputs(type(law)):
                found = [hint for span in _slipping(look, contact) for hint in _growing(look, contact, branch, span)]
                yield from found[:1]


def _slipping(look: Look, contact: int) -> list[RowSpan]:
    return look.spans(look.closed[:, contact] & ~look.locked[:, contact])


def _growing(look: Look, contact: int, branch: Branch, span: RowSpan) -> Iterator[Hint]:
    begin, end = float(look.time[span.first]), float(look.time[span.last])
    place = _falling(look, contact, branch, span)
    root = look.motion.vibration(contact, place.slope, place.locked)
    if place.slope > 0.0 and root.real * (end - begin) >= GROWTH:
        yield _hint(look, contact, branch, (begin, end), place, root)


def _falling(look: Look, contact: int, branch: Branch, span: RowSpan) -> Falling:
    """At the mean slip of a stretch, with the mean load."""
    rows, law = slice(span.first, span.last + 1), branch.component.friction
    slip = look.mean(span, np.abs(look.slip[rows, contact]))
    step = STEP * slip
    above, below, here = (coefficients(law, at)[0] for at in (slip + step, slip - step, slip))
    torque = look.mean(span, np.abs(look.part("contact_torque")[rows, contact]))
    slope = torque / here * (below - above) / (2.0 * step) if step and here > 0.0 else 0.0
    locked = np.flatnonzero(look.locked[(span.first + span.last) // 2])
    return Falling(slip, slope, tuple(locked.tolist()))


def _hint(look: Look, contact: int, branch: Branch, when: tuple[float, float], place: Falling, root: complex) -> Hint:
    unit, speed = f"{TORQUE[branch.domain]} s/{SPEED[branch.domain].removesuffix('/s')}", SPEED[branch.domain]
    low, high = 0.0, place.slope
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        stable = look.motion.vibration(contact, middle, place.locked).real <= 0.0
        low, high = (middle, high) if stable else (low, middle)
    frequency, time = root.imag / (2.0 * pi), 1.0 / root.real
    message = (
        f"judders while it slips from {when[0]:.4g} to {when[1]:.4g} s: at {shown(place.slip, speed)} its torque"
        f" falls by {shown(place.slope, unit)}, and the damping of the driveline makes up for {shown(low, unit)};"
        f" vibrations of {shown(frequency, 'Hz')} grow by a factor e every {shown(time, 's')}"
    )
    remedy = "give its springs more damping, or take a coefficient that falls less over the slip"
    numbers = {f"slope [{unit}]": place.slope, f"damped [{unit}]": low, "frequency [Hz]": frequency, "growth [s]": time}
    return Hint(NAME, (branch.name,), message, remedy, numbers, *when)
