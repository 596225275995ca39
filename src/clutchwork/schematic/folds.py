"""Where a long driveline is folded into rows: where one line alone goes on."""

from __future__ import annotations

from math import ceil

from clutchwork.schematic.layers import Layers
from clutchwork.schematic.places import Coordinates

WIDE = 880.0  # pt


def folds(layers: Layers, places: Coordinates, width: float = WIDE) -> list[int]:
    """The first layers of the second row and of those behind; none where all fits, or nothing can be cut."""
    first, last = places.x[0], places.x[-1]
    count = ceil((last - first) / width) if width > 0.0 else 1
    can = [layer for layer in range(2, layers.count - 1) if _single(layers, layer)]
    cuts = list[int]()
    for number in range(1, count):
        wanted = first + (last - first) * number / count
        free = [layer for layer in can if layer > (cuts[-1] + 1 if cuts else 1)]
        if not free:
            break
        cuts.append(min(free, key=lambda layer: abs(0.5 * (places.x[layer - 1] + places.x[layer]) - wanted)))
    return cuts


def _single(layers: Layers, layer: int) -> bool:
    """Whether only one line goes into a layer."""
    lines = [one for one in layers.lines if one.layer == layer - 1]
    return len(lines) == 1 and len(lines[0].left) == len(lines[0].right) == 1
