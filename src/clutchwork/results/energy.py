"""Where the energy of a run went.

    work of the sources = change of kinetic + change of elastic energy + heat + residual
    heat = heat in thermal nodes + heat that goes to no thermal node

The work integrals come from the solver itself, so the residual measures what the integration lost or made.

Heat of a contact is minus the work of its friction. Where the friction law has bristles, what they store at the end
counts as heat too: it is small, at most coefficient times deflection times load, and it comes back on the way back.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.wiring import Branch, Wiring
from clutchwork.base import columns, dataclass, html
from clutchwork.base.extras import need
from clutchwork.declare.calls import explained_methods
from clutchwork.declare.node import Component, Work
from clutchwork.results.events import Event, Events


@explained_methods("run.energy")
@dataclass(frozen=True)
class EnergyBalance:
    """Energies between the first and the last instant of a trajectory, all in J.

    Impulses at the very start belong to the trajectory: the kinetic energy is counted from before them. What they
    take out is part of the heat of the contacts; `impulses` only names it.
    """

    sources: Mapping[str, float]  # work that each source put in; negative for a load
    kinetic: float  # change
    elastic: float  # change, all springs
    heat: Mapping[str, float]  # per contact and damper
    impulses: float  # part of the heat: lost where speeds jumped
    thermal: Mapping[str, float] = field(default_factory=dict)  # change of the heat of each thermal node and ambient
    shares: Mapping[str, float] = field(default_factory=dict)  # share of the heat of each that goes to a thermal node
    stored: Mapping[str, float] = field(default_factory=dict)  # change of the elastic energy of each spring

    @property
    def input(self) -> float:
        """Net work of all sources and prescribed speeds [J]."""
        return sum(self.sources.values())

    @property
    def untracked(self) -> float:
        """Heat that goes to no thermal node [J]."""
        return sum(heat * (1.0 - self.shares.get(name, 0.0)) for name, heat in self.heat.items())

    @property
    def residual(self) -> float:
        """Error of the balance [J]; where there are thermal nodes, it counts the heat that arrived there."""
        return self.input - self.kinetic - self.elastic - self.untracked - sum(self.thermal.values())

    @property
    def turnover(self) -> float:
        """Half the sum of the absolute net energies [J]; small where energy came back, as in an oscillation."""
        parts = [*self.sources.values(), *self.heat.values(), self.kinetic, self.elastic]
        return 0.5 * sum(abs(part) for part in parts)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON, the unit at the end of each name."""
        return {
            "input_J": self.input,
            "sources_J": dict(self.sources),
            "kinetic_J": self.kinetic,
            "elastic_J": self.elastic,
            "heat_J": dict(self.heat),
            "thermal_J": dict(self.thermal),
            "untracked_J": self.untracked,
            "impulses_J": self.impulses,
            "residual_J": self.residual,
        }

    def to_pandas(self) -> Any:
        """A pandas DataFrame with one line for each energy: its kind, whose it is, and how much [J]. Needs pandas."""
        pandas = need("pandas", "tables", "a table")
        lines = [("source", name, work) for name, work in self.sources.items()]
        lines += [("kinetic", "", self.kinetic), ("elastic", "", self.elastic)]
        lines += [("heat", name, heat) for name, heat in self.heat.items()]
        lines += [("thermal", name, heat) for name, heat in self.thermal.items()]
        lines += [("impulses", "", self.impulses), ("untracked", "", self.untracked), ("residual", "", self.residual)]
        frame = pandas.DataFrame(lines, columns=["kind", "name", "energy"])
        frame.attrs["units"] = {"energy": "J"}
        return frame

    def __str__(self) -> str:
        """A table for reading."""
        return columns([("energy", "J"), *self._lines()], right={1})

    def _repr_html_(self) -> str:
        """A table for a notebook."""
        return html.table(("energy", "J"), self._lines(), right={1}, most=10 * html.MOST_ROWS)

    def _lines(self) -> list[tuple[str, str]]:
        lines = [(f"  {name}", f"{work:z.3f}") for name, work in self.sources.items() if work]
        lines.insert(0, ("work of sources", f"{self.input:z.3f}"))
        lines += [
            ("kinetic energy, change", f"{self.kinetic:z.3f}"),
            ("elastic energy, change", f"{self.elastic:z.3f}"),
        ]
        lines += [("heat", f"{sum(self.heat.values()):z.3f}")]
        lines += [(f"  {name}", f"{heat:z.3f}") for name, heat in self.heat.items() if heat]
        lines += [("of which in impulses", f"{self.impulses:z.3f}")] if self.impulses else []
        if self.thermal:
            lines += [("in thermal nodes", f"{sum(self.thermal.values()):z.3f}")]
            lines += [(f"  {name}", f"{heat:z.3f}") for name, heat in self.thermal.items() if heat]
            lines += [("heat not assigned to a thermal node", f"{self.untracked:z.3f}")]
        share = self.residual / self.turnover if self.turnover else 0.0
        lines += [("residual", f"{self.residual:.3e}"), ("residual / turnover", f"{share:.1e}")]
        return lines


def balance(wiring: Wiring, rows: NDArray[np.float64], events: Events, start: float) -> EnergyBalance:
    """Balance between the first and the last output row.

    Parameters: start, of the run [s].
    """
    ends = rows[[0, -1]]
    sources, heat, springs = dict[str, float](), dict[str, float](), dict[str, float]()
    drawn = {branch.name: energy for branch, energy in _works(wiring, ends, "supply_energy", wiring.supplies)}
    for number, (branch, work) in enumerate(_works(wiring, ends, "element_work", wiring.elements)):
        if branch.hidden:
            continue
        name = branch.component.name
        stored = 0.0 if branch.number else _stored(wiring, ends, branch, number)
        if Work.STORE in branch.component.work and not branch.number:
            springs[name] = stored
        lost = _lost(branch.component) * (0.0 - work - stored)
        if name in drawn:
            sources[name], heat[name] = drawn[name], drawn[name] - work - stored
            continue
        # the ways of one element add up
        if Work.SOURCE in branch.component.work:
            sources[name] = sources.get(name, 0.0) + work + stored + lost
        if _lost(branch.component):
            heat[name] = heat.get(name, 0.0) + lost
    sources |= {branch.name: work for branch, work in _works(wiring, ends, "prescribed_work", wiring.motions)}
    heat |= {branch.name: 0.0 - work for branch, work in _works(wiring, ends, "contact_work", wiring.contacts)}
    # a row at time zero lies behind the impulses of the start, whose work it holds already
    lost = _impulses([event for event in events if event.cause == "impulse" and event.time <= start])
    before = ends[0, wiring.columns["contact_work"]] if lost else np.zeros(len(wiring.contacts))
    for branch, work in zip(wiring.contacts, before, strict=True):
        heat[branch.name] -= float(work)
    driven = ends[0, wiring.columns["prescribed_work"]] if lost else np.zeros(len(wiring.motions))
    for branch, work in zip(wiring.motions, driven, strict=True):
        sources[branch.name] += float(work)
    # where sources prescribe speeds, the change of kinetic energy is not what the contacts lost
    named = 0.0 if wiring.motions else _impulses(events)
    shares = {branch.component.name: share for branch in wiring.elements if (share := _followed(branch.component))}
    shares |= {branch.name: share for branch in wiring.contacts if (share := _share(branch.component))}
    thermal = _thermal(wiring, ends, lost)
    elastic = sum(springs.values())
    return EnergyBalance(sources, _kinetic(wiring, ends) - lost, elastic, heat, named, thermal, shares, springs)


def _share(component: Component) -> float:
    """Share of the heat of an element that goes to a thermal node."""
    path = component.heat_path()
    return path.share if path else 0.0


def _lost(component: Component) -> float:
    """Share of the work of an element, less what it stores, that is heat: of a source, what a thermal node takes."""
    return _share(component) if Work.SOURCE in component.work else float(Work.LOSS in component.work)


def _followed(component: Component) -> float:
    """Share of that heat that goes to a thermal node."""
    if component.supply:
        return _share(component)
    return _share(component) / (_lost(component) or 1.0)


def _thermal(wiring: Wiring, ends: NDArray[np.float64], lost: float) -> dict[str, float]:
    """Change of the heat of each node; what impulses of the start brought is in the first row already."""
    columns = {node.name: wiring.columns["state"].start + node.states[0][2] for node in wiring.thermal}
    first = np.zeros_like(ends[0]) if lost else ends[0]
    return {name: float(ends[1, column] - first[column]) for name, column in columns.items()}


def _impulses(events: Iterable[Event]) -> float:
    """Energy lost where speeds jumped; contacts that change in one instant share one impulse."""
    jumps = {(e.time, e.energy_before, e.energy_after) for e in events}
    return sum(before - after for _, before, after in jumps)


def _works(
    wiring: Wiring, ends: NDArray[np.float64], part: str, branches: tuple[Branch, ...]
) -> list[tuple[Branch, float]]:
    gained = ends[1, wiring.columns[part]] - ends[0, wiring.columns[part]]
    return [(branch, float(work)) for branch, work in zip(branches, gained, strict=True)]


def _kinetic(wiring: Wiring, ends: NDArray[np.float64]) -> float:
    speeds = ends[:, wiring.columns["speed"]]
    inertia = np.array([node.inertia for node in wiring.nodes])
    # as a product of sum and difference, which keeps digits when little changed
    return float(0.5 * np.sum(inertia * (speeds[1] - speeds[0]) * (speeds[1] + speeds[0])))


def _stored(wiring: Wiring, ends: NDArray[np.float64], branch: Branch, number: int) -> float:
    """Change of what an element of a number stores."""
    if Work.STORE not in branch.component.work:
        return 0.0
    places = [wiring.columns["state"].start + index for *_, index in branch.states]
    torque = ends[:, wiring.columns["element_torque"].start + number].tolist()
    states = ends[:, places].tolist()
    before, after = (float(branch.component.stored(*at)) for at in zip(states, torque, strict=True))
    return after - before
