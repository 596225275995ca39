"""Units at the border."""

from __future__ import annotations

import math

import pytest

from clutchwork.declare.quantity import QuantityError, factor_to_si, in_si
from clutchwork.declare.schema import Spec
from clutchwork.declare.units import parse, split
from clutchwork.files.lists import curve_in_si
from clutchwork.model.numbers import At


@pytest.mark.parametrize(
    ("value", "unit", "wanted"),
    [
        (3, "s", 3.0),
        (3.5, "s", 3.5),
        ("0.2 kg m2", "kg m2", 0.2),
        ("0.2 kg.m^2", "kg m2", 0.2),
        ("0.2 kg·m²", "kg m2", 0.2),
        ("2e3 kg cm2", "kg m2", 0.2),
        ("300 rpm", "rad/s", 10 * math.pi),
        ("5rev/s", "rad/s", 10 * math.pi),
        ("30 deg", "rad", math.pi / 6),
        ("-2 bar", "Pa", -2e5),
        ("+2.5 MPa", "Pa", 2.5e6),
        ("20 ms", "s", 0.02),
        ("2 kN m/deg", "N m/rad", 2000 * 180 / math.pi),
        ("2 Nm s/rad", "N m s/rad", 2.0),
        ("36 km/h", "m/s", 10.0),
        ("50 %", "1", 0.5),
        (".5 1/s", "1/s", 0.5),
        ({"value": 2, "unit": "bar"}, "Pa", 2e5),
        ({"value": 2}, "Pa", 2.0),
        ({"value": "2 bar"}, "Pa", 2e5),
    ],
    ids=str,
)
def test_becomes_si(value, unit, wanted):
    assert in_si(value, unit) == pytest.approx(wanted, rel=1e-14)


def test_si_values_keep_their_bits():
    assert in_si("0.1 kg m2", "kg m2") == 0.1
    assert in_si({"value": 0.3, "unit": "Pa"}, "Pa") == 0.3


@pytest.mark.parametrize("value", [True, None, [1.0]])
def test_what_is_no_text_and_no_table_is_left_to_the_checks(value):
    assert in_si(value, "s") is value


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        ("3 bar", "kg m2", "has a unit that does not fit; give it in [kg m2]"),
        ("3 Hz", "rad/s", "does not fit"),
        ("3 N m", "N m/rad", "does not fit"),
        ("3 baar", "Pa", "unknown unit 'baar'; did you mean 'bar'?"),
        ("3 kg m2 zz", "kg m2", "unknown unit 'zz'"),
        ("3", "Pa", "has no unit; remove the quotes or add one, such as"),
        ("three", "Pa", "is not a number"),
        ("nan s", "s", "is not a number"),
        ("__import__('os')", "s", "is not a number"),
        ({"value": 3, "units": "bar"}, "Pa", "must be a number"),
        ({"value": 3, "unit": 4}, "Pa", "must be a unit"),
    ],
    ids=str,
)
def test_what_does_not_fit_is_told(value, unit, words):
    with pytest.raises(QuantityError) as caught:
        in_si(value, unit)
    assert words in str(caught.value)
    assert str(value) in str(caught.value)


def test_further_units_are_offered():
    assert factor_to_si("kN", "N m", ("N",)) == 1000.0
    with pytest.raises(QuantityError, match=r"\[N m\] or \[N\]"):
        factor_to_si("bar", "N m", ("N",))


def test_whole_numbers_stay_whole():
    assert isinstance(in_si(30, "1", whole=True), int)


def test_curves():
    spec, at = Spec("curve", "N m", "", unit_x="rad/s"), At("", "torque", "N m")
    assert curve_in_si([[0, 1], [2, 3]], spec, at) == [[0, 1], [2, 3]]
    table = {"points": [[0, 1], [60, "2 N m"]], "unit_x": "rpm", "unit": "kN m"}
    assert curve_in_si(table, spec, at) == ((0.0, 1000.0), (pytest.approx(2 * math.pi), 2.0))
    with pytest.raises(QuantityError, match="does not fit"):
        curve_in_si({"points": [[0, 1]], "unit": "bar"}, spec, at)


def test_dimension():
    assert parse("N m s/rad").powers == parse("kg m2/s/rad").powers
    assert split("  7.5e-3 kg m2 ") == (7.5e-3, "kg m2")
    assert split("kg") is None
