"""A case as a Driveline, with a function of the run for each of its outputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

import numpy as np

import clutchwork as cw
from clutchwork.declare.schema import Role

from .elements import ENTRIES, constant_speed, missing, position_signal
from .initial import measure, start
from .network import FLANGES, GROUND, TWO, Network
from .pieces import Pieces, UnsupportedError
from .signals import describe, first_value, pieces, signal

MODE_COLUMNS = ("mode", "startForward", "startBackward", "stuck")
TRANSLATION = {"mass", "rod", "mass_with_stop_and_friction", "elasto_gap", "rolling_resistance"}


@dataclass(frozen=True)
class Model:
    """What a case became."""

    driveline: cw.Driveline
    outputs: dict[str, Callable[[Any], np.ndarray]]  # csv column -> values on the time grid of a run
    contacts: tuple[str, ...]  # names of the friction elements


class Builder:
    """Builds the model of one case."""

    def __init__(self, case: Mapping[str, Any]) -> None:
        if missing(case):
            raise UnsupportedError(", ".join(missing(case)))
        self.case = case
        self.elements: Mapping[str, Mapping[str, Any]] = case["elements"]
        self.network = Network(self.elements, case["connections"])
        self.t_end = float(case["stop_time"])
        self.positions, self.speeds = start(case, self.network, self._sources())
        self.driveline = cw.Driveline(case["name"])
        self.nodes = self._make_nodes()
        for name, element in self.elements.items():
            for part in ENTRIES[element["type"]](self, name, element, self._at(name)):
                self.driveline.add(part)

    def signal(self, name: Any, scale: float = 1.0) -> Any:
        """A signal of the case."""
        return signal(self.case["signals"], name, self.t_end, scale)

    def pieces(self, name: Any) -> Pieces:
        """A signal of the case in pieces."""
        return pieces(self.case["signals"], name, self.t_end)

    def kind(self, name: Any) -> str:
        """Type of a signal."""
        return str(describe(self.case["signals"], name)["type"])

    def start_distance(self, name: str) -> float:
        """flange_b - flange_a at the start."""
        return self.start_place(f"{name}.flange_b") - self.start_place(f"{name}.flange_a")

    def start_place(self, flange: str) -> float:
        """Position of a flange at the start."""
        return self.positions[self.network.node(flange)] + self.network.offset(flange)

    def start_speed(self, name: str) -> float:
        """Speed of a source at the start, relative to its support."""
        flange, support = (self.speeds[self.network.node(f"{name}.{port}")] for port in ("flange", "support"))
        return flange - support

    def _sources(self) -> dict[tuple[str, int], float]:
        """Positions (0) and speeds (1) at the start that sources give."""
        signals, known, made = self.case["signals"], set(self.case["initial"]), dict[tuple[str, int], float]()
        for name, e in self.elements.items():
            if e["type"] == "speed":
                made[name, 1] = first_value(signals, e["w_ref"])
            if e["type"] == "constant_speed":
                made[name, 1] = constant_speed(e)
            if e["type"] == "position" and not {f"{name}.phi", f"{name}.s"} & known:
                made[name, 0] = first_value(signals, position_signal(e))
            if e["type"] == "position" and e.get("exact", False):
                made[name, 1] = pieces(signals, position_signal(e), 0.0)[0].slope()(0.0)
        return made

    def _at(self, name: str) -> Callable[[str], cw.Node]:
        return lambda port: self.nodes[self.network.node(f"{name}.{port}")]

    def _make_nodes(self) -> dict[str, cw.Node]:
        inertia = dict.fromkeys(self.network.nodes(), 0.0)
        label: dict[str, str] = {}
        for name, e in self.elements.items():
            if e["type"] in ("inertia", "mass", "mass_with_stop_and_friction"):
                node = self.network.node(f"{name}.flange_a")
                if node != GROUND:
                    inertia[node] += float(e["J"] if e["type"] == "inertia" else e["m"])
                    if e["type"] != "mass_with_stop_and_friction":
                        label.setdefault(node, name)
        nodes = {GROUND: self.driveline.housing}
        taken = (set(self.elements) - set(label.values())) | {"housing"}
        moving = self._translating()
        for node in self.network.nodes():
            name = label.get(node, node).replace(".", "_")
            while name in taken:
                name += "_"
            taken.add(name)
            motion = {"speed": self.speeds[node]}
            if node in moving:
                nodes[node] = self.driveline.mass(name, mass=inertia[node], position=self.positions[node], **motion)
            else:
                nodes[node] = self.driveline.shaft(name, inertia=inertia[node], angle=self.positions[node], **motion)
        return nodes

    def _translating(self) -> set[str]:
        """Nodes that move along a line: those of masses, and all that is joined to them by two-flange elements."""
        marked = set()
        for name, e in self.elements.items():
            if e["type"] in TRANSLATION:
                marked.add(self.network.node(f"{name}.{FLANGES.get(e['type'], TWO)[0]}"))
            if "flangeT" in FLANGES.get(e["type"], ()):
                marked.add(self.network.node(f"{name}.flangeT"))
        for path in self.case["initial"]:
            name, _, what = path.rpartition(".")
            if what in ("s", "v"):
                ports = FLANGES.get(self.elements[name]["type"], TWO)
                marked.add(self.network.node(f"{name}.{ports[0]}"))
        before = -1
        while len(marked) != before:
            before = len(marked)
            for name, e in self.elements.items():
                ports = FLANGES.get(e["type"], TWO)
                joined = {self.network.node(f"{name}.{p}") for p in ports} - {GROUND}
                if "flangeT" not in ports and joined & marked:
                    marked |= joined
        return marked - {GROUND}

    def kinematic(self, path: str) -> Callable[[Any], np.ndarray]:
        """A position or speed of the case."""
        order, row, constant = measure(path, self.elements, self.network)
        terms: dict[str, float] = {}
        for flange, coefficient in row.items():
            node = self.nodes[self.network.node(flange)]
            if order == 0:
                constant += coefficient * self.network.offset(flange)
            if not node.fixed:
                what = "speed" if order else ("position" if node.domain.value == "translation" else "angle")
                key = f"{node.name}.{what}"
                terms[key] = terms.get(key, 0.0) + coefficient

        def value(run: Any) -> np.ndarray:
            total = np.full(len(run.time), constant)
            for key, coefficient in terms.items():
                total = total + coefficient * run[key]
            return total

        return value

    def model(self) -> Model:
        """Everything together."""
        outputs = dict[str, Callable[[Any], np.ndarray]]()
        for output in self.case["outputs"]:
            what = output["signal"].rpartition(".")[2]
            if what == "T":
                outputs[output["csv"]] = itemgetter(f"{output['signal'][:-2]}.temperature")
            elif what not in (*MODE_COLUMNS, "lossPower"):
                outputs[output["csv"]] = self.kinematic(output["signal"])
        friction = {"clutch", "brake", "bearing_friction", "one_way_clutch", "lossy_gear"}
        made = {e.name for e in self.driveline.elements if e.role is Role.CONTACT or isinstance(e, cw.LossyGear)}
        contacts = tuple(name for name, e in self.elements.items() if e["type"] in friction and name in made)
        return Model(self.driveline, outputs, contacts)


def translate(case: Mapping[str, Any]) -> Model:
    """The model of a case; UnsupportedError names what is missing."""
    return Builder(case).model()
