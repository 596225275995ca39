"""Which numbers of a driveline are parameters of its FMU: those that the System follows along straight lines."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from math import isnan, nan
from numbers import Real

from clutchwork.assembly.provenance import SystemParameter
from clutchwork.assembly.system import System
from clutchwork.fmu.variables import FmuVariable, LeftOut, Place, VariableKind

BENDS = "it is fixed when the FMU is made: export one for each value"
NOTHING = "it acts on nothing in this driveline"


def parameters(system: System, taken: Collection[str]) -> Iterator[FmuVariable | LeftOut]:
    """All numbers of a System that are not signals, as parameters or with the reason why they cannot be some.

    Parameters: taken, names of results, which a value at the start must not have.
    """
    for name in system.parameters:
        found = system.parameters[name]
        if not isinstance(found.value, Real) or isinstance(found.value, bool) or found.inputs or isnan(found.value):
            continue
        called = f"{name}_start" if name in taken else name
        if not found.reach:
            yield LeftOut(called, NOTHING)
            continue
        slopes = found.slopes
        if slopes is None:
            yield LeftOut(called, BENDS)
            continue
        slope = [nan] * len(slopes) if found.is_word else slopes.tolist()
        words = tuple(map(Place, found.words.tolist(), slope))
        tunable = found.stays is None and found.is_word
        yield FmuVariable(
            called,
            VariableKind.TUNABLE if tunable else VariableKind.FIXED,
            found.unit,
            float(found.value),
            found.bounds,
            found.about,
            words=words,
            params=_pool(system, found) if tunable else (),
        )


def _pool(system: System, parameter: SystemParameter) -> tuple[Place, ...]:
    """Places in the pool of parameters, which may change during a run."""
    first = system.starts["params"] // 8
    return tuple(Place(word - first, nan) for word in parameter.words.tolist())
