"""Forms of signals as the library of FMUs evaluates them: sums of terms with their numbers one after another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from clutchwork.results.forms import Form


class RowSum(NamedTuple):
    """offset + sum of share times number of the row; offset None: there is none."""

    offset: float | None
    shares: tuple[tuple[int, float], ...]


class FormTerm(NamedTuple):
    """A combination, or the product with another one; gate, place of the mode that makes it zero while locked."""

    one: RowSum
    other: RowSum | None
    gate: int


class NumberOfForm(NamedTuple):
    """Where a number of a form stands: its term, the first or second combination there, its share, -1: its offset."""

    term: int
    side: int
    share: int
    place: int  # in the row


def terms(form: Form) -> list[FormTerm]:
    """The terms of a form."""
    return list(_terms(form.data()))


def numbers_of(form: Form) -> dict[NumberOfForm, float]:
    """All numbers of a form by where they stand; forms that differ in numbers alone have the same keys."""
    found = dict[NumberOfForm, float]()
    for k, term in enumerate(terms(form)):
        for side, part in enumerate((term.one, term.other)):
            if part is None:
                continue
            if part.offset is not None:
                found[NumberOfForm(k, side, -1, term.gate)] = part.offset
            found |= {NumberOfForm(k, side, i, place): share for i, (place, share) in enumerate(part.shares)}
    return found


def _terms(data: Sequence[Any]) -> Iterator[FormTerm]:
    """Terms of a form from what `Form.data` says."""
    kind, *rest = data
    if kind == "q":
        for part in rest[0]:
            yield from _terms(part)
    elif kind == "p":
        one, other = (next(_terms(part)) for part in rest)
        yield FormTerm(one.one, other.one, other.gate)
    elif kind == "s":
        yield from (one._replace(gate=rest[1]) for one in _terms(rest[0]))
    else:
        yield FormTerm(_combination(kind, rest), None, -1)


def _combination(kind: str, rest: Sequence[Any]) -> RowSum:
    """Offset and shares of numbers of the row."""
    if kind == "c":
        return RowSum(None, ((rest[0], 1.0),))
    if kind == "a":
        place, scale, offset = rest
        return RowSum(offset, ((place, scale),))
    if kind == "t":
        return RowSum(None, tuple((place, -1.0 if rest[1] else 1.0) for place in rest[0]))
    return RowSum(None, tuple(zip(*rest, strict=True)))
