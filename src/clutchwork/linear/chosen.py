"""Which inputs and outputs a linear system has: names, wildcards, and what goes by default."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

from clutchwork.assembly.wiring import wiring
from clutchwork.base import dataclass, near, quote
from clutchwork.declare.ports import ports
from clutchwork.results.channels import ACCELERATION, channels
from clutchwork.results.forms import Mode

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

WILD = frozenset("*?")


@dataclass(frozen=True)
class Excitation:
    """One input: a signal of the System, or the acceleration of a prescribed speed."""

    name: str
    unit: str
    signal: int  # number among the inputs of the System
    motion: int = -1  # number among the prescribed speeds, -1: none
    accelerates: bool = False  # its acceleration is given; else its value


def possible_inputs(system: System) -> dict[str, Excitation]:
    """Everything that can be an input, by name: all signals, then the accelerations of prescribed speeds."""
    motions = {int(number): place for place, number in enumerate(system.prescribed_input)}
    known = {
        item.name: Excitation(item.name, item.unit, number, motions.get(number, -1))
        for number, item in enumerate(system.inputs)
    }
    for number, place in motions.items():
        domain = next(n.domain for n in _ports(system.motions[place]))
        name = f"{system.motions[place].name}.acceleration"
        known.setdefault(name, Excitation(name, ACCELERATION[domain], number, place, accelerates=True))
    return known


def _ports(component: Any) -> list[Any]:
    nodes = list(ports(component).values())
    return [node for node in nodes if not node.fixed] or nodes


def chosen_inputs(system: System, wanted: Any, problems: list[str]) -> list[Excitation]:
    """The inputs that were asked for; by default all signals."""
    known, unused = possible_inputs(system), wiring(system).unused
    if wanted is None:
        return [given for given in known.values() if not given.accelerates and given.name not in unused]
    # a signal is also known by the name that it has in a result
    results = channels(system, True, True)
    aliases = {f"{name}_signal": name for name in known if f"{name}_signal" in results}
    there = [name for name in (*known, *aliases) if name not in unused]

    def unlike(name: str) -> str:
        return _not_given(name, there) if name in results else ""

    names = _matching("inputs", wanted, there, problems, unlike, unused)
    found = {aliases.get(name, name): known[aliases.get(name, name)] for name in names}
    twice = {given.signal: given.name for given in found.values()}
    problems.extend(
        f"inputs {given.name!r} and {twice[given.signal]!r} are one motion; give one of them"
        for given in found.values()
        if twice[given.signal] != given.name
    )
    return list(found.values())


def chosen_outputs(system: System, wanted: Any, default: Iterable[str], problems: list[str]) -> list[str]:
    """The selected outputs, or the default ones."""
    if wanted is None:
        return list(dict.fromkeys(default))
    known, columns = channels(system, True, True), wiring(system).columns["supply_power"]
    drawn = range(columns.start, columns.stop)
    names = _matching("outputs", wanted, list(known), problems)
    usable, integrals = [], _integrals(system)
    for name in names:
        reason = _unusable(name, known[name].evaluate, integrals, drawn)
        plain = wanted == name or (not isinstance(wanted, str) and name in list(wanted))
        if not reason:
            usable.append(name)
        elif plain:
            problems.append(f"outputs: {name!r} {reason}")
    return usable


def _unusable(name: str, form: Any, integrals: Collection[int], drawn: Collection[int]) -> str:
    """Why a signal cannot be an output, empty where it can."""
    if isinstance(form, Mode):
        return "does not change with a state; ask for the torque or the slip of the contact"
    if any(column in drawn for column in form.reads()):
        return f"holds losses, which a linear system does not have; ask for '{name.rpartition('.')[0]}.power'"
    if any(column in integrals for column in form.reads()):
        return f"is an integral over the run; ask for '{name.rpartition('.')[0]}.power'"
    return ""


def _integrals(system: System) -> set[int]:
    """Columns of the row that are integrals over the run."""
    columns = wiring(system).columns
    parts = ("element_work", "contact_work", "prescribed_work", "supply_energy", "meter_energy")
    return {column for part in parts for column in range(columns[part].start, columns[part].stop)}


def _not_given(name: str, known: Sequence[str]) -> str:
    """What to say of a result that is asked for as an input."""
    owner, _, quantity = name.rpartition(".")
    made = f"; a cw.Torque of 0 N m at a shaft of {owner!r} makes an input for a torque there"
    return (
        f"inputs: {name!r} is a result, which follows from the motion and the signals; inputs are {_some(known)}"
        f"{made if quantity == 'torque' else ''}"
    )


def _matching(
    what: str,
    wanted: Any,
    known: Sequence[str],
    problems: list[str],
    unlike: Callable[[str], str] = lambda _: "",
    hidden: Collection[str] = (),
) -> list[str]:
    """Names that fit a name or a wildcard, or several of them, each once.

    Parameters: unlike, says why a name that is not among those known is none of them; hidden, names that no wildcard
    fits.
    """
    asked = [wanted] if isinstance(wanted, str) else wanted
    if not isinstance(asked, Iterable) or isinstance(asked, bytes):
        problems.append(f"{what} = {quote(wanted)}: must be a name, such as '*.speed', or a list of names")
        return []
    names: dict[str, None] = {}
    for name in asked:
        if not isinstance(name, str):
            problems.append(f"{what}: {quote(name)} is not a name; give names as strings, such as '*.speed'")
        elif name in known or name in hidden:
            names[name] = None
        elif WILD & set(name):
            # brackets stand for themselves: they are part of names
            found = [other for other in known if fnmatchcase(other, name.replace("[", "[[]"))]
            if not found:
                problems.append(f"{what}: no signal fits {quote(name)}; `{what}` may be {_some(known)}")
            names.update(dict.fromkeys(found))
        elif reason := unlike(name):
            problems.append(reason)
        else:
            problems.append(f"{what}: no signal {quote(name)}{near(name, known, f'it may be {_some(known)}')}")
    return list(names)


def _some(known: Sequence[str]) -> str:
    first = ", ".join(known[:6])
    return f"{first} ..." if len(known) > 6 else first or "none, for the model has none"
