"""Units at the border."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from clutchwork.declare import units
from clutchwork.declare.quantity import QuantityError, factor_to_si, in_si, unit_table
from clutchwork.declare.schema import REGISTRY, Role, Spec, specs
from clutchwork.declare.unit_table import example_of
from clutchwork.declare.unit_words import QUANTITIES
from clutchwork.declare.units import known, parse, split
from clutchwork.files.lists import curve_in_si
from clutchwork.model.numbers import At

ROOT = Path(__file__).resolve().parents[2]


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
        ("300 1/min", "rad/s", 10 * math.pi),
        ("300 min-1", "rad/s", 10 * math.pi),
        ("300 min⁻¹", "rad/s", 10 * math.pi),
        ("300 U/min", "rad/s", 10 * math.pi),
        ("300 RPM", "rad/s", 10 * math.pi),
        ("300 1/min", "1/s", 5.0),
        ("360 deg/s", "rad/s", 2 * math.pi),
        ("360 °/s", "rad/s", 2 * math.pi),
        ("1 rev", "rad", 2 * math.pi),
        ("250 mbar", "Pa", 2.5e4),
        ("2 Bar", "Pa", 2e5),
        ("2 kPa", "Pa", 2e3),
        # 1 lbf over a square inch
        ("10 psi", "Pa", 10 * 0.45359237 * 9.80665 / 0.0254**2),
        ("10 lbf/in2", "Pa", 10 * 0.45359237 * 9.80665 / 0.0254**2),
        ("2 mNm", "N m", 2e-3),
        ("2 kNm", "N m", 2e3),
        ("100 lbf ft", "N m", 100 * 0.45359237 * 9.80665 * 0.3048),
        ("100 lb ft", "N m", 100 * 0.45359237 * 9.80665 * 0.3048),
        ("100 lb", "kg", 45.359237),
        ("100 lbf", "N", 45.359237 * 9.80665),
        ("2 t", "kg", 2000.0),
        ("2 in", "m", 0.0508),
        ("5 µm", "m", 5e-6),
        ("5 um", "m", 5e-6),
        ("60 mph", "m/s", 60 * 1609.344 / 3600),
        ("2 g cm2", "kg m2", 2e-7),
        ("2 kg·m²", "kg m2", 2.0),
        ("2 kg*m**2", "kg m2", 2.0),
        ("1 h", "s", 3600.0),
        ("2 kWh", "J", 7.2e6),
        ("2 hp", "W", 2 * 550 * 0.45359237 * 9.80665 * 0.3048),
        ("2 PS", "W", 2 * 75 * 9.80665),
        ("20 L/min", "m3/s", 20e-3 / 60),
        ("2 N m/deg", "N m/rad", 360 / math.pi),
        ("2 Nm/rpm", "N m s/rad", 60 / math.pi),
        ("0.5 kJ/(kg K)", "J/(kg K)", 500.0),
        ("5 W/(m2 K)", "W/(m2 K)", 5.0),
        ("0.5 -", "1", 0.5),
        ("90 degC", "K", 363.15),
        ("90°C", "K", 363.15),
        ("212 °F", "K", 373.15),
        ("−5 C", "K", 268.15),
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
        ("3 kg m", "N m", "does not fit"),
        ("3 MNm", "N m", "unknown unit 'MNm'; did you mean"),
        ("3 mpa", "Pa", "unknown unit 'mpa'"),
        ("3 kgm2", "kg m2", "unknown unit 'kgm2'; did you mean 'kg m2'?"),
        ("3 kPaa", "Pa", "unknown unit 'kPaa'; did you mean 'kPa'?"),
        ("2,5 bar", "Pa", "is not a number; write a decimal point: '2.5 bar'"),
        (
            "3 W/degC",
            "W/K",
            "is in degC, which has another zero; give it in [W/K]; per kelvin, a degree Celsius is 1 K",
        ),
        ("3 degC", "Pa", "is in degC, which has another zero; give it in [Pa]"),
        ("3 bar", "K", "does not fit; give it in [K], such as '363 K'"),
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


@pytest.mark.parametrize(
    ("text", "unit", "wanted"), [("35 mm", "m", 0.035), ("7 cm3", "m3", 7e-6), ("3 ms", "s", 3e-3)]
)
def test_decimal_parts_are_those_that_are_written(text, unit, wanted):
    assert in_si(text, unit) == wanted


def test_the_table_lists_what_is_understood():
    rows = unit_table()
    for row in rows:
        assert in_si(f"2 {row.name}", row.si) == pytest.approx(2 * row.factor + row.offset, rel=1e-15)
        for example in row.examples:
            number = float(example) if split(example)[1] == "" else in_si(example, row.si)
            assert math.isfinite(number)
    named = {row.name for row in rows}
    # every word is listed, but for second words of the same
    assert set(known()) - named == {"l", "ml"}
    assert {row.quantity for row in rows if row.name == "Nm"} == {"torque"}
    assert {row.quantity for row in rows if row.name == "kJ"} == {"work"}
    assert {row.quantity for row in rows if row.name == "1/min"} == {"rotational speed"}


def test_the_guide_lists_what_is_understood():
    page = (ROOT / "docs" / "guide" / "units.md").read_text(encoding="utf-8")
    listed = {word for line in page.splitlines() if line.startswith("|") for word in re.findall(r"`([^`]+)`", line)}
    for word in listed - {"°"}:
        assert units.other_zero(word) or units.parse(word)
    assert set(known()) - {part for word in listed for part in re.split(r"[ /]", word)} <= {"1", "U", "l", "ml"}


def test_every_declared_unit_has_an_example_that_fits():
    for row in QUANTITIES:
        assert example_of(row.unit) == row.examples[0]
    for role in Role:
        for cls in REGISTRY[role].values():
            for _, spec in specs(cls, "param", "option", "signal", "alternative", "curve", "numbers"):
                for unit in (spec.unit, *spec.units):
                    example = example_of(unit) if unit != "*" else "1 %"
                    assert split(example)[1] == "" or in_si(example, unit if unit != "*" else "1") is not None


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


def test_a_unit_of_one_quantity_is_listed_with_that_alone():
    """N s/m and kg/s are one by their powers; damping and mass flow are not."""
    named = {(row.quantity, row.name) for row in unit_table()}
    assert {("damping", "N s/m"), ("mass flow", "kg/s")} <= named
    assert not {("mass flow", "N s/m"), ("damping", "kg/s")} & named
