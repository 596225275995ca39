"""What goes through rigid lines, over accelerations and torques, so that the core can integrate it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.declare.schema import Role

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from fractions import Fraction

    from clutchwork.declare.node import Node
    from clutchwork.declare.rational import Row
    from clutchwork.model.structure import Mechanism

Matrix = NDArray[np.float64]
# the ports of a rigid line
ENDS = {"base", "follower"}


def multipliers(rigid: Matrix, inertia: Matrix, acting: Matrix) -> Matrix:
    """Multipliers of rigid rows over the accelerations of all nodes, then over the torques along all directions.

    Parameters: rigid and acting, coefficients of the nodes by rows and by directions, shape (nodes, ...).
    """
    if not rigid.shape[1]:
        return np.zeros((0, len(inertia) + acting.shape[1]))
    matrix = np.linalg.pinv(rigid, rcond=1e-12) @ np.hstack([np.diag(inertia), -acting])
    # what is only rounding becomes zero, so that a torque depends on what it physically depends on
    noise = 1e-14 * np.max(np.abs(matrix), axis=1, keepdims=True, initial=0.0)
    made: Matrix = np.where(np.abs(matrix) > noise, matrix, 0.0)
    return made


def meter_arrays(model: Mechanism) -> dict[str, Any]:
    """Arrays of the rigid lines of a model."""
    # the first row of each line
    firsts: dict[int, tuple[int, Mapping[str, Node], Mapping[str, Fraction]]] = {}
    for place, (gear, joined, row) in enumerate(model.gear_rows):
        if gear.role is Role.GEAR and joined.keys() == ENDS:
            firsts.setdefault(id(gear), (place, joined, row))
    ends, columns, values, nodes = list[int](), list[int](), list[float](), list[int]()
    made = _multipliers(model) if firsts else np.zeros((0, 0))
    for place, joined, coefficients in firsts.values():
        moving = joined["base"] if joined["follower"].fixed else joined["follower"]
        row = made[place] * float(coefficients["follower"])
        used = np.flatnonzero(row)
        columns += used.tolist()
        values += row[used].tolist()
        ends.append(len(columns))
        nodes.append(model.places.of(moving))
    return {"meter_node": nodes, "meter_end": ends, "meter_column": columns, "meter_value": values}


def _multipliers(model: Mechanism) -> Matrix:
    count = len(model.nodes)
    rigid = [row.coefficients for row in model.rigid_rows()]
    inertia = np.array([float(value) for value in model.inertia])
    return multipliers(_over(rigid, count), inertia, _over([row for _, row in model.acting], count))


def _over(rows: Sequence[Row], count: int) -> Matrix:
    matrix = np.zeros((count, len(rows)))
    for column, row in enumerate(rows):
        for node, value in row.items():
            if node < count:
                matrix[node, column] = float(value)
    return matrix
