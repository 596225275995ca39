"""Random drivelines of any declared elements, from a seed: which elements, joined where, is left to chance.

Two to five shafts and up to three masses, many of them without inertia, and up to six elements with the numbers of
their samples. Most of them mean nothing to an engineer; each is one that the checks of a model let pass.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.declare.schema import specs
from support import samples

Rng = np.random.Generator
# what is wrong is mended by inertia, or by leaving out an element
MENDED = 8


def driveline(seed: int) -> cw.Driveline | None:
    """The driveline of a seed; none where nothing of it can be joined."""
    rng = np.random.default_rng([seed, 7])
    shafts, masses = int(rng.integers(2, 6)), int(rng.integers(1, 4))
    bodies = {f"s{i}": _inertia(rng) for i in range(shafts)} | {f"m{i}": _inertia(rng) for i in range(masses)}
    kinds = samples.declared(*samples.ELEMENT_ROLES)
    count = int(rng.integers(1, 7))
    # the same element gets the same ports in each try
    picks = [(f"e{i}", kinds[int(rng.integers(len(kinds)))], int(rng.integers(2**31))) for i in range(count)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        for _ in range(MENDED):
            d, lost = _made(f"mix {seed}", bodies, picks)
            problems = d.check()
            if not problems:
                return d if d.elements else None
            faults = " ".join(problem.path for problem in problems)
            light = [name for name, inertia in bodies.items() if not inertia and f'"{name}"' in faults]
            bodies |= dict.fromkeys(light, 0.5)
            if not light:
                wrong = [pick for pick in picks if f'"{pick[0]}"' in faults] or picks[-1:]
                lost |= {wrong[-1][0]} if wrong else set()
            picks = [pick for pick in picks if pick[0] not in lost]
    return None


def _inertia(rng: Rng) -> float:
    return 0.0 if rng.random() < 0.35 else float(10 ** rng.uniform(-2, 0))


def _made(name: str, bodies: dict[str, float], picks: list[tuple[str, Any, int]]) -> tuple[cw.Driveline, set[str]]:
    """The driveline, and the elements with more ports than there are bodies."""
    d, lost = cw.Driveline(name), set[str]()
    nodes: dict[str, list[Any]] = {"rotation": [], "translation": []}
    for body, inertia in bodies.items():
        turns = body.startswith("s")
        node = d.shaft(body, inertia=inertia) if turns else d.mass(body, mass=inertia)
        nodes["rotation" if turns else "translation"].append(node)
    plain = {"plates": d.thermal("plates", capacity=800.0), "air": d.ambient("air", temperature=290.0)}
    plain |= {"rotation": nodes["rotation"][0], "other": nodes["rotation"][1], "translation": nodes["translation"][0]}
    for element, cls, seed in picks:
        rng = np.random.default_rng(seed)
        given = samples.fields(cls, plain)
        left = {kind: [ends[i] for i in rng.permutation(len(ends))] for kind, ends in nodes.items()}
        ports = [(item.name, spec.domain or "rotation") for item, spec in specs(cls, "port") if item.name in given]
        try:
            d.add(cls(element, **given | {port: left[kind].pop() for port, kind in ports}))
        except IndexError:
            lost.add(element)
    return d, lost
