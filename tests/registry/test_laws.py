"""Every friction law: what Python says of it is what the compiled core computes, in every contact."""

from __future__ import annotations

import math

import pytest

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role
from clutchwork.model.fields import object_problems
from clutchwork.model.numbers import At
from clutchwork.model.pools import coefficients
from support import samples

LAWS = samples.declared(Role.LAW)
STICKING = [cls for cls in LAWS if cls.sticks]
COMPLIANT = [cls for cls in LAWS if not cls.sticks]
# the one law that is there to fail
CHATTERS = {"naive_sign"}
SOUND = [cls for cls in LAWS if cls.kind not in CHATTERS]


CONTACTS = samples.pressed_contacts()


def _name(value):
    return getattr(value, "__name__", repr(value))


def _contact(kind, d, law):
    """A contact of a kind that brakes a shaft or a mass; its load is 50 N m or N."""
    values = {**samples.ends(kind, d.nodes[0], d.housing), **samples.pressing(kind, 50.0)}
    return d.add(REGISTRY[Role.CONTACT][kind]("c", friction=law, **values))


def _body(domain):
    d = cw.Driveline("brake")
    make = d.shaft if domain == "rotation" else d.mass
    make("body", **{"inertia" if domain == "rotation" else "mass": 0.4, "speed": 2.0})
    return d


@pytest.mark.parametrize("cls", STICKING, ids=_name)
def test_coefficient_at_vanishing_slip_agrees_with_the_core(cls):
    law = samples.law(cls)
    kinetic, static = coefficients(law, 0.0)
    if isinstance(law.static, float):
        assert static == law.static
    assert kinetic <= static
    if law.sliding() is not None:
        assert kinetic == pytest.approx(law.sliding(), rel=1e-14)


@pytest.mark.parametrize("cls", STICKING, ids=_name)
@pytest.mark.parametrize("slip", [0.0, 1e-9, 0.3, 5.0, 9.9])
def test_kinetic_coefficient_is_finite_and_at_most_static_without_its_viscous_part(cls, slip):
    law = samples.law(cls)
    kinetic, static = coefficients(law, slip)
    assert math.isfinite(kinetic)
    # static + viscous slip may round up
    assert 0.0 <= kinetic <= (static + getattr(law, "viscous", 0.0) * slip) * (1 + 1e-15)


@pytest.mark.parametrize("cls", LAWS, ids=_name)
def test_a_sample_has_no_mistake_and_no_warning(cls):
    assert list(object_problems(samples.law(cls), At("law", ""))) == []
    assert samples.law(cls).advice() == []


@pytest.mark.parametrize("cls", LAWS, ids=_name)
def test_says_whether_it_sticks_and_which_states_are_in_use(cls):
    law = samples.law(cls)
    assert isinstance(cls.sticks, bool)
    assert law.own_states() == cls.states[: len(law.own_states())]
    # what sticks does so by its multiplier, not by a state
    assert not (cls.sticks and law.own_states())


@pytest.mark.parametrize("cls", LAWS, ids=_name)
def test_says_when_to_use_it(cls):
    assert "se it" in cls.__doc__ or "demonstration" in cls.__doc__


@pytest.mark.parametrize("kind", CONTACTS)
@pytest.mark.parametrize("domain", ["rotation", "translation"])
@pytest.mark.parametrize("cls", SOUND, ids=_name)
def test_brakes_to_rest_in_every_contact(cls, kind, domain):
    """2 rad/s at 0.4 kg m2 against some 5 N m last some 0.2 s.

    Then bristles without much damping still swing: 5 N m over 2e-4 rad store up to 5e-4 J, some 0.05 rad/s.
    """
    d = _body(domain)
    _contact(kind, d, samples.law(cls))
    run = d.simulate(1.0)
    assert run.status == "done"
    assert abs(run["body.speed"][-1]) < 0.06
    # all kinetic energy, 0.8 J, went through the contact
    assert run["c.heat"][-1] == pytest.approx(0.8, abs=1e-3)
    assert run.energy.residual == pytest.approx(0.0, abs=1e-5)
    # a freewheel locks by itself
    assert ("locked" in run["c.state"]) == (cls.sticks or kind == "one_way_clutch")


@pytest.mark.parametrize("cls", SOUND, ids=_name)
def test_slides_at_its_steady_coefficient(cls):
    """At a constant slip every law settles; twice the load is twice the torque."""
    law, torques = samples.law(cls), []
    for pressure in (1.0, 2.0):
        d = cw.Driveline("steady")
        shaft = d.shaft("a", inertia=1.0)
        d.add(cw.PrescribedSpeed("p", shaft=shaft, speed=3.0))
        d.add(cw.Brake("c", shaft=shaft, friction=law, gain=1.0, pressure=pressure))
        torques.append(d.simulate(1.0)["c.torque"][-1])
    assert torques[1] == pytest.approx(2.0 * torques[0], rel=1e-5)
    if hasattr(law, "shape"):
        fall = math.exp(-((3.0 / law.speed) ** 2))
        steady = law.kinetic + (law.static - law.kinetic) * fall + law.viscous * 3.0
        assert -torques[0] == pytest.approx(steady, rel=1e-5)


@pytest.mark.parametrize("cls", [cls for cls in COMPLIANT if cls.states], ids=_name)
def test_states_in_use_are_signals_of_the_contact(cls):
    law = samples.law(cls)
    d = _body("rotation")
    d.add(cw.Spring("s", base=d.housing, follower=d.nodes[0], stiffness=1.0, initial_twist=0.1))
    _contact("brake", d, law)
    d.add(cw.BearingFriction("other", shaft=d.nodes[0], friction=law, torque=50.0))
    system = d.assemble()
    count = len(law.own_states())
    assert system.initial_state.tolist() == [0.1] + [0.0] * 2 * count
    assert system.contact_state.tolist() == [1, 1 + count]
    run = d.simulate(0.01)
    for state in law.own_states():
        assert run[f"c.{state.name}"][0] == 0.0
        assert run[f"c.{state.name}"][-1] == run[f"other.{state.name}"][-1] != 0.0
        assert run.units[f"c.{state.name}"] == state.unit
    for state in cls.states[count:]:
        assert f"c.{state.name}" not in run.names


@pytest.mark.parametrize("cls", LAWS, ids=_name)
def test_model_file_reads_back_to_the_same_system(cls, tmp_path):
    d = _body("translation")
    _contact("clutch", d, samples.law(cls))
    for name in ("model.toml", "model.json"):
        d.save(tmp_path / name)
        again = cw.Driveline.load(tmp_path / name)
        assert again.to_dict() == d.to_dict()
        assert again.assemble().to_bytes() == d.assemble().to_bytes()
    d.assemble().save(tmp_path / "system.npz")
    assert cw.System.load(tmp_path / "system.npz").to_bytes() == d.assemble().to_bytes()
