"""Which speeds are independent, and what is wrong with the rigid rows in words.

Gears, prescribed speeds and springs in series through a shaft without inertia all give linear rows over the speeds.
See docs/theory/reduction.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

from clutchwork.base import Problem, listed, near, quote
from clutchwork.declare.rational import MINUS, ONE, Echelon, Row, eliminate, plus, smallest
from clutchwork.model import massless, variable_ratios
from clutchwork.model.structure import Kinematics, Mechanism, RigidRow


def kinematics(
    model: Mechanism, wanted: Sequence[str] = (), *, incomplete: frozenset[str] = frozenset()
) -> tuple[Kinematics | None, list[Problem]]:
    """Choose the independent speeds.

    `wanted` names them, else shafts with the most inertia are taken. Shafts in `incomplete` belong to elements whose
    mistakes are reported elsewhere, so nothing is said about their inertia.
    """
    problems, places = _wanted_places(model, wanted)
    rows = list(model.rigid_rows())
    solved = order(model.inertia, places)
    echelon = eliminate((row.coefficients for row in rows), solved, traced=False)
    # what contradicting gears leave is checked nevertheless
    problems += _contradictions(model, rows, echelon)
    sound = not problems
    made = _solve(model, echelon)
    # springs in series through a shaft without inertia give further rows
    series, unbalanced = massless.series_rows(model, made)
    if series:
        loose = frozenset(place for speed in series for place in made.moved_by(speed))
        rows += series.values()
        echelon = eliminate((row.coefficients for row in rows), solved, traced=False)
        made = _solve(model, echelon)
        made.loose = loose
    problems += [*unbalanced, *(_choice_problems(model, made, wanted) if sound else ())]
    problems += massless.problems(model, made, incomplete)
    problems += variable_ratios.problems(model, made)
    made.notes += _redundant(rows, solved, echelon) + [
        f"{row.owner}: its springs act in series" for row in series.values()
    ]
    return (None if problems else made), problems


def _wanted_places(model: Mechanism, wanted: Sequence[str]) -> tuple[list[Problem], list[int]]:
    names = [node.name for node in model.nodes]
    unknown = [name for name in wanted if name not in names]
    problems = [
        Problem("independent", "", "is not a shaft" + near(name, names), quote(name), f"choose from {listed(names)}")
        for name in unknown
    ]
    return problems, [names.index(name) for name in wanted if name in names]


def order(inertia: Sequence[Fraction], wanted: Sequence[int]) -> list[int]:
    """Nodes in the order in which they are solved for: what is left are the independent ones."""
    rest = [place for place in range(len(inertia)) if place not in wanted]
    # floats compare faster than fractions, and mostly tell them apart
    by_inertia = sorted(rest, key=lambda place: (float(inertia[place]), inertia[place], -place))
    return [*by_inertia, *reversed(wanted)]


def _solve(model: Mechanism, echelon: Echelon) -> Kinematics:
    """Node speeds over the columns that no row is solved for."""
    speeds: list[Row] = []
    for node in range(len(model.nodes)):
        row = echelon.solved.get(node)
        speeds.append({node: ONE} if row is None else plus({node: ONE}, MINUS, row))
    free = [node for node in range(len(model.nodes)) if node not in echelon.solved]
    heavy = {column for row, inertia in zip(speeds, model.inertia, strict=True) if inertia for column in row}
    made = Kinematics(speeds, free, set(free) - heavy)
    made.followers = variable_ratios.followers(model, made)
    made.massless -= set(made.followers.values())
    return made


def _contradictions(model: Mechanism, rows: list[RigidRow], echelon: Echelon) -> Iterator[Problem]:
    """Rows that together hold a shaft still, and prescribed speeds that follow from each other."""
    table = [row.coefficients for row in rows]
    still: dict[tuple[int, ...], list[str]] = {}
    for node, row in echelon.solved.items():
        if len(row) == 1:
            still.setdefault(tuple(smallest(table, row)), []).append(model.node_label(node))
    for guilty, names in still.items():
        # what follows from a smaller contradiction is none of its own
        if any(set(other) < set(guilty) for other in still):
            continue
        verb = "contradict each other: they hold" if len(guilty) > 1 else "holds"
        remedy = "remove one of them or correct a ratio" if len(guilty) > 1 else "use the housing in place of the shaft"
        message = f"{verb} {' and '.join(names)} at rest permanently"
        yield Problem(_owners(rows, guilty), "", message, remedy=remedy)
    for _, left in echelon.spare:
        if left:
            owners = _owners(rows, smallest(table, left))
            yield Problem(owners, "", "prescribe speeds that follow from each other", remedy="remove one of them")


def _owners(rows: list[RigidRow], places: Sequence[int]) -> str:
    return " and ".join(dict.fromkeys(rows[place].owner for place in places))


def _redundant(rows: list[RigidRow], order: Sequence[int], echelon: Echelon) -> list[str]:
    """Sums of rows that came out as zero."""
    if not echelon.spare:
        return []
    # only now it counts where they came from
    echelon = eliminate((row.coefficients for row in rows), order)
    sums = [_owners(rows, sorted(origin)) for origin, left in echelon.spare if not left]
    return [f"{owners}: one of them is redundant" for owners in sums]


def _choice_problems(model: Mechanism, made: Kinematics, wanted: Sequence[str]) -> Iterator[Problem]:
    """A forced choice that is too large, too small, or hides a shaft without inertia."""
    if not wanted:
        return
    names = [node.name for node in model.nodes]
    free = [names[node] for node in made.independent]
    for name in wanted:
        if name not in free:
            others = [names[column] for column in made.speeds[names.index(name)] if column < len(names)]
            message = f"follows from {', '.join(others) or 'the prescribed speeds'}"
            yield Problem("independent", "", message, quote(name), "remove it")
    missing = [name for name in free if name not in wanted]
    if missing:
        yield Problem("independent", "", f"misses {', '.join(missing)}", remedy=f"{len(free)} speeds are independent")
    heavy = (row for row, inertia in zip(made.speeds, model.inertia, strict=True) if inertia)
    light = made.massless | set(made.followers.values())
    if len(eliminate(heavy, made.independent, traced=False).solved) < len(free) - len(light):
        yield Problem("independent", "", "mixes shafts with and without inertia", remedy="let the package choose")


def apart(items: Sequence[int], touching: Callable[[int], Sequence[int]]) -> list[int]:
    """Reverse Cuthill-McKee order: neighbours stand close to each other."""
    # of equal ones the last first, so that after the reversal they stand in the order in which they were given
    ranks = {item: (len(touching(item)), -item) for item in items}
    order: dict[int, None] = {}
    for start in sorted(items, key=ranks.__getitem__):
        queue = [start]
        for item in queue:
            if item not in order:
                order[item] = None
                queue += sorted((other for other in touching(item) if other not in order), key=ranks.__getitem__)
    return list(order)[::-1]
