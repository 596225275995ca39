"""A signal as a C expression of one output row."""

from __future__ import annotations

from clutchwork.codegen.text import literal
from clutchwork.results.forms import LOCKED, Affine, Dot, Form, Mode, Power, Powers, RowEntry, Slip, Total


def expression(form: Form, columns: list[str]) -> str:
    """The expression; `columns` holds the identifiers of all numbers of the row."""
    match form:
        case RowEntry(index) | Mode(index):
            return _number(columns[index])
        case Affine(index, scale, offset):
            return f"{literal(offset)} + {literal(scale)} * {_number(columns[index])}"
        case Total(indices, negative):
            total = " + ".join(_number(columns[index]) for index in indices)
            return f"-({total})" if negative else total
        case Dot(used, factors):
            terms = [f"{literal(f)} * {_number(columns[k])}" for k, f in zip(used, factors, strict=True)]
            return " + ".join(terms) or "0.0"
        case Slip(rate, mode):
            return f"{_number(columns[mode])} == {literal(LOCKED)} ? 0.0 : {expression(rate, columns)}"
        case Power(torque, rate):
            return f"({expression(torque, columns)}) * ({expression(rate, columns)})"
        case Powers(parts):
            return " + ".join(expression(part, columns) for part in parts)


def _number(column: str) -> str:
    return f"row[{column}]"
