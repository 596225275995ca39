"""Which numbers of a driveline are parameters of its FMU: those that the System follows along straight lines."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from itertools import combinations
from math import isnan, nan
from numbers import Real

from clutchwork.assembly.provenance import JointChanges, SystemParameter
from clutchwork.assembly.system import System
from clutchwork.fmu.variables import FmuVariable, LeftOut, Place, VariableKind

# arrays that no output is computed from
OF_STARTS = {"initial_speed", "initial_angle", "initial_state", "contact_tolerance"}
BENDS = "it is fixed when the FMU is made: export one for each value"
WHOLE = "it is a whole number, which is fixed when the FMU is made"
NOTHING = "it has no effect in this driveline"
EMPTY = "it has no value in this driveline"


def parameters(system: System, taken: Collection[str]) -> Iterator[FmuVariable | LeftOut]:
    """All numbers of a System that are not signals, as parameters or with the reason why they cannot be some.

    Parameters: taken, names of results, which a value at the start must not have.
    """
    known = {name: found for name in system.parameters if _is_number(found := system.parameters[name])}
    reasons = {name: why for name, found in known.items() if (why := _reason(found))}
    free = {name: found for name, found in known.items() if name not in reasons}
    reasons |= _acting_together(system, free)
    shared = _shared_words([found for name, found in free.items() if name not in reasons])
    for name, found in known.items():
        called = f"{name}_start" if name in taken else name
        yield LeftOut(called, reasons[name]) if name in reasons else _parameter(system, called, found, shared)


def _is_number(found: SystemParameter) -> bool:
    """Whether it is a number, or the place of one; signals are inputs."""
    is_real = isinstance(found.value, Real) and not isinstance(found.value, bool)
    return not found.inputs and (is_real or (found.value is None and found.is_plain))


def _reason(found: SystemParameter) -> str:
    """Why a number cannot be a parameter; empty where it can."""
    if found.value is None or isnan(found.value):
        return EMPTY
    if not found.reach:
        return NOTHING
    if found.is_whole:
        return WHOLE
    return "" if found.slopes is not None else BENDS


def _acting_together(system: System, free: Mapping[str, SystemParameter]) -> dict[str, str]:
    """Numbers that do not add up with others that come before them, such as a stiffness and a twist at the start."""
    together = JointChanges(system, free)
    if together.add_up(list(free)):
        return {}
    reasons = dict[str, str]()
    for one, other in combinations(free, 2):
        if one not in reasons and other not in reasons and not together.add_up([one, other]):
            reasons[other] = f"it acts together with {one}: export an FMU for each value"
    return reasons


def _shared_words(found: Collection[SystemParameter]) -> set[int]:
    """Words that several numbers reach."""
    once, several = set[int](), set[int]()
    for parameter in found:
        words = set(parameter.words.tolist())
        several |= words & once
        once |= words
    return several


def _parameter(system: System, called: str, found: SystemParameter, shared: set[int]) -> FmuVariable:
    slopes: list[float] = [] if found.slopes is None else found.slopes.tolist()
    # a word of its own is the value itself, to the bit
    alone = found.is_word and not shared & set(found.words.tolist())
    words = tuple(map(Place, found.words.tolist(), [nan] * len(slopes) if alone else slopes))
    tunable = found.stays is None and alone
    kind = VariableKind.TUNABLE if tunable else VariableKind.FIXED
    pool = _pool(system, found) if tunable else ()
    value = float(found.value)
    moves = not found.reach.keys() <= OF_STARTS
    about, path, far = found.about, found.name, tuple(found.far)
    return FmuVariable(called, kind, found.unit, value, found.bounds, about, path, far, moves, words=words, params=pool)


def _pool(system: System, parameter: SystemParameter) -> tuple[Place, ...]:
    """Places in the pool of parameters, which may change during a run."""
    first = system.starts["params"] // 8
    return tuple(Place(word - first, nan) for word in parameter.words.tolist())
