"""What a driveline is made of, as users add it and as a model file holds it."""

from __future__ import annotations

from dataclasses import field
from typing import Any

from clutchwork.base import dataclass
from clutchwork.declare.node import Component, Node, ThermalNode


@dataclass
class Model:
    """A driveline under construction: nodes, elements and the settings of its runs."""

    name: str = "driveline"
    nodes: list[Node] = field(default_factory=list)
    thermal: list[ThermalNode] = field(default_factory=list)
    elements: list[Component] = field(default_factory=list)
    settings: dict[str, Any] = field(default_factory=dict)  # as in [simulation] of a model file: t_end, dt, rtol ...
    from_file: bool = False  # messages use the words of model files
    # what the checks found, and of which content; `model.findings` alone reads it
    kept: Any = field(default=None, init=False, repr=False, compare=False)

    def copy(self) -> Model:
        """The same content, which stays when something is added here."""
        return Model(self.name, [*self.nodes], [*self.thermal], [*self.elements], {**self.settings}, self.from_file)
