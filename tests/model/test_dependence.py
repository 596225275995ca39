"""Which locked contacts depend on each other, before a run and in it."""

from __future__ import annotations

from typing import Any

import clutchwork as cw
from clutchwork.assembly.dependence import dependent_sets
from clutchwork.assembly.sparse import entries

ONE = cw.Coulomb(static=1.0, kinetic=1.0)


def clutch(name: str, base: cw.Node, follower: cw.Node, force: Any = 10.0) -> cw.Clutch:
    return cw.Clutch(name, base=base, follower=follower, friction=ONE, gain=1.0, normal_force=force)


def test_parallel_clutches_and_a_ring_are_sets_and_a_chain_is_none() -> None:
    d = cw.Driveline("sets")
    a, b, c, e = (d.shaft(name, inertia=1.0) for name in "abce")
    for name, base, follower in (("p", a, b), ("q", b, a), ("r", b, c), ("s", c, e), ("t", b, e)):
        d.add(clutch(name, base, follower))
    d.add(clutch("alone", d.housing, d.shaft("f", inertia=1.0)))
    system = d.assemble()
    assert system.dependent == (("p", "q"), ("r", "s", "t"))
    rates = entries(system.arrays, "contact_rate")
    assert dependent_sets([c.name for c in system.contacts], rates, ["p", "r", "s", "alone"]) == ()


def test_what_prescribed_speeds_move_alone_shares_nothing() -> None:
    d = cw.Driveline("prescribed")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.PrescribedSpeed("m", shaft=a, speed=0.0))
    for name in ("p", "q"):
        d.add(clutch(name, d.housing, a))
    assert d.assemble().dependent == ()


def test_a_run_tells_from_when_to_when() -> None:
    """A second brake closes at 0.25 s and opens at 0.75 s."""
    d = cw.Driveline("two brakes")
    a = d.shaft("a", inertia=1.0)
    d.add(clutch("held", d.housing, a))
    pulse = cw.Table([(0.0, -1.0), (0.25, -1.0), (0.25, 1.0), (0.75, 1.0), (0.75, -1.0)])
    d.add(clutch("now and then", d.housing, a, pulse))
    run = d.simulate(1.0)
    (phase,) = run.dependent
    assert (phase.begin, phase.end, phase.contacts) == (0.25, 0.75, ("held", "now and then"))
