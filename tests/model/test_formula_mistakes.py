"""What is wrong with a formula is told all at once, at the place where it stands."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare import units
from clutchwork.laws.bases.dimensions import powers_of, shown
from clutchwork.laws.bases.formula import in_si
from clutchwork.laws.bases.newton import root
from support.random_formulas import drawn

NUMBERS: dict[str, Any] = {"mu_k": 0.3, "mu_s": 0.4, "v_s": "0.1 rad/s"}
BRISTLES: dict[str, Any] = {"rates": {"z": "s*(v - abs(v)*z/mu)"}, "at_rest": "mu", "s": 1e3, "mu": 0.3}


def mistakes(law: cw.Law) -> list[str]:
    """What the check of a driveline says of a law."""
    d = cw.Driveline("brake")
    d.add(cw.Brake("b", shaft=d.shaft("a", inertia=1.0), friction=law, gain=1.0, pressure=1.0))
    return [str(problem).removeprefix('cw.Brake("b"): friction.') for problem in d.check()]


def test_what_is_right_has_no_mistakes() -> None:
    assert mistakes(cw.Formula("mu_k + (mu_s - mu_k)*exp(-abs(v)/v_s)", **NUMBERS)) == []
    assert mistakes(cw.Formula("0.3")) == []
    assert mistakes(cw.DynamicFormula("z", **BRISTLES)) == []


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("mu_k + (mu_s - mu_j)*exp(-v/v_s)", "expression has the unknown name 'mu_j' at character 16; did you mean"),
        ("mu_k + mu_s*exq(-v/v_s)", "expression has the unknown function 'exq(-v/v_s)' at character 13; did you"),
        ("mu_k + * mu_s", "expression cannot be read at character 8; write an expression such as"),
        ("  mu_k +\n mu_s $ 2", "expression cannot be read at character 16"),
        ("mu_k*(mu_s", "expression cannot be read at character 6"),
        ("mu_s^2", "expression has 'mu_s^2' at character 1, whose operator has no meaning in a formula"),
        ("v.real", "expression has 'v.real' at character 1, which has no meaning in a formula; use + - * /"),
        ("[mu_k]", "expression has '[mu_k]' at character 1, which has no meaning"),
        ("(lambda: 1)()", "expression has the unknown function '(lambda: 1)()' at character 1"),
        ("__import__('os').getcwd()", "expression has the unknown function"),
        ("'0.3'", "expression has \"'0.3'\" at character 1, which is not a number"),
        ("exp(mu_k, mu_s)", "expression gives 'exp(mu_k, mu_s)' at character 1 2 arguments; exp takes 1 number"),
        ("2*(v < v_s)", "expression takes the comparison 'v < v_s' at character 4 as a number"),
        ("where(mu_k, 0.3, 0.2)", "expression asks whether 'mu_k' at character 7, which is a number; compare it"),
        ("0.3 if v == 1 else 0.2", "expression has 'v == 1' at character 8, whose operator has no meaning"),
        ("µ", "expression has 'µ' at character 1; use plain letters"),
        ("0.3  # kinetic", "expression has '#' at character 6"),
        ("", "expression must be an expression; write one as a string"),
        ("1e999*mu_k", "expression has '1e999' at character 1, beyond all numbers"),
        ("+".join(["v"] * 300), "expression needs"),
        ("-" * 900 + "v", "expression"),
        ("(" * 150 + "v" + ")" * 150, "expression"),
        ("v" * 3000, "expression has 3000 characters; write at most 2000"),
    ],
)  # fmt: skip
def test_an_expression_that_cannot_be_read(text: str, told: str) -> None:
    assert any(said.startswith(told) for said in mistakes(cw.Formula(text, **NUMBERS))), mistakes(
        cw.Formula(text, **NUMBERS)
    )


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("mu + v", "expression is in [1/s], must be in [1]; give its numbers other units, or none"),
        ("mu + exp(-v)", "expression takes exp of [1/s] in 'exp(-v)' at character 6; give its numbers other units"),
        ("mu + v/w + v", "expression adds [1] and [1/s] in 'mu + v/w + v' at character 1"),
        ("mu*max(v, temperature)/w", "expression compares [1/s] and [K] in 'max(v, temperature)' at character 4"),
        ("sqrt(v/w**2)", "expression is in [s^(1/2)], must be in [1]"),
        ("v**1.5/w", "expression is in [1/s^(1/2)], must be in [1]"),
        ("mu*(1 if v < temperature else 2)", "expression compares [1/s] and [K] in 'v < temperature'"),
    ],
)  # fmt: skip
def test_units_that_do_not_fit(text: str, told: str) -> None:
    given: dict[str, Any] = {"temperature": 300.0} if "temperature" in text else {}
    said = mistakes(cw.Formula(text, **given, mu=0.3, w="30 rpm"))
    assert said[0].startswith(told)
    # numbers without units fit any
    said = mistakes(cw.Formula(text, **given, mu=0.3, w=3.0))
    assert not any("[" in one for one in said)


def test_masses_slip_in_metres_per_second() -> None:
    # which of both it is, the contact knows
    assert cw.Formula("mu*exp(-v/w)", mu=0.3, w="1 m/s").problems() == []
    assert cw.Formula("mu*exp(-v/w)", mu=0.3, w="1 m").problems() != []


def test_numbers_in_units_of_the_other_kind_of_motion_are_refused() -> None:
    (said,) = mistakes(cw.Formula("mu*exp(-v/w)", mu=0.3, w="1 m/s"))
    assert said == (
        "expression takes exp of [1/m] in 'exp(-v/w)' at character 4, with the slip of shafts [rad/s]; "
        "give its numbers other units, or none, which fits any"
    )
    for unit, count in (("1 m/s", 0), ("1 rad/s", 1), ("60 rpm", 1), (1.0, 0)):
        d = cw.Driveline("sledge")
        law = cw.Formula("mu*exp(-v/w)", mu=0.3, w=unit)
        d.add(cw.Brake("b", shaft=d.mass("m", mass=1.0), friction=law, gain=1.0, normal_force=1.0))
        assert len(d.check()) == count, unit


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("where(v < knee, 0.4, 0.2)", "expression jumps from 0.4 to 0.2 at a slip of 3 rad/s, where no step ends"),
        ("0.3 - 0.1*sign(v - knee)", "expression jumps from 0.4 to 0.3 at a slip of 3 rad/s"),
        ("0.3 if v < knee or v > 80 else 0.2", "expression jumps from 0.3 to 0.2 at a slip of 3 rad/s"),
        ("0.2 + 0.1*(1 if temperature < 350 else 0)*knee/3", "expression jumps from 0.3 to 0.2 at a slip of 0.1 rad/s"),
        ("0.3 + 0.05*abs(v - knee - 0.3)/(v - knee - 0.3)", "jumps from 0.25 to 0.35 at a slip of 3.3 rad/s"),
        ("0.3 + 0.05*sqrt((v - knee - 0.3)**2)/(v - knee - 0.3)", "jumps from 0.25 to 0.35 at a slip of 3.3 rad/s"),
        ("0.3 + 0.05*atan(1/(v - knee - 0.3))", "expression jumps from 0.22146 to 0.37854 at a slip of 3.3 rad/s"),
        ("0.3 + 1e-5*(v**2 - (knee + 0.3)**2)/(v - knee - 0.3)", ""),
        ("0.3 + 0.05*sin(v - knee - 0.3)/(v - knee - 0.3)", ""),
        ("max(0.2, 0.5 - 0.1*v) + 0*knee", ""),
        ("where(v < knee, 0.5 - 0.1*v, 0.2)", ""),
        ("0.2 + 0.1*abs(v - knee)/(1 + v)", ""),
    ],
)  # fmt: skip
def test_a_formula_that_jumps_is_warned_of_and_has_no_gradient(text: str, told: str) -> None:
    given: dict[str, Any] = (
        {"temperature": cw.Ramp(offset=300.0, height=100.0, duration=1.0)} if "temperature" in text else {}
    )
    law = cw.Formula(text, knee=3.0, at_rest="0.6*knee/3", **given)
    d = cw.Driveline("brake")
    d.add(cw.Brake("b", shaft=d.shaft("a", inertia=1.0, speed=10.0), friction=law, gain=1.0, normal_force=10.0))
    if not told:
        assert d.check() == []
        d.simulate(0.1).gradient(of="a.speed", by="b.friction.knee")
        return
    with pytest.warns(cw.ModelWarning, match=re.escape(told)):
        run = d.simulate(0.1)
    with pytest.raises(cw.UseError, match=r"b.friction jumps from .*, where no event is, so that derivatives would be"):
        run.gradient(of="a.speed", by="b.friction.knee")


def test_a_jump_is_told_with_the_slip_of_its_contact_and_one_at_rest_with_its_remedy() -> None:
    block = cw.Driveline("block")
    law = cw.Formula("where(v < knee, 0.4, 0.2)", knee=3.0)
    block.add(cw.Brake("b", shaft=block.mass("a", mass=1.0, speed=10.0), friction=law, gain=1.0, normal_force=10.0))
    with pytest.warns(cw.ModelWarning, match=r"jumps from 0.4 to 0.2 at a slip of 3 m/s"):
        block.simulate(0.1)
    disc = cw.Driveline("disc")
    law = cw.Formula("where(v > 0, 0.3, 0.4*mu)", mu=1.0)
    disc.add(cw.Brake("b", shaft=disc.shaft("a", inertia=1.0, speed=10.0), friction=law, gain=1.0, normal_force=10.0))
    told = (
        "jumps from 0.4 to 0.3 between rest and the least slip, .*; leave the condition out of it, and give what holds"
    )
    with pytest.warns(cw.ModelWarning, match=f"{told} at rest as at_rest=0.4$"):
        disc.check()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("mu_k - 0.01*v + 0*mu_s*v_s", "expression is -0.02 at a slip of 32 rad/s: below zero friction drives"),
        ("mu_k/v + mu_s*v_s", "expression has no finite value in 'mu_k/v' at character 1 at a slip of 0 rad/s"),
        ("mu_k + mu_s/(v - 1)*0*v_s", "expression has no finite value in 'mu_s/(v - 1)' at character 8 at a slip of 1"),
        ("mu_k*sqrt(1 - v/(mu_s*v_s))", "expression has no finite value in"),
        ("log(v/v_s)*mu_k*mu_s", "expression has no finite value in 'log(v/v_s)' at character 1 at a slip of 0 rad/s"),
    ],
)  # fmt: skip
def test_values_that_friction_has_not(text: str, told: str) -> None:
    law = cw.Formula(text, **NUMBERS | {"v_s": 0.1})
    assert mistakes(law)[0].startswith(told)


def test_a_static_coefficient_below_the_kinetic_one() -> None:
    (said,) = mistakes(cw.Formula("0.3 + 0.1*v/(1 + v)", at_rest="mu", mu=0.25))
    assert said == ("at_rest is 0.25, below the kinetic coefficient 0.3 at a slip of 0 rad/s; raise it to at least 0.3")
    (said,) = mistakes(cw.Formula("0.3", at_rest="0.4 + 0*v"))
    assert said.startswith("at_rest reads 'v' at character 9, which has no meaning at rest")


def test_all_at_once() -> None:
    said = mistakes(cw.Formula("mu_k + mu_x", at_rest="sin(mu_y) +", **NUMBERS))
    assert [one.partition(" ")[0] for one in said] == ["expression", "at_rest"]
    said = mistakes(cw.Formula("0.3 + 0.1*v", mu="0.1 m", nu=2.0))
    assert [one.partition(" ")[0] for one in said] == ["mu", "nu"]


def test_a_temperature_that_nothing_reads_is_warned_of() -> None:
    with pytest.warns(cw.ModelWarning, match="friction.temperature = 300 K: is in no expression"):
        assert mistakes(cw.Formula("0.3", temperature=300.0)) == []


def test_numbers_that_are_none() -> None:
    assert mistakes(cw.Formula("mu", mu="much"))[0].startswith("mu = 'much': is not a number")
    assert mistakes(cw.Formula("mu", mu=float("nan")))[0].startswith("mu = nan: must be finite")
    assert mistakes(cw.Formula("mu*v/w", mu=0.1, w="3 rdp/s"))[0].startswith("w = '3 rdp/s': has the unknown unit")
    assert "is in no expression; remove it" in mistakes(cw.Formula("mu_k", mu_k=0.3, mu_q=0.3))[0]


def test_inputs_that_nobody_gives() -> None:
    assert mistakes(cw.Formula("0.3*300/temperature"))[0].startswith("temperature is missing; give a temperature [K]")
    assert mistakes(cw.Formula("0.3*(pressure/1e5)**0.1"))[0].startswith(
        "pressure is missing; give the law the pressure"
    )


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({"rates": {}}, "rates must be a table of 1 to 4 rates by the names of states"),
        ({"rates": {"v": "s*mu"}}, "rates.v is not a name for a state; give it one that nothing else has"),
        ({"rates": {"torque": "s*mu"}}, "rates.torque is not a name for a state"),
        ({"rates": {"z": "s*(v - w)*mu"}}, "rates.z has the unknown name 'w' at character 8"),
        ({"expression": "-z"}, "expression is -0.3 in steady sliding at a slip of 0.001 rad/s: friction that drives"),
        ({"expression": "z + 0.1*sign(v)"}, "expression jumps from -0.1 to 0.1 where the slip changes its sign"),
        ({"at_rest": "z"}, "at_rest reads 'z' at character 1, which has no meaning at rest"),
        ({"rates": {"z": "s*(v - abs(v)*z/mu)"}, "s": "3 Pa"}, "rates.z is in [kg/(m s3)], must be in [1/s]"),
        ({"rates": {"z": "s*v/(mu - 0.3)"}}, "rates.z has no finite value in"),
    ],
)  # fmt: skip
def test_laws_with_states(fields: dict[str, Any], told: str) -> None:
    said = mistakes(cw.DynamicFormula(**{"expression": "z", **BRISTLES, **fields}))
    assert said[0].startswith(told), said


def test_what_must_be_given() -> None:
    with pytest.raises(cw.UseError, match="expression is missing; give an expression: coefficient over the slip"):
        cw.Formula(mu=0.3)  # type: ignore[call-arg]
    with pytest.raises(cw.UseError, match="rates is missing"):
        cw.DynamicFormula("z", at_rest="0.3")  # type: ignore[call-arg]


def test_a_model_file_says_the_line(tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_text("""
[[shaft]]
name = "a"
inertia = 1.0

[[element]]
name = "b"
type = "brake"
shaft = "a"
gain = 1.0
pressure = 1.0
friction = {type = "formula", expression = "mu + nu*v", mu = 0.3, w = "1 rpm"}
""")
    with pytest.raises(cw.ModelError, match=r"line 12: .*expression has the unknown name 'nu' at character 6"):
        cw.Driveline.load(path)


def test_a_name_that_a_law_has_already_is_an_unknown_field() -> None:
    with pytest.raises(cw.UseError, match="unknown field 'band'"):
        cw.Formula("0.3", band=0.1)


def test_a_page_has_no_room_for_it(tmp_path: Path) -> None:
    d = cw.Driveline("page")
    d.add(cw.Brake("b", shaft=d.shaft("a", inertia=1.0), friction=cw.Formula("0.3"), gain=1.0, pressure=1.0))
    with pytest.raises(ValueError, match="the friction of 'b' is a Formula, which pages have no room for; take a law"):
        d.simulate(0.1).page(tmp_path / "page.html")


@pytest.mark.parametrize("text", ["1/s", "rad/s", "kg m/s2", "1/(K m)", "N m", "Pa"])
def test_units_are_written_as_they_are_read(text: str) -> None:
    assert units.powers_of(in_si(units.powers_of(text))) == units.powers_of(text)
    assert shown(powers_of("rad/s")) == "[1/s]"


def test_a_root() -> None:
    found = root(lambda x: [x[0] ** 2 + x[1] - 3.0, x[0] - x[1] + 1.0], [1.0, 1.0])
    assert found == pytest.approx([1.0, 2.0], abs=1e-6)
    assert root(lambda x: [1.0 + x[0] ** 2], [0.5]) is None


@pytest.mark.parametrize("sticks", [True, False])
def test_random_formulas_are_read(sticks: bool) -> None:
    rng = np.random.default_rng(7)
    cls: Any = cw.Formula if sticks else cw.DynamicFormula
    good = [not cls(**drawn(rng, sticks)).problems() for _ in range(60)]
    # some fall below zero, or have a coefficient at rest that is too small
    assert sum(good) > 30
