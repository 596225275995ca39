"""What each element of a driveline takes, gives on, stores and loses: `run.losses`, docs/theory/energy.md."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import Any, TypeVar

from clutchwork.assembly.wiring import Wiring
from clutchwork.base import UnknownName, columns, dataclass, html, near, quote
from clutchwork.base.extras import need
from clutchwork.declare.calls import explained_methods
from clutchwork.declare.node import Component, Domain, Work
from clutchwork.results.energy import EnergyBalance
from clutchwork.results.flows import Flows
from clutchwork.results.ratios import input_and_output
from clutchwork.results.recorded import Recorded

# below this part of the turnover a line of zeros is left out of a printed table
NOTHING = 1e-9

T = TypeVar("T", bound="LossTable")


@dataclass(frozen=True)
class Loss:
    """Energies of one element or shaft over a window [J], or mean powers [W].

    `taken = given + stored + heat`, except for integration errors.
    """

    element: str
    kind: str  # such as "disk_clutch"; "shaft" and "mass" for those
    taken: float  # what went in, from shafts and from outside
    given: float  # what came out, to shafts and to outside
    stored: float  # change of kinetic and elastic energy
    heat: float
    share: float  # of all heat
    outside: float  # part of what went in that came from outside, negative: that went out there

    @property
    def efficiency(self) -> float:
        """What came out over what went in; not a number where nothing went in."""
        return self.given / self.taken if self.taken else float("nan")


@explained_methods("run.losses")
@dataclass(frozen=True)
class LossTable:
    """Where the energy of a window of a run went, element by element; print it to read it.

    With `power` all are mean powers in W in place of energies in J.
    """

    begin: float  # s
    end: float  # s
    lines: tuple[Loss, ...]
    joints: tuple[tuple[str, str, float], ...]  # (element, shaft, what the element gave to the shaft)
    balance: EnergyBalance  # of the window, in J
    power: bool = False
    model: str = ""  # name of the driveline
    shafts: tuple[str, str] | None = None  # of drive and load

    @property
    def unit(self) -> str:
        """Unit of all numbers."""
        return "W" if self.power else "J"

    @property
    def heat(self) -> float:
        """Heat of all elements."""
        return sum(line.heat for line in self.lines)

    @property
    def efficiency(self) -> float:
        """Part of the energy that came in that did not become heat; not a number where nothing came in.

        It comes in from sources, and from shafts and springs that gave what they had stored.
        """
        came = sum(max(0.0, line.outside) for line in self.lines) - sum(min(0.0, line.stored) for line in self.lines)
        return 1.0 - self.heat / came if came else float("nan")

    def __getitem__(self, element: str) -> Loss:
        """The line of an element or shaft; UnknownName, a KeyError, with near ones."""
        known = {line.element: line for line in self.lines}
        if element not in known:
            raise UnknownName(f"no element or shaft {quote(element)}{near(element, known)}")
        return known[element]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON, the unit at the end of each name."""
        unit = self.unit
        lines = {
            line.element: {
                "kind": line.kind,
                f"in_{unit}": line.taken,
                f"out_{unit}": line.given,
                f"stored_{unit}": line.stored,
                f"heat_{unit}": line.heat,
                "share": line.share,
            }
            for line in self.lines
        }
        return {
            "begin_s": self.begin,
            "end_s": self.end,
            "elements": lines,
            f"heat_{unit}": self.heat,
            "efficiency": self.efficiency if self.efficiency == self.efficiency else None,
            "residual_J": self.balance.residual,
        }

    def to_pandas(self) -> Any:
        """A pandas DataFrame with one line for each element and shaft. Needs pandas."""
        pandas = need("pandas", "tables", "a table")
        names = ("element", "kind", "in", "out", "stored", "heat", "share", "efficiency")
        lines = [(x.element, x.kind, x.taken, x.given, x.stored, x.heat, x.share, x.efficiency) for x in self.lines]
        frame = pandas.DataFrame(lines, columns=names).set_index("element")
        frame.attrs["units"] = dict.fromkeys(names[2:6], self.unit) | {"share": "1", "efficiency": "1"}
        return frame

    def __str__(self) -> str:
        """A table for reading."""
        return columns([self._head(), *self._cells()], right={2, 3, 4, 5, 6})

    def _repr_html_(self) -> str:
        """A table for a notebook."""
        return html.table(self._head(), self._cells(), right={2, 3, 4, 5, 6}, most=10 * html.MOST_ROWS)

    def _head(self) -> tuple[str, ...]:
        window = f"{self.begin:g} to {self.end:g} s"
        return (window, "", *(f"{name} [{self.unit}]" for name in ("in", "out", "stored", "heat")), "share of heat")

    def _cells(self) -> Iterator[tuple[str, ...]]:
        least = NOTHING * max((line.taken for line in self.lines), default=0.0)
        for line in self.lines:
            if max(line.taken, line.given) > least:
                numbers = [f"{x:z.3f}" for x in (line.taken, line.given, line.stored, line.heat)]
                yield line.element, line.kind, *numbers, f"{line.share:.2%}" if line.heat else ""
        stored, heat = (sum(getattr(line, name) for line in self.lines) for name in ("stored", "heat"))
        taken, given = (sum(max(0.0, sign * line.outside) for line in self.lines) for sign in (1.0, -1.0))
        yield "from and to outside", "", *(f"{x:z.3f}" for x in (taken, given, stored, heat)), ""


def losses(table: type[T], run: Recorded, found: Flows, power: bool) -> T:
    """The table of a window of a run, as a class of tables makes it."""
    scale = 1.0 / (found.end - found.begin) if power else 1.0
    wiring, owner = run.wiring, owners(run)
    nodes = [node.name for node in wiring.nodes]
    joints: dict[tuple[str, str], float] = defaultdict(float)
    for joint, energy in found.joints.items():
        pair = owner(joint.element), owner(nodes[joint.node])
        if pair[0] != pair[1]:
            joints[pair] += scale * energy
    stored: dict[str, float] = defaultdict(float)
    for number, energy in found.kinetic.items():
        stored[owner(nodes[number])] += scale * energy
    for name, energy in found.balance.stored.items():
        stored[owner(name)] += scale * energy
    outside, heat = (_summed(part, owner, scale) for part in (found.balance.sources, found.balance.heat))
    total = sum(heat.values())
    lines = []
    for name, kind in _kinds(run, owner).items():
        passed = [energy if whose == name else -energy for whose, energy in _at(joints, name)]
        taken = sum(max(0.0, -x) for x in passed) + max(0.0, outside[name])
        given = sum(max(0.0, x) for x in passed) + max(0.0, -outside[name])
        share = heat[name] / total if total else 0.0
        lines.append(Loss(name, kind, taken, given, stored[name], heat[name], share, outside[name]))
    made = tuple((element, shaft, energy) for (element, shaft), energy in joints.items())
    shafts = input_and_output(wiring) or _drive_and_vehicle(wiring)
    return table(found.begin, found.end, tuple(lines), made, found.balance, power, run.system.name, shafts)


def _drive_and_vehicle(wiring: Wiring) -> tuple[str, str] | None:
    """The shaft of the first source and the heaviest mass."""
    driven = [wiring.nodes[n].name for b in wiring.elements for n in b.direction if n >= 0 and _drives(b.component)]
    masses = [node for node in wiring.nodes if node.domain is Domain.TRANSLATION]
    return (driven[0], max(masses, key=lambda node: node.inertia).name) if driven and masses else None


def _drives(component: Component) -> bool:
    return Work.SOURCE in component.work


def _summed(part: Mapping[str, float], owner: Callable[[str], str], scale: float) -> dict[str, float]:
    made: dict[str, float] = defaultdict(float)
    for name, energy in part.items():
        made[owner(name)] += scale * energy
    return made


def _at(joints: dict[tuple[str, str], float], name: str) -> Iterator[tuple[str, float]]:
    """Joints of an element or a shaft: whose energy counts positive, and how much."""
    for (element, shaft), energy in joints.items():
        if name in (element, shaft):
            yield element, energy


def owners(run: Recorded) -> Callable[[str], str]:
    """The element of the user that a part or an inner shaft belongs to; others belong to themselves.

    Where the parts of an element are seen one by one, it is the part.
    """
    known = _own_kinds(run)

    def owner(name: str) -> str:
        words = name.split(".")
        longer = (".".join(words[:count]) for count in range(len(words), 0, -1))
        return next((whole for whole in longer if whole in known), name)

    return cache(owner)


def _own_kinds(run: Recorded) -> dict[str, str]:
    """Elements of the user by name, and the parts of those that are seen one by one."""
    source = run.system.source
    elements = source.elements if source is not None else ()
    seen = [element for element in elements if element.open]
    parts = [part for element in seen for part in element.parts() if isinstance(part, Component)]
    return {element.name: element.kind for element in (*parts, *elements) if element not in seen}


def _kinds(run: Recorded, owner: Callable[[str], str]) -> dict[str, str]:
    """All elements and shafts with what they are, elements first."""
    wiring: Wiring = run.wiring
    own = _own_kinds(run)
    made: dict[str, str] = {}
    for branch in (*wiring.motions, *wiring.elements, *wiring.contacts):
        if not branch.hidden:
            whole = owner(branch.component.name)
            made.setdefault(whole, own.get(whole, branch.component.kind))
    for gear in run.system.gears:
        made.setdefault(owner(gear.gear.name), own.get(owner(gear.gear.name), gear.gear.kind))
    for node in wiring.nodes:
        made.setdefault(owner(node.name), "shaft" if node.domain.value == "rotation" else "mass")
    return made
