"""Build and check a model: shafts, masses, the housing, and the elements between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from clutchwork.checks import At, component_problems, connection_problems, label, number_problems
from clutchwork.errors import ModelError, Problem
from clutchwork.node import HOUSING, Component, Domain, Node
from clutchwork.schema import Spec

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
        self._nodes: list[Node] = []
        self._elements: list[Component] = []

    @property
    def nodes(self) -> tuple[Node, ...]:
        """Shafts and masses in the order in which they were added."""
        return tuple(self._nodes)

    @property
    def elements(self) -> tuple[Component, ...]:
        """Elements in the order in which they were added."""
        return tuple(self._elements)

    @property
    def housing(self) -> Node:
        """What does not move: the base of brakes and the support of gears."""
        return HOUSING

    def shaft(self, name: str, *, inertia: float = 0.0, speed: float | None = None, angle: float = 0.0) -> Node:
        """Add a shaft.

        Parameters: inertia [kg m2], 0 only where gears or damped springs determine the motion; speed [rad/s] and
        angle [rad] at the start. A shaft without a given speed takes the one that gears give it, else starts at rest.
        """
        return self.add_node(Node(name, Domain.ROTATION, inertia, speed, angle))

    def mass(self, name: str, *, mass: float = 0.0, speed: float | None = None, position: float = 0.0) -> Node:
        """Add a mass that moves along a line.

        Parameters: mass [kg]; speed [m/s] and position [m] at the start. All else is as for a shaft.
        """
        return self.add_node(Node(name, Domain.TRANSLATION, mass, speed, position))

    def add_node(self, node: Node) -> Node:
        """Add a shaft or a mass that was made elsewhere."""
        self._nodes.append(node)
        return node

    def add(self, element: E) -> E:
        """Add an element and hand it back; TypeError for what is none."""
        if not isinstance(element, Component):
            raise TypeError(f"{element!r} is no element; add one such as clutchwork.Clutch(...)")
        self._elements.append(element)
        return element

    def check(self) -> list[Problem]:
        """All mistakes of the model, an empty list when there is none."""
        return model_problems(self._nodes, self._elements)

    def assemble(self, independent: Sequence[str] = ()) -> System:
        """Reduce the driveline to its independent speeds.

        Parameters: independent, names of the shafts whose speeds shall be the independent ones; by default those
        with the most inertia. ModelError lists all mistakes.
        """
        from clutchwork.assemble import assemble

        problems = self.check()
        if problems:
            raise ModelError(problems, self.name)
        return assemble(self.name, self._nodes, self._elements, independent, self._source())

    def simulate(self, t_end: float, **options: Any) -> Trajectory:
        """Assemble and run up to t_end [s]; options as for `clutchwork.simulate`."""
        from clutchwork.simulate import simulate

        return simulate(self.assemble(), t_end, **options)

    def _source(self) -> Mapping[str, Any]:
        """The model as plain data; empty when it holds Python functions."""
        from clutchwork.model_file import to_dict

        try:
            return to_dict(self, embed=True)
        except ModelError:
            return {}

    @classmethod
    def load(cls, path: str | Path) -> Driveline:
        """Read a model file, TOML or JSON; ModelError lists all its mistakes."""
        from clutchwork.model_file import load

        return load(path)

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


def model_problems(
    nodes: Sequence[Node], elements: Sequence[Component], incomplete: Sequence[str] = ()
) -> list[Problem]:
    """All mistakes of a model: of single nodes and elements, then of the structure as far as that can be seen.

    Nothing is said about the inertia of nodes in `incomplete`, which belong to elements that are not there.
    """
    from clutchwork.assemble import structure_problems

    problems = [problem for node in nodes for problem in node_problems(node)]
    sound, broken = list[Component](), list[Component]()
    problems += name_problems(nodes, elements)
    for element in elements:
        found = [*component_problems(element), *connection_problems(element, nodes)]
        problems += found
        (broken if found else sound).append(element)
    return problems + structure_problems(nodes, sound, [*incomplete, *_touched(broken)])


def _touched(elements: Sequence[Component]) -> list[str]:
    """Names of all nodes at the given elements."""
    return [value.name for element in elements for value in vars(element).values() if isinstance(value, Node)]


NODE_FIELDS = {
    Domain.ROTATION: {
        "inertia": Spec("param", "kg m2", "moment of inertia", at_least=0.0),
        "speed": Spec("param", "rad/s", "speed at the start", optional=True),
        "angle": Spec("param", "rad", "angle at the start"),
    },
    Domain.TRANSLATION: {
        "mass": Spec("param", "kg", "mass", at_least=0.0),
        "speed": Spec("param", "m/s", "speed at the start", optional=True),
        "position": Spec("param", "m", "position at the start"),
    },
}


def node_path(kind: str, name: object) -> str:
    """Path of a node in messages."""
    return f'{kind} "{name}"'


def node_problems(node: Node) -> list[Problem]:
    """Mistakes of one shaft or mass."""
    path = node_path("shaft" if node.domain is Domain.ROTATION else "mass", node.name)
    values = (node.inertia, node.speed, node.angle)
    problems: list[Problem] = []
    for (name, spec), value in zip(NODE_FIELDS[node.domain].items(), values, strict=True):
        if not (value is None and spec.optional):
            problems += number_problems(value, spec, At(path, name, spec.unit))
    return problems


def name_problems(nodes: Sequence[Node], elements: Sequence[Component]) -> list[Problem]:
    """Names that are no text, reserved or given twice."""
    problems, seen = [], {HOUSING.name: "the housing"}
    things = [(f'shaft "{node.name}"', node.name) for node in nodes]
    things += [(label(element), element.name) for element in elements]
    for path, name in things:
        if not isinstance(name, str) or not name or name != name.strip():
            remedy = "give a text without blanks at its ends"
            problems.append(Problem(path, "name", "must be a text", repr(name), remedy))
        elif name in seen:
            remedy = "choose another name: results are found by it"
            problems.append(Problem(path, "name", f"is taken by {seen[name]}", repr(name), remedy))
        else:
            seen[name] = path
    return problems
