"""Model exchange: which numbers are continuous states of an FMU, and which models cannot be taken."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import count
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import wiring
from clutchwork.fmu.sizes import nominal, size_of
from clutchwork.fmu.variables import FmuVariable, VariableKind
from clutchwork.results.channels import Channels
from clutchwork.results.forms import Form, RowEntry, Total
from clutchwork.results.rows import numbers

# states of which there are none unless an output reads them
INTEGRALS = ("angle", "element_work", "contact_work", "prescribed_work", "supply_energy", "meter_energy")
ABOUT_RATE = "time derivative of the state"
ABOUT_MARGIN = "above zero while nothing needs a decision"


class ContinuousState(NamedTuple):
    """A continuous state: its number in the core, its size, and the value references of it and of its rate."""

    number: int
    nominal: float
    variable: int
    rate: int


class ExchangeTerms(NamedTuple):
    """Variables with those of model exchange, and the continuous states."""

    variables: tuple[FmuVariable, ...]
    states: tuple[ContinuousState, ...]


def exchange(
    system: System, known: Channels, variables: Sequence[FmuVariable], amounts: NDArray[np.float64] | None
) -> ExchangeTerms:
    """Give an FMU its continuous states, their rates, and event indicators, behind the variables that it has.

    Parameters: amounts, the largest of all numbers of a row over a run, by which states have sizes; None: no run.
    """
    made = list(variables)
    read = set[int]().union(*(one.form.reads() for one in made if one.form is not None))
    placed = [(number, place) for number, place, always in _numbers(system) if always or place in read]
    references = [_state(system, known, made, place) for _, place in placed]
    states = list[ContinuousState]()
    for state, ((number, place), reference) in enumerate(zip(placed, references, strict=True)):
        one = made[reference]
        usual = nominal(system, one.unit)
        size = usual if amounts is None else size_of(float(amounts[place]), usual, one.unit)
        made[reference] = replace(one, state=state, nominal=size)
        states.append(ContinuousState(number, size, reference, len(made)))
        unit = "1/s" if one.unit == "1" else f"{one.unit}/s"
        made.append(FmuVariable(f"der({one.name})", VariableKind.RATE, unit, about=ABOUT_RATE, of=state, hidden=True))
    taken = {one.name for one in made}
    for margin, name in enumerate(_margins(system)):
        free = next(one for one in _named(name) if one not in taken)
        taken.add(free)
        made.append(FmuVariable(free, VariableKind.MARGIN, "1", about=ABOUT_MARGIN, of=margin, hidden=True))
    return ExchangeTerms(tuple(made), tuple(states))


def exchange_faults(system: System, inputs: Sequence[FmuVariable], version: str) -> Iterator[str]:
    """Why a driveline cannot be an FMU for model exchange."""
    found, speeds = wiring(system), set(system.prescribed_input.tolist())
    for number in system.transmission_element.tolist():
        yield f"'{found.elements[number].name}' has a ratio that varies, a constraint that a solver does not keep"
    for contact, place in zip(found.contacts, system.contact_place.tolist(), strict=True):
        if place >= 0:
            yield f"'{contact.name}' has impacts, after which a solver cannot decide whether it bounces or rests"
    if speeds:
        for number in system.load_contact.tolist():
            yield f"the friction of '{found.contacts[number].name}' depends on torques, beside a prescribed speed"
    for one in inputs:
        if version == "2.0" and speeds & set(one.inputs):
            yield f"'{one.name}' prescribes a speed, and FMI 2.0 has no rates of inputs there: take FMI 3.0"


def _numbers(system: System) -> Iterator[tuple[int, int, bool]]:
    """Numbers of the state of the core with their places in a row, and whether the motion depends on them."""
    found, number = wiring(system), count()
    names = [node.name for node in found.nodes]
    for name in system.independent:
        yield next(number), found.columns["speed"].start + names.index(name), True
    for part in ("state", *INTEGRALS):
        columns = found.columns[part]
        for place in range(columns.start, columns.stop):
            yield next(number), place, part == "state"


def _state(system: System, known: Channels, made: list[FmuVariable], place: int) -> int:
    """The value reference of the variable that is a number of the row; where there is none, of a new one."""
    for number, one in enumerate(made):
        if one.kind is VariableKind.SIGNAL and _place_of(one.form) == place:
            return number
    taken = {one.name for one in made}
    name = next((name for name, one in known.items() if _place_of(one.evaluate) == place), "")
    if name and name not in taken:
        unit = known[name].unit
    else:
        name, unit = numbers(wiring(system))[place][0], "1"
        name = next(one for one in _named(f"{name}_state") if one not in taken and one not in known)
    made.append(FmuVariable(name, VariableKind.SIGNAL, unit, form=RowEntry(place), hidden=True))
    return len(made) - 1


def _place_of(form: Form | None) -> int:
    """The place in the row of a signal that is a number of it; -1 where it is not."""
    if isinstance(form, RowEntry):
        return form.index
    alone = isinstance(form, Total) and len(form.indices) == 1 and not form.negative
    return int(form.indices[0]) if alone and isinstance(form, Total) else -1


def _named(name: str) -> Iterator[str]:
    """A name, and others where it is taken."""
    yield name
    yield from (f"{name}_{number}" for number in count(2))


def _margins(system: System) -> Iterator[str]:
    """Names of the event indicators in the order of the core."""
    found = wiring(system)
    branches = [branch.name for branch in (*found.elements, *found.contacts)]
    for name in (*branches, *(part.name for part in (*system.processes, *system.flows))):
        yield f"{name}.margin"
