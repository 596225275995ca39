"""A shaft that twists along its length: natural frequencies, damping, waves, static twist, energy."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from clutchwork.command.main import main

K, J = 5000.0, 0.08  # N m/rad, kg m2


def _shaft(n, *, fixed=False, damping_time=0.0, end=0.0):
    """A shaft alone: nothing at its ends, or one of them held."""
    d = cw.Driveline("shaft")
    b = d.shaft("b", inertia=end)
    a = d.housing if fixed else d.shaft("a", inertia=end)
    values = {"stiffness": K, "inertia": J, "segments": n, "damping_time": damping_time}
    return d, d.add(cw.FlexibleShaft("flex", base=a, follower=b, **values))


def _found(d):
    """Frequencies [rad/s] and damping ratios of the swings, lowest first."""
    modes = [mode for mode in cw.linearise(d).modes if mode.frequency > 1.0]
    modes.sort(key=lambda mode: mode.frequency)
    return [mode.natural_frequency for mode in modes], [mode.damping for mode in modes]


@pytest.mark.parametrize("n", [1, 2, 5, 8, 20])
@pytest.mark.parametrize("fixed", [False, True])
def test_frequencies_and_damping_are_the_closed_forms(n, fixed):
    beta = 1e-6
    d, flex = _shaft(n, fixed=fixed, damping_time=beta)
    found, ratios = _found(d)
    step = 0.5 if fixed else 0.0
    wanted = [2 * n * sqrt(K / J) * sin((j - step) * pi / (2 * n)) for j in range(1, n + 1)]
    assert flex.frequencies(fixed=fixed) == pytest.approx(wanted, rel=1e-14)
    # eigenvalues of a matrix with entries up to the square of the highest one
    assert 2 * pi * np.array(found) == pytest.approx(wanted, rel=1e-8)
    assert ratios == pytest.approx([beta * w / 2 for w in wanted], rel=1e-6)


def test_check_tells_the_frequencies(capsys, tmp_path):
    d, flex = _shaft(8, end=0.1)
    (note,) = d.assemble().notes
    free, held = ([w / (2 * pi) for w in flex.frequencies(fixed=fixed)[:3]] for fixed in (False, True))
    for hertz in (*free, *held):
        assert f"{hertz:.4g}" in note
    d.save(tmp_path / "shaft.toml")
    assert main(["check", str(tmp_path / "shaft.toml")]) == 0
    assert "natural frequencies" in capsys.readouterr().out


def test_frequencies_tend_to_those_of_the_bar():
    for n in (8, 40):
        _, flex = _shaft(n)
        error = 1.0 - np.array(flex.frequencies()[:2]) / (sqrt(K / J) * pi * np.array([1.0, 2.0]))
        # the leading term of docs/theory/compliance.md, the next one is its square
        assert error == pytest.approx((pi * np.array([1.0, 2.0])) ** 2 / (24 * n * n), rel=0.05)


def test_dimensions_of_a_tube():
    a, b = cw.Node("a"), cw.Node("b")
    tube = cw.FlexibleShaft("t", base=a, follower=b, length=1.5, outer_diameter=0.08, inner_diameter=0.07)
    moment = pi / 32 * (0.08**4 - 0.07**4)
    assert tube.whole_stiffness == pytest.approx(8e10 * moment / 1.5)
    assert tube.whole_inertia == pytest.approx(7850 * moment * 1.5)
    # the speed of sound in shear alone sets the frequencies
    assert tube.frequencies()[0] == pytest.approx(pi / 1.5 * sqrt(8e10 / 7850), rel=1e-2)


@pytest.mark.parametrize("modes", [1, 2, 3, 6])
def test_frequencies_by_modes_are_those_of_the_bar(modes):
    # ends with next to no inertia
    values = {"stiffness": K, "inertia": J, "modes": modes, "damping_time": 1e-6}
    for fixed in (False, True):
        d = cw.Driveline("modal")
        b = d.shaft("b", inertia=1e-10)
        flex = d.add(
            cw.FlexibleShaft("flex", base=d.housing if fixed else d.shaft("a", inertia=1e-10), follower=b, **values)
        )
        assert d.check() == []
        found, ratios = _found(d)
        wanted = flex.frequencies(fixed=fixed)
        assert 2 * pi * np.array(found[:modes]) == pytest.approx(wanted, rel=1e-6)
        assert ratios[:modes] == pytest.approx([1e-6 * w / 2 for w in wanted], rel=1e-5)
        bar = [(j - 0.5 * fixed) * pi * sqrt(K / J) for j in range(1, modes + 1)]
        # the lowest ones nearly exact with one end held too, the last one by the compliance of all above it
        assert wanted[0] == pytest.approx(bar[0], rel=0.005 if fixed else 1e-12)
        assert wanted[-1] == pytest.approx(bar[-1], rel=0.03 if fixed else 1e-12)


@pytest.mark.parametrize("modes", [1, 4])
def test_a_shaft_by_its_modes_moves_as_one_of_many_segments(modes):
    runs = []
    for more in ({"modes": modes}, {"segments": 60}):
        d = cw.Driveline("shaft")
        a, b = d.shaft("a", inertia=0.2, speed=50.0), d.shaft("b", inertia=0.1, speed=50.0)
        d.add(cw.FlexibleShaft("flex", base=a, follower=b, stiffness=K, inertia=J, **more))
        d.add(cw.Torque("t", shaft=a, torque=cw.Ramp(height=30.0, duration=0.05)))
        d.add(cw.Torque("u", shaft=b, torque=cw.Ramp(height=-30.0, duration=0.05)))
        runs.append(d.simulate(0.2, dt=0.002, rtol=1e-10))
        assert abs(runs[-1].energy.residual) <= 1e-8 * runs[-1].energy.turnover
    modal, fine = runs
    # it starts without swings, and twists at rest as the bar does
    assert modal["flex.rigid.speed"][0] == pytest.approx(50.0)
    assert modal["flex.mode_1.speed"][0] == pytest.approx(0.0, abs=1e-12)
    twist = fine["b.angle"] - fine["a.angle"]
    error = modal["b.angle"] - modal["a.angle"] - twist
    assert np.max(np.abs(error)) <= (0.02 if modes == 1 else 2e-3) * np.max(np.abs(twist))
    assert np.mean(twist[-50:]) == pytest.approx(-30.0 / K, rel=0.1)
    # amplitudes of modes react on nobody
    assert modal["housing.torque"] == pytest.approx(0.0, abs=1e-9)


def test_the_housing_takes_the_torque_of_a_held_end():
    d = cw.Driveline("held")
    b = d.shaft("b", inertia=0.1)
    d.add(cw.FlexibleShaft("flex", base=d.housing, follower=b, stiffness=K, inertia=J, modes=3, damping_time=1e-3))
    d.add(cw.Torque("t", shaft=b, torque=cw.Ramp(height=20.0, duration=0.1)))
    run = d.simulate(3.0)
    assert run["b.angle"][-1] == pytest.approx(20.0 / K, rel=1e-6)
    # the source takes as much from the housing as the shaft puts on it
    assert run["flex.base_end.torque_total"][-1] == pytest.approx(20.0, rel=1e-6)
    assert run["housing.torque"][-1] == pytest.approx(0.0, abs=1e-6)


def test_a_mode_swings_alone():
    # node speeds started in the shape of a mode stay in it
    n, j = 6, 2
    shape = [cos(j * pi * x / n) for x in range(n + 1)]
    d, flex = _shaft(n)
    d = cw.Driveline("mode")
    ends = [d.shaft("a", speed=shape[0]), d.shaft("b", speed=shape[-1])]
    inner = [d.shaft(f"m{x}", inertia=J / n, speed=shape[x]) for x in range(1, n)]
    halves = [d.shaft(f"h{x}", inertia=J / (2 * n)) for x in (0, n)]
    for end, half in zip(ends, halves, strict=True):
        d.add(cw.Gear(f"g {half.name}", input=end, output=half, ratio=1.0))
    row = [ends[0], *inner, ends[1]]
    for x in range(n):
        d.add(cw.SpringDamper(f"s{x}", base=row[x], follower=row[x + 1], stiffness=n * K))
    w = flex.frequencies()[j - 1]
    run = d.simulate(10 * 2 * pi / w, rtol=1e-10, atol=1e-10)
    assert run["b.speed"] == pytest.approx(shape[-1] * np.cos(w * run.time), abs=1e-6)


def test_a_blow_at_one_end_as_scipy_has_it():
    n, beta, end = 5, 2e-6, 0.01
    d, _ = _shaft(n, damping_time=beta, end=end)
    d.add(cw.Torque("blow", shaft=d.nodes[0], torque=cw.Pulse(height=50.0, period=1.0, width=0.002)))
    run = d.simulate(0.05, rtol=1e-10, atol=1e-10, dt=1e-3)
    mass = np.full(n + 1, J / n)
    mass[[0, -1]] = J / (2 * n) + end
    stretch = np.diff(np.eye(n + 1), axis=0)

    def rates(time, y):
        twist, speed = y[:n], y[n:]
        torque = -stretch.T @ (n * K * (twist + beta * (stretch @ speed)))
        # the follower is the first shaft that was added
        torque[-1] += 50.0 if time < 0.002 else 0.0
        return np.concatenate([stretch @ speed, torque / mass])

    first = solve_ivp(rates, (0.0, 0.002 - 1e-12), np.zeros(2 * n + 1), rtol=1e-11, atol=1e-12, method="DOP853")
    rest = solve_ivp(rates, (0.002, 0.05), first.y[:, -1], rtol=1e-11, atol=1e-12, method="DOP853", t_eval=[0.02, 0.05])
    at = [int(np.argmin(abs(run.time - t))) for t in (0.02, 0.05)]
    for k in range(n + 1):
        scale = np.max(np.abs(run[f"flex.node_{k + 1}.speed"]))
        assert run[f"flex.node_{k + 1}.speed"][at] == pytest.approx(rest.y[n + k], abs=1e-7 * scale)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


def test_its_heat_goes_to_a_thermal_node_and_it_may_be_a_rod():
    d = cw.Driveline("rod")
    block, rod = d.mass("block", mass=2.0, speed=1.0), d.thermal("rod mass", capacity=100.0)
    flex = cw.FlexibleShaft(
        "rod", base=d.housing, follower=block, stiffness=1e5, inertia=1.0, damping_time=1e-4, segments=4, heat=rod
    )
    d.add(flex)
    assert d.check() == []
    run = d.simulate(2.0, rtol=1e-9)
    assert run.units["rod.node_2.speed"] == "m/s"
    balance = run.energy
    assert sum(balance.thermal.values()) == pytest.approx(sum(balance.heat.values()), rel=1e-6)
    assert abs(balance.residual) <= 1e-8 * balance.turnover


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"stiffness": 1.0}, "inertia is missing; give `stiffness` and `inertia`, or `length` and `outer_diameter`"),
        ({"length": 1.0}, "outer_diameter is missing"),
        ({"length": 1.0, "outer_diameter": 0.1, "inertia": 1.0}, "length is given beside stiffness or inertia"),
        ({"length": 1.0, "outer_diameter": 0.1, "inner_diameter": 0.1}, "inner_diameter is 0.1 m, not below"),
        ({"stiffness": 1.0, "inertia": 1.0, "segments": 201}, "segments = 201"),
        ({"length": 1e-200, "outer_diameter": 1e-200}, "too large or too small"),
    ],
)
def test_mistakes(values, words):
    d = cw.Driveline("mistakes")
    d.add(cw.FlexibleShaft("x", base=d.shaft("a", inertia=1.0), follower=d.shaft("b", inertia=1.0), **values))
    assert words in str(d.check()[0])
