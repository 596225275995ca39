"""Torques of rigid parts: gears, prescribed speeds and the housing.

The core eliminates rigid rows, so their torques are not part of its output. The balance of every node,
`inertia acceleration = torques of elements and contacts + rows' multipliers`, gives them back by one constant
least-squares matrix. Redundant rows share their torque with the smallest sum of squares.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly import meters
from clutchwork.assembly.wiring import HOUSING, GearRow, Wiring
from clutchwork.declare.node import Domain

Matrix = NDArray[np.float64]


def multipliers(wiring: Wiring) -> Matrix:
    """Matrix that turns an output row into the multipliers of gear rows, then of prescribed speeds [N m]."""
    rigid = np.hstack([_gear_directions(wiring), wiring.spread(wiring.motions)])
    acting = np.hstack([wiring.spread(wiring.elements), wiring.spread(wiring.contacts)])
    inertia = np.array([node.inertia for node in wiring.nodes])
    found = meters.multipliers(rigid, inertia, acting)
    matrix, columns = np.zeros((len(found), wiring.row_size)), wiring.columns
    # also where nothing has a name, in a System of bytes
    if len(found):
        parts = np.cumsum([len(wiring.nodes), len(wiring.elements)])
        by = np.split(found, parts, axis=1)
        matrix[:, columns["acceleration"]], matrix[:, columns["element_torque"]] = by[0], by[1]
        matrix[:, columns["contact_torque"]] = by[2]
    return matrix


def on_housing(wiring: Wiring, rows_to_multipliers: Matrix, domain: Domain) -> Matrix:
    """Vector that turns an output row into the torque (or force) that all parts put on the housing."""
    total = np.zeros(wiring.row_size)
    for part, branches in (("element_torque", wiring.elements), ("contact_torque", wiring.contacts)):
        start = wiring.columns[part].start
        for index, branch in enumerate(branches):
            total[start + index] += branch.grounded.get(domain, 0.0)
    for index, row in enumerate(wiring.gears):
        total += _on_housing(row, domain) * rows_to_multipliers[index]
    for index, branch in enumerate(wiring.motions, start=len(wiring.gears)):
        total += branch.grounded.get(domain, 0.0) * rows_to_multipliers[index]
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
