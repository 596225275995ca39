"""A gearbox and what can be asked of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

from clutchwork.base import Problem, UseError, counted, dataclass, listed, near, quote
from clutchwork.base.paths import fitting, path_of
from clutchwork.base.verbs import do
from clutchwork.base.writing import put
from clutchwork.declare.calls import explain, explained, explained_methods
from clutchwork.declare.rational import exact
from clutchwork.gearbox import analysis, checks, losses, motion, operating, store
from clutchwork.gearbox.definition import Definition
from clutchwork.gearbox.reader import plain
from clutchwork.gearbox.state import GearState, state
from clutchwork.gearbox.tables import summary


@explained_methods("box")
@dataclass(frozen=True, repr=False)
class Gearbox(Definition):
    """A gearbox of planetary sets: its teeth, its members, its shift elements and its shift table.

    Use it to analyse a gearbox before any simulation, and as the `gearbox` of a `cw.Transmission`. Take one from the
    catalogue, `cw.Gearbox.load("zf-8hp70")`, read a file of your own, or build one with `cw.Gearbox.from_dict`. Its
    speeds and torques are exact, for speed 1 and torque 1 at the input.

    Equations: docs/theory/gearboxes.md. Source: H. W. Müller, Epicyclic Drive Trains, Wayne State Univ. Press 1982.
    """

    @classmethod
    def load(cls, source: str | Path) -> Gearbox:
        """A gearbox of the catalogue by its name, or that of a TOML or JSON file; ModelError lists all its mistakes."""
        path_of("cw.Gearbox.load", source, "zf-8hp70")
        return cls._of(store.definition(source))

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Gearbox:
        """A gearbox from the content of a file; ModelError lists all its mistakes."""
        return cls._of(store.from_data(data))

    @classmethod
    def import_table(cls, data: Mapping[str, Any], path: str | Path) -> Gearbox:
        """A gearbox whose shift table stands in a CSV file, as spreadsheets write it.

        Parameters: data, the content of a gearbox file without gears: sets and elements; path, a table whose first
        column names the gears, with a column for each element, an x where it is closed, and a column `ratio` with
        published ratios if there are some. ModelError lists all mistakes.
        """
        return cls._of(store.with_shift_table(data, path_of("cw.Gearbox.import_table", path, "table.csv")))

    @classmethod
    def _of(cls, box: Definition) -> Gearbox:
        return cls(**{item.name: getattr(box, item.name) for item in fields(box)})

    def to_dict(self) -> dict[str, Any]:
        """The content of a gearbox file."""
        return plain(self)

    def save(self, path: str | Path) -> None:
        """Write a gearbox file in TOML."""
        where = fitting("box.save", path, "gearbox.toml", (".toml",))
        put(where, store.toml(plain(self)))

    def page(self, path: str | Path) -> Path:
        """Write a page, one HTML file: its reader chooses a gear and sees power flow, levers, speeds and torques."""
        return do("box.page", self, path)  # type: ignore[no-any-return]

    def check(self) -> list[Problem]:
        """All mistakes: names, teeth, rows of the shift table that make no gear, published ratios that are missed."""
        return checks.problems(self)

    def state(self, gear: str | Sequence[str]) -> GearState:
        """Speeds, torques, powers and efficiency in a gear, by its name or by the elements that are closed.

        UseError for a name that the box does not have, and for elements that give no ratio.
        """
        if isinstance(gear, str):
            if gear not in self.gears:
                raise UseError(
                    "box.state", [f"{quote(gear)} is not a gear{near(gear, self.gears, _known(self.gears))}"]
                )
            closed = self.closed_in(gear)
        else:
            closed = self._elements("box.state", gear)
        found = state(self, closed, gear if isinstance(gear, str) else "")
        if found is None:
            kind = self.combination(closed).kind
            raise UseError(
                "box.state", [f"{listed(closed) or 'nothing'} closed make {kind}, not a gear; close other elements"]
            )
        return found

    def operating_point(
        self,
        mode: str | Sequence[str],
        *,
        torque: float,
        speed: float | None = None,
        output_speed: float | None = None,
        speeds: Mapping[str, float] | None = None,
        machines: Mapping[str, float] | None = None,
        output_torque: float | None = None,
        battery_power: float | None = 0.0,
    ) -> operating.OperatingPoint:
        """Every speed, torque and power of a power split, from speed and torque of the engine; no losses.

        Use it for rows with two free speeds, and for hybrids in a gear. Give as many quantities as the mode leaves
        free: a split has two speeds, and torques of two machines that follow from balance and battery.

        Parameters: mode, a row of the shift table or closed elements; torque [N m] and speed [rad/s] of the input;
        output_speed [rad/s]; speeds [rad/s], of other members; machines, torques [N m] of machines that are known, by
        name; output_torque [N m], on what the output drives; battery_power [W], what the machines draw together, None
        where it is to follow. UseError where that is too little, or too much.
        """
        if isinstance(mode, str) and mode not in self.gears:
            meant = near(mode, self.gears, _known(self.gears))
            raise UseError("box.operating_point", [f"{quote(mode)} is not a row of the shift table{meant}"])
        named = isinstance(mode, str)
        closed = self.closed_in(mode) if isinstance(mode, str) else self._elements("box.operating_point", mode)
        members = dict.fromkeys(self.members)
        known = {self.input: speed, self.output: output_speed}
        twice = [name for name, value in known.items() if value is not None and name in (speeds or {})]
        if twice:
            raise UseError("box.operating_point", [f"speed of {quote(name)} is given twice" for name in twice])
        known |= speeds or {}
        wanted = operating.Wanted(
            operating.exactly({name: value for name, value in known.items() if value is not None}, members, "member"),
            exact(torque),
            None if output_torque is None else exact(output_torque),
            operating.exactly(machines or {}, self.machines, "machine"),
            None if battery_power is None else exact(battery_power),
        )
        return operating.operating_point(self, closed, str(mode) if named else "", wanted)

    def mechanical_points(self, mode: str) -> list[operating.MechanicalPoint]:
        """The ratios of a split at which one machine stands still and all power is mechanical, from low to high gear.

        UseError for a row that is not a split.
        """
        found = self.combination(self.gears.get(mode, ()))
        if mode not in self.gears or self.combination(self.closed_in(mode)).kind != motion.SPLIT:
            splits = [name for name in self.gears if self.combination(self.closed_in(name)).kind == motion.SPLIT]
            raise UseError("box.mechanical_points", [f"{quote(mode)} is not a split; {_known(splits)}"])
        return operating.mechanical_points(self, found.closed)

    def loss_map(
        self,
        gear: str,
        *,
        speeds: Sequence[float],
        torques: Sequence[float],
        temperatures: Sequence[float],
        oil: losses.Oil,
        parts: Sequence[losses.LossPart] = (),
    ) -> losses.LossMap:
        """Losses of a gear over speed, torque and temperature: meshes, and the bearings, seals, plates and pumps given.

        Use it for the losses of a whole box in one table, before anything is simulated. Meshes lose by the `efficiency`
        of the sets, see `with_efficiency`, in the direction that power takes.

        Parameters: gear; speeds [rad/s] and torques [N m] of the input, negative ones too; temperatures [K] of the oil;
        oil, a `cw.Oil`; parts: `cw.Bearing`, `cw.Seal`, `cw.OpenPlates`, `cw.Churning`, `cw.OilPump`. UseError for what
        the box does not have.
        """
        return losses.loss_map(self, self.state(gear), (temperatures, speeds, torques), oil, parts)

    def with_efficiency(self, efficiency: float) -> Gearbox:
        """The same box whose sets have an efficiency, from wheel to wheel at resting carrier, such as 0.985."""
        data = plain(self)
        data["sets"] = {name: {**entry, "efficiency": efficiency} for name, entry in data["sets"].items()}
        return type(self).from_dict(data)

    def states(self) -> dict[str, GearState]:
        """The state of every gear by its name."""
        return analysis.states(self)

    @property
    def ratios(self) -> dict[str, float]:
        """Speed of the input over that of the output by gear, negative in reverse."""
        return {gear: one.ratio for gear, one in self.states().items()}

    def combination(self, closed: Sequence[str]) -> motion.Combination:
        """The state of the box with these closed elements: a gear, neutral, input or output held, a tie-up.

        UseError for elements that the box does not have.
        """
        return motion.combination(self, self._elements("box.combination", closed))

    def _elements(self, call: str, closed: Sequence[str]) -> tuple[str, ...]:
        """Names of elements, as they were given; UseError for others."""
        if isinstance(closed, str) or not isinstance(closed, Iterable):
            raise UseError(call, [f"{quote(closed)} is not a list of elements; write ('A', 'B')"])
        names = [element.name for element in self.elements]
        wrong = [name for name in closed if name not in names]
        if wrong:
            raise UseError(
                call, [f"{quote(name)} is not an element{near(name, names, _known(names))}" for name in wrong]
            )
        return tuple(closed)

    def combinations(self) -> Iterator[motion.Combination]:
        """Every combination of closed elements, all of them: 2 to the power of their number."""
        return motion.all_combinations(self)

    def swaps(self) -> list[analysis.Swap]:
        """Every shift, skip shifts too: which elements open and close."""
        return list(analysis.swaps(self))

    def capacities(self) -> dict[str, analysis.Capacity]:
        """The torque that each element must hold per torque 1 at the input, and its fastest slip while open."""
        return analysis.capacities(self)

    def __repr__(self) -> str:
        has = {"sets": self.sets, "elements": self.elements, "gears": self.gears}
        return f"<Gearbox {quote(self.name)}: {', '.join(counted(len(all_), of) for of, all_ in has.items())}>"

    def __str__(self) -> str:
        return summary(self)


explain(Gearbox)


@explained("cw.catalogue")
def catalogue() -> dict[str, Gearbox]:
    """The known gearboxes by name, each with its source and its published ratios."""
    return {name: Gearbox.load(name) for name in store.names()}


def _known(names: Sequence[str] | Mapping[str, Any]) -> str:
    return f"choose from {listed(names)}"
