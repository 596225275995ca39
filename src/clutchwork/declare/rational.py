"""Exact arithmetic for the kinematics: fractions of the decimal numbers that the user wrote."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction

# column -> value; what is not there is zero
Row = dict[int, Fraction]
ZERO = Fraction(0)
ONE = Fraction(1)
MINUS = Fraction(-1)
# beyond it not every whole number is a float
WHOLE = 2.0**53


def exact(value: float | Fraction) -> Fraction:
    """The decimal number as written: 2.78 becomes 278/100, not its binary neighbour."""
    if isinstance(value, Fraction):
        return value
    number = float(value)
    # most are whole, and those are read the fastest
    if -WHOLE < number < WHOLE and number.is_integer():
        return Fraction(int(number))
    return Fraction(*Decimal(repr(number)).as_integer_ratio())


def plus(row: Mapping[int, Fraction], factor: Fraction, other: Mapping[int, Fraction]) -> Row:
    """Sum of row + factor * other, without zeros."""
    made = dict(row)
    if factor:
        for column, value in other.items():
            term = product(factor, value)
            before = made.get(column)
            total = term if before is None else before + term
            if total:
                made[column] = total
            else:
                made.pop(column, None)
    return made


def product(one: Fraction, other: Fraction) -> Fraction:
    """Product of two fractions, of which most are plus or minus one."""
    if one is ONE:
        return other
    if other is ONE:
        return one
    return -other if one is MINUS else one * other


class Echelon:
    """Linear rows, each solved for one column: there its entry is 1, and 0 in all other rows.

    Columns are solved for in the order that is given; columns that are not in it never are.
    """

    def __init__(self, order: Iterable[int], *, traced: bool = True) -> None:
        """Start without rows; only where it is traced it knows the origin of each row."""
        self.solved: dict[int, Row] = {}
        self.origin: dict[int, Row] = {}  # of each solved row: the sum of added rows that it is
        self.spare: list[tuple[Row, Row]] = []  # sums of added rows without a column to solve for, and what they left
        self._rank = {column: place for place, column in enumerate(order)}
        self._holders: dict[int, set[int]] = {}  # columns whose rows hold a column, or did
        self._traced = traced
        self._added = 0

    def add(self, row: Mapping[int, Fraction]) -> None:
        """Add a row and solve it for the first column that is left in it."""
        rest, origin = self._replaced(row, {self._added: ONE} if self._traced else {})
        self._added += 1
        columns = [column for column in rest if column in self._rank]
        if not columns:
            self.spare.append((origin, rest))
            return
        column = min(columns, key=self._rank.__getitem__)
        scale = ONE if rest[column] is ONE else 1 / rest[column]
        rest, origin = plus({}, scale, rest), plus({}, scale, origin)
        rest[column] = ONE
        touched = [other for other in self._holders.pop(column, ()) if self.solved[other].get(column)]
        for other in touched:
            factor = self.solved[other][column]
            self.solved[other] = plus(self.solved[other], -factor, rest)
            self.origin[other] = plus(self.origin[other], -factor, origin) if self._traced else {}
        self.solved[column], self.origin[column] = rest, origin
        for held in rest.keys() - {column}:
            self._holders.setdefault(held, set()).update((column, *touched))

    def rest(self, row: Mapping[int, Fraction]) -> Row:
        """Remainder of a row after substituting all solved columns."""
        return self._replaced(row, {})[0]

    def _replaced(self, row: Mapping[int, Fraction], origin: Row) -> tuple[Row, Row]:
        rest = dict(row)
        for column, factor in row.items():
            if column in self.solved:
                rest = plus(rest, -factor, self.solved[column])
                origin = plus(origin, -factor, self.origin[column]) if self._traced else origin
        return rest, origin


def eliminate(rows: Iterable[Mapping[int, Fraction]], order: Iterable[int], *, traced: bool = True) -> Echelon:
    """Solve rows for the columns in the given order, as far as possible."""
    echelon = Echelon(order, traced=traced)
    for row in rows:
        echelon.add(row)
    return echelon


def smallest(rows: Sequence[Row], target: Row) -> list[int]:
    """A minimal set of rows whose combination is the target: drops every row that is not needed."""
    columns = sorted({column for row in (*rows, target) for column in row})
    keep = list(range(len(rows)))
    for number in list(keep):
        fewer = [other for other in keep if other != number]
        if not eliminate((rows[other] for other in fewer), columns, traced=False).rest(target):
            keep = fewer
    return keep
