"""Springs and bristles that ring faster than anything that was asked for, and hold the steps down."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, sqrt
from typing import NamedTuple

import numpy as np

from clutchwork.assembly.wiring import HOUSING, Branch
from clutchwork.hints.hint import Hint, shown
from clutchwork.hints.look import Look
from clutchwork.hints.registry import run_rule
from clutchwork.results.channels import SPEED

NAME = "stiff"
# a run of fewer steps takes a moment whatever holds them down
FEWEST = 3000
# share of the steps that is worth a word
SHARE = 0.5
# time constants that a step has where an oscillation holds it down
RESOLVED = 4.0
FINER = 0.25
# rate of a spring over the speeds of its ends, below which a rigid joint gives the same motion
RIGID = 0.005
# distance of slipping over the deflection of bristles, from which the deflection is lost in it
FAR = 1e4


class Ringing(NamedTuple):
    """What oscillates by itself, with its frequency [rad/s]."""

    branch: Branch
    omega: float
    remedy: str


@run_rule(NAME)
def stiff(look: Look) -> Iterator[Hint]:
    """A spring or a bristle whose oscillation is too fast to matter and costs most of the steps."""
    steps = look.run.statistics.get("steps", 0)
    if steps < FEWEST or not look.duration > 0.0:
        return
    found = sorted([*_springs(look), *_bristles(look)], key=lambda ringing: -ringing.omega)
    for ringing in found:
        short = _short(look, ringing.omega)
        if short >= SHARE * steps:
            yield _hint(look, ringing, short / steps)
            # what is slower is not what holds the steps down
            return


def _springs(look: Look) -> Iterator[Ringing]:
    for number, branch in enumerate(look.run.wiring.elements):
        passive = None if branch.hidden else branch.component.passive()
        ease = look.motion.ease_of_element(number)
        if passive is None or not passive.stiffness or ease <= 0.0:
            continue
        rate = float(np.max(np.abs(look.rate(branch)), initial=0.0))
        moving = [node for node in branch.direction if node != HOUSING]
        if rate < RIGID * float(np.max(np.abs(look.part("speed")[:, moving]))):
            rate_there = shown(rate, SPEED[branch.domain])
            same = f"join its ends rigidly, whose speeds differ by {rate_there} at most, or give it more damping"
            yield Ringing(branch, sqrt(passive.stiffness * ease), same)


def _bristles(look: Look) -> Iterator[Ringing]:
    for contact, branch in enumerate(look.contacts):
        law = branch.component.friction
        stiffness, coefficient = getattr(law, "stiffness", None), law.static or law.kinetic
        if law.sticks or not isinstance(stiffness, float | int) or not isinstance(coefficient, float | int):
            continue
        if _distance(look, contact) < FAR * coefficient / stiffness:
            continue
        load = float(np.max(look.part("contact_capacity")[:, contact], initial=0.0)) / coefficient
        omega = sqrt(stiffness * load * look.motion.ease(contact, ()))
        if omega > 0.0:
            remedy = "give its law a lower stiffness or more damping, or take one that sticks exactly, such as Stribeck"
            yield Ringing(branch, omega, remedy)


def _distance(look: Look, contact: int) -> float:
    """Largest relative displacement of the two sides of a contact by slip."""
    slip = look.slip[:, contact]
    return float(np.ptp(np.cumsum(0.5 * (slip[1:] + slip[:-1]) * np.diff(look.time)))) if len(slip) > 1 else 0.0


def _short(look: Look, omega: float) -> float:
    """How many steps an oscillation limits; where the output has instants of its own, all or none by their mean.

    Steps that are much shorter are limited by something else; with the tolerance they shrink as those of order five do.
    """
    options, steps = look.run.options, float(look.run.statistics["steps"])
    shortest, longest = FINER * (options.rtol / 1e-6) ** 0.2 / omega, RESOLVED / omega
    if look.fine is not look.run:
        return steps if shortest < look.duration / steps < longest else 0.0
    gaps = np.diff(look.time)
    # where a step is longer than the output asks for it was cut into several
    longest = min(longest, 0.99 * look.duration / options.points)
    return float(np.count_nonzero((gaps > shortest) & (gaps < longest)))


def _hint(look: Look, ringing: Ringing, share: float) -> Hint:
    branch, omega = ringing.branch, ringing.omega
    ends = {HOUSING: "the housing"} | {k: node.name for k, node in enumerate(look.system.nodes)}
    share, steps = min(share, 1.0), int(look.run.statistics["steps"])
    message = (
        f"rings with {shown(omega / (2.0 * pi), 'Hz')} between {' and '.join(ends[k] for k in branch.direction)},"
        f" a time constant of {shown(1.0 / omega, 's')}, and limits {share:.0%} of the {steps} steps,"
        f" which are {shown(look.duration / steps, 's')} on average"
    )
    numbers = {"frequency [Hz]": omega / (2.0 * pi), "time constant [s]": 1.0 / omega, "share [1]": share}
    return Hint(NAME, (branch.name,), message, ringing.remedy, numbers | {"steps [1]": steps}, look.begin, look.end)
