"""Which numbers of an output row signals need, and the same forms over those alone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from clutchwork.results.forms import Affine, Dot, Form, Mode, Power, Powers, RowEntry, Slip, Total


def needed(form: Form) -> set[int]:
    """Places of the row that a form reads."""
    match form:
        case RowEntry(index) | Mode(index) | Affine(index):
            return {index}
        case Total(indices):
            return set(indices)
        case Dot(used):
            return {int(place) for place in used}
        case Slip(rate, mode):
            return needed(rate) | {mode}
        case Power(torque, rate):
            return needed(torque) | needed(rate)
        case Powers(parts):
            return set[int]().union(*map(needed, parts))


def moved(form: Form, places: Mapping[int, int]) -> Any:
    """The form over rows that hold what stood at a place at another one."""
    match form:
        case RowEntry(index) | Mode(index) | Affine(index):
            return replace(form, index=places[index])
        case Total(indices):
            return replace(form, indices=tuple(places[index] for index in indices))
        case Dot(used):
            return replace(form, used=np.array([places[int(place)] for place in used], dtype=np.intp))
        case Slip(rate, mode):
            return Slip(moved(rate, places), places[mode])
        case Power(torque, rate):
            return Power(moved(torque, places), moved(rate, places))
        case Powers(parts):
            return Powers(tuple(moved(part, places) for part in parts))


def all_needed(forms: Iterable[Form]) -> list[int]:
    """Places that any of the forms reads, in order."""
    return sorted(set[int]().union(*map(needed, forms)))


def fixed(signal: str, form: Form) -> bool:
    """Whether the form of a signal is the same for all drivelines of one structure.

    Ratios, inertias, stiffnesses and capacities are part of the others.
    """
    match form:
        case Affine():
            return False
        case Dot(_, factors):
            # that of a way may have a radius in it
            return signal.endswith(".rate") and bool(np.all(np.abs(factors) == 1.0))
        case Power(torque, rate):
            return isinstance(torque, Total) and fixed(".rate", rate)
        case Powers(parts):
            return all(fixed(signal, part) for part in parts)
        case Slip(rate):
            return fixed(".rate", rate)
        case _:
            return True
