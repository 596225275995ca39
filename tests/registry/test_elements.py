"""Every element: its mistakes are named, its model file reads back, its system runs."""

from __future__ import annotations

import math
from dataclasses import MISSING, replace

import pytest

import clutchwork as cw
from clutchwork.declare.schema import specs
from clutchwork.model.components import component_problems
from support import samples

ELEMENTS = samples.declared(*samples.ELEMENT_ROLES)
CASES = [(cls, item.name) for cls in ELEMENTS for item, _ in specs(cls, "param", "option", "signal", "alternative")]


def _name(value):
    return getattr(value, "__name__", str(value))


@pytest.mark.parametrize("cls", ELEMENTS, ids=_name)
def test_a_sample_has_no_mistake(cls):
    assert [str(problem) for problem in samples.driveline(cls).check()] == []


@pytest.mark.parametrize("cls", ELEMENTS, ids=_name)
def test_model_file_reads_back_to_the_same_system(cls, tmp_path):
    d = samples.driveline(cls)
    for name in ("model.toml", "model.json"):
        d.save(tmp_path / name)
        again = cw.Driveline.load(tmp_path / name)
        assert again.to_dict() == d.to_dict()
        assert again.assemble().to_bytes() == d.assemble().to_bytes()


@pytest.mark.parametrize("cls", ELEMENTS, ids=_name)
def test_runs_for_a_moment(cls):
    run = samples.driveline(cls).simulate(0.01)
    assert run.status == "done"


@pytest.mark.parametrize(("cls", "name"), CASES, ids=_name)
@pytest.mark.parametrize("wrong", [math.nan, math.inf, "3"], ids=str)
def test_what_is_no_finite_number_is_named(cls, name, wrong):
    element = replace(samples.driveline(cls).elements[0], **{name: wrong})
    found = [problem for problem in component_problems(element) if problem.quantity == name]
    assert found
    assert '"x"' in found[0].path
    assert f"cw.{cls.__name__}" in found[0].path


@pytest.mark.parametrize(("cls", "name"), CASES, ids=_name)
def test_bounds_are_kept(cls, name):
    spec = {item.name: spec for item, spec in specs(cls)}[name]
    for limit, wrong in (
        (spec.above, spec.above),
        (spec.at_least, (spec.at_least or 0.0) - 1e-9),
        (spec.below, spec.below),
    ):
        if limit is not None:
            element = replace(samples.driveline(cls).elements[0], **{name: wrong})
            found = [str(p) for p in component_problems(element) if p.quantity == name]
            assert found
            assert spec.bound in found[0]


@pytest.mark.parametrize("cls", ELEMENTS, ids=_name)
def test_missing_fields_are_all_named(cls):
    needed = [item.name for item, spec in specs(cls) if item.default is MISSING]
    data = {"shaft": [{"name": "a", "inertia": 1.0}], "element": [{"name": "x", "type": cls.kind}]}
    with pytest.raises(cw.ModelError) as caught:
        cw.Driveline.from_dict(data)
    assert set(needed) <= {problem.quantity for problem in caught.value.problems}
