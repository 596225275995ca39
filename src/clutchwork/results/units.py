"""Results in other units than SI: `converter` says what puts the values of each signal into the one asked for."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

from clutchwork.base import UnknownName, UseError, advised, dataclass, listed, near, quote
from clutchwork.declare.quantity import PLAIN, QuantityError, scale_to_si
from clutchwork.declare.unit_table import fitting
from clutchwork.declare.units import Scale
from clutchwork.declare.wording import where_signals

if TYPE_CHECKING:
    from clutchwork.results.recorded import Recorded


UNFIT = "the unit does not fit"
# a torque is not work, though both are N m
MISTAKEN = {"N m": "J", "J": "N m"}


@dataclass(frozen=True)
class Converter:
    """Units of signals, and what puts their values into these: `values` of a signal, `unit` of it."""

    units: Mapping[str, str]  # of signals in other units than SI
    plain: Mapping[str, str]  # of all signals, in SI
    scales: Mapping[str, Scale]

    def unit(self, name: str) -> str:
        """The unit in which a signal is given."""
        return self.units.get(name) or self.plain[name]

    def values(self, run: Recorded, name: str) -> Any:
        """A signal over time in its unit."""
        return self.put(run[name], name)

    def put(self, values: Any, name: str) -> Any:
        """Values of a signal in SI, or of "time", in their unit."""
        scale = self.scales.get(name, PLAIN)
        return values if scale == PLAIN else (values - scale.zero) / scale.factor


def converter(run: Recorded, units: Mapping[str, str] | None = None) -> Converter:
    """What puts signals of a run into other units; UseError names all units that do not fit, with examples.

    Parameters: units by names of signals, in which `*` stands for any characters: {"engine.speed": "rpm", "*.pressure":
    "bar"}. A later entry overrules an earlier one; a pattern that only some signals fit by their quantity takes those.
    "time" is that of the instants.
    """
    return among({**run.units, "time": "s"}, units)


def among(known: Mapping[str, str], units: Mapping[str, str] | None) -> Converter:
    """The same for signals that are known by their units in SI."""
    found, problems = dict[str, str](), list[str]()
    for pattern, unit in _checked(units).items():
        try:
            found |= _matched(pattern, unit, known)
        except QuantityError as bad:
            problems.append(f"{pattern} in {bad.value}: {advised(bad.message, bad.remedy)}")
    if problems:
        raise UseError("units", problems)
    return Converter(found, known, {name: scale_to_si(unit, known[name]) for name, unit in found.items()})


def _checked(units: object) -> Mapping[str, str]:
    if units is None:
        return {}
    if not isinstance(units, Mapping):
        remedy = 'give units by signal: units={"engine.speed": "rpm", "*.pressure": "bar"}'
        raise UseError("units", [f"units is {quote(units)}: {remedy}"])
    return units


def _matched(pattern: object, unit: object, known: Mapping[str, str]) -> dict[str, str]:
    """The signals that a name or a pattern means, with their unit."""
    if isinstance(pattern, str) and pattern in known:
        return {pattern: _fits(unit, known[pattern])}
    names = _names(pattern, known)
    fitting_ones, wrong = dict[str, str](), list[QuantityError]()
    for si, of_unit in _by_unit(names, known).items():
        try:
            fitting_ones |= dict.fromkeys(of_unit, _fits(unit, si))
        except QuantityError as bad:
            wrong.append(bad)
    if not fitting_ones:
        raise wrong[0]
    return fitting_ones


def _names(pattern: object, known: Mapping[str, str]) -> list[str]:
    # brackets are letters of names, not sets of letters
    plain = pattern.replace("[", "[[]") if isinstance(pattern, str) else ""
    names = [name for name in known if fnmatchcase(name, plain)]
    if not names:
        meant = near(pattern, known, where_signals())
        raise UnknownName(f"no signal {quote(pattern)}{meant}")
    return names


def _by_unit(names: Iterable[str], known: Mapping[str, str]) -> dict[str, list[str]]:
    found = dict[str, list[str]]()
    for name in names:
        found.setdefault(known[name], []).append(name)
    return found


def _fits(unit: object, si: str) -> str:
    """A unit that fits a signal; QuantityError says what the signal has, and what it may be given in."""
    if not si:
        raise QuantityError("the signal is a word and has no unit", quote(unit), "leave it out")
    remedy = f"the signal is in [{si}]; give it in {listed(fitting(si))}" if fitting(si) else f"it is in [{si}]"
    try:
        scale_to_si(unit, si)
    except QuantityError as bad:
        message = UNFIT if bad.message.startswith("has a unit") else f"the unit {bad.message}"
        raise QuantityError(message.replace("has the unknown unit", "is unknown:"), quote(unit), remedy) from None
    word = str(unit).strip()
    if si in MISTAKEN and word in {*fitting(MISTAKEN[si])} - {*fitting(si)}:
        raise QuantityError(UNFIT, quote(unit), remedy)
    return word
