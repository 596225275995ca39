"""Motion of a power split over the speeds of its input and output, and torques of its machines. Theory: shifts (24)."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

import numpy as np

from clutchwork.base import UseError, dataclass, listed
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.gearbox.motion import speeds

Pair = tuple[float, float]
# of a determinant that is none
NOTHING = 1e-9


@dataclass(frozen=True)
class SplitMotion:
    """Speeds of machines per speed 1 of input and of output, and inertias.

    Parameters: inertia, at the input with the output at rest; coupling, between input and output [kg m2].
    """

    machines: Mapping[str, Pair]
    inertia: float
    coupling: float

    def speed(self, machine: str, at: Pair) -> float:
        """Of a machine [rad/s] at speeds of input and output."""
        first, second = self.machines[machine]
        return first * at[0] + second * at[1]

    def torques(
        self, needed: float, output: float, ranges: Mapping[str, Pair], battery: Pair, at: Pair
    ) -> dict[str, float]:
        """Torques of both machines which give the input what it needs, and the output as much as limits leave.

        Parameters: needed, at the input, and output, that is wanted there [N m]; ranges, of each torque; battery, of
        the sum of their powers [W]; at, speeds of input and output [rad/s].
        """
        (one, (a, b)), (two, (c, d)) = self.machines.items()
        size = a * d - b * c
        # linear in the torque of the output, by virtual work along both speeds
        fixed = {one: d * needed / size, two: -b * needed / size}
        per = {one: -c / size, two: a / size}
        turning = {name: self.speed(name, at) for name in self.machines}
        lines = [(fixed[name], per[name], *ranges[name]) for name in self.machines]
        lines.append((sum(fixed[n] * turning[n] for n in turning), sum(per[n] * turning[n] for n in turning), *battery))
        low, high = -inf, inf
        for start, slope, least, most in lines:
            if abs(slope) > NOTHING:
                ends = sorted(((least - start) / slope, (most - start) / slope))
                low, high = max(low, ends[0]), min(high, ends[1])
        given = min(max(output, low), high) if low <= high else 0.5 * (low + high)
        found = {name: fixed[name] + per[name] * given for name in self.machines}
        return {name: min(max(value, ranges[name][0]), ranges[name][1]) for name, value in found.items()}


def split_motion(box: Gearbox, closed: tuple[str, ...], inertias: Mapping[str, float]) -> SplitMotion:
    """Of a mode in which input and output turn as they like; UseError where its machines cannot hold both."""
    rows = speeds(box, closed)
    columns = sorted({column for row in rows.values() for column in row})
    free = {name: np.array([float(row.get(column, 0)) for column in columns]) for name, row in rows.items()}
    ends = np.array([free[box.input], free[box.output]])
    if len(columns) != 2 or abs(np.linalg.det(ends)) < NOTHING:
        raise UseError("split", [f"{listed(closed) or 'no element'} closed leave {len(columns)} speeds free, not two"])
    back = np.linalg.inv(ends)
    over = {name: row @ back for name, row in free.items()}
    machines = {name: (float(over[m][0]), float(over[m][1])) for name, m in box.machines.items()}
    (a, b), (c, d) = machines.values()
    if abs(a * d - b * c) < NOTHING:
        raise UseError("split", [f"{listed(machines)} turn in one ratio: they cannot hold input and output"])
    sizes = [(size, over[member]) for member, size in inertias.items() if member in over]
    own, both = (sum(size * float(row[0] * row[k]) for size, row in sizes) for k in (0, 1))
    return SplitMotion(machines, own, both)
