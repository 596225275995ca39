"""Exact elimination."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from clutchwork.declare.rational import eliminate, exact, plus, smallest

NUMBERS = st.integers(-3, 3).map(Fraction)
ROWS = st.lists(st.lists(NUMBERS, min_size=5, max_size=5), min_size=1, max_size=6)


def _row(values):
    return {column: value for column, value in enumerate(values) if value}


def _sum(rows, origin):
    total = {}
    for number, factor in origin.items():
        total = plus(total, factor, rows[number])
    return total


def test_decimals_are_taken_as_written():
    assert exact(2.78) == Fraction(278, 100)
    assert exact(1e-5) == Fraction(1, 100_000)
    assert exact(7) == 7


@given(ROWS)
def test_solved_rows_are_sums_of_the_given_ones_with_one_pivot_each(values):
    rows = [_row(row) for row in values]
    echelon = eliminate(rows, range(5))
    for column, row in echelon.solved.items():
        assert row[column] == 1
        assert not row.keys() & (echelon.solved.keys() - {column})
        assert _sum(rows, echelon.origin[column]) == row
    for origin, left in echelon.spare:
        assert origin
        assert left == {}
        assert _sum(rows, origin) == {}
    assert all(echelon.rest(row) == {} for row in rows)


@given(ROWS, st.permutations(range(5)))
def test_columns_are_solved_for_in_order(values, order):
    """Each column is solved for if it can be after the ones before it, in whatever order the rows come."""
    rows = [_row(row) for row in values]
    solved = set(eliminate(rows, order).solved)
    assert solved == set(eliminate(rows[::-1], order).solved)
    # the first column in order that stands in any row is solved for
    first = next((column for column in order if any(column in row for row in rows)), None)
    assert first is None or first in solved


@given(ROWS)
def test_smallest_set_gives_the_target_and_needs_every_row(values):
    rows = [_row(row) for row in values]
    target = _sum(rows, dict.fromkeys(range(len(rows)), Fraction(1)))
    chosen = smallest(rows, target)
    assert not eliminate([rows[n] for n in chosen], range(5)).rest(target)
    for left_out in chosen:
        assert eliminate([rows[n] for n in chosen if n != left_out], range(5)).rest(target)
