"""What carries a shaft without inertia is declared, and what is declared is so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.ports import ports
from clutchwork.declare.schema import Role, specs
from clutchwork.model.massless import _damps, _is_spring
from clutchwork.model.parts import take_apart
from support import samples

ACTING = samples.acting(Role.TORQUE, Role.CONTACT)
LOAD = 3.0


def _name(cls):
    return cls.__name__


def _sample(cls):
    """The sample of a class; one that may damp or be wound up does."""
    element = samples.driveline(cls).elements[0]
    names = {item.name for item, _ in specs(cls)}
    more = {"damping": 1.5, "initial_twist": 0.02} if element.passive() is not None else {}
    return replace(element, **{name: value for name, value in more.items() if name in names})


PASSIVE = [cls for cls in ACTING if _sample(cls).passive() is not None]


def _at_massless_shaft(cls, **changes):
    """An element between a heavy shaft and one without inertia, with a load there."""
    element = _sample(cls)
    d = cw.Driveline(cls.__name__)
    names = list(ports(element))
    moving = next((name for name in ("follower", "shaft") if name in names), names[0])
    light = samples.bodies(d, cls, moving)("light")
    joined = {name: samples.bodies(d, cls, name)(f"heavy_{name}", inertia=1e9) for name in names if name != moving}
    d.add(replace(element, **{moving: light}, **joined, **changes))
    d.add(cw.Torque("load", shaft=light, torque=LOAD))
    return d


@pytest.mark.parametrize("cls", ACTING, ids=_name)
def test_what_carries_no_shaft_without_inertia_is_refused(cls):
    d = _at_massless_shaft(cls)
    words = {'mass "light": mass': 'shaft "light": inertia', "give it mass > 0 kg": "give it inertia > 0 kg m2"}
    found = [str(problem) for problem in d.check()]
    for mass, shaft in words.items():
        found = [problem.replace(mass, shaft) for problem in found]
    element = d.elements[0]
    passive = element.passive()
    if "bound" in element.hooks:
        # its gear row carries the shaft
        assert found == []
    elif element.role is Role.CONTACT or element.jumps:
        named = f'cw.{cls.__name__}("x")'
        assert found == [f'shaft "light": inertia is missing at {named}, whose torque jumps; give it inertia > 0 kg m2']
    elif passive is not None and passive.damping > 0.0:
        assert found == []
    elif passive is not None and passive.stiffness > 0.0:
        # springs alone balance only springs
        assert any('shaft "light": inertia is missing' in words for words in found)
    else:
        (problem,) = found
        assert problem.startswith('shaft "light": inertia is missing, and nothing else determines its motion: cw.')
        assert f'cw.{cls.__name__}("x") and cw.Torque("load") is neither spring nor damper' in problem
        assert "give it inertia > 0 kg m2" in problem


@pytest.mark.parametrize("cls", PASSIVE, ids=_name)
def test_what_is_declared_is_all_its_torque(cls):
    d = cw.Driveline(cls.__name__)
    a, b = d.shaft("a", inertia=0.4, speed=5.0), d.shaft("b", inertia=0.7, speed=-2.0)
    element = d.add(replace(_sample(cls), base=a, follower=b))
    run = d.simulate(0.5, dt=0.05, rtol=1e-10)
    rate, twist = run["b.speed"] - run["a.speed"], run["b.angle"] - run["a.angle"]
    twist = twist + getattr(element, "initial_twist", 0.0)
    stiffness, damping = element.passive()
    assert np.allclose(run["x.torque"], -(stiffness * twist + damping * rate), rtol=1e-6, atol=1e-7)


@pytest.mark.parametrize("cls", [cls for cls in PASSIVE if _damps(_sample(cls))], ids=_name)
def test_what_is_declared_to_damp_gives_a_shaft_without_inertia_its_speed(cls):
    d = _at_massless_shaft(cls)
    run = d.simulate(20.0)
    assert run.status == "done"
    stiffness, damping = d.elements[0].passive()
    rate = run["light.speed"] - run["heavy_base.speed"]
    twist = run["light.angle"] - run["heavy_base.angle"] + getattr(d.elements[0], "initial_twist", 0.0)
    assert np.allclose(stiffness * twist + damping * rate, LOAD, rtol=1e-4)


def test_springs_are_told_from_dampers():
    parts = take_apart([samples.driveline(cw.Spring).elements[0]]).components
    assert [_is_spring(part) for part in parts] == [True]
    assert not _damps(parts[0])


@pytest.mark.parametrize("other", [None, cw.Torque, cw.Spring, cw.SpringDamper, cw.Damper], ids=str)
@pytest.mark.parametrize("engaged", [False, True])
def test_a_dog_clutch_at_a_shaft_without_inertia_is_refused(engaged, other):
    d = cw.Driveline("m")
    a, b = d.shaft("a", inertia=1.0, speed=5.0), d.shaft("b")
    values = {"command": float(engaged), "teeth": 20, "gap": 0.05, "stiffness": 1e4, "engaged": engaged}
    d.add(cw.DogClutch("dog", base=a, follower=b, **values))
    if other is cw.Torque:
        d.add(cw.Torque("t", shaft=b, torque=3.0))
    elif other is not None:
        d.add(replace(_sample(other), base=d.housing, follower=b))
    (problem,) = d.check()
    assert str(problem) == (
        'shaft "b": inertia is missing at cw.DogClutch("dog"), whose torque jumps; give it inertia > 0 kg m2'
    )
