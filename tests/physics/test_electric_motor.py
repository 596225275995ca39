"""The electric motor in four quadrants: envelope, lag before the clip, losses, derating; closed forms and SciPy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import clutchwork as cw

FINE = {"rtol": 1e-9, "atol": 1e-11}
DRIVES, BRAKES = [(0.0, 200.0), (100.0, 180.0), (300.0, 60.0)], [(0.0, 150.0), (300.0, 90.0)]
MOTOR, GENERATOR = 2e4, 1.5e4
POLYNOMIAL = {"no_load_loss": 20.0, "drag_loss": 0.3, "iron_loss": 2e-3, "copper_loss": 0.02}
SPEEDS, TORQUES = (10.0, 100.0, 300.0), (20.0, 100.0, 200.0)
ETA = ((0.6, 0.7, 0.65), (0.8, 0.9, 0.92), (0.85, 0.95, 0.93))
WATTS = ((5.0, 90.0, 300.0), (20.0, 120.0, 380.0), (60.0, 200.0, 500.0))
ENVELOPE = {
    "max_torque": DRIVES,
    "max_power": MOTOR,
    "generator_torque": BRAKES,
    "generator_power": GENERATOR,
}


def _limits(w, share=1.0):
    """Least and largest torque at a speed."""

    def most(points, power):
        return share * min(np.interp(abs(w), *zip(*points, strict=True)), power / max(abs(w), 1e-9))

    drives, brakes = most(DRIVES, MOTOR), most(BRAKES, GENERATOR)
    return (-brakes, drives) if w >= 0.0 else (-drives, brakes)


def _loss(w, torque):
    p = POLYNOMIAL
    polynomial = p["no_load_loss"] + p["drag_loss"] * abs(w) + p["iron_loss"] * w**2
    return polynomial + p["copper_loss"] * torque**2


def _bilinear(table, w, torque):
    across = [np.interp(abs(torque), TORQUES, row) for row in table]
    return float(np.interp(abs(w), SPEEDS, across))


def _driveline(speed, command, inertia=0.5, **more):
    d = cw.Driveline()
    d.add(cw.ElectricMotor("m", shaft=d.shaft("s", inertia=inertia, speed=speed), command=command, **more))
    return d


def _prescribed(w0, w1, command, **more):
    d = cw.Driveline()
    shaft = d.shaft("s")
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=cw.Ramp(height=w1 - w0, duration=1.0, offset=w0)))
    d.add(cw.ElectricMotor("m", shaft=shaft, command=command, **more))
    return d.simulate(1.0, times=np.linspace(0.0, 1.0, 301), **FINE)


@pytest.mark.parametrize("command", [900.0, 70.0, -70.0, -900.0])
def test_envelope_holds_in_four_quadrants(command):
    run = _prescribed(-400.0, 400.0, command, **ENVELOPE, **POLYNOMIAL)
    w, torque = run["s.speed"], run["m.torque"]
    # a speed that is zero to round-off stands between two quadrants
    moving = np.abs(w) > 1e-6
    known = np.array([np.clip(command, *_limits(x)) for x in w])
    np.testing.assert_allclose(torque[moving], known[moving], rtol=1e-12)
    loss = np.array([_loss(*pair) for pair in zip(w, torque, strict=True)])
    # what it draws is work and losses
    np.testing.assert_allclose(run["m.electric_power"], torque * w + loss, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(run["m.power"], torque * w, rtol=1e-12, atol=1e-9)
    assert run.units["m.electric_power"] == "W"


@pytest.mark.parametrize("command", [150.0, -150.0])
@pytest.mark.parametrize("sort", ["efficiencies", "losses"])
def test_losses_of_a_map(command, sort):
    table = ETA if sort == "efficiencies" else WATTS
    axes = {"speeds": SPEEDS, "torques": TORQUES}
    run = _prescribed(-350.0, 350.0, command, **ENVELOPE, no_load_loss=20.0, **axes, **{sort: table})
    for w, torque, drawn in zip(run["s.speed"], run["m.torque"], run["m.electric_power"], strict=True):
        power, found = torque * w, _bilinear(table, w, torque)
        drawn_by_eta = power / found if power > 0.0 else power * found
        known = 20.0 + (power + found if sort == "losses" else drawn_by_eta)
        assert drawn == pytest.approx(known, rel=1e-10, abs=1e-7)


def test_the_command_lags_first_and_is_clipped_then():
    """So it leaves its limit late, when what has come through is below it."""
    lag, limit = 0.1, 100.0
    command = cw.Table([(0.0, 250.0), (0.5, 250.0), (0.5, 0.0)])
    times = np.linspace(0.0, 1.0, 1001)
    run = _driveline(0.0, command, max_torque=limit, lag=lag).simulate(1.0, times=times, **FINE)
    request = np.where(
        times < 0.5,
        250.0 * (1 - np.exp(-times / lag)),
        250.0 * (1 - math.exp(-0.5 / lag)) * np.exp(-(times - 0.5) / lag),
    )
    np.testing.assert_allclose(run["m.request"], request, atol=1e-6)
    np.testing.assert_allclose(run["m.torque"], np.minimum(request, limit), atol=1e-6)
    # the impulse: limit between both instants, exponentials outside of them
    on, off = -lag * math.log(1 - limit / 250.0), 0.5 + lag * math.log(250.0 * (1 - math.exp(-0.5 / lag)) / limit)
    before = 250.0 * (on - lag * (1 - math.exp(-on / lag)))
    after = limit * lag * (1 - math.exp(-(1.0 - off) / lag))
    assert run["s.speed"][-1] == pytest.approx((before + limit * (off - on) + after) / 0.5, rel=1e-9)


def test_energy_that_it_draws_is_work_and_heat():
    d = _driveline(150.0, cw.Sine(amplitude=260.0, frequency=0.7), lag=0.03, **ENVELOPE, **POLYNOMIAL)
    run = d.simulate(3.0, times=np.linspace(0.0, 3.0, 30001), **FINE)
    energy, drawn = run.energy, run["m.electric_energy"]
    assert abs(energy.residual) <= 1e-8 * energy.turnover
    assert energy.sources["m"] == drawn[-1]
    assert energy.sources["m"] - energy.heat["m"] == pytest.approx(energy.kinetic, rel=1e-8)
    # trapezoids of 0.1 ms
    power = run["m.electric_power"]
    known = np.concatenate([[0.0], np.cumsum(np.diff(run.time) * 0.5 * (power[1:] + power[:-1]))])
    np.testing.assert_allclose(drawn, known, atol=1e-6 * np.ptp(known))
    assert run["m.electric_power"].min() < 0.0 < run["m.electric_power"].max()


def test_steady_temperature_under_derating():
    """C dT/dt = copper loss - G (T - ambient), with the torque that is left: a root of one variable."""
    derating, ambient, cooling = [(320.0, 1.0), (420.0, 0.0)], 300.0, 4.0
    d = cw.Driveline()
    shaft = d.shaft("s")
    d.add(cw.PrescribedSpeed("drive", shaft=shaft, speed=50.0))
    d.add(
        cw.ElectricMotor(
            "m",
            shaft=shaft,
            command=1e3,
            max_torque=100.0,
            copper_loss=0.08,
            derating=derating,
            thermal_mass=50.0,
            cooling=cooling,
            ambient=ambient,
        )
    )
    run = d.simulate(300.0, **FINE)

    def torque(warm):
        return 100.0 * np.interp(warm, *zip(*derating, strict=True))

    warm = brentq(lambda x: 0.08 * torque(x) ** 2 - cooling * (x - ambient), 320.0, 420.0, xtol=1e-12)
    assert run["m.temperature"][-1] == pytest.approx(warm, rel=1e-9)
    assert run["m.torque"][-1] == pytest.approx(torque(warm), rel=1e-7)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover


@pytest.mark.parametrize("seed", range(6))
def test_random_motors_against_scipy(seed):
    g = np.random.default_rng(seed)
    lag, inertia, w0 = g.uniform(0.01, 0.2), g.uniform(0.2, 1.0), g.uniform(-250.0, 250.0)
    amplitude, frequency, phase = g.uniform(50.0, 400.0), g.uniform(0.3, 2.0), g.uniform(0.0, 6.0)
    mass, cooling = g.uniform(20.0, 60.0), g.uniform(1.0, 10.0)
    derating = [(310.0, 1.0), (350.0, 0.7), (420.0, 0.2)]
    command = cw.Sine(amplitude=amplitude, frequency=frequency, phase=phase)
    more = {"thermal_mass": mass, "cooling": cooling, "ambient": 300.0, "derating": derating, "lag": lag}
    run = _driveline(w0, command, inertia, **ENVELOPE, **POLYNOMIAL, **more).simulate(
        2.0, times=np.linspace(0.0, 2.0, 101), **FINE
    )
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover

    def slope(t, y):
        w, request, warm = y
        torque = float(np.clip(request, *_limits(w, np.interp(warm, *zip(*derating, strict=True)))))
        wanted = amplitude * math.sin(2 * math.pi * frequency * t + phase)
        return torque / inertia, (wanted - request) / lag, (_loss(w, torque) - cooling * (warm - 300.0)) / mass

    known = solve_ivp(
        slope, (0.0, 2.0), (w0, 0.0, 300.0), t_eval=run.time, rtol=1e-10, atol=1e-10, max_step=2e-3, method="DOP853"
    )
    # steps of 2 ms across kinks leave some 1e-6 of full scale
    np.testing.assert_allclose(run["s.speed"], known.y[0], atol=1e-6 * np.abs(known.y[0]).max())
    np.testing.assert_allclose(run["m.request"], known.y[1], atol=1e-6 * np.abs(known.y[1]).max())
    np.testing.assert_allclose(run["m.temperature"], known.y[2], atol=1e-6 * 300.0)


def test_a_motor_without_limits_that_can_be_reached_is_a_torque():
    run = _driveline(0.0, 12.0, max_torque=1e6).simulate(2.0, **FINE)
    assert run["s.speed"][-1] == pytest.approx(48.0, rel=1e-12)
    assert "m.request" not in run.names
    assert run["m.electric_energy"][-1] == pytest.approx(run["m.work"][-1], rel=1e-12)


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("brakes", [0.0, 10.0, 30.0])
def test_from_rest_either_way_drives(way, brakes):
    """A brake of 15 N m gives way to the 20 N m of the motor, whatever its generator can do."""
    d = cw.Driveline("stall")
    s = d.shaft("s", inertia=1.0)
    grip = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Brake("b", shaft=s, friction=grip, gain=1.0, normal_force=15.0, locked=True))
    d.add(cw.ElectricMotor("m", shaft=s, command=way * 50.0, max_torque=20.0, generator_torque=brakes))
    run = d.simulate(1.0)
    assert run["s.speed"][-1] == pytest.approx(way * 5.0, rel=1e-9)
    assert run["m.torque"][0] == way * 20.0


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_held_at_rest_it_drives_whichever_way_its_command_turns(way):
    d = cw.Driveline("held")
    s = d.shaft("s", inertia=1.0)
    grip = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(cw.Brake("b", shaft=s, friction=grip, gain=1.0, normal_force=30.0, locked=True))
    command = cw.Table([(0.0, way * 5.0), (1.0, -way * 50.0), (1.0, way * 50.0), (2.0, -way * 15.0)])
    d.add(cw.ElectricMotor("m", shaft=s, command=command, max_torque=20.0, generator_torque=10.0))
    run = d.simulate(2.0, times=[0.0, 0.5, 0.99, 1.01, 2.0])
    assert run["m.torque"] == pytest.approx(way * np.array([5.0, -20.0, -20.0, 20.0, -15.0]), rel=1e-12)


@pytest.mark.parametrize("beside", [0.0, 4e4])
@pytest.mark.parametrize("load", [30.0, 31.7, 34.0, 40.0])
@pytest.mark.parametrize("brakes", [20.0, 33.3, 50.0, 100.0])
@pytest.mark.parametrize("speed", [5.0, -5.0, 7.7])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_what_comes_to_rest_in_friction_is_held_there_while_it_drives(way, speed, brakes, load, beside):
    """Its torque jumps there; the speed at which it arrives is round-off, more of it beside a fast shaft."""
    d, asked, friction, inertia = cw.Driveline("rests"), 74.0, 50.0, 0.1
    s = d.shaft("s", inertia=inertia, speed=way * speed)
    d.shaft("beside", inertia=1.0, speed=beside)
    d.add(cw.Torque("t", shaft=s, torque=way * load))
    d.add(cw.BearingFriction("b", shaft=s, torque=friction, friction=cw.Coulomb(static=1.0, kinetic=1.0)))
    d.add(cw.ElectricMotor("m", shaft=s, command=-way * asked, max_torque=100.0, generator_torque=brakes))
    run = d.simulate(1.0, rtol=1e-6)
    assert run.status == "done"
    drive = load - friction - min(asked, brakes) if speed > 0.0 else load + friction - asked
    (rest,) = run.events
    assert (rest.after, rest.time) == ("locked", pytest.approx(-speed * inertia / drive, rel=1e-9))
    later = run.time > rest.time
    assert run["m.torque"][later] == pytest.approx(np.full(later.sum(), -way * asked), rel=1e-12)
    assert run["b.torque"][later] == pytest.approx(np.full(later.sum(), way * (asked - load)), rel=1e-12)
    assert np.all(run["s.speed"][later] == 0.0)


@pytest.mark.parametrize(("speed", "beside"), [(5e-11, 0.0), (-5e-11, 0.0), (1e-6, 4e4), (-1e-6, 4e4)])
@pytest.mark.parametrize("brakes", [20.0, 50.0])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_what_moves_less_than_counts_is_at_rest_and_it_drives(way, brakes, speed, beside):
    d, asked, load = cw.Driveline("rests"), 74.0, 30.0
    s = d.shaft("s", inertia=0.1, speed=way * speed)
    d.shaft("beside", inertia=1.0, speed=beside)
    d.add(cw.Torque("t", shaft=s, torque=way * load))
    d.add(cw.BearingFriction("b", shaft=s, torque=50.0, friction=cw.Coulomb(static=1.0, kinetic=1.0)))
    d.add(cw.ElectricMotor("m", shaft=s, command=-way * asked, max_torque=100.0, generator_torque=brakes))
    run = d.simulate(1.0)
    assert run.status == "done"
    assert run["m.torque"] == pytest.approx(np.full(len(run.time), -way * asked), rel=1e-12)
    assert run["b.torque"] == pytest.approx(np.full(len(run.time), way * (asked - load)), rel=1e-12)


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("point", [12.0, 15.0, 19.0])
def test_held_at_rest_it_drives_beyond_a_point_of_its_losses(way, point):
    """Its torque passes a point of the table beyond what its generator can do."""
    d = cw.Driveline("held")
    s = d.shaft("s")
    d.add(cw.PrescribedSpeed("still", shaft=s, speed=0.0))
    limits = {"max_torque": 20.0, "generator_torque": 10.0}
    axes = {"speeds": SPEEDS, "torques": (5.0, point, 100.0), "losses": WATTS}
    d.add(cw.ElectricMotor("m", shaft=s, command=cw.Ramp(height=way * 40.0, duration=1.0), **limits, **axes))
    run = d.simulate(1.0)
    # ends of pieces are found to 1e-12
    assert run["m.torque"] == pytest.approx(way * np.minimum(40.0 * run.time, 20.0), rel=1e-11)


@pytest.mark.parametrize("start", [10.0, 7.3, 1.9])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_it_passes_rest_where_its_torque_falls_past_a_point_of_its_losses(way, start):
    """It drives with 3 N m and brakes with 2 N m; its losses have a point at 2.5 N m."""
    d, load, inertia = cw.Driveline("passes"), 8.0, 0.5
    s = d.shaft("s", inertia=inertia, speed=way * start)
    d.add(cw.Torque("t", shaft=s, torque=-way * load))
    losses = {"speeds": (0.0, 300.0), "torques": (0.0, 2.5, 4.0), "losses": ((0.0, 10.0, 40.0), (0.0, 10.0, 40.0))}
    d.add(cw.ElectricMotor("m", shaft=s, command=way * 10.0, max_torque=3.0, generator_torque=2.0, **losses))
    rest = start * inertia / (load - 3.0)
    run = d.simulate(rest + 1.0, times=[rest + 1.0])
    assert run["s.speed"][-1] == pytest.approx(-way * (load - 2.0) / inertia, rel=1e-9)


@pytest.mark.parametrize("method", ["rodas5p", "dopri5"])
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_driven_from_rest_against_its_command_it_brakes_at_once(way, method):
    """The limit at rest is that of the side to which it moves: nothing jumps in the first step."""
    d, load, brakes, inertia = cw.Driveline("driven"), 5.0, 2.0, 0.5
    s = d.shaft("s", inertia=inertia)
    d.add(cw.Torque("t", shaft=s, torque=way * load))
    d.add(cw.ElectricMotor("m", shaft=s, command=-way * 10.0, max_torque=3.0, generator_torque=brakes))
    run = d.simulate(1.0, method=method)
    rate = way * (load - brakes) / inertia
    assert run["s.acceleration"] == pytest.approx(np.full(len(run.time), rate), rel=1e-12)
    assert run["s.speed"][-1] == pytest.approx(rate, rel=1e-12)
    assert cw.squared_jerk("s").of(run) == 0.0


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_driven_from_rest_it_loses_what_its_torque_there_does(way):
    """The first row of a grid has the loss of the side to which it moves, not that of what it would drive with."""
    d, watts = cw.Driveline("driven"), ((0.0, 10.0, 40.0), (0.0, 10.0, 40.0))
    s = d.shaft("s", inertia=0.5)
    d.add(cw.Torque("t", shaft=s, torque=way * 5.0))
    lost = {"speeds": (0.0, 300.0), "torques": (0.0, 2.5, 4.0), "losses": watts}
    d.add(cw.ElectricMotor("m", shaft=s, command=-way * 10.0, max_torque=3.0, generator_torque=2.0, **lost))
    run = d.simulate(1.0, times=[0.0, 1.0])
    assert run["m.electric_power"] == pytest.approx([8.0, 8.0 - 2.0 * 6.0], rel=1e-9)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"max_torque": [(-10.0, 5.0), (10.0, 5.0)]}, r"starts at -10"),
        ({"max_torque": "100 bar"}, r"has a unit that does not fit; give it in \[N m\]"),
        ({"losses": ((1.0,),)}, r"needs speeds and torques"),
        ({"speeds": SPEEDS, "torques": TORQUES}, r"belongs to a map"),
        ({"speeds": SPEEDS, "torques": TORQUES, "losses": ((1.0, 2.0),)}, r"must have 3 rows of 3 numbers"),
        ({"speeds": (0.0,), "torques": (1.0,), "efficiencies": ((1.2,),)}, r"exceeds 1"),
        ({"derating": [(300.0, 1.0)]}, r"has no temperature"),
        ({"cooling": 2.0}, r"needs a winding of its own"),
    ],
    ids=str,
)
def test_mistakes_are_named(values, words):
    with pytest.raises(cw.ModelError, match=words):
        _driveline(0.0, 1.0, **({"max_torque": 100.0} | values)).assemble()


@pytest.mark.parametrize("share", [0.0, 1.2])
def test_efficiencies_of_the_torque_alone_are_checked(share: float) -> None:
    """An efficiency of zero loses without bound: 0 W over 0 at rest."""
    d = cw.Driveline("rest")
    motor = {"speeds": [0.0, 5.0], "motoring": [12.0, 8.0], "generating": [9.0, 9.0], "torques": [0.0, 6.0]}
    motor |= {"map": [[share, 0.5], [0.8, 0.9]], "map_of": "efficiencies", "derating": [[400.0, 0.8]], "command": 4.0}
    d.add(cw.MotorTorque("motor", shaft=d.shaft("shaft", inertia=1.0), **motor))
    with pytest.raises(cw.ModelError, match=rf"has the efficiency {share:g}; give efficiencies above 0"):
        d.assemble()
