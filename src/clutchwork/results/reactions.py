"""Torques of rigid parts: gears, prescribed speeds and the housing.

The core eliminates rigid rows, so their torques are not part of its output. The balance of every node,
`inertia acceleration = torques of elements and contacts + rows' multipliers`, gives them back by one constant
least-squares matrix. Redundant rows share their torque with the smallest sum of squares.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import HOUSING, GearRow, Wiring
from clutchwork.declare.node import Domain

Matrix = NDArray[np.float64]


def multipliers(wiring: Wiring) -> Matrix:
    """Matrix that turns an output row into the multipliers of gear rows, then of prescribed speeds [N m]."""
    rigid = np.hstack([_gear_directions(wiring), wiring.spread(wiring.motions)])
    # also where nothing has a name, in a System of bytes
    if not rigid.shape[1]:
        return np.zeros((0, wiring.row_size))
    matrix = np.linalg.pinv(rigid, rcond=1e-12) @ _missing_torque(wiring)
    # what is only rounding becomes zero, so that a torque depends on what it physically depends on
    noise = 1e-14 * np.max(np.abs(matrix), axis=1, keepdims=True, initial=0.0)
    return np.where(np.abs(matrix) > noise, matrix, 0.0)


def on_housing(wiring: Wiring, rows_to_multipliers: Matrix, domain: Domain) -> Matrix:
    """Vector that turns an output row into the torque (or force) that all parts put on the housing."""
    total = np.zeros(wiring.row_size)
    for part, branches in (("element_torque", wiring.elements), ("contact_torque", wiring.contacts)):
        start = wiring.columns[part].start
        for index, branch in enumerate(branches):
            total[start + index] += branch.direction.get(HOUSING, 0.0) * (branch.domain is domain)
    for index, row in enumerate(wiring.gears):
        total += _on_housing(row, domain) * rows_to_multipliers[index]
    for index, branch in enumerate(wiring.motions, start=len(wiring.gears)):
        total += branch.direction.get(HOUSING, 0.0) * (branch.domain is domain) * rows_to_multipliers[index]
    return total


def _on_housing(row: GearRow, domain: Domain) -> float:
    return sum(c for port, (node, c) in row.ports.items() if node == HOUSING and row.domains[port] is domain)


def _gear_directions(wiring: Wiring) -> Matrix:
    matrix = np.zeros((len(wiring.nodes), len(wiring.gears)))
    for column, row in enumerate(wiring.gears):
        for node, coefficient in row.ports.values():
            if node != HOUSING:
                matrix[node, column] += coefficient
    return matrix


def _missing_torque(wiring: Wiring) -> Matrix:
    """Inertia times acceleration less the torques of elements and contacts, per node, from an output row."""
    columns = wiring.columns
    matrix = np.zeros((len(wiring.nodes), wiring.row_size))
    matrix[:, columns["acceleration"]] = np.diag([node.inertia for node in wiring.nodes])
    matrix[:, columns["element_torque"]] = -wiring.spread(wiring.elements)
    matrix[:, columns["contact_torque"]] = -wiring.spread(wiring.contacts)
    return matrix
