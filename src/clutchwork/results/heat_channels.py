"""Signals of thermal nodes, flows and processes, and of inputs that other components give."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from clutchwork.assembly.shared_states import state_scales

if TYPE_CHECKING:
    from clutchwork.assembly.wiring import Wiring

# column of the output row, factor, offset
Affine = tuple[int, float, float]


def affine(wiring: Wiring) -> Iterator[tuple[str, str, Affine]]:
    """Name, unit, and how each follows from one column of the output rows."""
    state = wiring.columns["state"].start
    for node in wiring.thermal:
        column = state + node.states[0][2]
        yield f"{node.name}.heat", "J", (column, 1.0, 0.0)
        if node.component.capacity is not None:
            yield f"{node.name}.temperature", "K", _temperature(wiring, node.name)
    for process in wiring.processes:
        for (name, unit, index), scale in zip(process.states, state_scales(process.component), strict=True):
            yield f"{process.name}.{name}", unit, (state + index, scale, 0.0)
    if "flow" in wiring.columns:
        for number, flow in enumerate(wiring.flows):
            yield f"{flow}.heat_flow", "W", (wiring.columns["flow"].start + number, 1.0, 0.0)
    for branch in (*wiring.elements, *wiring.contacts):
        path = branch.component.heat_path()
        if path is not None and not branch.number:
            yield f"{branch.component.name}.temperature", "K", _temperature(wiring, path.node.name)
    yield from _links(wiring)


def _temperature(wiring: Wiring, name: str) -> Affine:
    """Temperature of a thermal mass, from its heat, or of an ambient, which is a signal."""
    for number, (signal, _) in enumerate(wiring.inputs):
        if signal == f"{name}.temperature":
            return wiring.columns["input"].start + number, 1.0, 0.0
    node = next(node for node in wiring.thermal if node.name == name)
    column = wiring.columns["state"].start + node.states[0][2]
    return column, 1.0 / node.component.capacity, float(node.component.temperature)


def _links(wiring: Wiring) -> Iterator[tuple[str, str, Affine]]:
    first = len(wiring.thermal)
    states = [state for process in wiring.processes for state in process.states]
    scales = [scale for process in wiring.processes for scale in state_scales(process.component)]
    for link in wiring.links:
        if link.sort == "input":
            yield link.name, link.unit, (wiring.columns["input"].start + link.number, 1.0, 0.0)
        elif link.number < first:
            yield link.name, link.unit, _temperature(wiring, wiring.thermal[link.number].name)
        else:
            column = wiring.columns["state"].start + states[link.number - first][2]
            yield link.name, link.unit, (column, scales[link.number - first], 0.0)
