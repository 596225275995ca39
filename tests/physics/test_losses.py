"""Losses: what goes through every joint closes the balance of every shaft and element, over any window."""

from __future__ import annotations

import warnings
from itertools import pairwise

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.results.flows import flows
from support import random_contacts, random_large, samples

# part of the turnover, at rtol 1e-9: Gauss points on the same steps as the work of the core
CLOSED = 1e-8


def _run(seed: int, make=random_contacts.driveline, t_end: float = 1.0):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return make(seed).simulate(t_end, rtol=1e-9, atol=1e-11)


def _closes(run, table, turnover: float) -> None:
    for line in table.lines:
        missed = line.taken - line.given - line.stored - line.heat
        assert abs(missed) <= CLOSED * turnover, (line, missed / turnover)
    assert sum(line.heat for line in table.lines) == pytest.approx(table.heat)


@pytest.mark.parametrize("seed", range(12))
def test_random_drivelines_close(seed: int) -> None:
    """Impulses, open and locked contacts among them; each shaft and each element by itself."""
    run = _run(seed)
    table = run.losses()
    _closes(run, table, run.energy.turnover)
    assert abs(table.heat - sum(run.energy.heat.values())) <= CLOSED * run.energy.turnover


@pytest.mark.parametrize("seed", range(2))
def test_a_large_driveline_closes(seed: int) -> None:
    run = _run(seed, random_large.driveline, 0.3)
    _closes(run, run.losses(), run.energy.turnover)


@pytest.mark.parametrize("seed", range(4))
def test_windows_add_up(seed: int) -> None:
    """Also where they are cut at an event with an impulse: an instant is its left limit."""
    run = _run(seed)
    inner = [event.time for event in run.events if 0.0 < event.time < 1.0][:2] or [0.3]
    cuts = [0.0, *dict.fromkeys(inner), 1.0]
    parts = [flows(run, a, b) for a, b in pairwise(cuts)]
    whole = flows(run, 0.0, 1.0)
    turnover = run.energy.turnover
    for joint, energy in whole.joints.items():
        assert sum(part.joints[joint] for part in parts) == pytest.approx(energy, abs=CLOSED * turnover)
    assert sum(part.balance.input for part in parts) == pytest.approx(whole.balance.input, abs=CLOSED * turnover)


# its torque grows with the square of the speed, without end
ENDLESS = ("QuadraticTorque",)
ALL = [cls for cls in samples.declared(*samples.ELEMENT_ROLES) if cls.__name__ not in ENDLESS]


@pytest.mark.parametrize("cls", ALL, ids=lambda cls: cls.__name__)
def test_every_element_closes(cls) -> None:
    """Whatever it is, what goes in comes out, is stored or is heat."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        d = samples.driveline(cls)
        d.add(cw.Torque("push", shaft=d.nodes[0], torque=cw.Sine(amplitude=3.0, frequency=1.7, offset=4.0)))
        run = d.simulate(0.3, rtol=1e-9, atol=1e-11)
    assert run.finished, run.message
    _closes(run, run.losses(), run.energy.turnover)


def test_a_clutch_that_slips_at_a_constant_speed() -> None:
    """In 100 N m 200 rad/s, out 100 N m 150 rad/s: efficiency 3/4, all in closed form."""
    d = cw.Driveline("slip")
    a, b = d.shaft("a", inertia=0.1, speed=200.0), d.shaft("b", inertia=0.1, speed=150.0)
    d.add(cw.PrescribedSpeed("drive", shaft=a, speed=200.0))
    d.add(cw.PrescribedSpeed("load", shaft=b, speed=150.0))
    d.add(
        cw.Clutch("c", base=a, follower=b, friction=cw.Coulomb(static=0.5, kinetic=0.4), gain=1.0, normal_force=250.0)
    )
    run = d.simulate(2.0)
    table = run.losses(0.5, 1.5)
    assert table["c"].taken == pytest.approx(20e3)
    assert table["c"].given == pytest.approx(15e3)
    assert table["c"].heat == pytest.approx(5e3)
    assert table["c"].efficiency == pytest.approx(0.75)
    assert table.efficiency == pytest.approx(0.75)
    assert table["c"].share == 1.0
    assert table["drive"].outside == pytest.approx(20e3)
    assert table["load"].outside == pytest.approx(-15e3)
    assert run.losses("500 ms", "1500 ms", power=True)["c"].heat == pytest.approx(5e3)
    assert run.losses(0.0, 2.0, power=True)["c"].heat == pytest.approx(5e3)


def test_power_that_circulates_in_a_gear_set() -> None:
    """Sun driven, carrier and ring geared together by 1:2: powers of the three ports by the lever rule."""
    d = cw.Driveline("split")
    sun, ring, carrier = (d.shaft(name, inertia=0.0 if name == "ring" else 0.2) for name in ("sun", "ring", "carrier"))
    d.add(cw.Planetary("set", sun=sun, ring=ring, carrier=carrier, ratio=2.0))
    d.add(cw.Gear("back", input=ring, output=carrier, ratio=2.0))
    d.add(cw.PrescribedSpeed("drive", shaft=sun, speed=10.0))
    d.add(cw.Torque("load", shaft=carrier, torque=-30.0))
    run = d.simulate(1.0)
    # sun + 2 ring = 3 carrier and ring = 2 carrier: sun = -carrier; torques sun : ring : carrier = 1 : 2 : -3
    assert run["carrier.speed"][-1] == pytest.approx(-10.0)
    through = {(element, shaft): energy for element, shaft, energy in run.losses().joints}
    power = -30.0 * -10.0
    assert through["load", "carrier"] == pytest.approx(power)
    assert through["set", "sun"] == pytest.approx(-through["drive", "sun"])
    assert through["drive", "sun"] == pytest.approx(-power)
    # T sun 10 = power of the sun, ring: 2 T (-20), carrier: -3 T (-10)
    torque = through["set", "sun"] / 10.0
    assert through["set", "ring"] == pytest.approx(2.0 * torque * -20.0)
    assert through["set", "carrier"] == pytest.approx(-3.0 * torque * -10.0)
    assert through["back", "carrier"] == pytest.approx(-through["back", "ring"])


def test_an_impulse_goes_through_gears() -> None:
    """A freewheel that stops a geared shaft at once: the gear passes on what the far inertia loses."""
    d = cw.Driveline("blow")
    near, far = d.shaft("near", inertia=0.5, speed=-4.0), d.shaft("far", inertia=0.1)
    d.add(cw.Gear("gear", input=far, output=near, ratio=3.0))
    d.add(
        cw.OneWayClutch("stop", base=d.housing, follower=near, friction=cw.Coulomb(static=1.0, kinetic=1.0), gain=1.0)
    )
    run = d.simulate(0.1)
    table = run.losses()
    assert table["stop"].heat == pytest.approx(0.5 * 0.5 * 16.0 + 0.5 * 0.1 * 144.0)
    assert table["far"].stored == pytest.approx(-0.5 * 0.1 * 144.0)
    assert table["gear"].taken == pytest.approx(0.5 * 0.1 * 144.0)
    assert table["gear"].given == pytest.approx(0.5 * 0.1 * 144.0)


def test_what_is_asked_for_must_be_a_window() -> None:
    run = _run(0)
    for start, end in ((0.5, 0.5), (0.8, 0.2), (-1.0, 0.5), (0.0, 2.0)):
        with pytest.raises(cw.UseError, match="must rise and lie between 0 and 1 s"):
            run.losses(start, end)
    with pytest.raises(cw.UseError, match="give a time in s"):
        run.losses("soon")
    with pytest.raises(cw.UnknownName, match="no element or shaft"):
        run.losses()["c99"]
    bare = random_contacts.driveline(0).simulate(0.1, work=False)
    with pytest.raises(cw.OptionError, match="work=True"):
        bare.losses()


def test_tables_for_programs() -> None:
    table = _run(1).losses(0.1, 0.9)
    data = table.to_dict()
    frame = table.to_pandas()
    assert list(data["elements"]) == list(frame.index)
    assert frame["heat"].sum() == pytest.approx(data["heat_J"])
    assert np.isfinite(data["efficiency"])
    assert frame.attrs["units"]["in"] == "J"
    assert str(table).splitlines()[0].startswith("0.1 to 0.9 s")
    assert table._repr_html_().startswith("<table")
