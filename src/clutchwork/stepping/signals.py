"""The signals of a System that can be set from outside, by name, and what each of them may be."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from clutchwork.assembly.provenance import parameter
from clutchwork.assembly.wiring import wiring
from clutchwork.base.errors import Problem, near
from clutchwork.base.memoize import memoize
from clutchwork.base.quote import quote
from clutchwork.declare.node import Component, is_reference
from clutchwork.declare.quantity import QuantityError, has_unit, in_si
from clutchwork.declare.schema import Spec, specs
from clutchwork.declare.wording import path_of
from clutchwork.model.changes import named, of_owner, own_names, owner_of
from clutchwork.model.fields import number_problems
from clutchwork.model.numbers import At
from clutchwork.results.channels import channels

if TYPE_CHECKING:
    from clutchwork.assembly.system import System


class Settable(NamedTuple):
    """One signal: its numbers in the core, its unit, its bounds, and where it is."""

    numbers: tuple[int, ...]  # several where a composite gives it to parts of it
    unit: str
    spec: Spec
    path: str
    quantity: str

    def read(self, value: Any) -> tuple[float, list[Problem]]:
        """A number in SI, and what is wrong with it."""
        at = At(self.path, self.quantity, self.unit)
        try:
            given = in_si(value, self.unit, self.spec.units) if has_unit(value) else value
        except QuantityError as bad:
            return 0.0, [at.problem(bad.message, bad.value, bad.remedy)]
        found = list(number_problems(given, self.spec, at))
        return (0.0 if found else float(given)), found

    def told(self, value: float) -> tuple[tuple[int, float], ...]:
        """The value for each of its inputs in the core."""
        return tuple([(number, value) for number in self.numbers])


def signals(system: System) -> dict[str, Settable]:
    """All signals of a System, under the names of results and those of composites whose parts have them."""
    return {**settable(system), **composed(system)}


@memoize
def settable(system: System) -> dict[str, Settable]:
    """All signals of a System, found once."""
    made = {}
    for number, item in enumerate(system.inputs):
        owner = item.owner
        path = path_of(owner) if isinstance(owner, Component) else f'cw.ThermalNode("{owner.name}")'
        made[item.name] = Settable((number,), item.unit, item.spec, path, item.quantity)
    return made


@memoize
def composed(system: System) -> dict[str, Settable]:
    """Signals of composites that have other names in their parts, such as the command of a synchroniser."""
    made = {}
    for element in system.source.elements if system.source else ():
        composite = type(element).parts is not Component.parts
        for item, spec in specs(type(element), "signal", "alternative") if composite else ():
            name, value = f"{element.name}.{item.name}", getattr(element, item.name)
            if name not in settable(system) and value is not None and not is_reference(value):
                numbers = parameter(system, name).inputs
                if numbers:
                    made[name] = Settable(numbers, system.inputs[numbers[0]].unit, spec, path_of(element), item.name)
    return made


def given_by_others(system: System, name: str) -> Problem | None:
    """Why a signal that another component gives cannot be set; None where it is another name."""
    for motion in system.motions:
        speed = f"{motion.name}.speed"
        if name != speed and name in [f"{motion.name}.{item.name}" for item, _ in specs(type(motion), "signal")]:
            return Problem(name, "", f"acts by the speed that follows from it, {speed!r}", remedy=f"set {speed!r}")
    linked = next((link for link in system.links if link.name == name), None)
    if linked is None:
        return None
    if linked.sort == "input":
        source = system.inputs[linked.number].name
        return Problem(name, "", f"is given by {source!r}", remedy=f"set {source!r}")
    owner = _owner(system, linked.number)
    commands = [other for other in settable(system) if other.startswith(f"{owner}.")]
    remedy = f"set {commands[0]!r}" if commands else "leave it to that, or give the model a signal there"
    return Problem(name, "", f"is given by {owner!r}", remedy=remedy)


def _owner(system: System, shared: int) -> str:
    """Name of the thermal node or process that has a shared state."""
    owners = [node.name for node in system.thermal]
    owners += [process.name for process in system.processes for _ in type(process).states]
    return owners[shared]


def unknown(system: System, name: object) -> Problem:
    """Explains why a name cannot be set."""
    path = name if isinstance(name, str) else quote(name)
    given = [signal for signal in signals(system) if signal not in wiring(system).unused]
    plain = path.removesuffix("_signal")
    if plain != path and plain in given:
        return Problem(path, "", f"is what results call the signal {plain!r}", remedy=f"set {plain!r}")
    is_result = path in channels(system, True, True)
    message = f"is {'a result, which follows from the motion, and no' if is_result else 'neither a signal nor a'}"
    message += " signal or parameter of this driveline" if is_result else " parameter of this driveline"
    owners = named(system.source) if system.source else {}
    owner = owner_of({*owners, *(signal.rpartition(".")[0] for signal in given)}, path)
    if owner:
        thing = owners.get(owner)
        own = [signal[len(owner) + 1 :] for signal in given if signal.startswith(f"{owner}.")]
        own += [word for word in (own_names(thing) if isinstance(thing, Component) else ()) if word not in own]
        return Problem(path, "", f"{message}{of_owner(path, owner, own, exact=is_result)}")
    such = f"signals are such as {', '.join(map(repr, given[:3]))}" if given else ""
    if is_result:
        return Problem(path, "", message, remedy=such)
    return Problem(path, "", f"{message}{near(path, [*given, *system.places], such)}")
