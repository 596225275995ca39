"""Shift maps of the trade: a line for each shift over a speed and the pedal, kickdown, and what forbids a gear."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from itertools import pairwise
from math import inf, isfinite, nextafter, pi
from pathlib import Path
from typing import TYPE_CHECKING

from clutchwork.base import ModelError, Problem, UseError, dataclass, listed, quote
from clutchwork.base.frozen import frozen
from clutchwork.base.paths import path_of
from clutchwork.shifts.lines import Line, at

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.shifts.record import Measured

Pair = tuple[str, str]
# what lines are speeds of
INPUT, OUTPUT, VEHICLE = "input", "output", "vehicle"
# SI per unit of a speed in a table
UNITS = {"rad/s": 1.0, "rpm": pi / 30.0, "1/min": pi / 30.0, "m/s": 1.0, "km/h": 1.0 / 3.6, "mph": 0.44704}
LINEAR = ("m/s", "km/h", "mph")
# least gap between a line up and the one back, as a share of the speed up: what sensors and a drive shaft that rings
# shake a speed by
GAP = 0.01
FITS = 'give rad/s or rpm for "input" and "output", m/s, km/h or mph for "vehicle"'


@dataclass(frozen=True)
class Inhibit:
    """Gears that are not shifted up into while the oil is colder than a temperature [K], or on a climb [rad]."""

    gears: tuple[str, ...]
    colder_than: float = -inf
    steeper_than: float = inf

    def holds(self, gear: str, now: Measured) -> bool:
        """Whether it forbids an upshift into a gear at present."""
        return gear in self.gears and (now.oil < self.colder_than or now.grade > self.steeper_than)


@dataclass(frozen=True)
class ShiftMap:
    """When to shift, by a line of its own for each pair of gears: speed over the pedal, 0 to 1.

    Use it as the `schedule` of a `ShiftController`; `two_lines` makes one for all gears. Shift ("1", "2") is made above
    its line, ("2", "1") below its own; lines are linear between their points and held outside. Where a line leads over
    several gears they are skipped, if `skips` says so.

    Parameters:
        ratios: of the forward gears, first gear first
        lines: points (pedal, speed) by pair of gears
        of: what the speeds are of: "input" of the gearbox, which is the turbine of a converter [rad/s], its "output"
        [rad/s], or the "vehicle" [m/s]
        per_output: speed of the vehicle per speed of the output [m], for lines of the vehicle
        kickdown: pedal from which on `kickdown_speeds` count instead of lines; above 1: there is none
        kickdown_speeds: by pair of gears, of the same as lines
        fastest: speed of the input that no shift may lead to [rad/s]
        inhibits: what forbids upshifts
        skips: whether gears are skipped
        gap: least gap between a line up and the one back, as a share of the speed up; below 0 where the vehicle is
        counted on to gain as much while it shifts, as some published maps do
    """

    ratios: Mapping[str, float]
    lines: Mapping[Pair, Line]
    of: str = OUTPUT
    per_output: float | None = None
    kickdown: float = inf
    kickdown_speeds: Mapping[Pair, float] = field(default_factory=dict)
    fastest: float = inf
    inhibits: tuple[Inhibit, ...] = ()
    skips: bool = True
    gap: float = GAP

    def __post_init__(self) -> None:
        """Tables that never change. ModelError for lines that are missing or wrong, or with which gears hunt."""
        lines = {pair: tuple(map(tuple, line)) for pair, line in self.lines.items()}
        vars(self).update(ratios=frozen(self.ratios), inhibits=tuple(self.inhibits), lines=frozen(lines))
        vars(self).update(kickdown_speeds=frozen(dict(self.kickdown_speeds)))
        found = [*self._missing()] or [*self._hunting()]
        if found:
            raise ModelError(found, "shift map")

    @classmethod
    def two_lines(
        cls, box: Gearbox, up: Line, down: Line, *, gears: Sequence[str] = (), skips: bool = True
    ) -> ShiftMap:
        """A map with one line up and one down for all forward gears of a gearbox, or for some of them.

        Parameters: up and down, speeds of the input [rad/s] over the pedal. ModelError where gears hunt.
        """
        forward = _forward(box)
        unknown = [gear for gear in gears if gear not in forward]
        if unknown:
            raise UseError("ShiftMap.two_lines", [f"{box.name} has no forward gear {quote(gear)}" for gear in unknown])
        used = {gear: ratio for gear, ratio in forward.items() if not gears or gear in gears}
        lines = {way: line for pair in pairwise(used) for way, line in ((pair, up), (pair[::-1], down))}
        return cls(used, lines, INPUT, skips=skips)

    @classmethod
    def from_csv(
        cls, path: str | Path, box: Gearbox, *, of: str = OUTPUT, unit: str = "rad/s", **more: object
    ) -> ShiftMap:
        """A map from a table with the columns shift, pedal and speed: `1-2, 0.3, 25`.

        Parameters: of, what the speeds are of; unit, of the speeds: rad/s, rpm, m/s, km/h or mph; more, fields of the
        map. UseError for lines of the file that cannot be read, ModelError for lines of the map that make gears hunt.
        """
        if unit not in UNITS:
            raise UseError("ShiftMap.from_csv", [f"unit is {quote(unit)}; choose from {listed(UNITS)}"])
        if (unit in LINEAR) != (of == VEHICLE):
            raise UseError("ShiftMap.from_csv", [f"unit is {quote(unit)}, and the speeds are of {quote(of)}: {FITS}"])
        rows, lines = _rows(path_of("ShiftMap.from_csv", path, "map.csv")), dict[Pair, list[tuple[float, float]]]()
        for pair, pedal, speed in rows:
            lines.setdefault(pair, []).append((pedal, speed * UNITS[unit]))
        used = {gear: ratio for gear, ratio in _forward(box).items() if any(gear in pair for pair in lines)}
        sorted_lines = {pair: tuple(sorted(points)) for pair, points in lines.items()}
        return cls(used, sorted_lines, of, **more)  # type: ignore[arg-type]

    def gear(self, current: str, now: Measured) -> str:
        """The gear to drive in, from the one that is in."""
        order = list(self.ratios)
        if current not in self.ratios:
            return current
        place = order.index(current)
        for _ in range(len(order) if self.skips else 1):
            new = self._step(order, place, now)
            if new == place:
                break
            place = new
        return order[place]

    def speed(self, pair: Pair, pedal: float) -> float:
        """Speed of the output [rad/s] at which a shift is made."""
        if pedal >= self.kickdown and pair in self.kickdown_speeds:
            value = self.kickdown_speeds[pair]
        else:
            value = at(self.lines[pair], pedal)
        return value / {INPUT: self.ratios[pair[0]], OUTPUT: 1.0, VEHICLE: self.per_output or 1.0}[self.of]

    def _step(self, order: Sequence[str], place: int, now: Measured) -> int:
        here, speed = order[place], now.output_speed
        if place + 1 < len(order) and speed > self.speed((here, order[place + 1]), now.throttle):
            return place if any(one.holds(order[place + 1], now) for one in self.inhibits) else place + 1
        if place > 0 and speed < self.speed((here, order[place - 1]), now.throttle):
            return place if speed * self.ratios[order[place - 1]] > self.fastest else place - 1
        return place

    def _missing(self) -> Iterator[Problem]:
        if self.of not in (INPUT, OUTPUT, VEHICLE):
            yield Problem("shift map", "of", f"is {quote(self.of)}", remedy="choose from input, output, vehicle")
        if self.of == VEHICLE and not self.per_output:
            remedy = "give per_output, speed of the vehicle per speed of the output [m]"
            yield Problem("shift map", "per_output", "is missing for lines of the vehicle", remedy=remedy)
        if not -1.0 < self.gap < 1.0:
            yield Problem("shift map", "gap", f"is {self.gap:g}", remedy="give a share of the speed up, such as 0.01")
        if self.per_output is not None and not 0.0 < self.per_output < inf:
            remedy = "give the speed of the vehicle per speed of the output [m], above 0"
            yield Problem("shift map", "per_output", f"is {self.per_output:g}", remedy=remedy)
        yield from self._wrong()
        yield from self._unused()
        for lower, higher in pairwise(self.ratios):
            for pair in ((lower, higher), (higher, lower)):
                if pair not in self.lines or len(self.lines[pair]) == 0:
                    yield Problem(f"shift {'-'.join(pair)}", "", "has no line", remedy="give points (pedal, speed)")

    def _wrong(self) -> Iterator[Problem]:
        """Lines of gears that are not neighbours, and points that are none."""
        known = {way for pair in pairwise(self.ratios) for way in (pair, pair[::-1])}
        for pair, line in self.lines.items():
            name, pedals = f"shift {'-'.join(pair)}", [point[0] for point in line]
            if pair not in known:
                yield Problem(name, "", "is not between two gears that follow each other", remedy="leave it out")
            if not all(0.0 <= pedal <= 1.0 and isfinite(speed) and speed >= 0.0 for pedal, speed in line):
                yield Problem(name, "", "has an invalid point", remedy="give pedals from 0 to 1 and speeds from 0")
            if sorted(set(pedals)) != pedals:
                yield Problem(name, "", "has pedals that do not rise", remedy="give each pedal once, in rising order")

    def _unused(self) -> Iterator[Problem]:
        """Kickdown and inhibits that would never act."""
        if (self.kickdown <= 1.0) != bool(self.kickdown_speeds):
            remedy = "give both `kickdown` and `kickdown_speeds`, or neither"
            yield Problem(
                "shift map", "kickdown", "has a pedal without speeds, or speeds without a pedal", remedy=remedy
            )
        for pair in self.kickdown_speeds.keys() - self.lines.keys():
            remedy = "give pairs of gears that follow each other"
            yield Problem(f"shift {'-'.join(pair)}", "kickdown_speeds", "has no line", remedy=remedy)
        for one in self.inhibits:
            gears = (one.gears,) if isinstance(one.gears, str) else one.gears
            for gear in gears:
                if isinstance(one.gears, str) or gear not in self.ratios:
                    known = ", ".join(self.ratios)
                    fault = f"has {quote(gear)}, which is not a tuple of gears of the map"
                    yield Problem("shift map", "inhibits", fault, remedy=f"choose from {known}")

    def _hunting(self) -> Iterator[Problem]:
        """No line back above a line up, (23) of docs/theory/shifts.md, and no line up above that of the next gear.

        The worst pedal of each pair is named.
        """
        gears = list(self.ratios)
        ends = {self.kickdown, nextafter(self.kickdown, 0.0)} if self.kickdown <= 1.0 else set[float]()
        pedals = sorted({point[0] for line in self.lines.values() for point in line} | {1.0} | ends)
        for lower, higher in pairwise(gears):
            seen = [(p, self.speed((lower, higher), p), self.speed((higher, lower), p)) for p in pedals]
            pedal, up, down = max(seen, key=lambda one: one[2] - (1.0 - self.gap) * one[1])
            if down > (1.0 - self.gap) * up:
                fault = f"hunts at pedal {pedal:g}: up at {up:.4g} rad/s of the output, down at {down:.4g}"
                remedy = f"keep the line down {self.gap:.0%} below the line up, or give another `gap`"
                yield Problem(f"shifts {lower}-{higher}-{lower}", "", fault, remedy=remedy)
        for lower, higher, after in zip(gears, gears[1:], gears[2:], strict=False):
            crossed = [p for p in pedals if self.speed((higher, after), p) <= self.speed((lower, higher), p)]
            if crossed:
                fault = (
                    f"is above that of {higher}-{after} at pedal {crossed[0]:g}, so that {higher} is never driven in"
                )
                yield Problem(f"line {lower}-{higher}", "", fault, remedy="order the lines up by their gears")


def _forward(box: Gearbox) -> dict[str, float]:
    """Ratios of the forward gears, first gear first."""
    return dict(sorted(((gear, ratio) for gear, ratio in box.ratios.items() if ratio > 0.0), key=lambda one: -one[1]))


def _rows(path: Path) -> list[tuple[Pair, float, float]]:
    """Rows of a table, a head or not; UseError names those that cannot be read."""
    made, wrong = list[tuple[Pair, float, float]](), list[str]()
    with path.open(encoding="utf-8-sig", newline="") as file:
        for number, row in enumerate(csv.reader(file), 1):
            cells = [cell.strip() for cell in row]
            if not any(cells) or (number == 1 and cells[0].lower() == "shift"):
                continue
            try:
                first, second = cells[0].split("-")
                made.append(((first.strip(), second.strip()), float(cells[1]), float(cells[2])))
            except (ValueError, IndexError):
                wrong.append(f"{path.name}, line {number}: {quote(','.join(cells))} must be a row such as 1-2, 0.3, 25")
    if wrong or not made:
        raise UseError("ShiftMap.from_csv", wrong or [f"{path.name} has no rows; write lines such as 1-2, 0.3, 25"])
    return made
