"""The squared jerk: one value wherever it is asked for, which converges, and its derivative where something bends."""

from __future__ import annotations

import warnings
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from support import gradient_cases
from support.amount import amount

T_END = 0.5
OMEGA = 2.0 * np.pi * 8.0
SMALL = 1e-7


def pushed(curve: list[tuple[float, float]], amplitude: float, speed: float, inertia: float) -> cw.Driveline:
    """An inertia under a torque over its speed, and one that swings."""
    d = cw.Driveline("bend")
    e = d.shaft("e", inertia=inertia, speed=speed)
    d.add(cw.SpeedTorque("curve", shaft=e, torque=curve))
    d.add(cw.Torque("t", shaft=e, torque=cw.Sine(amplitude=amplitude, frequency=8.0)))
    return d


def integrated(curve: list[tuple[float, float]], amplitude: float, speed: float, inertia: float) -> float:
    """Its squared jerk by SciPy, from bend to bend of the curve."""
    speeds, torques = np.array(curve).T
    slopes, bends = np.diff(torques) / np.diff(speeds), speeds[1:-1]
    # the outer pieces go on beyond the ends
    piece = int(np.searchsorted(bends, speed))

    def rates(t: float, y: Any) -> list[float]:
        a = (torques[piece] + slopes[piece] * (y[0] - speeds[piece]) + amplitude * np.sin(OMEGA * t)) / inertia
        return [a, ((slopes[piece] * a + amplitude * OMEGA * np.cos(OMEGA * t)) / inertia) ** 2]

    time, y = 0.0, [speed, 0.0]
    while time < T_END:
        ends = []
        for bend, way in ((piece - 1, -1), (piece, 1)):
            if 0 <= bend < len(bends):
                ends.append(lambda t, y, at=bends[bend]: y[0] - at)
                ends[-1].terminal, ends[-1].direction = True, way
        part = solve_ivp(rates, (time, T_END), y, method="DOP853", rtol=1e-13, atol=1e-13, events=ends, max_step=0.01)
        time, y = float(part.t[-1]), part.y[:, -1].tolist()
        piece += sum(int(end.direction) for end, found in zip(ends, part.t_events or [], strict=False) if len(found))
    return y[1]


@pytest.mark.random
def test_bends_of_a_curve_are_in_its_derivative() -> None:
    for seed in range(amount(12)):
        rng = np.random.default_rng([3031, seed])
        speeds = np.sort(rng.uniform(95.0, 150.0, 4)) + np.arange(4.0)
        curve = [(float(s), float(t)) for s, t in zip(speeds, rng.uniform(60.0, 140.0, 4), strict=True)]
        at = np.array([rng.uniform(20.0, 120.0), rng.uniform(90.0, 110.0), rng.uniform(0.5, 1.5)])
        by = ["t.torque.amplitude", "e.speed", "e.inertia"]
        model, of = pushed(curve, *map(float, at)), cw.squared_jerk("e")
        found = cw.differentiable(model, T_END, of=of, by=by, rtol=1e-9, atol=1e-11)
        values, matrix = found.value_and_jacobian(found.x0)
        assert values[0] == pytest.approx(integrated(curve, *map(float, at)), rel=1e-7), seed
        for number, size in enumerate(at):
            steps = [at + width * size * (np.arange(3) == number) for width in (-1e-4, 1e-4)]
            low, high = (integrated(curve, *map(float, one)) for one in steps)
            wanted = (high - low) / (2e-4 * size)
            assert matrix[0, number] == pytest.approx(wanted, rel=1e-4, abs=1e-4 * values[0] / size), (seed, number)


@pytest.mark.random
def test_a_ratio_that_varies_has_the_jerk_of_its_energy() -> None:
    """Two free inertias keep their energy, so the speed of the output follows from the ratio."""
    j1, j2 = 0.4, 1.5
    for seed in range(amount(12)):
        rng = np.random.default_rng([3032, seed])
        times = np.r_[0.0, np.sort(rng.uniform(0.1, 0.9, 3)), 1.0]
        ratios = rng.uniform(0.5, 4.0, 5)
        d = cw.Driveline("two")
        a, b = d.shaft("a", inertia=j1), d.shaft("b", inertia=j2, speed=50.0)
        d.add(
            cw.VariableRatio(
                "v", input=a, output=b, ratio=cw.Table(list(zip(times.tolist(), ratios.tolist(), strict=True)))
            )
        )
        level, wanted = 50.0 * np.sqrt(j1 * ratios[0] ** 2 + j2), 0.0
        for (t0, r0), (t1, r1) in pairwise(zip(times, ratios, strict=True)):
            places, weights = np.polynomial.legendre.leggauss(40)
            r = r0 + 0.5 * (r1 - r0) * (1.0 + places)
            whole = j1 * r * r + j2
            jerk = level * j1 * ((r1 - r0) / (t1 - t0)) ** 2 * (whole**-1.5 - 3.0 * j1 * r * r * whole**-2.5)
            wanted += 0.5 * (t1 - t0) * float(weights @ jerk**2)
        for rtol in (1e-6, 1e-9):
            found = cw.squared_jerk("b").of(d.simulate(1.0, rtol=rtol, atol=rtol / 100))
            assert found == pytest.approx(wanted, rel=100.0 * rtol), (seed, rtol)


def test_the_friction_of_a_pump_bends_where_its_pressure_difference_passes_zero() -> None:
    """The torque is straight before and behind, and so steep that a rounded bend would be far shorter than a step."""
    inertia, displacement, efficiency, rise, time, low = 0.05, 8e-6, 0.6, 2e6, 0.02, -6e5
    d = cw.Driveline("pump")
    s = d.shaft("s", inertia=inertia, speed=200.0)
    outlet = cw.Ramp(height=rise, duration=time, start=0.03, offset=low)
    values: dict[str, float] = {"displacement": displacement, "efficiency": efficiency, "slow": 1e-6}
    d.add(cw.PumpTorque("p", shaft=s, outlet=outlet, **values))
    d.add(cw.Torque("t", shaft=s, torque=5.0))
    found = cw.differentiable(d, 0.1, of=cw.squared_jerk("s"), by=["p.outlet.offset"])
    value, matrix = found.value_and_jacobian(found.x0)
    slope = rise / time
    below, above = (
        (displacement * slope * share / (2.0 * np.pi * inertia)) ** 2
        for share in (2.0 - 1.0 / efficiency, 1.0 / efficiency)
    )
    assert value[0] == pytest.approx(below * -low / slope + above * (time + low / slope), rel=1e-9)
    assert matrix[0, 0] == pytest.approx((above - below) / slope, rel=1e-6)


def test_a_prescribed_speed_that_bends_has_no_jerk_but_between_its_bends() -> None:
    """The acceleration of a speed in straight lines jumps; the rows have both sides of each jump."""
    d = cw.Driveline("lines")
    a, b = d.shaft("a", inertia=1.0, speed=None), d.shaft("b", inertia=0.5)
    d.add(cw.PrescribedSpeed("p", shaft=a, speed=cw.Table([(0.0, 0.0), (0.3, 30.0), (0.5, 10.0), (1.0, 60.0)])))
    d.add(cw.Gear("g", input=a, output=b, ratio=2.0))
    run = d.simulate(1.0)
    assert cw.squared_jerk("a").of(run) < 1e-12
    assert cw.squared_jerk("b").of(run) < 1e-12
    for time, before, behind in ((0.3, 100.0, -100.0), (0.5, -100.0, 100.0)):
        np.testing.assert_allclose(run["a.acceleration"][run.time == time], [before, behind], rtol=1e-9)


def launch() -> cw.Driveline:
    """A clutch that locks just before the end, a bearing that holds at first: steps as short as round-off."""
    d = cw.Driveline("launch")
    e, g, w = d.shaft("e", inertia=0.2, speed=100.0), d.shaft("g", inertia=0.05), d.shaft("l", inertia=0.8)
    law, p = cw.Stribeck(static=0.14, kinetic=0.1, speed=5.0), cw.Table([(0, 1e4), (0.2, 1.8e5), (1, 1.8e5)])
    d.add(cw.Clutch("c", base=e, follower=g, friction=law, gain=5e-4, pressure=p))
    d.add(cw.SpringDamper("k", base=g, follower=w, stiffness=2e3, damping=4.0))
    d.add(cw.BearingFriction("b", shaft=w, friction=cw.Coulomb(static=1.2, kinetic=1.0), torque=3.0))
    return d


@pytest.mark.parametrize("rtol", [1e-6, 1e-7, 1e-8, 1e-9, 1e-10])
def test_steps_as_short_as_round_off_add_nothing(rtol: float) -> None:
    found = cw.sweep(launch(), 2.0, vary=[{}], outputs={"j": cw.squared_jerk("l")}, rtol=rtol, atol=rtol / 100)
    # that of a run at 1e-12
    assert float(found["j"].ravel()[0]) == pytest.approx(5922.4725, rel=max(10.0 * rtol, 1e-7))


def events(run: cw.Trajectory) -> list[tuple[str, str, str]]:
    return [(event.element, event.before, event.after) for event in run.events]


@pytest.mark.random
@pytest.mark.parametrize("kind", ["parts", "clutches", "laws"])
def test_one_value_that_converges(kind: str) -> None:
    """Sweep, run, function and gradient have one value, not below zero, with more digits at a tighter tolerance."""
    compared = 0
    for seed in range(amount(8)):
        model, t_end = gradient_cases.KINDS[kind](seed)
        rng = np.random.default_rng([3033, seed])
        # signs that chatter have another motion at any tolerance
        if "naive_sign" in getattr(model, "name", ""):
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            options: dict[str, Any] = {"rtol": SMALL, "atol": SMALL / 100, "method": "rodas5p"}
            run = cw.simulate(model, t_end, **options)
            if not run.finished:
                continue
            node = str(rng.choice([one.name for one in run.system.nodes if not one.fixed]))
            of = cw.squared_jerk(node)
            value = of.of(run)
            assert value >= 0.0
            swept = cw.sweep(model, t_end, vary=[{}], outputs={"j": of}, **options)
            assert float(swept["j"].ravel()[0]) == pytest.approx(value, rel=1e-9, abs=1e-300)
            by = next(f"{one.name}.inertia" for one in run.system.nodes if not one.fixed and one.inertia > 0.0)
            function = cw.differentiable(model, t_end, of=of, by=by, **options)
            plain = float(function(function.x0)[0])
            assert plain == pytest.approx(value, rel=1e-9, abs=1e-300)
            tight = cw.simulate(model, t_end, rtol=1e-3 * SMALL, atol=1e-5 * SMALL, method="rodas5p")
            if events(tight) != events(run):
                continue
            assert value == pytest.approx(of.of(tight), rel=1e-4), (seed, node)
            try:
                found = cw.differentiable(model, t_end, of=of, by=by, **options).value_and_jacobian(function.x0)[0]
                assert float(found[0]) == plain
            except cw.NoGradient:
                continue
            compared += 1
    assert compared > 0


def struck(*points: tuple[float, float]) -> cw.Driveline:
    """A shaft under a torque over time."""
    d = cw.Driveline("struck")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=0.2, speed=5.0), torque=cw.Table(list(points))))
    return d


@pytest.mark.parametrize("number", ["times[2]", "values[2]"])
def test_a_jerk_by_a_knot_on_its_grid_has_two_sides(number: str) -> None:
    """A speed bends where a torque jumps, so speeds at that instant have one derivative before and one behind it."""
    d, by = struck((0.0, 0.0), (0.5, 1.0), (0.5, -6.0), (0.7, -6.0)), f"t.torque.{number}"
    f = cw.differentiable(d, 1.0, of=cw.jerk("a"), by=by, rtol=1e-12, atol=1e-14)
    for side, step in (("left", -1e-6), ("right", 1e-6)):
        found = cw.differentiable(d, 1.0, of=cw.jerk("a"), by=by, side=side).gradient().matrix[0, 0]
        assert found == pytest.approx((f(f.x0 + step)[0] - f(f.x0)[0]) / step, rel=1e-4)
    if number == "times[2]":
        with pytest.raises(cw.NoGradient, match=r"compares speeds at 0\.5 s, where a signal jumps whose knot moves"):
            f.gradient()
    else:
        assert f.gradient().problems == ()


def test_a_jerk_at_an_event_on_its_grid_has_two_sides() -> None:
    """A clutch locks at an instant of the grid, where the speed bends."""
    d = cw.Driveline("locks")
    a = d.shaft("a", inertia=1.0, speed=4.0)
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Brake("b", shaft=a, friction=law, gain=1.0, normal_force=80.0))
    f = cw.differentiable(d, 1.0, of=cw.jerk("a"), by="a.speed", rtol=1e-9, atol=1e-11)
    with pytest.raises(cw.NoGradient, match=r"compares speeds at 0\.5 s, where an event is that moves"):
        f.gradient()
    for side, step in (("left", -1e-5), ("right", 1e-5)):
        found = cw.differentiable(d, 1.0, of=cw.jerk("a"), by="a.speed", side=side, rtol=1e-9).gradient().matrix[0, 0]
        assert found == pytest.approx((f(f.x0 + step)[0] - f(f.x0)[0]) / step, rel=1e-3)


@pytest.mark.parametrize(("number", "sides"), [(3, (12.5, 87.5)), (4, (12.5, 87.5))])
def test_two_equal_jerks_have_a_derivative_for_each_side(number: int, sides: tuple[float, float]) -> None:
    d, by = struck((0.0, 0.0), (0.3, 0.0), (0.3, 5.0), (0.5, 5.0), (0.5, 0.0), (0.7, 0.0)), f"t.torque.values[{number}]"
    with pytest.raises(cw.NoGradient, match=r"is reached at 0\.3 s and at 0\.5 s"):
        cw.differentiable(d, 1.0, of=cw.jerk("a"), by=by).gradient()
    for side, wanted in zip(("left", "right"), sides, strict=True):
        found = cw.differentiable(d, 1.0, of=cw.jerk("a"), by=by, side=side).gradient()
        assert found.matrix[0, 0] == pytest.approx(wanted, rel=1e-6)


def test_a_jerk_that_stays_has_one_derivative() -> None:
    """Of a torque that rises all windows are equal, and their jerks change alike."""
    d = struck((0.0, 0.0), (1.0, 4.0))
    found = cw.differentiable(d, 1.0, of=cw.jerk("a"), by=["a.inertia", "t.torque.values[2]"]).gradient()
    assert found.problems == ()
    np.testing.assert_allclose(found.matrix[0], [-20.0 / 0.2, 5.0], rtol=1e-6)
