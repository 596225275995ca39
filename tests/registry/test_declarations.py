"""Every declaration: named after its file, documented, with units that can be read."""

from __future__ import annotations

import inspect
import sys
from dataclasses import MISSING, FrozenInstanceError
from pathlib import Path

import pytest

import clutchwork as cw
from clutchwork.declare import units
from clutchwork.declare.schema import COMPILED_ROLES, REGISTRY, Role, kinds, schema_hash, schema_text, specs
from support import samples

ALL = samples.declared(*Role)
WITHOUT_UNIT = {"port", "thermal", "text", "function", "elements", "data"}


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_kind_is_the_stem_of_the_file_and_the_class_in_lower_case(cls):
    assert cls.kind == Path(sys.modules[cls.__module__].__file__).stem
    assert cls.kind.replace("_", "") == cls.__name__.lower()


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_is_published_under_its_name(cls):
    assert getattr(cw, cls.__name__) is cls
    assert cls.__name__ in cw.__all__


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_class_and_fields_say_what_they_are(cls):
    assert len(cls.__doc__) > 30
    assert not cls.__doc__.startswith(f"{cls.__name__}(")
    for item, spec in specs(cls):
        assert spec.doc, item.name
        assert spec.doc[0].islower(), f"{item.name}: {spec.doc}"


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_methods_say_what_they_do_or_are_said_by_their_base(cls):
    found = [name for name, item in inspect.getmembers(cls) if callable(item) or isinstance(item, property)]
    assert [name for name in found if name[0] != "_" and not inspect.getdoc(getattr(cls, name))] == []


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_units_can_be_read_and_are_si(cls):
    for item, spec in specs(cls):
        words = [unit for unit in (spec.unit, *spec.units, spec.unit_x, *spec.units_x, *spec.gain) if unit]
        assert words or spec.what in WITHOUT_UNIT | {"law"}, item.name
        for unit in words:
            assert unit == "*" or units.parse(unit).factor == 1.0, f"{item.name} [{unit}]"


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_defaults_keep_their_bounds(cls):
    for item, spec in specs(cls, "param", "option"):
        if item.default not in (MISSING, None):
            assert spec.allows(item.default), item.name


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_choices_are_different_words_and_hold_their_default(cls):
    for item, spec in specs(cls):
        if spec.choices:
            assert len(set(spec.choices)) == len(spec.choices) > 1, item.name
            assert item.default is MISSING or item.default in (*spec.choices, *[None] * spec.optional), item.name


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_states_have_names_of_their_own_and_units(cls):
    states = getattr(cls, "states", ())
    assert len({state.name for state in states}) == len(states)
    for state in states:
        assert state.doc
        assert units.parse(state.unit).factor == 1.0


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_is_frozen(cls):
    path = () if cls.role in (Role.LAW, Role.SIGNAL) else ("x",)
    thing = cls(*path, **samples.fields(cls, samples.nodes()))
    name = next(iter(vars(thing)))
    with pytest.raises(FrozenInstanceError):
        setattr(thing, name, 1.0)


@pytest.mark.parametrize("cls", samples.declared(*COMPILED_ROLES), ids=lambda cls: cls.__name__)
def test_has_a_header_of_the_same_stem(cls, root):
    folder = "laws" if cls.role is Role.LAW else "elements"
    assert (root / "cpp/include/clutchwork" / folder / f"{cls.kind}.hpp").is_file()


def test_numbers_of_kinds_are_their_places_in_the_alphabet():
    assert kinds(Role.LAW) == sorted(REGISTRY[Role.LAW])


def test_hash_follows_the_declarations():
    assert "contact clutch gain:param[m3],pressure:signal[Pa] 0" in schema_text()
    assert "law coulomb static:param[1],kinetic:param[1] 0 sticks" in schema_text()
    assert "law dahl kinetic:param[1],stiffness:param[1/rad],exponent:param[1] 1 compliant" in schema_text()
    assert "reset:param[1]{saturate|clip|literal}" in schema_text()
    assert schema_hash() == schema_hash("")
    assert schema_hash("another layout") != schema_hash()
    assert 0 <= schema_hash() < 2**63
