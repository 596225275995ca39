"""Every law in every contact, between shafts and between masses: it runs, its energy adds up, it takes energy."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role
from support import samples

# residual over energy turned over: asked for
RESIDUAL = 1e-8
# the naive law ends where a contact should lock
LAWS = {cls.kind: samples.law(cls) for cls in samples.declared(Role.LAW) if cls.kind != "naive_sign"}


def driveline(kind: str, domain: str, law: cw.Law) -> cw.Driveline:
    """Two bodies, one pushed back and forth and one on a spring, coupled or braked by a contact of 5 N m or N."""
    d = cw.Driveline(kind)
    make, inertia = (d.shaft, "inertia") if domain == "rotation" else (d.mass, "mass")
    a = make("a", **{inertia: 0.4, "speed": 2.0})
    b = make("b", **{inertia: 0.7})
    d.add(cw.Torque("push", shaft=a, torque=cw.Sine(amplitude=12.0, frequency=1.7)))
    d.add(cw.SpringDamper("spring", base=d.housing, follower=b, stiffness=90.0, damping=0.3))
    values = {**samples.ends(kind, a, b), **samples.pressing(kind, 40.0)}
    d.add(REGISTRY[Role.CONTACT][kind]("c", friction=law, **values))
    return d


def simulate(d: cw.Driveline, **options: Any) -> Any:
    """A run at the tolerance at which the balance is asked for."""
    with warnings.catch_warnings():
        # samples of the declarations may be warned of; that is no part of this
        warnings.simplefilter("ignore", cw.ModelWarning)
        return d.simulate(1.0, rtol=1e-9, atol=1e-11, **options)


@pytest.mark.parametrize("kind", samples.pressed_contacts())
@pytest.mark.parametrize("domain", ["rotation", "translation"])
@pytest.mark.parametrize("law", LAWS)
def test_every_law_works_in_every_contact(law: str, domain: str, kind: str) -> None:
    run = simulate(driveline(kind, domain, LAWS[law]))
    assert run.status == "done"
    assert abs(run.energy.residual) <= RESIDUAL * run.energy.turnover
    # what is stored in bristles was put in: since the start heat is never negative
    assert np.min(run["c.heat"]) >= -1e-9
    if REGISTRY[Role.LAW][law].sticks:
        assert np.max(run["c.power"]) <= 1e-9
    # it did slide, both ways but in a freewheel, whose slip is never negative
    assert np.max(run["c.slip"]) > 0.1
    if kind == "one_way_clutch":
        assert np.min(run["c.slip"]) >= -1e-9
    elif law in samples.over_slip():
        # the samples of the tables over temperature hold 14 N m and more, which 12 N m never push back
        assert np.min(run["c.slip"]) < -0.1


@pytest.mark.parametrize("law", LAWS)
def test_shafts_and_masses_do_the_same(law: str) -> None:
    """The same numbers in SI units, the same run."""
    one, other = (simulate(driveline("clutch", domain, LAWS[law]), dt=0.01) for domain in ("rotation", "translation"))
    assert np.array_equal(one["a.speed"], other["a.speed"])
    assert np.array_equal(one["c.torque"], other["c.torque"])


@pytest.mark.parametrize("law", LAWS)
def test_base_and_follower_are_mirror_images(law: str) -> None:
    """Ends exchanged: slip, torque and states change sign, the motion does not."""
    results = []
    for turned in (False, True):
        d = cw.Driveline("mirror")
        a, b = d.shaft("a", inertia=0.4, speed=2.0), d.shaft("b", inertia=0.7)
        d.add(cw.Torque("push", shaft=a, torque=cw.Sine(amplitude=12.0, frequency=1.7)))
        ends = {"base": a, "follower": b} if turned else {"base": b, "follower": a}
        d.add(cw.Clutch("c", friction=LAWS[law], gain=4.0, pressure=10.0, **ends))
        results.append(simulate(d, dt=0.01))
    one, other = results
    # tolerance of the runs; a stiff contact amplifies it
    assert one["a.speed"] == pytest.approx(other["a.speed"], abs=1e-6)
    assert one["c.torque"] == pytest.approx(-other["c.torque"], abs=1e-4)
    for state in LAWS[law].own_states():
        assert one[f"c.{state.name}"] == pytest.approx(-other[f"c.{state.name}"], abs=1e-5)
