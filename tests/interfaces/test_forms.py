"""Every form of a signal: its derivatives, its C and what a page evaluates are those of its value."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

import numpy as np
import pytest

from clutchwork.assembly.wiring import Wiring, wiring
from clutchwork.declare.layout import MODES
from clutchwork.results.channels import Channels
from clutchwork.results.forms import LOCKED, Form, Mode
from support import samples

STEP = 1e-6
CHOICE = re.compile(r"(.*) == (.*) \? (.*) : (.*)")


@cache
def found() -> dict[type[Form], tuple[Form, Wiring]]:
    """A form of each type as signals have it, the longest one, and what its row is made of."""
    made = dict[type[Form], tuple[Form, Wiring]]()
    for cls in samples.declared(*samples.ELEMENT_ROLES):
        wires = wiring(samples.driveline(cls).assemble())
        for channel in Channels(wires).values():
            form = channel.evaluate
            if type(form) not in made or len(form.reads()) > len(made[type(form)][0].reads()):
                made[type(form)] = form, wires
    return made


def modes(wires: Wiring) -> set[int]:
    """Places of the modes of contacts, by which nothing has a derivative."""
    return set(range(wires.row_size)[wires.columns["contact_mode"]])


def rows_of(wires: Wiring) -> Any:
    """Rows with every mode of a contact in them."""
    rows = np.random.default_rng(7).uniform(-2.0, 2.0, (len(MODES), wires.row_size))
    rows[:, sorted(modes(wires))] = np.array(sorted(MODES))[:, None]
    return rows


def evaluated(data: list[Any], row: Any) -> float:
    """What interfaces/page/src/forms.ts makes of the plain data of a form."""
    match data:
        case ["c", column]:
            return float(row[column])
        case ["a", column, scale, offset]:
            return float(offset + scale * row[column])
        case ["t", columns, negative]:
            return (-1.0 if negative else 1.0) * sum(float(row[column]) for column in columns)
        case ["l", columns, factors]:
            return sum(factor * float(row[column]) for column, factor in zip(columns, factors, strict=True))
        case ["s", rate, mode]:
            return 0.0 if row[mode] == LOCKED else evaluated(rate, row)
        case ["p", one, other]:
            return evaluated(one, row) * evaluated(other, row)
        case ["q", parts]:
            return sum(evaluated(part, row) for part in parts)
    raise AssertionError(f"no page knows {data}")


def test_every_form_is_that_of_a_signal():
    assert set(Form.__subclasses__()) == found().keys()


@pytest.mark.parametrize("cls", Form.__subclasses__(), ids=lambda cls: cls.__name__)
def test_every_form_says_the_same_everywhere(cls):
    form, wires = found()[cls]
    rows, size = rows_of(wires), wires.row_size
    values = np.asarray(form(rows)) if cls is not Mode else rows[:, form.index]
    # at other places of the row
    places = np.random.default_rng(8).permutation(size)
    moved = np.empty_like(rows)
    moved[:, places] = rows
    there = form.over({k: int(place) for k, place in enumerate(places)})
    assert there.reads() == {int(places[k]) for k in form.reads()}
    assert np.array_equal(there(moved), form(rows))
    # sums of a few numbers of size 1, in another order: some rounding errors
    assert [evaluated(form.data(), row) for row in rows] == pytest.approx(values, rel=1e-13, abs=1e-13)
    c = CHOICE.sub(r"\3 if \1 == \2 else \4", form.c([str(k) for k in range(size)]))
    assert [eval(c, {"row": row}) for row in rows] == pytest.approx(values, rel=1e-13, abs=1e-13)


@pytest.mark.parametrize("cls", [cls for cls in Form.__subclasses__() if cls is not Mode], ids=lambda cls: cls.__name__)
def test_derivatives_of_every_form_are_its_differences(cls):
    form, wires = found()[cls]
    rows, size = rows_of(wires), wires.row_size
    weights, slopes = form.weights(rows), np.zeros((len(rows), size))
    # a number may be read twice, as in a power
    np.add.at(slopes, (slice(None), weights.columns), weights.values)
    for column in form.reads() - modes(wires):
        step = np.zeros(size)
        step[column] = STEP
        expected = (form(rows + step) - form(rows - step)) / (2.0 * STEP)
        # products of two numbers have no third derivative: rounding of 1e-16 over the step remains
        assert slopes[:, column] == pytest.approx(expected, rel=1e-8, abs=1e-8), column
