"""From the plain data of a gearbox file to its definition; every mistake is collected."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isfinite
from typing import Any

from clutchwork.base import Problem, listed, near, quote
from clutchwork.gearbox.definition import ELEMENTS, Definition, ShiftElement
from clutchwork.gearbox.gear_set import HOUSING, KINDS, GearSet

TOP = (
    *("name", "title", "input", "output", "ratio_form", "tolerance", "tolerance_relative", "source", "notes"),
    *("shafts", "always_closed", "sets", "elements", "machines", "gears", "published"),
)
FORMS = ("in/out", "out/in")
# of teeth and of ratios, far above any gear; what follows from them stays within floating-point numbers
MOST = 1e6
SET = ("type", "planets", "equally_spaced", "efficiency")


class GearboxReader:
    """Turns plain data into a definition and collects what is wrong with it."""

    def __init__(self) -> None:
        self.problems: list[Problem] = []

    def definition(self, data: Any) -> Definition | None:
        """The gearbox of the data; None where something is missing or wrong."""
        if not isinstance(data, Mapping):
            self._report("gearbox", "", "must be a table", quote(data), "see the guide on gearboxes")
            return None
        self._unknown(data, TOP, "gearbox")
        values: dict[str, Any] = {name: self._text(data, name) for name in ("name", "input", "output")}
        for name in ("title", "source", "notes"):
            values[name] = self._text(data, name, "")
        values["ratio_form"] = self._form(data.get("ratio_form", "in/out"))
        for name, default in (("tolerance", 0.001), ("tolerance_relative", 0.0)):
            values[name] = self._number(data.get(name, default), "gearbox", name, at_least=0.0)
        for name in ("shafts", "always_closed"):
            values[name] = self._names(data.get(name, []), "gearbox", name)
        values["sets"] = tuple(self._sets(self._table(data, "sets")))
        values["elements"] = tuple(self._elements(self._table(data, "elements")))
        gears = self._table(data, "gears")
        values["gears"] = {name: self._names(row, f'gear "{name}"', "") for name, row in gears.items()}
        machines = self._table(data, "machines")
        values["machines"] = {name: self._member({name: member}, name, "machines") for name, member in machines.items()}
        published = self._table(data, "published")
        values["published"] = {
            name: self._number(value, "published", name, zero=False) for name, value in published.items()
        }
        return None if self.problems else Definition(**values)

    def _report(self, path: str, quantity: str, message: str, value: str = "", remedy: str = "") -> None:
        self.problems.append(Problem(path, quantity, message, value, remedy))

    def _unknown(self, data: Mapping[str, Any], known: tuple[str, ...], path: str) -> None:
        for key in data:
            if key not in known:
                meant = near(key, known)
                remedy = "" if meant else f"known keys: {listed(known)}"
                self._report(path, str(key), f"is an unknown key{meant}", remedy=remedy)

    def _text(self, data: Mapping[str, Any], key: str, default: str | None = None) -> str:
        value = data.get(key, default)
        if isinstance(value, str) and (value or default == ""):
            return value
        message = "must be a string" if key in data else "is missing"
        self._report("gearbox", key, message, quote(value) if key in data else "", REMEDIES.get(key, ""))
        return ""

    def _form(self, value: Any) -> str:
        if value not in FORMS:
            self._report(
                "gearbox", "ratio_form", "is an unknown choice", quote(value), f"choose one of {listed(FORMS)}"
            )
        return str(value)

    def _table(self, data: Mapping[str, Any], key: str) -> Mapping[str, Any]:
        value = data.get(key, {})
        if isinstance(value, Mapping):
            return {str(name): entry for name, entry in value.items()}
        self._report("gearbox", key, "must be a table", quote(value), f"write [{key}] above its lines")
        return {}

    def _number(
        self,
        value: Any,
        path: str,
        quantity: str,
        *,
        at_least: float | None = None,
        above: float | None = None,
        at_most: float | None = None,
        whole: bool = False,
        zero: bool = True,
    ) -> Any:
        """A number within its bounds; what is none is reported."""
        signs = ((">=", at_least), (">", above), ("<=", at_most))
        bound = " and ".join(f"{sign} {end:g}" for sign, end in signs if end is not None) or ("" if zero else "not 0")
        kind = "a whole number" if whole else "a number"
        wanted = f"must be {kind} {bound}".rstrip()
        fits = isinstance(value, int) and not isinstance(value, bool) if whole else _is_number(value)
        low = fits and ((at_least is not None and value < at_least) or (above is not None and value <= above))
        if not fits or low or (at_most is not None and value > at_most) or (not zero and value == 0):
            self._report(path, quantity, wanted, quote(value), "correct it")
        return value

    def _names(self, value: Any, path: str, quantity: str) -> tuple[str, ...]:
        if isinstance(value, list | tuple) and all(isinstance(name, str) for name in value):
            for name in {name for name in value if list(value).count(name) > 1}:
                self._report(path, quantity, f"names {name} twice", remedy="name it once")
            return tuple(value)
        self._report(path, quantity, "must be a list of names", quote(value), 'write ["A", "B"]')
        return ()

    def _sets(self, tables: Mapping[str, Any]) -> Iterator[GearSet]:
        for name, entry in tables.items():
            path = f'set "{name}"'
            if not isinstance(entry, Mapping):
                self._report(path, "", "must be a table", quote(entry), f"write [sets.{name}] above its keys")
                continue
            kind = entry.get("type", "")
            if not isinstance(kind, str) or kind not in KINDS:
                message = "is missing" if "type" not in entry else f"is an unknown type{near(kind, KINDS)}"
                value = quote(kind) if "type" in entry else ""
                self._report(path, "type", message, value, f"choose one of {listed(KINDS)}")
                continue
            before = len(self.problems)
            made = self._set(str(name), kind, entry, path)
            if len(self.problems) == before:
                yield made

    def _set(self, name: str, kind: str, entry: Mapping[str, Any], path: str) -> GearSet:
        shape = KINDS[kind]
        self._unknown(entry, (*SET, *shape.ports, *shape.teeth, *shape.extra, *shape.ratios), path)
        members = {port: self._member(entry, port, path) for port in shape.ports}
        by_ratio = any(ratio in entry for ratio in shape.ratios)
        if by_ratio and any(key in entry for key in shape.teeth):
            ratio = next(ratio for ratio in shape.ratios if ratio in entry)
            self._report(path, ratio, "is given beside teeth", remedy="give only one of the two")
        ratios, teeth = dict[str, float](), dict[str, int]()
        extra = [key for key in shape.extra if key in entry]
        for key in shape.ratios if by_ratio else [*shape.teeth, *extra]:
            if key not in entry:
                rest = "" if by_ratio else f", or {' and '.join(shape.ratios)} in place of all teeth"
                self._report(path, key, "is missing", remedy=f"give {key}{rest}")
            elif by_ratio:
                ratios[key] = self._number(entry[key], path, key, above=0.0, at_most=MOST)
            else:
                teeth[key.removeprefix("teeth_")] = self._number(
                    entry[key], path, key, above=0, at_most=MOST, whole=True
                )
        planets = entry.get("planets")
        if planets is not None:
            self._number(planets, path, "planets", at_least=1, whole=True)
        spaced = entry.get("equally_spaced", True)
        if not isinstance(spaced, bool):
            self._report(path, "equally_spaced", "must be true or false", quote(spaced), "write true or false")
        efficiency = self._number(entry.get("efficiency", 1.0), path, "efficiency", above=0.0, at_most=1.0)
        return GearSet(name, kind, members, teeth, ratios, planets, spaced, efficiency)

    def _member(self, entry: Mapping[str, Any], port: str, path: str) -> str:
        value = entry.get(port)
        if isinstance(value, str) and value:
            return value
        message, remedy = "must be the name of a member", f"give a name, or {HOUSING!r} for one that never turns"
        given = port in entry
        self._report(path, port, message if given else "is missing", quote(value) if given else "", remedy)
        return ""

    def _elements(self, tables: Mapping[str, Any]) -> Iterator[ShiftElement]:
        for name, entry in tables.items():
            path, before = f'element "{name}"', len(self.problems)
            table = entry if isinstance(entry, Mapping) else {"members": entry}
            self._unknown(table, ("type", "members"), path)
            members = self._names(table.get("members", ()), path, "members")
            if len(self.problems) == before and len(members) != 2:
                found = f"has {len(members)} members"
                self._report(path, "", found, remedy='give two: ["S1", "housing"] of a brake, ["in", "C2"] of a clutch')
            kind = table.get("type", "brake" if HOUSING in members else "clutch")
            if not isinstance(kind, str) or kind not in ELEMENTS:
                fault = f"is an unknown type{near(kind, ELEMENTS)}"
                self._report(path, "type", fault, quote(kind), f"choose one of {listed(ELEMENTS)}")
            if len(self.problems) == before:
                first, second = members
                # of a brake the member stands first
                swapped = kind == "brake" and first == HOUSING
                yield ShiftElement(str(name), kind, *((second, first) if swapped else (first, second)))


REMEDIES = {
    "name": 'give it a name, such as "six-speed"',
    "input": "give the name of the member that is driven",
    "output": "give the name of the member that drives the load",
}


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)


def plain(box: Definition) -> dict[str, Any]:
    """The content of a gearbox file."""
    data: dict[str, Any] = {"name": box.name, "title": box.title, "input": box.input, "output": box.output}
    data |= {"source": box.source, "notes": box.notes, "shafts": list(box.shafts)}
    data["always_closed"] = list(box.always_closed)
    for name, default in (("ratio_form", "in/out"), ("tolerance", 0.001), ("tolerance_relative", 0.0)):
        if getattr(box, name) != default:
            data[name] = getattr(box, name)
    data["sets"] = {one.name: _plain_set(one) for one in box.sets}
    data["elements"] = {element.name: _plain_element(element) for element in box.elements}
    data["machines"] = dict(box.machines)
    data["gears"] = {name: list(row) for name, row in box.gears.items()}
    data["published"] = dict(box.published)
    needed = ("name", "input", "output", "gears")
    return {key: value for key, value in data.items() if value or key in needed}


def _plain_set(one: GearSet) -> dict[str, Any]:
    teeth = {f"teeth_{wheel}": count for wheel, count in one.teeth.items()}
    made = {"type": one.kind, **one.members, **teeth, **one.ratios}
    extra: dict[str, tuple[Any, Any]] = {"planets": (one.planets, None), "equally_spaced": (one.equally_spaced, True)}
    extra["efficiency"] = (one.efficiency, 1.0)
    return made | {name: value for name, (value, default) in extra.items() if value != default}


def _plain_element(element: ShiftElement) -> Any:
    usual = "brake" if HOUSING in element.members else "clutch"
    members = list(element.members)
    return members if element.kind == usual else {"type": element.kind, "members": members}
