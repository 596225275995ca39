"""The order of things within their layers: few crossings, what carries the power first."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from clutchwork.base import dataclass
from clutchwork.schematic.layers import End, Layers

ROUNDS = 8
SHUFFLED, SEED = 5, 1


@dataclass(frozen=True)
class _Line:
    """A line between two neighbouring layers."""

    net: int
    left: End
    right: End
    weight: float


def ordered(layers: Layers) -> list[list[int]]:
    """The spots of each layer from top to bottom."""
    return _OrderSearch(layers).best()


class _OrderSearch:
    """Sweeps over the layers, each sorted by where its neighbours are, then by exchanging neighbours."""

    def __init__(self, layers: Layers) -> None:
        self.members = [[s.number for s in layers.spots if s.layer == k] for k in range(layers.count)]
        self.between: list[list[_Line]] = [[] for _ in range(layers.count)]
        for number, lines in enumerate(layers.lines):
            for end in lines.others:
                left, right = (lines.trunk, end) if end in lines.right else (end, lines.trunk)
                self.between[lines.layer].append(_Line(number, left, right, lines.weight[end]))
        self.heaviness = [0.0] * len(layers.spots)
        for line in (line for lines in self.between for line in lines):
            for end in (line.left, line.right):
                self.heaviness[end.spot] = max(self.heaviness[end.spot], line.weight)

    def best(self) -> list[list[int]]:
        """The best of several starts."""
        heavy = [sorted(members, key=lambda s: (-self.heaviness[s], s)) for members in self.members]
        plain = [list(members) for members in self.members]
        starts = [heavy, plain, [members[::-1] for members in plain]]
        # the same ones in every run
        draw = np.random.default_rng(SEED)
        starts += [[[int(spot) for spot in draw.permutation(members)] for members in plain] for _ in range(SHUFFLED)]
        return min(map(self._swept, starts), key=self._cost)

    def _swept(self, order: list[list[int]]) -> list[list[int]]:
        best, least = [list(row) for row in order], self._cost(order)
        for number in range(ROUNDS):
            down = number % 2 == 0
            layers = range(1, len(order)) if down else range(len(order) - 2, -1, -1)
            for layer in layers:
                order[layer] = self._sorted(order, layer, down)
            self._exchange(order)
            cost = self._cost(order)
            if cost < least:
                best, least = [list(row) for row in order], cost
        return best

    def _sorted(self, order: list[list[int]], layer: int, down: bool) -> list[int]:
        """A layer sorted by the mean height of each spot's neighbours; spots without neighbours keep their place."""
        lines = self.between[layer - 1] if down else self.between[layer]
        place = self._places(order[layer - 1 if down else layer + 1])
        wanted: dict[int, list[float]] = {}
        for line in lines:
            own, other = (line.right, line.left) if down else (line.left, line.right)
            # an end above the middle of its thing wants it lower
            wanted.setdefault(own.spot, []).append(place[other.spot] - other.height / 60.0 + own.height / 60.0)
        means = {spot: sum(values) / len(values) for spot, values in wanted.items()}
        now = order[layer]
        return sorted(now, key=lambda spot: means.get(spot, float(now.index(spot))))

    @staticmethod
    def _places(row: Sequence[int]) -> dict[int, int]:
        return {spot: number for number, spot in enumerate(row)}

    def _exchange(self, order: list[list[int]]) -> None:
        """Exchange neighbours as long as that helps."""
        better = True
        while better:
            better = False
            for layer, row in enumerate(order):
                for first in range(len(row) - 1):
                    before = self._near(order, layer)
                    row[first], row[first + 1] = row[first + 1], row[first]
                    if self._near(order, layer) < before:
                        better = True
                    else:
                        row[first], row[first + 1] = row[first + 1], row[first]

    def _near(self, order: list[list[int]], layer: int) -> tuple[int, float]:
        chosen = [k for k in (layer - 1, layer) if 0 <= k < len(order) - 1]
        costs = [self._channel(order, k) for k in chosen]
        return sum(crossings for crossings, _ in costs), round(sum(length for _, length in costs), 6)

    def _cost(self, order: list[list[int]]) -> tuple[int, float]:
        costs = [self._channel(order, k) for k in range(len(order) - 1)]
        return sum(crossings for crossings, _ in costs), round(sum(length for _, length in costs), 6)

    def _channel(self, order: list[list[int]], layer: int) -> tuple[int, float]:
        """Crossings and weighted length of the lines behind a layer."""
        left, right = self._places(order[layer]), self._places(order[layer + 1])
        ends = [
            (left[line.left.spot], -line.left.height, right[line.right.spot], -line.right.height, line.net)
            for line in self.between[layer]
        ]
        crossings = sum(
            one[4] != two[4]
            and ((one[:2] < two[:2] and one[2:4] > two[2:4]) or (one[:2] > two[:2] and one[2:4] < two[2:4]))
            for number, one in enumerate(ends)
            for two in ends[:number]
        )
        length = sum(line.weight * abs(left[line.left.spot] - right[line.right.spot]) for line in self.between[layer])
        # what carries the power stands above what hangs on it
        above = sum(0.01 * (self.heaviness[low] > self.heaviness[high] + 0.5) for high, low in pairwise(order[layer]))
        return crossings, length + above
