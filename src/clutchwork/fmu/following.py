"""Outputs that follow from parameters themselves, not from the run alone: an FMU has either of both."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from clutchwork.assembly.system import System
from clutchwork.base.errors import ModelError
from clutchwork.declare.options import Options
from clutchwork.fmu.variables import FmuVariable, VariableKind
from clutchwork.results.channels import channels
from clutchwork.results.forms import Form


def following(
    system: System, options: Options, numbers: Iterable[FmuVariable], outputs: Sequence[str]
) -> dict[str, str]:
    """By the name of a number that is fixed during a run: an output that is computed from it too, where there is one.

    The torque of a gear, for example, follows from accelerations by the inertias behind it.
    """
    base = _forms(system, options, outputs)
    dependent = [name for name in outputs if not base[name].is_of_structure()]
    found = dict[str, str]()
    for one in numbers if dependent else ():
        if one.kind is not VariableKind.FIXED or not one.reaches_forms:
            continue
        others = (_changed(system, one.path, value) for value in one.far)
        other = next((made for made in others if made is not None), None)
        forms = base if other is None else _forms(other, options, dependent)
        name = next((name for name in dependent if forms[name].data() != base[name].data()), None)
        if name is not None:
            found[one.name] = name
    return found


def _changed(system: System, name: str, value: float) -> System | None:
    """The System with another value; None where that is refused."""
    try:
        return system.changed({name: value})
    except ModelError:
        return None


def _forms(system: System, options: Options, names: Iterable[str]) -> Mapping[str, Form]:
    known = channels(system, options.angles, options.work)
    return {name: known[name].evaluate for name in names}
