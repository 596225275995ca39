"""Places of labels beside what they name, apart from each other."""

from __future__ import annotations

from collections.abc import Sequence


def spread(wanted: Sequence[float], apart: float) -> list[float]:
    """Places as near to the wanted ones as they may be, no two nearer than `apart`."""
    order = sorted(range(len(wanted)), key=lambda n: (wanted[n], n))
    # blocks of places that touch: the sum of wanted tops, and how many
    blocks: list[list[float]] = []
    for place, number in enumerate(order):
        blocks.append([wanted[number] - apart * place, 1.0])
        while len(blocks) > 1 and blocks[-2][0] / blocks[-2][1] >= blocks[-1][0] / blocks[-1][1]:
            total, count = blocks.pop()
            blocks[-1][0] += total
            blocks[-1][1] += count
    found, place = [0.0] * len(order), 0
    for total, count in blocks:
        for _ in range(int(count)):
            found[order[place]] = total / count + apart * place
            place += 1
    return found
