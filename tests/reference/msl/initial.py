"""Positions and speeds of the nodes at the start: the linear system of all that the case states about them.

What it leaves open is zero, by the least-norm solution.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .network import GROUND, Network

POSITION, SPEED = ("phi", "s"), ("w", "v")
RELATIVE = {"phi_rel": 0, "s_rel": 0, "w_rel": 1, "v_rel": 1}


def rows_of_gears(name: str, element: Mapping[str, Any]) -> list[dict[str, float]]:
    """Rigid relations sum(coefficient position) = 0 of an element, by flange."""
    kind = element["type"]
    if kind in ("ideal_gear", "lossy_gear"):
        ratio = float(element["ratio"])
        return [{f"{name}.flange_a": 1.0, f"{name}.flange_b": -ratio, f"{name}.support": ratio - 1.0}]
    if kind == "ideal_planetary":
        ratio = float(element["ratio"])
        return [{f"{name}.sun": 1.0, f"{name}.ring": ratio, f"{name}.carrier": -(1.0 + ratio)}]
    if kind in ("ideal_rolling_wheel", "ideal_gear_r2t"):
        # position of the translating flange over the angle of the turning one
        radius = float(element["radius"]) if kind == "ideal_rolling_wheel" else 1.0 / float(element["ratio"])
        wheel = {f"{name}.flangeR": radius, f"{name}.supportR": -radius}
        return [{**wheel, f"{name}.flangeT": -1.0, f"{name}.supportT": 1.0}]
    return []


def _flanges(name: str, element: Mapping[str, Any], network: Network) -> tuple[dict[str, float], float]:
    """The flange that X.phi or X.s speaks of, and the constant between them."""
    if element["type"] in ("mass", "rod", "mass_with_stop_and_friction"):
        return {f"{name}.flange_a": 1.0}, float(element.get("L", 0.0)) / 2
    for port in ("flange_a", "flange"):
        try:
            network.node(f"{name}.{port}")
        except KeyError:
            continue
        return {f"{name}.{port}": 1.0}, 0.0
    raise KeyError(f"{name} has no position of its own")


def measure(path: str, elements: Mapping[str, Any], network: Network) -> tuple[int, dict[str, float], float]:
    """A kinematic quantity as (0 position or 1 speed, coefficients by flange, constant)."""
    name, _, what = path.rpartition(".")
    if what in RELATIVE:
        return RELATIVE[what], {f"{name}.flange_b": 1.0, f"{name}.flange_a": -1.0}, 0.0
    if what in POSITION or what in SPEED:
        row, constant = _flanges(name, elements[name], network)
        return int(what in SPEED), row, constant if what in POSITION else 0.0
    raise KeyError(what)


def start(
    case: Mapping[str, Any], network: Network, sources: Mapping[tuple[str, int], float]
) -> tuple[dict[str, float], dict[str, float]]:
    """(positions, speeds) of every node at the start; sources by element and order, 0 or 1."""
    elements, nodes = case["elements"], network.nodes()
    index = {node: i for i, node in enumerate(nodes)}
    systems: tuple[list[np.ndarray], list[np.ndarray]] = ([], [])
    values: tuple[list[float], list[float]] = ([], [])

    def state(order: int, row: Mapping[str, float], value: float) -> None:
        line = np.zeros(len(nodes))
        for flange, coefficient in row.items():
            node = network.node(flange)
            if order == 0:
                value -= coefficient * network.offset(flange)
            if node != GROUND:
                line[index[node]] += coefficient
        systems[order].append(line)
        values[order].append(value)

    for path, value in case["initial"].items():
        order, row, constant = measure(path, elements, network)
        state(order, row, float(value) - constant)
    for (name, order), value in sources.items():
        state(order, {f"{name}.flange": 1.0, f"{name}.support": -1.0}, value)
    for name, element in elements.items():
        for row in rows_of_gears(name, element):
            state(0, row, 0.0)
            state(1, row, 0.0)
    solved = []
    for lines, right in zip(systems, values, strict=True):
        if not lines:
            solved.append(dict.fromkeys(nodes, 0.0))
            continue
        matrix = np.array(lines)
        x = np.linalg.lstsq(matrix, np.array(right), rcond=None)[0]
        if not np.allclose(matrix @ x, right, atol=1e-9):
            raise ValueError("the initial values of the case contradict each other")
        # least squares leaves 1e-17 where the case says 0
        solved.append({n: float(round(v, 13)) for n, v in zip(nodes, x, strict=True)})
    for states in solved:
        states[GROUND] = 0.0
    return solved[0], solved[1]
