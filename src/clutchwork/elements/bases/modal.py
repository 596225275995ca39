"""A shaft by its modes: docs/theory/compliance.md (5) to (8)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from math import inf, pi, sqrt
from typing import Any, ClassVar

from clutchwork.declare import HOUSING, Component, Node, Role, ThermalNode, family, param, port
from clutchwork.declare.node import Domain, Part


@family
class Sum(Component):
    """Rigid row: total = first + factor second."""

    kind: ClassVar[str] = "gear"
    role: ClassVar[Role] = Role.GEAR

    total: Node = port("sum of both speeds")
    first: Node = port("one of them")
    second: Node = port("the other one")
    factor: float = param("1", "of the second one", default=1.0)

    def rows(self) -> list[dict[str, Fraction]]:
        """Coefficients of the speeds whose sum is zero."""
        return [{"total": Fraction(1), "first": Fraction(-1), "second": -Fraction(self.factor)}]


def compliances(stiffness: float, modes: int) -> tuple[float, float]:
    """What is left beside the modes: of equal, and of opposite torques at both ends [rad/(N m)]."""
    of_mode = [2.0 / (j * j * pi * pi * stiffness) for j in range(1, modes + 1)]
    return 1.0 / (12.0 * stiffness) - sum(of_mode[1::2]), 1.0 / (4.0 * stiffness) - sum(of_mode[0::2])


def frequencies(stiffness: float, inertia: float, modes: int, *, fixed: bool) -> tuple[float, ...]:
    """Natural frequencies [rad/s] with free ends, which are those of the bar, or with one end held."""
    scale = sqrt(stiffness / inertia)
    free = [j * pi * scale for j in range(modes + 1)]
    if not fixed:
        return tuple(free[1:])

    def twist(w: float) -> float:
        """Of the held end by a torque there, which has a zero between two free frequencies."""
        swings = sum(2.0 / inertia / (other * other - w * w) for other in free[1:])
        return sum(compliances(stiffness, modes)) + swings - 1.0 / (inertia * w * w)

    return tuple(_zero(twist, low, high) for low, high in pairwise(free))


def _zero(function: Callable[[float], float], low: float, high: float) -> float:
    """Where a function that rises from -inf to +inf is zero."""
    for _ in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if function(middle) < 0.0 else (low, middle)
    return low


def twist_of(stiffness: float, modes: int) -> dict[str, float]:
    """The twist from end to end by the torques of the springs on the amplitudes: minus twice all odd ones."""
    made = {f"spring_{j}.spring_torque": -2.0 / _modal_stiffness(stiffness, j) for j in range(1, modes + 1, 2)}
    opposite = compliances(stiffness, modes)[1]
    return made | ({"rest_spring_opposite.spring_torque": -2.0 * opposite} if opposite > 0.0 else {})


def _modal_stiffness(stiffness: float, j: int) -> float:
    return j * j * pi * pi * stiffness / 2.0


class Modal:
    """The parts of a shaft by its modes."""

    def __init__(
        self,
        name: str,
        domain: Domain,
        stiffness: float,
        inertia: float,
        damping_time: float,
        coordinate: Callable[..., Component],
    ) -> None:
        self._name, self._domain, self._coordinate = name, domain, coordinate
        self._stiffness, self._inertia, self._damping_time = stiffness, inertia, damping_time

    def parts(
        self, ends: tuple[Node, Node], modes: int, heat: ThermalNode | None = None, heat_share: float = 1.0
    ) -> Iterator[Part]:
        """Amplitudes, springs on them, and the rows that make the speeds of the ends of them."""
        self._heat: Any = {"heat": heat, "heat_share": heat_share}
        rigid = self._node("rigid", self._inertia)
        yield rigid
        even, odd = [rigid], list[Node]()
        for j in range(1, modes + 1):
            mode = self._node(f"mode_{j}", self._inertia / 2.0)
            yield mode
            yield self._spring(f"spring_{j}", mode, _modal_stiffness(self._stiffness, j))
            (odd if j % 2 else even).append(mode)
        for label, nodes, compliance in zip(
            ("equal", "opposite"), (even, odd), compliances(self._stiffness, modes), strict=True
        ):
            rest = self._node(f"rest_{label}", 0.0)
            yield rest
            yield self._spring(f"rest_spring_{label}", rest, 1.0 / compliance if compliance > 0.0 else inf)
            nodes.append(rest)
        same, other = self._node("equal", 0.0), self._node("opposite", 0.0)
        yield from self._sums("equal", same, even)
        yield from self._sums("opposite", other, odd)
        for label, end, factor in (("base", ends[0], 1.0), ("follower", ends[1], -1.0)):
            yield Sum(f"{self._name}.{label}_end", total=end, first=same, second=other, factor=factor)

    def _sums(self, label: str, total: Node, nodes: Sequence[Node]) -> Iterator[Part]:
        """The rows of a sum, two at a time."""
        sofar = nodes[0]
        for number, node in enumerate(nodes[1:], 2):
            last = number == len(nodes)
            made = total if last else self._node(f"{label}_{number}", 0.0)
            yield made
            yield Sum(f"{self._name}.{label}_sum_{number}", total=made, first=sofar, second=node)
            sofar = made

    def _node(self, name: str, inertia: float) -> Node:
        return Node(f"{self._name}.{name}", self._domain, inertia)

    def _spring(self, name: str, node: Node, stiffness: float) -> Component:
        springs: dict[str, Any] = {"stiffness": stiffness, "damping": self._damping_time * stiffness}
        return self._coordinate(f"{self._name}.{name}", base=HOUSING, follower=node, **springs, **self._heat)
