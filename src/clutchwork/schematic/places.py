"""Heights and columns: straight lines where they can be, and a track for each upright piece of a line."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from clutchwork.base import dataclass
from clutchwork.schematic.layers import End, Layers, NodeLines, linear_program
from clutchwork.schematic.pen import Point

TRACK, EDGE, NEAR = 6.5, 8.0, 4.0  # pt between tracks, beside them, and between lines that must not touch
SMALL = 14.0  # pt, the smallest step of a line
TRIES = 6


@dataclass(frozen=True, eq=False)
class Wire:
    """The lines of a node in one channel: points joined by straight pieces, and dots where three meet."""

    lines: NodeLines
    pieces: list[tuple[Point, Point]]
    dots: list[Point]
    pins: list[Point]  # what it joins, those on the left first


@dataclass(frozen=True, eq=False)
class Coordinates:
    """Where everything is [pt]."""

    x: list[float]  # of each layer
    y: list[float]  # of each spot
    wires: list[Wire]


def placed(layers: Layers, order: list[list[int]]) -> Coordinates:
    """Place all spots and route all lines."""
    apart: dict[tuple[End, End], int] = {}
    for _ in range(TRIES):
        y = _heights(layers, order, apart)
        tracks = [_Tracks([one for one in layers.lines if one.layer == k], y) for k in range(layers.count)]
        clashes = [pair for track in tracks for pair in track.clashes()]
        new = {(one, two): sign for one, two, sign in clashes if (one, two) not in apart}
        if not new:
            break
        apart |= new
    x, edges = _columns(layers, tracks)
    wires = [track.wire(lines, *edges[k], layers, x, y) for k, track in enumerate(tracks) for lines in track.lines]
    return Coordinates(x, y, wires)


def _heights(layers: Layers, order: list[list[int]], apart: dict[tuple[End, End], int]) -> list[float]:
    """Heights with the least weighted steps in lines, where nothing in a layer covers its neighbour.

    A step that is so small that it looks like a mistake is taken out where there is room.
    """
    lines = [(one.trunk, end, one.weight[end]) for one in layers.lines for end in one.others]
    straight: list[tuple[End, End]] = []
    y = _solved(layers, order, apart, lines, straight)
    refused = set[tuple[End, End]]()
    while y is not None:
        steps = [(abs(y[a.spot] + a.height - y[b.spot] - b.height), a, b) for a, b, _ in lines]
        small = [(step, a, b) for step, a, b in steps if 1e-3 < step < SMALL and (a, b) not in refused]
        if not small:
            return [round(value, 3) for value in y]
        _, one, two = min(small, key=lambda found: (found[0], found[1].spot, found[2].spot))
        better = _solved(layers, order, apart, lines, [*straight, (one, two)])
        if better is None:
            refused.add((one, two))
        else:
            straight.append((one, two))
            y = better
    # nothing fits what keeps lines apart: without it
    return _heights(layers, order, {}) if apart else [0.0] * len(layers.spots)


def _solved(
    layers: Layers,
    order: list[list[int]],
    apart: dict[tuple[End, End], int],
    lines: list[tuple[End, End, float]],
    straight: list[tuple[End, End]],
) -> list[float] | None:
    """The linear program behind the heights; None where no heights fit."""
    spots, count = layers.spots, len(layers.spots)
    cost = np.concatenate([np.zeros(count), [weight for _, _, weight in lines]])
    rows: list[tuple[dict[int, float], float]] = []
    for column in order:
        for high, low in pairwise(column):
            rows.append(({high: -1.0, low: 1.0}, -(spots[high].down + spots[low].up)))
    for number, (one, two, _) in enumerate(lines):
        for sign in (1.0, -1.0):
            row = {one.spot: sign, two.spot: -sign, count + number: -1.0}
            rows.append((row, -sign * (one.height - two.height)))
    for (one, two), sign in apart.items():
        # `one` above `two` where the sign is positive
        rows.append(({one.spot: -float(sign), two.spot: float(sign)}, sign * (one.height - two.height) - 2.0 * NEAR))
    if not rows:
        return [0.0] * count
    kept = {(one, two) for one, two in straight}
    values = [value for row, _ in rows for value in row.values()]
    places = [number for number, (row, _) in enumerate(rows) for _ in row]
    columns = [column for row, _ in rows for column in row]
    limits: list[tuple[float | None, float | None]] = [(None, None)] * count
    limits += [(0.0, 0.0 if (one, two) in kept else None) for one, two, _ in lines]
    found = linear_program(cost, (values, (places, columns)), [bound for _, bound in rows], limits)
    return None if found is None else [float(value) for value in found[:count]]


def _columns(layers: Layers, tracks: list[_Tracks]) -> tuple[list[float], list[tuple[float, float]]]:
    """The middle of each layer, and the sides of the channel behind each."""
    left, right = [0.0] * layers.count, [0.0] * layers.count
    for spot in layers.spots:
        if spot.cell is not None:
            left[spot.layer] = max(left[spot.layer], -spot.cell.box.left, spot.cell.half)
            right[spot.layer] = max(right[spot.layer], spot.cell.box.right, spot.cell.half)
    x, edges, at = list[float](), list[tuple[float, float]](), 0.0
    for layer in range(layers.count):
        at += left[layer]
        x.append(at)
        at += right[layer]
        count = tracks[layer].count
        wide = 2.0 * EDGE + TRACK * (count - 1) if count else EDGE
        edges.append((at, at + wide))
        at += wide
    return x, edges


class _Tracks:
    """The upright pieces of one channel, each on a track, so that none lies on another line."""

    def __init__(self, lines: list[NodeLines], y: list[float]) -> None:
        self.lines = lines
        self._left = [[y[end.spot] + end.height for end in one.left] for one in lines]
        self._right = [[y[end.spot] + end.height for end in one.right] for one in lines]
        spans = [(min(a + b), max(a + b)) for a, b in zip(self._left, self._right, strict=True)]
        self._spans = spans
        self._bent = [k for k, (low, high) in enumerate(spans) if high - low > 1e-6]
        self._order = self._sorted()
        self.track = self._packed()
        self.count = max(self.track.values(), default=-1) + 1

    def _cost(self, one: int, two: int) -> int:
        """What it costs to have `one` on the left of `two`: crossings, and much for lines on each other."""
        low, high = self._spans[one]
        low_two, high_two = self._spans[two]
        cost = sum(low < y < high for y in self._left[two]) + sum(low_two < y < high_two for y in self._right[one])
        return cost + 1000 * sum(abs(a - b) < NEAR for a in self._right[one] for b in self._left[two])

    def _sorted(self) -> list[int]:
        order = sorted(self._bent, key=lambda k: self._spans[k])
        for _ in range(len(order) ** 2):
            swapped = False
            for k in range(len(order) - 1):
                if self._cost(order[k + 1], order[k]) < self._cost(order[k], order[k + 1]):
                    order[k], order[k + 1] = order[k + 1], order[k]
                    swapped = True
            if not swapped:
                break
        return order

    def _packed(self) -> dict[int, int]:
        """The first free track of each; pieces that are clear of each other share one."""
        track: dict[int, int] = {}
        for number, one in enumerate(self._order):
            low, high = self._spans[one]
            near = [
                k for k in self._order[:number] if self._spans[k][0] < high + NEAR and self._spans[k][1] > low - NEAR
            ]
            track[one] = max((track[k] + 1 for k in near), default=0)
        return track

    def clashes(self) -> list[tuple[End, End, int]]:
        """Ends of two lines that would lie on each other in any order of the tracks."""
        found = []
        for number, one in enumerate(self._order):
            for two in self._order[number + 1 :]:
                if self.track[one] < self.track[two]:
                    found += list(self._on_each_other(one, two))
        return found

    def _on_each_other(self, one: int, two: int) -> Any:
        for a, end in zip(self._right[one], self.lines[one].right, strict=True):
            for b, other in zip(self._left[two], self.lines[two].left, strict=True):
                if abs(a - b) < NEAR:
                    yield end, other, 1 if a >= b else -1

    def wire(self, lines: NodeLines, left: float, right: float, layers: Layers, x: list[float], y: list[float]) -> Wire:
        """The pieces of one line, from pin to pin."""
        number = self.lines.index(lines)
        wide = TRACK * max(self.count - 1, 0)
        middle = 0.5 * (left + right) - 0.5 * wide + TRACK * self.track.get(number, 0)
        pins = [(self._pin(end, side, layers, x), y[end.spot] + end.height)
                for ends, side in ((lines.left, 1.0), (lines.right, -1.0)) for end in ends]  # fmt: skip
        heights = [height for _, height in pins]
        low, high = min(heights), max(heights)
        if number not in self.track:
            return Wire(lines, [((min(pins)[0], low), (max(pins)[0], low))], [], pins)
        pieces = [((start, height), (middle, height)) for start, height in pins]
        pieces.append(((middle, low), (middle, high)))
        dots = [(middle, h) for h in sorted(set(heights)) if self._meets(heights, h, low, high) > 2]
        return Wire(lines, pieces, dots, pins)

    @staticmethod
    def _pin(end: End, side: float, layers: Layers, x: list[float]) -> float:
        spot = layers.spots[end.spot]
        return x[spot.layer] + side * (spot.cell.half if spot.cell is not None else 0.0)

    @staticmethod
    def _meets(heights: list[float], at: float, low: float, high: float) -> int:
        return sum(abs(h - at) < 1e-6 for h in heights) + (at > low + 1e-6) + (at < high - 1e-6)
