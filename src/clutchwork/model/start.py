"""The start of a motion: independent speeds from the given ones, and what drives the prescribed ones."""

from __future__ import annotations

from contextlib import suppress
from math import isfinite
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from clutchwork.base import Problem, quote
from clutchwork.declare.node import Domain
from clutchwork.declare.rational import MINUS, ONE, ZERO, Echelon, Row, exact, plus, smallest
from clutchwork.declare.schema import Role, specs
from clutchwork.declare.wording import path_of
from clutchwork.elements.bases.motion import MotionError, PrescribedMotion
from clutchwork.model.variable_ratios import start_grips, start_rows
from clutchwork.signals.bases.waveform import value
from clutchwork.signals.constant import Constant

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from fractions import Fraction

    from clutchwork.declare.node import Component, Node, Signal
    from clutchwork.model.structure import Kinematics, Mechanism


class Started(NamedTuple):
    """Speeds of the independent nodes at the start, and how they answer where a run begins later than at 0.

    Columns of the answers: prescribed speeds, then what each transmission misses of its ratio at 0 s.
    """

    speeds: list[Fraction]
    answers: list[Row]
    notes: tuple[str, ...] = ()


# prescribed speeds and what gives them
Motions: TypeAlias = "list[tuple[Component, Signal]]"
# speeds that were rounded when they were written may differ by this share
ROUNDING = exact(1e-6)
# column of the right-hand side
KNOWN = -1
# of a note: what shafts added before one have to do with its speed
LEFT_OPEN = ", which the given speeds leave open, beside the rest of "


def start(model: Mechanism, made: Kinematics) -> tuple[Started, Motions, list[Problem]]:
    """Independent speeds at the start, the prescribed speeds with their signals, and what is wrong with both."""
    motions: Motions = []
    problems: list[Problem] = []
    begun = _begun(model, made)
    for number, motion in enumerate(model.role(Role.MOTION)):
        try:
            motions.append((motion, _finite_speed(motion, begun(number) if motion.begins_with_shaft() else 0.0)))
        except MotionError as bad:
            problems.append(Problem(path_of(motion), bad.quantity, bad.message, bad.value, bad.remedy))
            motions.append((motion, Constant(0.0)))
    if problems:
        return Started([ZERO] * len(made.independent), [{} for _ in made.independent]), motions, problems
    speeds, wrong = initial_speeds(model, made, [value(signal, 0.0) for _, signal in motions])
    return speeds, motions, [*problems, *wrong, *_position_problems(model)]


def speed_at_start(
    model: Mechanism, made: Kinematics, speeds: Sequence[Fraction], motions: Motions, node: Node
) -> float:
    """Speed of a node, given or not."""
    if node.fixed:
        return 0.0
    known = dict(zip(made.independent, speeds, strict=True))
    row = made.speeds[model.places.of(node)]
    ahead = len(model.nodes)
    return float(
        sum((c * (known[i] if i in known else exact(value(motions[i - ahead][1], 0.0))) for i, c in row.items()), ZERO)
    )


def _position_problems(model: Mechanism) -> Iterator[Problem]:
    """Positions that are given where a crank holds another one."""
    held = [(one, *place) for one in model.role(Role.TORQUE) for place in one.start_positions()]
    angles = initial_angles(model) if held else []
    for component, node, position in held:
        place = model.places.of(node)
        if abs(angles[place] - position) > ROUNDING * exact(position):
            message, remedy = f"is not where {path_of(component)} holds it", f"give {position:.9g} m, or leave it out"
            yield Problem(model.node_label(place), "position", message, f"{angles[place]:g} m", remedy)


def _begun(model: Mechanism, made: Kinematics) -> Callable[[int], float]:
    """Speeds from their bases with which motions begin: what follows from the speeds that are given, else at rest."""
    motions = model.role(Role.MOTION)
    first = len(model.nodes)
    given = {node: speed for node, speed in enumerate(model.speed) if speed is not None and node not in made.loose}
    echelon = Echelon([*made.independent, *range(first, first + len(motions))], traced=False)
    if any(motion.begins_with_shaft() for motion in motions):
        for number, motion in enumerate(motions):
            with suppress(MotionError):
                if not motion.begins_with_shaft():
                    echelon.add({first + number: ONE, KNOWN: exact(value(motion.speed_signal(0.0), 0.0))})
        for node, speed in given.items():
            echelon.add({**made.speeds[node], KNOWN: speed})
        for _, tie in start_rows(model, made):
            echelon.add(tie)
        for _, tie in start_grips(model, made):
            if echelon.rest(tie).keys() - {KNOWN}:
                echelon.add(tie)

    def speed_of(node: Node | None) -> Fraction | None:
        if node is None or node.fixed:
            return ZERO
        place = model.places.of(node)
        left = echelon.rest(made.speeds[place])
        return given[place] if place in given else None if left.keys() - {KNOWN} else -left.get(KNOWN, ZERO)

    def begun(number: int) -> float:
        base = speed_of(motions[number].base) or ZERO
        speed = speed_of(motions[number].shaft)
        return float((base if speed is None else speed) - base)

    return begun


def _finite_speed(motion: PrescribedMotion, begun: float) -> Signal:
    """The speed that a motion gives, which is finite at the start."""
    made = motion.speed_signal(begun)
    if isfinite(speed := value(made, 0.0)):
        return made
    quantity = next(item.name for item, _ in specs(type(motion), "signal"))
    raise MotionError(quantity, "gives a speed at the start that is not finite", f"{speed:g}", "give smaller numbers")


def initial_angles(model: Mechanism) -> list[float]:
    """Angle [rad] or position [m] of each node at the start, prescribed ones from their bases on."""
    angles = [float(node.angle or 0.0) for node in model.nodes]
    for component in model.role(Role.TORQUE):
        for node, position in component.start_positions():
            if node.angle is None:
                angles[model.places.of(node)] = position
    motions = [(motion, motion.start_angle()) for motion in model.role(Role.MOTION)]
    # a base may be prescribed itself
    for _ in motions:
        for motion, angle in motions:
            base = 0.0 if _fixed(motion.base) else angles[model.places.of(motion.base)]
            if angle is not None and not _fixed(motion.shaft):
                angles[model.places.of(motion.shaft)] = base + angle
    return angles


def _fixed(node: Node | None) -> bool:
    return node is None or node.fixed


def initial_speeds(model: Mechanism, made: Kinematics, prescribed: Sequence[float]) -> tuple[Started, list[Problem]]:
    """Speeds of the independent nodes, and given speeds that contradict each other.

    A shaft without a given speed takes the one that follows from the others; what is free starts at rest, in the
    order in which the shafts were added. A shaft inside of a composite turns so that its springs stay in balance.
    """
    first = len(model.nodes)
    inputs = {first + number: exact(speed) for number, speed in enumerate(prescribed)}
    # what transmissions miss of their ratios: nothing at 0 s
    inputs |= {first + len(prescribed) + number: ZERO for number in range(len(start_rows(model, made)))}
    given = {node: speed for node, speed in enumerate(model.speed) if speed is not None and node not in made.loose}
    slack = ROUNDING * max([ONE, *map(abs, given.values())])
    echelon, used, problems = Echelon(made.independent, traced=False), dict[str, Row](), list[Problem]()
    # shafts between springs follow from all others and come last, after those inside of composites
    own = len(model.nodes) - model.inner
    free = set(range(len(model.nodes))) - given.keys()
    rest = sorted(free, key=lambda node: (node in made.loose, node >= own, node))
    for node in given:
        row = _row(made.speeds[node], given[node])
        left = echelon.rest(row)
        if _free(left, inputs):
            echelon.add(row)
            used[model.node_label(node)] = row
        elif abs(excess := _known(left, inputs)) > slack:
            problems.append(_problem(model, node, _guilty(used, row, inputs), excess))
    problems += _follow_ratios(model, made, inputs, echelon, used, slack)
    for name, tie in start_grips(model, made):
        if _free(echelon.rest(tie), inputs):
            echelon.add(tie)
            used[name] = tie
    open_ones = [node for node in rest if node < own and _free(echelon.rest(made.speeds[node]), inputs)]
    decided = set(used)
    for node in rest:
        # all speeds are known: those not given follow
        if len(used) == len(made.independent):
            break
        row = made.speeds[node]
        if _free(echelon.rest(row), inputs):
            balance = _balance(model, made, node) if node >= own else {}
            row = balance if _free(echelon.rest(balance), inputs) else row
            echelon.add(row)
            used[model.node_label(node)] = row
    moving = next((node for node in open_ones if _known(echelon.rest(made.speeds[node]), inputs)), None)
    started = _solved(made, echelon, inputs)
    if moving is not None and moving not in made.loose and not problems:
        speed = -_known(echelon.rest(made.speeds[moving]), inputs)
        others = [name for name in _guilty(used, made.speeds[moving], inputs) if name not in decided]
        started = started._replace(notes=(_undecided(model, moving, speed, others),))
    return started, problems


def _undecided(model: Mechanism, node: int, speed: Fraction, others: list[str]) -> str:
    """What is said of a speed that the given ones leave open, and that is not zero."""
    unit = "m/s" if model.nodes[node].domain is Domain.TRANSLATION else "rad/s"
    return f"{model.node_label(node)}: starts at {float(speed):.6g} {unit}{LEFT_OPEN}{' and '.join(others)}"


def _solved(made: Kinematics, echelon: Echelon, inputs: dict[int, Fraction]) -> Started:
    """The speeds of the independent nodes from their rows, and how they answer to what the rows have beside them."""
    rows = [echelon.solved[node] for node in made.independent]
    first = min(inputs, default=0)
    answers = [{column - first: -value for column, value in row.items() if column in inputs} for row in rows]
    return Started([_known(row, inputs) for row in rows], answers)


def _free(row: Row, inputs: dict[int, Fraction]) -> bool:
    """Whether speeds that are not known are left in a row."""
    return any(column != KNOWN and column not in inputs for column in row)


def _known(row: Row, inputs: dict[int, Fraction]) -> Fraction:
    """What the known parts of a row make of it."""
    given = (value * inputs[column] for column, value in row.items() if column in inputs)
    return row.get(KNOWN, ZERO) - sum(given, ZERO)


def _follow_ratios(
    model: Mechanism,
    made: Kinematics,
    inputs: dict[int, Fraction],
    echelon: Echelon,
    used: dict[str, Row],
    slack: Fraction,
) -> Iterator[Problem]:
    """Rates that the ratios tie together at the start, and given speeds that contradict them."""
    ties = start_rows(model, made)
    first = len(model.nodes) + len(model.role(Role.MOTION))
    for number, (component, tie) in enumerate(ties, first):
        row = {**tie, number: MINUS}
        left = echelon.rest(row)
        if _free(left, inputs):
            echelon.add(row)
            used[path_of(component)] = row
        elif abs(_known(left, inputs)) > slack:
            guilty = _guilty(used, row, inputs)
            message = f"has the ratio {component.start_ratio():.9g} at the start, which contradicts "
            message += f"the initial speed of {' and '.join(guilty)}" if guilty else "the prescribed speeds"
            remedy = "correct one of them, or remove a speed: it then follows from the ratio"
            yield Problem(path_of(component), "ratio", message, remedy=remedy)


def _guilty(used: dict[str, Row], row: Row, inputs: dict[int, Fraction]) -> list[str]:
    """Whose rows together make another one."""
    known = inputs.keys() | {KNOWN}
    kinematic = [{column: value for column, value in other.items() if column not in known} for other in used.values()]
    target = {column: value for column, value in row.items() if column not in known}
    return [list(used)[place] for place in smallest(kinematic, target)]


def _balance(model: Mechanism, made: Kinematics, node: int) -> Row:
    """Sum of stiffness times rate over the springs that a node inside of a composite moves: they stay in balance."""
    row: Row = {}
    whole = model.nodes[node].name.rpartition(".")[0]
    for component, direction in model.acting:
        passive = component.passive() if component.name.startswith(f"{whole}.") else None
        if passive is not None and passive.stiffness:
            rate = made.over(direction)
            row = plus(row, exact(passive.stiffness) * rate[node], rate) if node in rate else row
    return row


def _row(speed: Row, wanted: Fraction) -> Row:
    """Node speed over the independent ones and the prescribed ones = wanted."""
    return {**speed, KNOWN: wanted} if wanted else speed


def _problem(model: Mechanism, node: int, guilty: list[str], excess: Fraction) -> Problem:
    unit = "m/s" if model.nodes[node].domain is Domain.TRANSLATION else "rad/s"
    speed = model.speed[node] or ZERO
    message = (
        f"contradicts the initial speed of {' and '.join(guilty)}, which gives {float(speed - excess):.9g} {unit}"
        if guilty
        else f"contradicts the prescribed speeds, which give {float(speed - excess):.9g} {unit}"
    )
    remedy = "correct one of them, or remove this one: it then follows from the others"
    whole = model.nodes[node].name.rpartition(".")[0]
    if node >= len(model.nodes) - model.inner and whole:
        # this speed was not given, it follows from the gear of a composite
        message = f"follows from the start of {quote(whole)}, and {message}"
        remedy = "give the speed of one side alone at the start: the other side then follows"
    return Problem(model.node_label(node), "speed", message, f"{float(speed):g} {unit}", remedy)
