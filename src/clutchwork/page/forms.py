"""Forms of signals as lists, which the script of a page evaluates on rows as `results.forms` does."""

from __future__ import annotations

from typing import Any

from clutchwork.results.forms import Affine, Dot, Form, Mode, Power, Powers, RowEntry, Slip, Total


def plain(form: Form) -> list[Any]:
    """A form as a list: a letter, then its numbers and inner forms."""
    match form:
        case RowEntry(index):
            return ["c", int(index)]
        case Affine(index, scale, offset):
            return ["a", int(index), float(scale), float(offset)]
        case Total(indices, negative):
            return ["t", [int(index) for index in indices], negative]
        case Dot(used, factors):
            return ["l", [int(index) for index in used], [float(factor) for factor in factors]]
        case Slip(rate, mode):
            return ["s", plain(rate), int(mode)]
        case Power(torque, rate):
            return ["p", plain(torque), plain(rate)]
        case Powers(parts):
            return ["q", [plain(part) for part in parts]]
        case Mode(index):
            return ["c", int(index)]
