"""Build and check a model: shafts, masses, the housing, and the elements between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from clutchwork.calls import explained
from clutchwork.errors import ModelError, Problem, UseError, warn
from clutchwork.node import HOUSING, Component, Domain, Node, Signal, ThermalNode
from clutchwork.shown import shown
from clutchwork.speech import words_of_files

if TYPE_CHECKING:
    from clutchwork.system import System
    from clutchwork.trajectory import Trajectory

E = TypeVar("E", bound=Component)


class Driveline:
    """A driveline under construction.

    Mistakes are collected, not raised one by one: `check` lists all of them, `assemble` and `simulate` raise
    `ModelError` with all of them.
    """

    def __init__(self, name: str = "driveline") -> None:
        """Start an empty driveline."""
        self.name = name
        self.simulation: dict[
            str, Any
        ] = {}  # settings of a run as in [simulation] of a model file: t_end, dt, rtol ...
        self.from_file = False  # messages use the words of model files
        self._nodes: list[Node] = []
        self._thermal: list[ThermalNode] = []
        self._elements: list[Component] = []

    @property
    def nodes(self) -> tuple[Node, ...]:
        """Shafts and masses in the order in which they were added."""
        return tuple(self._nodes)

    @property
    def thermal_nodes(self) -> tuple[ThermalNode, ...]:
        """Thermal masses and ambients in the order in which they were added."""
        return tuple(self._thermal)

    @property
    def elements(self) -> tuple[Component, ...]:
        """Elements in the order in which they were added."""
        return tuple(self._elements)

    @property
    def housing(self) -> Node:
        """What does not move: the base of brakes and the support of gears."""
        return HOUSING

    @explained("d.shaft")
    def shaft(self, name: str, *, inertia: float = 0.0, speed: float | None = None, angle: float = 0.0) -> Node:
        """Add a shaft.

        Parameters: inertia [kg m2], 0 only where gears or damped springs determine the motion; speed [rad/s] and
        angle [rad] at the start. A shaft without a given speed takes the one that gears give it, else starts at rest.
        """
        return self.add_node(Node(name, Domain.ROTATION, inertia, speed, angle))

    @explained("d.mass")
    def mass(self, name: str, *, mass: float = 0.0, speed: float | None = None, position: float = 0.0) -> Node:
        """Add a mass that moves along a line.

        Parameters: mass [kg]; speed [m/s] and position [m] at the start. All else is as for a shaft.
        """
        return self.add_node(Node(name, Domain.TRANSLATION, mass, speed, position))

    @explained("d.add_node")
    def add_node(self, node: Node) -> Node:
        """Add a shaft or a mass that was made elsewhere."""
        if not isinstance(node, Node):
            raise UseError("d.add_node", [f"{shown(node)} is not a shaft or mass; add a cw.Node, or call d.shaft(...)"])
        self._nodes.append(node)
        return node

    @explained("d.thermal")
    def thermal(self, name: str, *, capacity: float, temperature: float = 300.0) -> ThermalNode:
        """Add a mass that holds heat and has one temperature.

        Parameters: capacity [J/K], mass times specific heat; temperature [K] at the start.
        """
        return self.add_thermal(ThermalNode(name, capacity, temperature))

    @explained("d.ambient")
    def ambient(self, name: str, *, temperature: float | Signal = 300.0) -> ThermalNode:
        """Add surroundings whose temperature [K], a number or a signal, does not depend on the heat they take."""
        return self.add_thermal(ThermalNode(name, None, temperature))

    @explained("d.add_thermal")
    def add_thermal(self, node: ThermalNode) -> ThermalNode:
        """Add a thermal mass or an ambient that was made elsewhere."""
        if not isinstance(node, ThermalNode):
            raise UseError("d.add_thermal", [f"{shown(node)} is not a thermal node; add a cw.ThermalNode"])
        self._thermal.append(node)
        return node

    def add(self, element: E) -> E:
        """Add an element and hand it back; UseError, a TypeError, for what is none."""
        if not isinstance(element, Component):
            raise UseError("d.add", [f"{shown(element)} is not an element; add one such as cw.Clutch(...)"])
        self._elements.append(element)
        return element

    def check(self) -> list[Problem]:
        """All mistakes of the model, an empty list when there is none.

        What is allowed and rarely wanted, such as a friction law that can give energy away, is a `ModelWarning`.
        """
        from clutchwork.model_checks import model_advice, model_problems

        with words_of_files(self.from_file):
            problems = model_problems(self._nodes, self._elements, self._thermal, driveline=self.name)
            advice = model_advice(self._elements, self._thermal)
        for one in advice:
            warn(one)
        return problems

    @explained("d.assemble")
    def assemble(self, independent: Sequence[str] = ()) -> System:
        """Reduce the driveline to its independent speeds.

        Parameters: independent, names of the shafts whose speeds shall be the independent ones; by default those
        with the most inertia. ModelError lists all mistakes, warnings are those of `check`.
        """
        from clutchwork.assemble import assemble
        from clutchwork.model_checks import TOO_FAR_APART

        problems = self.check()
        if problems:
            raise ModelError(problems, self.name)
        with words_of_files(self.from_file):
            try:
                return assemble(self.name, self._nodes, self._elements, independent, self._source(), self._thermal)
            except ArithmeticError:
                raise ModelError([TOO_FAR_APART], self.name) from None

    @explained("d.simulate")
    def simulate(self, t_end: float, **options: Any) -> Trajectory:
        """Assemble and run up to t_end [s]; options as for `clutchwork.simulate`."""
        from clutchwork.simulation import simulate

        return simulate(self.assemble(), t_end, **options)

    def _source(self) -> Mapping[str, Any]:
        """The model as plain data; empty when it holds Python functions."""
        from clutchwork.model_file import to_dict

        try:
            return to_dict(self, embed=True)
        except ModelError:
            return {}

    @classmethod
    @explained("cw.Driveline.load")
    def load(cls, path: str | Path) -> Driveline:
        """Read a model file, TOML or JSON; ModelError lists all its mistakes."""
        if not isinstance(path, str | Path):
            raise UseError("cw.Driveline.load", [f"{shown(path)} is not a path; give the name of a TOML or JSON file"])
        from clutchwork.model_file import load

        return load(path)

    @explained("d.save")
    def save(self, path: str | Path) -> None:
        """Write a model file, TOML or JSON by its ending."""
        from clutchwork.model_file import save

        save(self, path)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], folder: str | Path = "") -> Driveline:
        """A driveline from the content of a model file; CSV paths are relative to the folder."""
        from clutchwork.model_file import from_dict

        return from_dict(data, folder)

    def to_dict(self) -> dict[str, Any]:
        """The content of a model file."""
        from clutchwork.model_file import to_dict

        return to_dict(self)
