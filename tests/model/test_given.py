"""Values from the command line: each is read as in a model file, and any text is a value or a list of mistakes."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role
from clutchwork.files.given import given_values
from clutchwork.files.writer import Writer, toml_value
from clutchwork.model.changes import all_names, targets_of
from clutchwork.model.model import Model
from support import samples


def model_of(d: cw.Driveline) -> Model:
    """The model of a driveline, as its System keeps it."""
    source = d.assemble().source
    assert source is not None
    return source


def with_law(cls: Any) -> cw.Driveline:
    """A clutch with a friction law."""
    d = cw.Driveline(cls.__name__)
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=2.0)
    heat = d.thermal("plates", capacity=800.0)
    d.add(cw.Clutch("x", base=a, follower=b, friction=samples.law(cls), gain=1.0, pressure=10.0, heat=heat))
    return d


def texts(model: Model) -> dict[str, str]:
    """All that may be changed and has a value which a text can say, as a model file writes it."""
    targets, _ = targets_of(model, all_names(model))
    values = {name: reduce(getattr, aim.path, aim.owner) for name, aim in targets.items()}
    plain = {name: value for name, value in values.items() if isinstance(value, int | float | str | tuple | list)}
    return {name: toml_value(value) for name, value in plain.items() if not _refers(value)}


def _refers(value: Any) -> bool:
    return isinstance(value, tuple) and any(hasattr(part, "name") for part in value)


DRIVELINES = {cls.__name__: lambda cls=cls: samples.driveline(cls) for cls in samples.declared(*samples.ELEMENT_ROLES)}
DRIVELINES |= {cls.__name__: lambda cls=cls: with_law(cls) for cls in REGISTRY[Role.LAW].values()}


@pytest.mark.filterwarnings("ignore::clutchwork.ModelWarning")
@pytest.mark.parametrize("name", DRIVELINES)
def test_the_values_that_are_there_change_nothing(name: str) -> None:
    d = DRIVELINES[name]()
    system, model = d.assemble(), model_of(d)
    found = texts(model)
    assert found
    values = given_values(model, [f"{key}={text}" for key, text in found.items()])
    assert set(values) == set(found)
    same = system.changed(values)
    for key, array in system.arrays.items():
        np.testing.assert_array_equal(same.arrays[key], array)


@pytest.mark.filterwarnings("ignore::clutchwork.ModelWarning")
@pytest.mark.parametrize("cls", REGISTRY[Role.LAW].values(), ids=lambda cls: cls.__name__)
def test_a_law_and_a_signal_may_be_given_whole(cls: Any) -> None:
    model = model_of(with_law(cw.Coulomb))
    clutch: Any = with_law(cls).elements[0]
    data = Writer(None, embed=True).element(clutch)["friction"]
    made = given_values(model, [f"x.friction={toml_value(data)}", 'x.pressure={type="step", height="2 bar"}'])
    assert made["x.pressure"] == cw.Step(height=2e5)
    assert type(made["x.friction"]) is type(clutch.friction)
    assert Writer(None, embed=True).element(replace(clutch, friction=made["x.friction"]))["friction"] == data


MODEL = model_of(with_law(cw.Coulomb))
NAMES = st.sampled_from([*all_names(MODEL), "x", "y.z", ""]) | st.text(max_size=8)
ODD = """1 1e999 nan inf -0.0 [] {} [1,2] [[1]] {type=3} {type='table'} ' " true 1979-05-27 {type='coulomb'} {of='x'}"""
VALUES = st.text(max_size=30) | st.sampled_from([*ODD.split(), "1 bar", "1\nx=2", "{value=1, unit=3}"])


@pytest.mark.filterwarnings("ignore::clutchwork.ModelWarning")
@given(st.lists(st.tuples(NAMES, VALUES), min_size=1, max_size=4))
def test_any_text_is_a_value_or_a_list_of_mistakes(pairs: list[tuple[str, str]]) -> None:
    try:
        MADE.changed(given_values(MODEL, [f"{name}={value}" for name, value in pairs]))
    except cw.ModelError as error:
        problems = error.problems
    else:
        problems = ()
    assert all(str(problem).isprintable() for problem in problems)


MADE = with_law(cw.Coulomb).assemble()
