"""Damaged files and wrong types: the package's own errors only; files each within 2 s and 500 MB."""

from __future__ import annotations

import os
import subprocess
import sys
import warnings
from functools import cache
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.base.errors import Problem
from clutchwork.declare.schema import Role, specs
from clutchwork.run.begin import new_run
from support import samples
from support.amount import amount
from support.fuzz.cases import CASES

# a process that hangs where no signal is heard
LONGEST = 2.0


@pytest.mark.random
@pytest.mark.parametrize("kind", CASES)
def test_damaged_files_are_refused_in_words(kind, root):
    count = amount()
    command = [sys.executable, "-m", "support.fuzz.worker", kind, "0", str(count)]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        cwd=root,
        env={**os.environ, "PYTHONPATH": str(root / "tests")},
        timeout=120.0 + LONGEST * count,
    )
    assert done.stdout + done.stderr == ""
    assert done.returncode == 0


# what stands in a file where another type is meant
ODD: tuple[Any, ...] = (
    "?", "", "3 apples", [], {}, [None], ["?"], [{}], [[[1.0]]], [[1.0, "?"]], [[1.0], 2.0], {"a": 1}, {"of": 3},
    {"type": "?"}, {"type": 3}, {"type": "table", "points": 3}, {"points": 3}, {"values": [1.0, [2.0]]}, {"unit": 3},
)  # fmt: skip
PLAIN: tuple[Any, ...] = (None, True, False, 3, -2, 2.5, 0.0, 1e308, [1.0], [[1.0, 2.0, 3.0]], [[1.0, 2.0], [3.0, 4.0]])
# what takes whatever it is given, or is told of by what it names
ANY = ("text", "function", "data", "elements")


def model(cls: Any, name: str, value: Any) -> dict[str, Any]:
    """A model with one of a declared class, and a value in one of its fields."""
    if cls in samples.declared(Role.LAW):
        given = {"type": cls.kind, **samples.fields(cls, {}), name: value}
        return disc({"type": "brake", "gain": 1.0, "normal_force": 1.0, "friction": given})
    if cls in samples.declared(Role.SIGNAL):
        return disc({"type": "torque", "torque": {"type": cls.kind, **samples.fields(cls, {}), name: value}})
    data = sample(cls)
    return data | {"element": [one | {name: value} if one["name"] == "x" else one for one in data["element"]]}


@cache
def sample(cls: Any) -> dict[str, Any]:
    """A model with one of an element, named "x"."""
    return samples.driveline(cls).to_dict()


def disc(element: dict[str, Any]) -> dict[str, Any]:
    return {"name": "m", "shaft": [{"name": "a", "inertia": 1.0}], "element": [{"name": "x", "shaft": "a", **element}]}


def mistakes(data: dict[str, Any]) -> list[Problem]:
    """What is said of a model; nothing where it can be run."""
    try:
        new_run(cw.Driveline.from_dict(data).assemble().to_bytes())
    except cw.ModelError as error:
        return list(error.problems)
    return []


@pytest.mark.parametrize("cls", samples.declared(*Role), ids=lambda cls: cls.kind)
def test_each_wrong_type_in_each_field_is_named(cls):
    if any(spec.what == "function" for _, spec in specs(cls)):
        pytest.skip("no file holds it")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        for item, spec in specs(cls):
            for value in ODD:
                found = mistakes(model(cls, item.name, value))
                named = [one for one in found if '"x' in one.path and item.name in one.quantity]
                assert named or spec.what in ANY or not found, (item.name, value, found)
                assert found or spec.what in ANY or spec.optional, (item.name, value)
            for value in PLAIN:
                assert all(one.path and str(one) for one in mistakes(model(cls, item.name, value)))
