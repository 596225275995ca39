"""How `cw.linearise` is called: instants, names, what is undecided, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.command.main import main

LINING = {"friction": cw.Coulomb(static=0.12, kinetic=0.1), "gain": 1.0}


def launch() -> cw.Driveline:
    d = cw.Driveline("launch")
    engine, car = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("car", inertia=0.8)
    d.add(cw.Torque("drive", shaft=engine, torque=20.0))
    ramp = cw.Table([(0.0, 0.0), (0.5, 600.0), (3.0, 600.0), (3.5, 0.0)])
    d.add(cw.Clutch("c1", base=engine, follower=car, normal_force=ramp, **LINING))
    return d


@pytest.fixture(scope="module")
def run() -> cw.Trajectory:
    return launch().simulate(4.0)


def test_a_model_a_system_and_a_run_give_the_same(run):
    d = launch()
    d.simulation["t_end"] = 4.0
    made = [
        cw.linearise(run, at=1.0),
        cw.linearise(d, at=1.0),
        cw.linearise(d.assemble(), at=1.0),
        cw.linearize(run, at=1.0),
        cw.linearise(run, at="1000 ms"),
    ]
    for lin in made[1:]:
        assert np.array_equal(lin.A, made[0].A)
        # a run to another end takes other steps
        assert list(lin.state.values()) == pytest.approx(list(made[0].state.values()), rel=1e-6)
    assert np.array_equal(cw.linearise(d).A, cw.linearise(run, at=0.0).A)
    assert cw.linearise(d).time == 0.0


def test_locking_takes_a_state_away_and_the_engine_goes_with_the_car(run):
    (lock,) = [event.time for event in run.events if event.after == "locked"]
    before, after = cw.linearise(run, at=lock - 1e-3), cw.linearise(run, at=lock + 1e-3)
    assert before.states == ("engine.speed", "car.speed")
    assert after.states == ("engine.speed",)
    assert after.B[:, after.inputs.index("drive.torque")] == pytest.approx([1.0])
    assert after.contacts == {"c1": "locked"}


def test_at_an_event_what_comes_after_it_is_taken(run):
    lock = next(event.time for event in run.events if event.after == "locked")
    lin = cw.linearise(run, at=lock)
    assert lin.contacts == {"c1": "locked"}
    assert any("c1 goes from" in note and "the motion after it is used" in note for note in lin.notes)
    assert "c1 goes from" in str(lin)
    lin = cw.linearise(run, at=0.5)
    assert any("c1.normal_force has a knot at this instant" in note for note in lin.notes)
    assert cw.linearise(run, at=0.6).notes == ()


def test_a_contact_at_its_capacity_and_one_that_breaks_away(run):
    d = cw.Driveline("held")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("t", shaft=a, torque=12.0))
    d.add(cw.Brake("b1", shaft=a, normal_force=100.0, **LINING))
    lin = cw.linearise(d)
    assert lin.contacts == {"b1": "locked"}
    assert any("b1 is at its capacity, 12 N m: it is taken as locked" in note for note in lin.notes)
    away = next(event for event in run.events if event.before == "locked" and event.after in ("forward", "backward"))
    lin = cw.linearise(run, at=away.time)
    assert any("c1 has no slip but is not locked" in note for note in lin.notes)


def test_an_idle_freewheel_and_a_contact_without_load():
    d = cw.Driveline("idle")
    a, b, c = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0), d.shaft("c", inertia=1.0, speed=5.0)
    d.add(cw.OneWayClutch("f1", base=a, follower=b))
    d.add(cw.Clutch("c1", base=b, follower=c, normal_force=0.0, **LINING))
    text = " ".join(cw.linearise(d).notes)
    assert "f1 is locked without load" in text
    assert "c1 is open, its load exactly zero" in text


def test_names_and_wildcards(run):
    lin = cw.linearise(run, at=0.6, inputs=["drive.*", "c1.normal_force"], outputs=["*.speed", "c1.torque", "c1.slip"])
    assert lin.inputs == ("drive.torque", "c1.normal_force")
    assert lin.outputs == ("engine.speed", "car.speed", "c1.torque", "c1.slip")
    assert (lin.A.shape, lin.B.shape, lin.C.shape, lin.D.shape) == ((2, 2), (2, 2), (4, 2), (4, 2))
    assert lin.units["c1.torque"] == "N m"
    assert lin.units["drive.torque"] == "N m"
    # a result calls the signal of a torque otherwise than the torque itself
    assert cw.linearise(run, at=1.0, inputs="drive.torque_signal").inputs == ("drive.torque",)
    nothing = cw.linearise(run, at=0.6, inputs=[], outputs=[])
    assert (nothing.B.shape, nothing.C.shape, nothing.D.shape) == ((2, 0), (0, 2), (0, 0))
    # what a wildcard finds beside what has a derivative is left out
    assert "c1.work" not in cw.linearise(run, at=1.0, outputs="c1.*").outputs


def test_values_and_rates_are_those_of_the_run(run):
    lin = cw.linearise(run, at=0.6, outputs=["c1.power", "car.acceleration"])
    there = run.at([0.6])
    # the row at the end of a step, and that where the next one starts
    assert lin.state["engine.speed"] == pytest.approx(there["engine.speed"][0], rel=1e-14)
    assert lin.rate["car.speed"] == pytest.approx(there["car.acceleration"][0], rel=1e-12)
    assert lin.output["c1.power"] == pytest.approx(there["c1.power"][0], rel=1e-12)
    assert lin.input["drive.torque"] == 20.0


def test_controllers_are_replayed_and_their_inputs_are_inputs():
    d = cw.Driveline("controlled")
    engine, car = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("car", inertia=0.8)
    calls = []

    def force(time, readings):
        calls.append(time)
        return 300.0 + time

    d.add(cw.Clutch("c1", base=engine, follower=car, normal_force=cw.Sampled(period=0.01, function=force), **LINING))
    run = d.simulate(0.1)
    asked = len(calls)
    lin = cw.linearise(run, at=0.055)
    assert len(calls) == asked
    assert lin.input["c1.normal_force"] == pytest.approx(300.05)
    assert lin.B[:, 0] == pytest.approx([-0.1 / 0.2, 0.1 / 0.8])


def test_all_that_is_wrong_is_said_at_once(run):
    with pytest.raises(cw.UseError) as caught:
        cw.linearise(run, at=1.0, inputs=["drive.torqe", 3], outputs=["*.sped", "c1.work", "c1.mode", "engin.speed"])
    text = str(caught.value)
    assert "did you mean 'drive.torque'" in text
    assert "3 is not a name" in text
    assert "no signal fits '*.sped'" in text
    assert "'c1.work' is an integral over the run; ask for 'c1.power'" in text
    assert "'c1.mode' does not change with a state" in text
    assert "did you mean 'engine.speed'" in text
    assert len(caught.value.problems) == 6


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda run: cw.linearise(run), "at is missing"),
        (lambda run: cw.linearise(run, at=9.0), "is after the end of the run at 4 s"),
        (lambda run: cw.linearise(run, at=-1.0), "must be a time in s, zero or later"),
        (lambda run: cw.linearise(run, at="late"), "must be a time in s"),
        (lambda run: cw.linearise(run, at="2 bar"), "must be a time in s"),
        (lambda run: cw.linearise("model.toml"), "cw.Driveline.load('model.toml')"),
        (lambda run: cw.linearise(3), "is not a model"),
        (lambda run: cw.linearise(run, at=1.0, output="x"), "did you mean 'outputs'"),
        (lambda run: cw.linearise(run, at=1.0, inputs=3), "must be a name"),
        (lambda run: cw.linearise(run, at=1.0).frequency_response("high"), "or a string such as '5 Hz'"),
        (lambda run: cw.linearise(run, at=1.0).frequency_response(0.0), "frequency of an undamped mode"),
    ],
)
def test_what_is_refused(run, call, words):
    with pytest.raises(cw.UseError, match=words.replace("(", r"\(").replace(")", r"\)")):
        call(run)


def test_a_run_that_stops_before_the_instant_says_why():
    d = cw.Driveline("stops")
    a, b = d.shaft("a", inertia=1.0, speed=10.0), d.shaft("b", inertia=1.0)
    law = cw.FrictionTable(kinetic=[(0.0, 0.1), (20.0, 0.09)], static=0.2, extrapolation="error")
    d.add(cw.Clutch("c1", base=a, follower=b, friction=law, gain=1.0, normal_force=10.0))
    d.add(cw.Torque("t", shaft=a, torque=50.0))
    with pytest.raises(cw.SimulationError, match="a table is left"):
        cw.linearise(d, at=5.0)


def test_a_saved_state_is_an_instant(run, tmp_path):
    state = run.state(0.6)
    state.save(tmp_path / "here.state")
    there = cw.linearise(run, at=0.6)
    for one in (state, cw.State.load(tmp_path / "here.state")):
        lin = cw.linearise(run.system, at=one)
        assert np.array_equal(lin.A, there.A)
        assert lin.state == there.state
        assert lin.time == 0.6
    with pytest.raises(cw.UseError, match="at is a saved state; give the model"):
        cw.linearise(run, at=state)
    with pytest.raises(cw.StateError, match="another model"):
        cw.linearise(swinging(), at=state)


def swinging(damping: float = 2.0, kinetic: float = 0.1, **start: float) -> cw.Driveline:
    """A disc on a spring that rubs on the next, whose lining gets warm; start: speeds, force and temperature."""
    d = cw.Driveline("swinging")
    a = d.shaft("a", inertia=0.2, speed=start.get("a", 60.0))
    b = d.shaft("b", inertia=0.1, speed=start.get("b", 60.0))
    c = d.shaft("c", inertia=0.5, speed=start.get("c", 0.0))
    lining = d.thermal("lining", capacity=500.0, temperature=start.get("lining", 300.0))
    air = d.ambient("air", temperature=290.0)
    d.add(
        cw.SpringDamper(
            "k", base=a, follower=b, stiffness=900.0, damping=damping, initial_twist=start.get("twist", 0.0)
        )
    )
    law = cw.Stribeck(static=1.2 * kinetic, kinetic=kinetic, speed=20.0)
    pressed = {"gain": 1.0, "normal_force": start.get("force", 50.0), "heat": lining}
    d.add(cw.Clutch("c1", base=b, follower=c, friction=law, **pressed))
    d.add(cw.Convection("wind", hot=lining, cold=air, conductance=30.0))
    return d


def test_what_was_set_and_changed_acts_in_the_linear_system():
    sim = cw.Simulator(swinging())
    sim.advance(0.2)
    set_now = {"k.damping": 5.0, "c1.friction.kinetic": 0.07, "c1.friction.static": 0.084}
    sim.set({**set_now, "c1.normal_force": 65.0})
    sim.advance(0.1)
    here = {name: sim[f"{name}.speed"] for name in "abc"} | {"lining": sim["lining.temperature"], "force": 65.0}
    twin = swinging(5.0, 0.07, **here, twist=sim["k.twist"])
    wanted, plain = cw.linearise(twin), cw.linearise(swinging(**here, twist=sim["k.twist"]))
    for lin in (cw.linearise(sim), cw.linearise(swinging(), at=sim.save()), cw.linearise(sim.run, at=sim.time)):
        assert lin.states == wanted.states
        assert lin.time == pytest.approx(0.3)
        # the same numbers but for the round-off of the twist, which the core keeps as a torque
        np.testing.assert_allclose(lin.A, wanted.A, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(lin.B, wanted.B, rtol=1e-9, atol=1e-9)
        assert lin.state == pytest.approx(wanted.state, rel=1e-9)
        assert lin.input["c1.normal_force"] == 65.0
    assert np.abs(wanted.A - plain.A).max() > 1.0


def test_scales_of_what_is_shown_stay_while_a_run_goes_on():
    sim = cw.Simulator(swinging())
    for name, value in {"k.stiffness": 800.0, "lining.capacity": 400.0}.items():
        with pytest.raises(cw.ModelError):
            sim.set(name, value)


def test_a_held_signal_has_no_knots():
    sim = cw.Simulator(launch())
    sim.advance_to(0.5)
    assert any("c1.normal_force has a knot" in note for note in cw.linearise(sim).notes)
    sim.set("c1.normal_force", 400.0)
    assert not any("knot" in note for note in cw.linearise(sim).notes)


def test_a_simulator_is_taken_where_it_is(run):
    sim = cw.Simulator(launch())
    assert np.array_equal(cw.linearise(sim).A, cw.linearise(launch()).A)
    sim.advance_to(0.6)
    assert cw.linearise(sim).time == 0.6
    with pytest.raises(cw.UseError, match=r"at cannot be given with a Simulator.*give sim.run"):
        cw.linearise(sim, at=0.3)
    # looking changes nothing
    other = cw.Simulator(launch())
    other.advance_to(0.6)
    sim.advance_to(1.0)
    other.advance_to(1.0)
    assert sim["engine.speed"] == other["engine.speed"]


def test_controllers_are_asked_at_a_state():
    d = cw.Driveline("controlled")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("t", shaft=a, torque=cw.Sampled(lambda time, readings: 2.0 + time, 0.01)))
    state = d.simulate(0.1).state(0.05)
    assert cw.linearise(d, at=state).input == {"t.torque": pytest.approx(2.05)}


def test_a_model_that_begins_later_is_linearised_there():
    d = launch()
    d.simulation["t_start"] = 0.25
    assert cw.linearise(d).time == 0.25
    assert cw.linearise(d).input["c1.normal_force"] == pytest.approx(300.0)
    assert cw.linearise(d, at=0.25).time == 0.25
    assert cw.linearise(d, at=0.4).time == 0.4
    with pytest.raises(cw.UseError, match=r"at = 0 s is before t_start = 0.25 s of the settings"):
        cw.linearise(d, at=0.0)
    late = d.simulate(1.0)
    with pytest.raises(cw.UseError, match=r"before the begin of the run at 0.25 s"):
        cw.linearise(late, at=0.1)
    assert cw.linearise(late, at=0.25).time == 0.25


def test_a_run_from_a_file_is_repeated_and_one_with_controllers_says_that_it_cannot_be(run, tmp_path):
    run.save(tmp_path / "run.cw")
    assert np.array_equal(cw.linearise(cw.load_run(tmp_path / "run.cw"), at=0.6).A, cw.linearise(run, at=0.6).A)
    d = cw.Driveline("controlled")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Torque("t", shaft=a, torque=cw.Sampled(lambda time, readings: 2.0, 0.01)))
    assert cw.linearise(d).input == {"t.torque": 2.0}
    d.simulate(0.1).save(tmp_path / "other.cw")
    with pytest.raises(cw.ClutchworkError, match="cannot be repeated"):
        cw.linearise(cw.load_run(tmp_path / "other.cw"), at=0.05)


def engine_and_clutch() -> cw.Driveline:
    d = cw.Driveline("car")
    engine, car = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("car", inertia=2.0)
    d.add(cw.SpeedTorque("ice", shaft=engine, torque=[(0.0, 50.0), (300.0, 100.0)]))
    disk = {"surfaces": 2, "radius": 0.12, "normal_force": 2000.0}
    d.add(cw.DiskClutch("clutch", base=engine, follower=car, friction=cw.Coulomb(static=0.3, kinetic=0.28), **disk))
    d.add(cw.QuadraticTorque("rolling", shaft=car, nominal_torque=-50.0, nominal_speed=200.0))
    return d


def test_signals_that_nobody_gave_are_no_inputs_unless_they_are_named():
    d = engine_and_clutch()
    given = cw.linearise(d).inputs
    assert set(given) <= set(d.simulate(0.01).names)
    assert given == cw.linearise(d, inputs="*").inputs
    assert "clutch.wear" not in given
    assert cw.linearise(d, inputs=["clutch.wear"]).inputs == ("clutch.wear",)


def test_a_result_that_is_asked_for_as_an_input_is_told_as_one():
    with pytest.raises(cw.UseError) as caught:
        cw.linearise(engine_and_clutch(), inputs=["ice.torque", "car.speed"])
    torque, speed = caught.value.problems
    assert torque == (
        "inputs: 'ice.torque' is a result, which follows from the motion and the signals; inputs are"
        " clutch.normal_force; a cw.Torque of 0 N m at a shaft of 'ice' makes an input for a torque there"
    )
    assert "'car.speed' is a result" in speed
    assert "cw.Torque" not in speed


def test_the_start_is_where_runs_of_the_model_begin(tmp_path, capsys):
    """With t_start in its settings a model starts there, with signals and controllers of that time."""
    d = launch()
    d.simulation["t_start"] = 0.25
    late = cw.simulate(d, 0.5)
    sampled = d.assemble().changed({"c1.normal_force": cw.Sampled(lambda t, _: 1e3 * t, period=0.01)})
    for lin in (cw.linearise(d), cw.linearise(d, at=0.25), cw.linearise(late, at=0.25)):
        assert lin.time == 0.25
        for quantity in lin.input_quantities:
            assert quantity.value == late[quantity.name][0]
    lin = cw.linearise(sampled)
    assert lin.time == 0.25
    assert {q.name: q.value for q in lin.input_quantities}["c1.normal_force"] == 250.0
    d.save(tmp_path / "late.toml")
    assert main(["linearise", str(tmp_path / "late.toml"), "--json"]) == 0
    assert '"time": 0.25' in capsys.readouterr().out
