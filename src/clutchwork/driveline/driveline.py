"""Build and check a model: shafts, masses, the housing, and the elements between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, Unpack

from clutchwork.base import ModelError, Problem, UseError, counted, quote
from clutchwork.base.errors import warn
from clutchwork.base.paths import path_of
from clutchwork.declare.calls import explain, explained, explained_methods
from clutchwork.declare.node import HOUSING, Component, Domain, Element, Node, Signal, ThermalNode
from clutchwork.declare.wording import words_of_files
from clutchwork.model.model import Model

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Number
    from clutchwork.declare.option_fields import OptionFields
    from clutchwork.declare.options import Options
    from clutchwork.hints.hint import Hints
    from clutchwork.model.findings import Findings
    from clutchwork.results.recorded import Recorded
    from clutchwork.run.record import Progress
    from clutchwork.run.trajectory import Trajectory
    from clutchwork.schematic.picture import Schematic

E = TypeVar("E", bound=Element)


@explained_methods("d")
class Driveline:
    """A driveline under construction.

    Mistakes are collected, not raised one by one: `check` lists all of them, `assemble` and `simulate` raise
    `ModelError` with all of them.
    """

    def __init__(self, name: str = "driveline") -> None:
        """Start an empty driveline."""
        self._model = Model(name)

    def __repr__(self) -> str:
        """Its name and what it has."""
        has = {"shafts and masses": self.nodes, "thermal nodes": self.thermal_nodes, "elements": self.elements}
        return f"<Driveline {quote(self.name)}: {', '.join(counted(len(all_), of) for of, all_ in has.items())}>"

    @property
    def name(self) -> str:
        """Name of the driveline."""
        return self._model.name

    @name.setter
    def name(self, name: str) -> None:
        self._model.name = name

    @property
    def simulation(self) -> dict[str, Any]:
        """Settings of its runs, to be changed: t_end [s] and fields of `Options`, as in [simulation] of a model file.

        `simulate` uses them where it is given nothing else; `save` writes them.
        """
        return self._model.settings

    @simulation.setter
    def simulation(self, settings: Mapping[str, Any]) -> None:
        self._model.settings = dict(settings)

    @property
    def nodes(self) -> tuple[Node, ...]:
        """Shafts and masses in the order in which they were added."""
        return tuple(self._model.nodes)

    @property
    def shafts(self) -> tuple[Node, ...]:
        """Shafts alone, in the order in which they were added."""
        return tuple(node for node in self.nodes if node.domain is Domain.ROTATION)

    @property
    def masses(self) -> tuple[Node, ...]:
        """Masses on a line alone, in the order in which they were added."""
        return tuple(node for node in self.nodes if node.domain is Domain.TRANSLATION)

    @property
    def thermal_nodes(self) -> tuple[ThermalNode, ...]:
        """Thermal masses and ambients in the order in which they were added."""
        return tuple(self._model.thermal)

    @property
    def elements(self) -> tuple[Component, ...]:
        """Elements in the order in which they were added."""
        return tuple(self._model.elements)

    @property
    def housing(self) -> Node:
        """The fixed node: the base of brakes and the support of gears."""
        return HOUSING

    @explained("d.shaft")
    def shaft(self, name: str, *, inertia: Number = 0.0, speed: Number | None = None, angle: Number = 0.0) -> Node:
        """Add a shaft.

        Numbers may have units, here and everywhere: speed="955 rpm", or a quantity of pint.

        Parameters: inertia [kg m2], 0 only where gears or damped springs determine the motion; speed [rad/s] and
        angle [rad] at the start. A shaft without a given speed takes the one that gears give it, else starts at rest.
        """
        values: Any = (inertia, speed, angle)
        return self.add_node(Node(name, Domain.ROTATION, *values))

    @explained("d.mass")
    def mass(
        self, name: str, *, mass: Number = 0.0, speed: Number | None = None, position: Number | None = None
    ) -> Node:
        """Add a mass that moves along a line.

        Parameters: mass [kg]; speed [m/s] and position [m] at the start. All else is as for a shaft; what a crank or
        cam moves starts where that holds it.
        """
        values: Any = (mass, speed, position)
        return self.add_node(Node(name, Domain.TRANSLATION, *values))

    @explained("d.add_node")
    def add_node(self, node: Node) -> Node:
        """Add a shaft or a mass that was made elsewhere."""
        if not isinstance(node, Node):
            raise UseError("d.add_node", [f"{quote(node)} is not a shaft or mass; add a cw.Node, or call d.shaft(...)"])
        self._model.nodes.append(node)
        return node

    @explained("d.thermal")
    def thermal(
        self, name: str, *, capacity: Number, temperature: Number = 300.0, limit: Number | None = None
    ) -> ThermalNode:
        """Add a mass that holds heat and has one temperature.

        Parameters: capacity [J/K], mass times specific heat; temperature [K] at the start, or "90 degC"; limit [K], the
        highest temperature that it stands, such as that of a lining, which `run.hints` compare with.
        """
        values: Any = (capacity, temperature, limit)
        return self.add_thermal(ThermalNode(name, *values))

    @explained("d.ambient")
    def ambient(self, name: str, *, temperature: Number | Signal = 300.0) -> ThermalNode:
        """Add surroundings whose temperature [K], a number or a signal, does not depend on the heat they take."""
        given: Any = temperature
        return self.add_thermal(ThermalNode(name, None, given))

    @explained("d.add_thermal")
    def add_thermal(self, node: ThermalNode) -> ThermalNode:
        """Add a thermal mass or an ambient that was made elsewhere."""
        if not isinstance(node, ThermalNode):
            raise UseError("d.add_thermal", [f"{quote(node)} is not a thermal node; add a cw.ThermalNode"])
        self._model.thermal.append(node)
        return node

    @explained("d.add", element="cw.Clutch('c1', base=a, follower=b, gain=5e-4)")
    def add(self, element: E) -> E:
        """Add an element and return it; UseError, a TypeError, for anything else."""
        if not isinstance(element, Component):
            raise UseError("d.add", [f"{quote(element)} is not an element; add one such as cw.Clutch(...)"])
        self._model.elements.append(element)
        return element

    def check(self) -> list[Problem]:
        """All mistakes of the model, an empty list when there is none.

        What is allowed but rarely intended, such as a friction law that can generate energy, is a `ModelWarning`.
        """
        return list(self._looked_at().problems)

    def _looked_at(self) -> Findings:
        """What the checks find, its advice as warnings."""
        from clutchwork.model.findings import findings

        with words_of_files(self._model.from_file):
            found = findings(self._model)
        for one in found.advice:
            warn(one)
        return found

    def hints(self) -> Hints:
        """What an expert would point out in the model before it runs, with numbers and a remedy; print it to read it.

        Hints are neither the mistakes that `check` lists nor warnings. Those that a run shows are in
        `Trajectory.hints`. ModelError lists all mistakes.
        """
        from clutchwork.assembly.system import System
        from clutchwork.hints.registry import of_model
        from clutchwork.model.findings import findings
        from clutchwork.model.problems import TOO_FAR_APART

        with words_of_files(self._model.from_file):
            found = findings(self._model)
            if found.problems:
                raise ModelError(found.problems, self.name)
            try:
                return of_model(System.of(self._model, found=found))
            except ArithmeticError:
                raise ModelError([TOO_FAR_APART], self.name) from None

    @explained("d.assemble")
    def assemble(self, independent: Sequence[str] = ()) -> System:
        """Reduce the driveline to its independent speeds.

        Parameters: independent, names of the shafts whose speeds shall be the independent ones; by default those
        with the most inertia. ModelError lists all mistakes, warnings are those of `check`.
        """
        from clutchwork.assembly.system import System
        from clutchwork.model.problems import TOO_FAR_APART

        found = self._looked_at()
        if found.problems:
            raise ModelError(list(found.problems), self.name)
        with words_of_files(self._model.from_file):
            try:
                return System.of(self._model, independent, found)
            except ArithmeticError:
                raise ModelError([TOO_FAR_APART], self.name) from None

    @explained("d.simulate")
    def simulate(
        self,
        t_end: Number | None = None,
        *,
        options: Options | None = None,
        progress: Progress | bool | None = None,
        **changes: Unpack[OptionFields],
    ) -> Trajectory:
        """Assemble and run up to t_end [s], or "500 ms"; options as for `clutchwork.simulate`.

        Options that are left out come from `simulation`, so a driveline from a model file runs with the settings of its
        file.
        """
        from clutchwork.run.simulation import simulate

        return simulate(self.assemble(), t_end, options=options, progress=progress, **changes)

    @explained("d.draw")
    def draw(
        self,
        path: str | Path | None = None,
        *,
        run: Recorded | None = None,
        at: Number | None = None,
        values: bool = True,
        power: bool = False,
        width: float = 310.0,
    ) -> Schematic:
        """Schematic of the driveline, with mistakes or without; notebooks show it. Needs the extra `draw`.

        Parameters: path, SVG, PNG or PDF by its ending, written when given; run, a result whose states, speeds and
        torques are shown at the time `at` [s, or with a unit], by default its end; values, whether inertias, ratios
        and the like are shown; power, whether the power [W] of elements is; width [mm], from which on a long driveline
        is folded into rows. UseError for what does not fit, such as a time outside of the run.
        """
        from clutchwork.schematic.draw import drawn

        return drawn(self._model, path, run=run, at=at, values=values, power=power, width=width)

    def _repr_html_(self) -> str:
        from clutchwork.schematic.notebook import html

        return html(self._model)

    @classmethod
    @explained("cw.Driveline.load", path="'model.toml'")
    def load(cls, path: str | Path, *, trust: bool = False) -> Driveline:
        """Read a model file, TOML or JSON; ModelError lists all its mistakes.

        Parameters: trust, whether it may have FMUs of other people, whose libraries a run executes.
        """
        from clutchwork.files.model_file import load

        return cls._of(load(path_of("cw.Driveline.load", path, "model.toml"), trust=trust))

    @explained("d.save", path="'model.toml'")
    def save(self, path: str | Path) -> None:
        """Write a model file, TOML or JSON by its ending."""
        from clutchwork.files.model_file import save

        save(self._model, path)

    @explained("d.to_fmu", path="'car.fmu'")
    def to_fmu(self, path: str | Path, **given: Any) -> Path:
        """Write an FMU, which other simulators run; its path.

        Parameters: given, as for `cw.export_fmu`: inputs, outputs, parameters, version, picture, t_end and options.
        """
        from clutchwork.base.verbs import do

        made: Path = do("driveline.fmu", self, path, given)
        return made

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], folder: str | Path = "", *, trust: bool = False) -> Driveline:
        """A driveline from the content of a model file; its paths are relative to the folder, `trust` as for `load`."""
        from clutchwork.files.model_file import from_dict

        return cls._of(from_dict(data, folder, trust=trust))

    def to_dict(self) -> dict[str, Any]:
        """The content of a model file."""
        from clutchwork.files.model_file import to_dict

        return to_dict(self._model)

    @classmethod
    def _of(cls, model: Model) -> Driveline:
        made = cls(model.name)
        made._model = model
        return made


explain(Driveline)
