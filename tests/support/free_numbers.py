"""Numbers of a driveline by which can be differentiated, and points beside those that it has."""

from __future__ import annotations

import numpy as np

import clutchwork as cw
from clutchwork.gradients.parameters import Tunable, parameters
from clutchwork.model.changes import all_names


def free(system: cw.System) -> tuple[Tunable, ...]:
    """All numbers of a System, ordinates and abscissae of its tables among them."""
    found = dict[str, Tunable]()
    for name in all_names(system.source):
        for asked in (name, f"{name}.values", f"{name}.times", f"{name}.arguments"):
            try:
                made = parameters(system, asked)
            except cw.UseError:
                continue
            # the points of a signal that is a table are those of the signal
            found |= {one.name: one for one in made if ".points" not in one.name}
    return tuple(found.values())


def some(system: cw.System, rng: np.random.Generator, count: int) -> tuple[Tunable, ...]:
    """Some of them, by chance."""
    known = free(system)
    return tuple(known[place] for place in sorted(rng.permutation(len(known))[:count]))


def start(chosen: tuple[Tunable, ...]) -> np.ndarray:
    """The values that they have."""
    return np.array([one.start for one in chosen])


def beside(chosen: tuple[Tunable, ...], rng: np.random.Generator, share: float) -> np.ndarray:
    """Values near those, within what each may be."""
    sizes = np.array([min(one.scale, one.reach) for one in chosen])
    moved = start(chosen) + share * sizes * rng.uniform(-1.0, 1.0, len(chosen))
    return np.clip(moved, [one.lower for one in chosen], [one.upper for one in chosen])
