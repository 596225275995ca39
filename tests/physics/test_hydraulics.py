"""Oil, pumps, valves, accumulators and pistons: closed forms, energies that close, a clutch that a pump engages."""

from __future__ import annotations

from math import log10, pi, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import clutchwork as cw

RHO, NU = 810.0, 9e-6  # kg/m3, m2/s: the defaults
FLUID = {"viscosity_40": 30e-6, "viscosity_100": 6e-6}
CD, RE = 0.7, 12.0
CLEARANCE = 5e-3
BULK = 1.4e9  # Pa


def bench(speed: float = 1.0) -> tuple[cw.Driveline, cw.Node]:
    """A shaft that keeps its speed, so that a model has something that moves."""
    d = cw.Driveline("oil")
    return d, d.shaft("shaft", inertia=1.0, speed=speed)


def orifice_flow(area: float, drop: float, rho: float = RHO, nu: float = NU) -> float:
    """Written anew from the Reynolds number: below the transition a line, above it a root."""
    diameter = sqrt(4.0 * area / pi)
    laminar = 0.5 * rho * (RE * nu / (CD * diameter)) ** 2 + 1.0
    return CD * area * sqrt(2.0 / rho) * drop / (drop**2 + laminar**2) ** 0.25


def test_oil_follows_its_temperature() -> None:
    """The line of Walther goes through both viscosities, and is straight in between."""
    oil = cw.HydraulicOil("oil", temperature=353.15, viscosity_40=32e-6, viscosity_100=6.2e-6)
    assert oil.at(313.15)[0] == pytest.approx(32e-6, rel=1e-12)
    assert oil.at(373.15)[0] == pytest.approx(6.2e-6, rel=1e-12)
    ends = [log10(log10(1e6 * oil.at(t)[0] + 0.7)) for t in (313.15, 342.0, 373.15)]
    share = (log10(342.0) - log10(313.15)) / (log10(373.15) - log10(313.15))
    assert ends[1] == pytest.approx(ends[0] + share * (ends[2] - ends[0]), rel=1e-12)
    d, _ = bench()
    d.add(cw.HydraulicOil("oil", temperature=cw.Step(height=-40.0, start=0.5, offset=363.15), lag=0.05, **FLUID))
    run = d.simulate(1.0)
    made = cw.HydraulicOil("oil", **FLUID)
    assert run["oil.viscosity"][0] == pytest.approx(made.at(363.15)[0], rel=1e-12)
    # ten lags later, to the tolerance of the run
    assert run["oil.viscosity"][-1] == pytest.approx(made.at(323.15)[0], rel=1e-4)
    assert run["oil.density"][-1] == pytest.approx(850.0 * (1.0 - 7.5e-4 * 35.0), rel=1e-5)
    # nothing moves before the step
    assert np.ptp(run["oil.viscosity"][run.time < 0.5]) < 1e-14


@pytest.mark.parametrize("drop", [-8e5, 50.0, 3e3, 1e6])
@pytest.mark.parametrize("nu", [9e-6, 300e-6])
def test_flow_through_an_orifice(drop: float, nu: float) -> None:
    d, _ = bench()
    d.add(cw.Orifice("bore", inlet=2e6 + drop, outlet=2e6, area=3e-6, viscosity=nu))
    run = d.simulate(1.0)
    # a constant rate is integrated exactly
    assert run["bore.loss"][-1] == pytest.approx(orifice_flow(3e-6, drop, nu=nu) * drop, rel=1e-9)


def test_a_turbulent_orifice_is_that_of_bernoulli_and_a_laminar_one_a_line() -> None:
    turbulent = orifice_flow(3e-6, 1e6)
    assert turbulent == pytest.approx(CD * 3e-6 * sqrt(2e6 / RHO), rel=1e-4)
    assert orifice_flow(3e-6, 2.0, nu=3e-4) == pytest.approx(2.0 * orifice_flow(3e-6, 1.0, nu=3e-4), rel=1e-6)


def test_a_volume_that_is_filled() -> None:
    """Without air the pressure rises in proportion to the oil, and the work is that of a spring."""
    d, _ = bench()
    d.add(cw.OilVolume("line", volume=2e-4, air=0.0, inflow=1e-6))
    run = d.simulate(1.0)
    assert run["line.pressure"] == pytest.approx(BULK / 2e-4 * 1e-6 * run.time, rel=1e-9)
    assert run["line.energy"][-1] == pytest.approx(0.5 * 2e-4 / BULK * run["line.pressure"][-1] ** 2, rel=1e-9)


def test_air_makes_it_soft() -> None:
    """The oil that goes in is what oil and air give way by, at constant temperature."""
    d, _ = bench()
    d.add(cw.OilVolume("line", volume=2e-4, air=0.02, inflow=2e-6))
    run = d.simulate(2.0)
    p = run["line.pressure"]
    given = 2e-4 * (p / BULK + 0.02 * (1.0 - 101325.0 / (p + 101325.0)))
    # the tolerance of the run
    assert given == pytest.approx(2e-6 * run.time, rel=1e-5, abs=1e-11)


def test_a_volume_that_empties_through_an_orifice() -> None:
    """The root of the pressure falls in proportion to the time while the flow is turbulent."""
    d, _ = bench()
    line = d.add(cw.OilVolume("line", volume=1e-2, air=0.0, initial_pressure=2e6))
    d.add(cw.Orifice("bore", inlet=line, area=1e-5, transition=1e-6))
    run = d.simulate(0.05, rtol=1e-9)
    slope = CD * 1e-5 * sqrt(2.0 / RHO) * BULK / 1e-2
    assert np.sqrt(run["line.pressure"]) == pytest.approx(sqrt(2e6) - 0.5 * slope * run.time, rel=1e-7)


def pumped(**more: Any) -> tuple[cw.Driveline, cw.OilVolume]:
    """A pump that a prescribed shaft drives, a line and a relief valve."""
    d = cw.Driveline("pump")
    shaft = d.shaft("shaft", inertia=0.1)
    d.add(cw.PrescribedSpeed("motor", shaft=shaft, speed=150.0))
    line = d.add(cw.OilVolume("line", volume=2e-4))
    values = {"displacement": 2e-5, "efficiency": 0.88, "drag": 0.01, "leakage": 4e-14}
    d.add(cw.Pump("pump", shaft=shaft, outlet=line, **values))
    d.add(cw.ReliefValve("relief", inlet=line, **{"command": 1.5e6, "span": 1e5, "area": 4e-5, **more}))
    return d, line


def relieved(pressure: float, setting: float = 1.5e6) -> float:
    """Flow through that valve."""
    way = min(1.0, (pressure - setting) / 1e5)
    return orifice_flow(4e-5 * 0.5 * (way + sqrt(way**2 + CLEARANCE**2)), pressure)


def test_line_pressure_without_demand_is_that_of_the_relief_valve() -> None:
    d, _ = pumped()
    run = d.simulate(0.5)
    q = 2e-5 * 150.0 / (2.0 * pi)
    expected = brentq(lambda p: q - 4e-14 * p / (RHO * NU) - relieved(p), 1e6, 2e6, xtol=1e-3)
    assert 1.5e6 < expected < 1.6e6
    assert run["line.pressure"][-1] == pytest.approx(expected, rel=1e-6)
    # p D/(2 pi eta) and the drag; friction is full far above 5 rad/s
    ideal, friction = 2e-5 / (2.0 * pi) * expected, 150.0 / sqrt(150.0**2 + 25.0)
    torque = ideal * (1.0 + (1.0 / 0.88 - 1.0) * friction) + 0.01 * 150.0
    assert run["pump.torque"][-1] == pytest.approx(-torque, rel=1e-6)


def test_line_pressure_falls_where_more_is_wanted_than_delivered() -> None:
    d, line = pumped()
    d.add(cw.Orifice("leak", inlet=line, area=3e-5))
    run = d.simulate(0.5)
    q = 2e-5 * 150.0 / (2.0 * pi)
    expected = brentq(lambda p: q - 4e-14 * p / (RHO * NU) - relieved(p) - orifice_flow(3e-5, p), 1e4, 1.5e6, xtol=1e-3)
    assert expected < 5e5
    assert run["line.pressure"][-1] == pytest.approx(expected, rel=1e-6)


def test_line_pressure_follows_its_command() -> None:
    d, _ = pumped(command=cw.Step(height=8e5, start=0.3, offset=6e5), lag=0.01)
    run = d.simulate(0.6)
    before, after = run["line.pressure"][run.time < 0.3][-1], run["line.pressure"][-1]
    # within the span of the valve
    assert 6e5 < before < 7e5
    assert 14e5 < after < 15e5


PISTON = {"piston_area": 6e-3, "preload": 400.0, "spring_rate": 1.5e5, "kiss_stroke": 2e-3, "contact_rate": 5e6}


@pytest.mark.parametrize("volume", [0.0, 1e-5])
def test_a_piston_takes_its_oil_from_a_volume(volume: float) -> None:
    """A volume so large that its pressure stays fills it in the time of the closed form; what it lost is in it."""
    d, _ = bench()
    tank = d.add(cw.OilVolume("tank", volume=50.0, air=0.0, initial_pressure=6e5))
    piston = cw.ClutchActuator("piston", supply_pressure=tank, orifice_area=4e-6, volume=volume, **PISTON)
    d.add(piston)
    run = d.simulate(0.5, rtol=1e-9)
    closed = run.time[run["piston.force"] > 0.0][0]
    if not volume:
        # the laminar part of the orifice and the step of the output grid
        assert closed == pytest.approx(piston.fill_time(6e5), abs=2e-3)
    stroke = 2e-3 + run["piston.force"][-1] / 5e6
    held = 6e-3 * stroke + volume / BULK * run["piston.pressure"][-1]
    lost = (6e5 - run["tank.pressure"][-1]) * 50.0 / BULK
    # the tank loses 200 Pa in a pressure of 6e5, which has 16 digits
    assert lost == pytest.approx(held, rel=1e-6)
    gained = piston.stored([run[f"piston.{name}"][-1] for name in ("force", "pressure")]) - piston.stored((-1e4, 0.0))
    assert -run["tank.energy"][-1] == pytest.approx(run["piston.loss"][-1] + gained, rel=1e-6)


@pytest.mark.parametrize("against", ["gas", "spring"])
def test_an_accumulator_gives_back_its_oil(against: str) -> None:
    """A constant flow out of it: the pressure at each time is that of the oil which is left, down to the precharge."""
    d, _ = bench()
    values: dict[str, Any] = {"precharge": 5e5, "capacity": 2e-4, "volume": 2e-5}
    values |= {"exponent": 1.3} if against == "gas" else {"rate": 4e9}
    one = cw.Accumulator("store", against=against, initial_pressure=1.2e6, inflow=-5e-5, **values)
    d.add(one)
    end = one.oil(1.2e6) / 5e-5
    run = d.simulate(0.9 * end, rtol=1e-9)
    p = run["store.pressure"]
    left = np.array([one.oil(float(at)) for at in p]) + 2e-5 / BULK * (p - 1.2e6)
    assert left == pytest.approx(one.oil(1.2e6) - 5e-5 * run.time, rel=1e-6)
    # empty, the pressure falls at once
    empty = d.simulate(1.01 * end, rtol=1e-9)
    assert empty["store.pressure"][-1] < 4e5


def test_a_full_accumulator_takes_no_more() -> None:
    d, _ = bench()
    d.add(cw.Accumulator("store", against="spring", precharge=5e5, capacity=1e-4, rate=4e9, inflow=1e-5))
    # half a percent of air is compressed up to the precharge
    air = 0.005 * 2e-5 * (1.0 - 101325.0 / (5e5 + 101325.0))
    run = d.simulate(10.0 + (2e-5 * 9e5 / BULK + air) / 1e-5 + 0.1)
    assert run["store.pressure"][-1] == pytest.approx(9e5 + 0.1 * 1e-5 * BULK / 2e-5, rel=1e-5)


def spool(**values: Any) -> cw.SpoolValve:
    return cw.SpoolValve("valve", supply_area=1e-5, exhaust_area=2e-5, **values)


def test_a_spool_without_feedback_is_a_way_valve() -> None:
    """Full opening at the end of its way, none within the overlap but for the clearance."""
    flows = dict[float, float]()
    for pilot in (-1e5, 0.0, 1e5):
        d, _ = bench()
        tank = d.add(cw.OilVolume("tank", volume=50.0, air=0.0, initial_pressure=4e5))
        d.add(spool(supply=1e6, clutch=tank, command=pilot, feedback=0.0, span=1e5, overlap=0.2))
        run = d.simulate(0.1)
        flows[pilot] = (run["tank.pressure"][-1] - 4e5) * 50.0 / BULK / 0.1
    # the clearance adds a little to what is open; the pressure of the tank is nearly constant
    assert flows[1e5] == pytest.approx(orifice_flow(1e-5, 6e5), rel=1e-3)
    assert flows[-1e5] == pytest.approx(-orifice_flow(2e-5, 4e5), rel=1e-3)
    assert abs(flows[0.0]) < 1e-3 * flows[1e5]


@pytest.mark.parametrize("wanted", [2e5, 7e5])
def test_a_spool_with_feedback_regulates(wanted: float) -> None:
    """Both ways: the clutch comes to the pilot pressure within the overlap."""
    d, _ = bench()
    port = d.add(cw.OilVolume("port", volume=2e-5, initial_pressure=4e5))
    d.add(spool(supply=1e6, clutch=port, command=wanted, span=5e4, overlap=0.1))
    run = d.simulate(0.2)
    # leaks of the clearance hold it near the edge from which it came
    assert run["port.pressure"][-1] == pytest.approx(wanted, abs=0.12 * 5e4)


def circuit(clutch: bool = True) -> cw.Driveline:
    """A motor drives a pump and, through a clutch that this pump engages, a load."""
    d = cw.Driveline("circuit")
    motor = d.shaft("motor", inertia=0.3, speed=180.0)
    load = d.shaft("load", inertia=0.25)
    d.add(cw.Torque("drive", shaft=motor, torque=60.0))
    oil = d.add(
        cw.HydraulicOil("oil", temperature=cw.Ramp(height=30.0, duration=0.5, start=0.1, offset=323.15), **FLUID)
    )
    state: dict[str, Any] = {"density": (oil, "density"), "viscosity": (oil, "viscosity")}
    line = d.add(cw.OilVolume("line", volume=2e-4))
    d.add(
        cw.Pump(
            "pump", shaft=motor, outlet=line, displacement=1.6e-5, efficiency=0.9, drag=5e-3, leakage=2e-14, **state
        )
    )
    d.add(cw.ReliefValve("regulator", inlet=line, command=1.2e6, area=4e-5, **state))
    store = d.add(cw.Accumulator("store", precharge=6e5, capacity=3e-5))
    d.add(cw.Orifice("throttle", inlet=line, outlet=store, area=4e-6, **state))
    port = d.add(cw.OilVolume("port", volume=1e-5))
    command = cw.Table([(0.0, 0.0), (0.15, 0.0), (0.15, 1e6), (0.25, 2e5), (0.6, 6e5), (0.8, 6e5), (0.8, 0.0)])
    d.add(spool(supply=line, clutch=port, command=command, span=5e4, transition=260.0, **state))
    piston = d.add(cw.ClutchActuator("piston", supply_pressure=port, orifice_area=6e-6, seal_friction=20.0, **PISTON))
    if clutch:
        law = cw.Coulomb(static=0.13, kinetic=0.12)
        d.add(cw.Clutch("clutch", base=motor, follower=load, friction=law, gain=0.5, normal_force=piston))
    return d


def stored(d: cw.Driveline, run: cw.Trajectory, at: int) -> float:
    piston: Any = next(one for one in d.elements if one.name == "piston")
    volumes = sum(run[f"{name}.energy"][at] for name in ("line", "port", "store"))
    return float(volumes + piston.stored([run[f"piston.{name}"][at] for name in ("force", "pressure")]))


@pytest.mark.parametrize("method", ["rodas5p", "dopri5", "auto"])
def test_a_pump_engages_a_clutch_and_all_energies_close(method: str) -> None:
    """Work of the pump = losses of all openings + what volumes, accumulator and piston store, to 1e-8 at rtol 1e-9."""
    d = circuit()
    run = d.simulate(1.0, rtol=1e-9, method=method)
    assert run["clutch.state"][np.searchsorted(run.time, 0.79)] == "locked"
    work = -run["pump.work"][-1]
    given, lost = run["pump.oil.energy"][-1], run["pump.oil.loss"][-1]
    assert work > 500.0
    assert given + lost == pytest.approx(work, rel=1e-8)
    heat = sum(run[f"{name}.loss"][-1] for name in ("regulator", "throttle", "valve", "piston"))
    assert heat + stored(d, run, -1) - stored(d, run, 0) == pytest.approx(given, rel=1e-8)
    assert abs(run.energy.residual) < 1e-8 * run.energy.turnover


def test_oil_that_is_cold_fills_later() -> None:
    times = []
    for kelvin in (263.15, 353.15):
        d = circuit(clutch=False)
        run = cw.simulate(d.assemble().changed({"oil.temperature": kelvin}), 0.6)
        times.append(run.time[run["piston.force"] > 0.0][0])
    # 600 in place of 9 mm2/s before a bore in which the flow is turbulent
    assert times[0] > times[1] + 1e-3


def test_gradients_of_a_circuit() -> None:
    """Against central differences of runs at a tolerance that is far below the step."""
    names = ["pump.displacement", "line.volume", "valve.supply_area", "piston.preload", "oil.viscosity_40"]
    d = circuit()
    run = d.simulate(0.4, rtol=1e-8)
    found = run.gradient("clutch.heat", names)
    for name in names:
        base = float(d.assemble().parameters[name].value)
        values = []
        for side in (1.0, -1.0):
            moved = cw.simulate(d.assemble().changed({name: base * (1.0 + side * 1e-4)}), 0.4, rtol=1e-10)
            values.append(float(moved["clutch.heat"][-1]))
        slope = (values[0] - values[1]) / (2e-4 * base)
        assert found["clutch.heat", name] == pytest.approx(slope, rel=2e-3), name


def test_what_a_port_may_be() -> None:
    """A pressure; and of a volume its energy is none."""
    d, _ = bench()
    line = d.add(cw.OilVolume("line", volume=1e-4))
    d.add(cw.Orifice("bore", inlet=(line, "energy"), area=1e-6))
    with pytest.raises(cw.ModelError, match=r"must be in \[Pa\]"):
        d.assemble()


def test_a_page_refuses_it_by_name(tmp_path: Path) -> None:
    run = circuit().simulate(0.1)
    with pytest.raises(cw.ClutchworkError, match="is a HydraulicOil, which pages have no room for"):
        run.page(tmp_path / "circuit.html")


def test_steps_of_one_length_are_refused() -> None:
    """Volumes settle within microseconds: their pressures would ring far from what they are."""
    with pytest.raises(cw.OptionError, match="pressures of its oil change within any step"):
        circuit().simulate(0.1, method="fixed", step=1e-3)


@pytest.mark.parametrize("kind", ["volume", "accumulator"])
def test_no_pressure_falls_below_vacuum(kind: str) -> None:
    """A pump that sucks a closed volume empty: air makes it soft, however long that lasts."""
    d = cw.Driveline("suction")
    motor = d.shaft("motor", inertia=0.3)
    d.add(cw.PrescribedSpeed("drive", shaft=motor, speed=100.0))
    made = (
        cw.OilVolume("store", volume=1e-4)
        if kind == "volume"
        else cw.Accumulator("store", precharge=6e5, capacity=3e-5)
    )
    store = d.add(made)
    d.add(cw.Pump("pump", shaft=motor, inlet=store, outlet=0.0, displacement=1.6e-5))
    run = d.simulate(0.5)
    assert run.status == "done"
    assert run["store.pressure"].min() > -101325.0


def test_a_pump_near_vacuum_delivers_less() -> None:
    """At 10 kPa absolute its chambers are half full: half of its oil, and half of its torque, by (13)."""
    d = cw.Driveline("suction")
    motor = d.shaft("motor", inertia=0.3)
    d.add(cw.PrescribedSpeed("drive", shaft=motor, speed=100.0))
    line = d.add(cw.OilVolume("line", volume=1e-2, air=0.0))
    d.add(cw.Pump("pump", shaft=motor, inlet=1e4 - 101325.0, outlet=line, displacement=2e-5, efficiency=1.0))
    run = d.simulate(0.5, rtol=1e-9)
    flow = 0.5 * 2e-5 / (2.0 * pi) * 100.0
    assert run["line.pressure"] == pytest.approx(BULK / 1e-2 * flow * run.time, rel=1e-9)
    drop = run["line.pressure"] + 101325.0 - 1e4
    assert run["pump.torque"] == pytest.approx(-0.5 * 2e-5 / (2.0 * pi) * drop, rel=1e-9)
    assert run["pump.oil.energy"][-1] == pytest.approx(-run["pump.work"][-1], rel=1e-9)


def test_a_pump_gets_no_more_oil_than_there_is() -> None:
    """From a closed volume it delivers what air in that makes room for, a tenth of what it turned for."""
    d = cw.Driveline("suction")
    motor = d.shaft("motor", inertia=0.3)
    d.add(cw.PrescribedSpeed("drive", shaft=motor, speed=100.0))
    store, line = d.add(cw.OilVolume("store", volume=1e-4)), d.add(cw.OilVolume("line", volume=1e-2, air=0.0))
    d.add(cw.Pump("pump", shaft=motor, inlet=store, outlet=line, displacement=2e-5))
    run = d.simulate(2.0)
    given, low = run["line.pressure"][-1] / BULK * 1e-2, run["store.pressure"][-1]
    # the tolerance of the run
    assert given == pytest.approx(1e-4 * (0.005 * (101325.0 / (low + 101325.0) - 1.0) - low / BULK), rel=1e-4)
    assert given < 0.1 * 2e-5 / (2.0 * pi) * 100.0 * 2.0
    assert low + 101325.0 > 1e3
    (hint,) = run.hints.of("store")
    assert hint.rule == "starved pump"
    assert hint.message.endswith("absolute, below 20 kPa")


def test_a_spool_valve_that_empties_a_line_above_its_pilot_pressure_is_its_relief() -> None:
    for feedback, said in ((1.0, []), (0.0, ["no relief valve"])):
        d = cw.Driveline("regulated")
        motor = d.shaft("motor", inertia=0.3)
        d.add(cw.PrescribedSpeed("drive", shaft=motor, speed=100.0))
        line = d.add(cw.OilVolume("line", volume=1e-3))
        d.add(cw.Pump("pump", shaft=motor, outlet=line, displacement=2e-5))
        areas = {"supply_area": 1e-5, "exhaust_area": 1e-4}
        d.add(cw.SpoolValve("valve", supply=0.0, clutch=line, command=5e5, feedback=feedback, **areas))
        run = d.simulate(1.0)
        assert [hint.rule for hint in run.hints if hint.rule in ("no relief valve", "ports swapped")] == said
        if feedback:
            # of the span and the overlap
            assert run["line.pressure"][-1] == pytest.approx(5e5, abs=1.1e5)


@pytest.mark.parametrize("line", [1.2e6, cw.Constant(1.2e6)])
def test_a_valve_body_starts_with_the_pressure_of_its_line(line: Any) -> None:
    d = cw.Driveline("body")
    motor = d.shaft("motor", inertia=0.3, speed=180.0)
    d.add(cw.ValveBody("body", shaft=motor, piston_areas={"A": 6e-3}, pressures={"A": 1e6}, line_pressure=line))
    run = d.simulate(0.05)
    assert run["body.line.pressure"][0] == 1.2e6
    assert run["body.A_port.pressure"][-1] == pytest.approx(1e6, rel=0.05)


def test_one_volume_at_two_ports_is_named() -> None:
    d, line = cw.Driveline("same"), cw.OilVolume("line", volume=1e-4)
    d.add(line)
    d.add(cw.Orifice("bore", inlet=line, outlet=line, area=1e-6))
    with pytest.raises(cw.ModelError, match="outlet is also the inlet; join it to another volume"):
        d.assemble()


def test_parts_that_are_not_there_are_named() -> None:
    d = cw.Driveline("parts")
    shaft = d.shaft("shaft", inertia=1.0)
    with pytest.raises(cw.UnknownName, match="body has no part 'B_piston'; did you mean 'A_piston'"):
        cw.ValveBody("body", shaft=shaft, piston_areas={"A": 6e-3}).part("B_piston")
    with pytest.raises(cw.UnknownName, match="body has values that make no parts"):
        cw.ValveBody("body", shaft=shaft, piston_areas=[6e-3]).part("A_piston")  # type: ignore[arg-type]


def test_a_pump_whose_pressure_difference_jumps_through_zero_in_fixed_steps() -> None:
    """Its friction follows the pressure within the step: errors fall with the square of its length."""
    d = cw.Driveline("pump")
    s = d.shaft("s", inertia=0.3, speed=100.0)
    outlet = cw.Pulse(height=1e6, offset=-5e5, period=0.2, width=0.1, start=0.03)
    d.add(cw.Pump("p", shaft=s, displacement=1.6e-5, efficiency=0.8, drag=5e-3, leakage=1e-12, outlet=outlet))
    d.add(cw.Torque("t", shaft=s, torque=0.5))
    exact = d.simulate(1.0, rtol=1e-10, atol=1e-12)["s.speed"][-1]
    long, short = (abs(d.simulate(1.0, method="fixed", step=step)["s.speed"][-1] - exact) for step in (1e-2, 1e-3))
    assert long < 1e-4
    assert short < 0.02 * long


@pytest.mark.parametrize("seal", [20.0, 50.0, 300.0])
@pytest.mark.parametrize("volume", [1e-6, 1e-5])
@pytest.mark.parametrize("port", [1e-5, 1e-4])
@pytest.mark.parametrize("rtol", [1e-6, 1e-9])
def test_a_seal_holds_a_piston_whose_pressure_reverses(seal: float, volume: float, port: float, rtol: float) -> None:
    """The valve opens to its exhaust: held until the pressure has fallen by the friction both ways, then let go."""
    d, _ = bench()
    line = d.add(cw.OilVolume("line", volume=port))
    command = cw.Table([(0.5, 1e6), (0.5, 1e5)])
    areas = {"supply_area": 2e-5, "exhaust_area": 2e-5}
    d.add(cw.SpoolValve("valve", supply=1e6, clutch=line, command=command, span=1e5, overlap=0.0, **areas))
    plates = 2e7
    parts = {**PISTON, "contact_rate": plates, "seal_friction": seal, "volume": volume}
    d.add(cw.ClutchActuator("piston", supply_pressure=line, orifice_area=4e-6, **parts))
    run = d.simulate(1.0, rtol=rtol)
    assert run.status == "done"
    force, pressure = run["piston.force"], run["piston.pressure"]
    stroke = PISTON["kiss_stroke"] + force / plates
    left = 6e-3 * pressure - PISTON["preload"] - PISTON["spring_rate"] * stroke - np.maximum(force, 0.0)
    resting = np.isclose(force, -plates * PISTON["kiss_stroke"], rtol=1e-12)
    # round-off of forces of 6 kN, and the kiss point between two rows
    assert np.all(left <= seal + 1e-6)
    assert np.all(left[~resting] >= -seal - 1e-6)
    fell = run.time > 0.5
    assert np.all(np.diff(force[fell]) <= 1e-7)
    held = fell & (left > -seal + 1e-3)
    top = force[run.time <= 0.5][-1]
    assert force[held & (force > 0.0)] == pytest.approx(top, rel=1e-6)
    # what moved it out last was all that its friction let through
    assert left[run.time <= 0.5][-1] == pytest.approx(seal, abs=1e-6)
    assert force[-1] < 0.0 or left[-1] == pytest.approx(-seal, abs=1e-3)
