"""The start of a motion: independent speeds from the given ones, and what drives the prescribed ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

from clutchwork.base.errors import Problem
from clutchwork.declare.node import Domain, Signal
from clutchwork.declare.rational import ONE, ZERO, Echelon, Row, exact, smallest
from clutchwork.declare.schema import Role
from clutchwork.declare.speech import path_of
from clutchwork.signals.bases.waveform import low_pass, value
from clutchwork.signals.constant import Constant

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from clutchwork.declare.node import Component
    from clutchwork.model.structure import Kinematics, Mechanism

# speeds that were rounded when they were written may differ by this share
ROUNDING = exact(1e-6)
# column of the right-hand side
KNOWN = -1


def start(model: Mechanism, made: Kinematics) -> tuple[list[Fraction], list[tuple[Component, Signal]], list[Problem]]:
    """Independent speeds at the start, the prescribed speeds with their signals, and what is wrong with both."""
    motions: list[tuple[Component, Signal]] = []
    problems: list[Problem] = []
    for motion in model.role(Role.MOTION):
        signal = motion.speed if isinstance(motion.speed, Signal) else Constant(float(motion.speed))
        if motion.cutoff is not None:
            try:
                signal = low_pass(signal, motion.cutoff)
            except ValueError as error:
                remedy = "remove cutoff, or give the speed as a table"
                problems.append(Problem(path_of(motion), "cutoff", str(error), f"{motion.cutoff:g} Hz", remedy))
        motions.append((motion, signal))
    speeds, wrong = initial_speeds(model, made, [value(signal, 0.0) for _, signal in motions])
    return speeds, motions, problems + wrong


def initial_speeds(
    model: Mechanism, made: Kinematics, prescribed: Sequence[float]
) -> tuple[list[Fraction], list[Problem]]:
    """Speeds of the independent nodes, and given speeds that contradict each other.

    A shaft without a given speed takes the one that follows from the others; what is free starts at rest, in the
    order in which the shafts were added.
    """
    inputs = {len(model.nodes) + number: exact(speed) for number, speed in enumerate(prescribed)}
    given = {node: speed for node, speed in enumerate(model.speed) if speed is not None and node not in made.loose}
    slack = ROUNDING * max([ONE, *map(abs, given.values())])
    echelon, used, problems = Echelon(made.independent, traced=False), dict[int, Row](), list[Problem]()
    # shafts between springs follow from all others, so they come last
    rest = sorted(set(range(len(model.nodes))) - given.keys(), key=lambda node: (node in made.loose, node))
    for node in (*given, *rest):
        # all speeds are known: those that nobody gave follow
        if node not in given and len(used) == len(made.independent):
            break
        row = _row(made.speeds[node], inputs, given.get(node, ZERO))
        left = echelon.rest(row)
        if left.keys() - {KNOWN}:
            echelon.add(row)
            used[node] = row
        elif node in given and abs(left.get(KNOWN, ZERO)) > slack:
            problems.append(_problem(model, used, node, row, left[KNOWN]))
    return [echelon.solved[node].get(KNOWN, ZERO) for node in made.independent], problems


def _row(speed: Row, inputs: dict[int, Fraction], wanted: Fraction) -> Row:
    """Node speed over the independent ones = wanted, with the prescribed inputs on the right."""
    row = {column: factor for column, factor in speed.items() if column not in inputs}
    known = wanted - sum((factor * inputs[column] for column, factor in speed.items() if column in inputs), ZERO)
    return {**row, KNOWN: known} if known else row


def _problem(model: Mechanism, used: dict[int, Row], node: int, row: Row, excess: Fraction) -> Problem:
    unit = "m/s" if model.nodes[node].domain is Domain.TRANSLATION else "rad/s"
    kinematic = [{column: value for column, value in other.items() if column != KNOWN} for other in used.values()]
    target = {column: value for column, value in row.items() if column != KNOWN}
    guilty = [model.node_label(list(used)[place]) for place in smallest(kinematic, target)]
    speed = model.speed[node] or ZERO
    message = (
        f"contradicts the initial speed of {' and '.join(guilty)}, which gives {float(speed - excess):.9g} {unit}"
        if guilty
        else f"contradicts the prescribed speeds, which give {float(speed - excess):.9g} {unit}"
    )
    remedy = "correct one of them, or remove this one: it then follows from the others"
    return Problem(model.node_label(node), "speed", message, f"{float(speed):g} {unit}", remedy)
