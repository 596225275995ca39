"""What cannot be differentiated is said under its own head, with a remedy; ranges of tables; stops struck together."""

from __future__ import annotations

import math

import numpy as np
import pytest

import clutchwork as cw

BY = "c1.gain"


def launch() -> cw.Driveline:
    """Two discs and a clutch."""
    d = cw.Driveline("launch")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    pressure = cw.Table([(0.0, 0.0), (0.2, 2e5), (1.0, 2.2e5)])
    lining = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=5e-4, pressure=pressure))
    return d


WRONG = {
    "contact": ({"of": cw.lock("engine"), "by": BY}, "no contact 'engine'; contacts are c1"),
    "signal": ({"of": "load.sped", "by": BY}, "no signal 'load.sped'; did you mean 'load.speed'?"),
    "output": ({"of": 3, "by": BY}, "3 is not an output"),
    "rms jerk": ({"of": cw.rms_jerk("load"), "by": BY}, "is for calibrate alone; take cw.jerk or cw.squared_jerk"),
    "threads": ({"of": "load.speed", "by": BY, "threads": 0}, "threads is 0"),
    "entry": ({"of": "load.speed", "by": "c1.pressure.values[9]"}, "entries are counted from 1"),
    "word": (
        {"of": "c1.state", "by": BY},
        "c1.state is a word, which has no derivative; take a signal that is a number",
    ),
    "word at": ({"of": cw.at("c1.state", 0.5), "by": BY}, "or when it changes, such as cw.lock('c1')"),
    "speed": (
        {"of": cw.jerk("load.speed"), "by": BY},
        "'load.speed' is a signal; give its shaft or mass: cw.jerk('load')",
    ),
    "squared": ({"of": cw.squared_jerk("load.speed"), "by": BY}, "give its shaft or mass: cw.squared_jerk('load')"),
    "shaft": ({"of": cw.jerk("laod"), "by": BY}, "no shaft or mass 'laod'; did you mean 'load'?"),
    "no shaft": ({"of": cw.jerk("x"), "by": BY}, "no shaft or mass 'x'; they are engine, load"),
    "jerk": ({"of": "load.jerk", "by": BY}, "no signal 'load.jerk'; a jerk is an output of its own: cw.jerk('load')"),
    "jerk()": ({"of": "jerk(load)", "by": BY}, "a jerk is an output of its own: cw.jerk('load')"),
    "bracket": ({"of": "load.speed", "by": "c1.pressure[2]"}, "did you mean 'c1.pressure.values[2]'?"),
    "range": ({"of": "load.speed", "by": "c1.pressure.values[2:4]"}, "counted from 1, [1:3] are all"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_function_that_cannot_be(name: str) -> None:
    given, text = WRONG[name]
    with pytest.raises(cw.UseError) as caught:
        cw.differentiable(launch(), 2.0, **given)  # type: ignore[arg-type]
    assert str(caught.value).startswith("differentiable: 1 problem\n")
    assert text in str(caught.value)


def test_a_wrong_number_hides_no_wrong_output() -> None:
    given = {
        "of": ["load.sped", cw.lock("c2"), 3, cw.rms_jerk("load")],
        "by": ["c1.gian", BY],
        "side": "up",
        "threads": 0,
    }
    with pytest.raises(cw.UseError) as caught:
        cw.differentiable(launch(), 2.0, **given)  # type: ignore[arg-type]
    said = "\n".join(caught.value.problems)
    # what is no output at all hides names of others
    for text in ("3 is not an output", "for calibrate alone", "did you mean 'c1.gain'", "side is 'up'", "threads is 0"):
        assert text in said
    with pytest.raises(cw.UseError) as caught:
        launch().simulate(2.0).gradient(of=["load.sped", cw.lock("c2")], by="c1.gian")
    said = "\n".join(caught.value.problems)
    for text in ("did you mean 'load.speed'", "no contact 'c2'", "did you mean 'c1.gain'"):
        assert text in said


def test_the_head_of_a_mistake_is_what_was_called() -> None:
    run = launch().simulate(2.0)
    with pytest.raises(cw.UseError, match=r"^gradient: 1 problem\n  c1.state is a word"):
        run.gradient(of="c1.state", by=BY)
    with pytest.raises(cw.UseError, match=r"c1.state is a word, which has no derivative"):
        cw.calibrate(launch(), 2.0, free={BY: (4e-4, 6e-4)}, minimise="c1.state")


def test_a_jerk_of_a_calibration_is_asked_for_by_the_shaft() -> None:
    with pytest.raises(cw.UseError, match=r"'load.speed' is a signal; give its shaft or mass: cw.jerk\('load'\)"):
        cw.calibrate(launch(), 2.0, free={BY: (4e-4, 6e-4)}, minimise=cw.jerk("load.speed"))


def test_a_contact_that_is_locked_all_the_while_is_said_to_be() -> None:
    d = launch()
    rests = d.assemble().changed({"engine.speed": 0.0, "c1.pressure": 1e5})
    with pytest.raises(cw.NoGradient, match=r"lock\(c1\) does not happen: the contact is locked from the start to 2 s"):
        cw.differentiable(rests, 2.0, of=cw.lock("c1"), by=BY).gradient()
    with pytest.raises(cw.NoGradient, match=r"lock\(c1, 2\) does not happen before 2 s"):
        cw.differentiable(d, 2.0, of=cw.lock("c1", 2), by=BY).gradient()


def test_a_driveline_without_contacts_says_so() -> None:
    d = cw.Driveline("free")
    d.shaft("a", inertia=1.0, speed=1.0)
    with pytest.raises(cw.UseError, match="no contact 'a'; the driveline has no contact"):
        cw.differentiable(d, 1.0, of=cw.lock("a"), by="a.inertia")


@pytest.mark.parametrize(("given", "places"), [("[2:]", (2, 3)), ("[:2]", (1, 2)), ("[2:2]", (2,)), ("[:]", (1, 2, 3))])
def test_a_range_of_ordinates_has_both_of_its_ends(given: str, places: tuple[int, ...]) -> None:
    f = cw.differentiable(launch(), 2.0, of=cw.lock("c1"), by=f"c1.pressure.values{given}")
    assert f.by == tuple(f"c1.pressure.values[{place}]" for place in places)


def test_a_batch_names_the_line_that_the_driveline_refuses() -> None:
    f = cw.differentiable(launch(), 2.0, of=cw.lock("c1"), by=["engine.inertia", BY])
    lines = np.array([[0.2, 5e-4], [0.3, 5e-4], [-0.2, 5e-4]])
    for call in (f.batch, f.batch_jacobian):
        with pytest.raises(cw.ModelError, match=r'^x\[2\] of 3 lines: 1 problem\n.*"engine": inertia = -0.2'):
            call(lines)


def test_a_system_names_the_function_that_runs_it() -> None:
    with pytest.raises(AttributeError, match=r"no 'simulate'; run it by cw.simulate\(system, t_end\)"):
        launch().assemble().simulate(2.0)


# mass and height of both balls [kg, m], weight [N], and what a bounce leaves
MASS, HEIGHT, WEIGHT, LEFT = 2.0, 0.5, 19.6, 0.4


def balls(joint: str) -> cw.Driveline:
    """Two balls that strike their floors at one instant, joined by a spring, rigidly or not at all."""
    d = cw.Driveline("balls")
    found = [d.mass(f"ball{number}", mass=MASS, position=HEIGHT) for number in (1, 2)]
    for number, ball in enumerate(found, 1):
        d.add(cw.EndStop(f"floor{number}", follower=ball, lower=0.0, lower_restitution=LEFT * number))
        d.add(cw.Torque(f"weight{number}", shaft=ball, torque=-WEIGHT))
    if joint == "spring":
        d.add(cw.Spring("spring", base=found[0], follower=found[1], stiffness=100.0))
    elif joint == "rigid":
        d.add(cw.Gear("lever", input=found[0], output=found[1], ratio=1.0))
    return d


def test_stops_that_are_struck_together_matter_only_where_their_order_does() -> None:
    fall = math.sqrt(2.0 * HEIGHT * MASS / WEIGHT)
    asked = {"of": cw.at("ball1.speed", 1.2 * fall), "rtol": 1e-10, "atol": 1e-12}
    with pytest.raises(cw.NoGradient, match="floor1 and floor2 are struck at one instant"):
        cw.differentiable(balls("rigid"), 1.5 * fall, by="floor1.lower", **asked).gradient()  # type: ignore[arg-type]
    for joint, by in (("rigid", "ball1.mass"), ("spring", "floor1.lower"), ("none", "floor1.lower_restitution")):
        f = cw.differentiable(balls(joint), 1.5 * fall, by=by, **asked)  # type: ignore[arg-type]
        difference = (f(f.x0 + 1e-4) - f(f.x0 - 1e-4)) / 2e-4
        assert f.gradient().matrix[0, 0] == pytest.approx(difference[0], rel=1e-4), (joint, by)
    # alone it leaves the floor with a share of the speed that it came with
    assert f.gradient().matrix[0, 0] == pytest.approx(WEIGHT / MASS * fall, rel=1e-7)


def test_a_lag_has_a_derivative_unless_it_is_zero() -> None:
    """Of zero it leaves out a state."""

    def turbine(lag: float) -> cw.Driveline:
        d = cw.Driveline("converter")
        pump, turbine = d.shaft("pump", inertia=0.16, speed=190.0), d.shaft("turbine", inertia=0.12, speed=10.0)
        table = {"speed_ratio": [0.0, 0.4, 0.7, 1.0], "torque_ratio": [2.0, 1.6, 1.2, 1.0]}
        curve = [0.0035, 0.0034, 0.003, 0.0]
        d.add(cw.TorqueConverter("tc", impeller=pump, turbine=turbine, capacity=curve, lag=lag, **table))
        return d

    with pytest.raises(cw.UseError, match=r"tc\.lag is 0, which leaves out a state"):
        cw.differentiable(turbine(0.0), 0.1, of="turbine.speed", by="tc.lag")
    function = cw.differentiable(turbine(0.05), 0.1, of="turbine.speed", by="tc.lag", rtol=1e-10, atol=1e-12)
    around = function(function.x0 + 1e-4) - function(function.x0 - 1e-4)
    assert function.jacobian(function.x0)[0] == pytest.approx(around / 2e-4, rel=1e-5)


@pytest.mark.parametrize(
    ("of", "words"),
    [
        ([cw.at("ball1.speed", 0.1), cw.at("ball1.speed", 0.2)], r"name them: of=\{'first'"),
        ([], "of is missing"),
    ],
)
def test_what_is_wrong_with_values_is_said_in_the_words_of_the_call(of, words) -> None:
    with pytest.raises(cw.UseError, match=words):
        cw.differentiable(balls("none"), 0.3, of=of, by="ball1.mass")
    with pytest.raises(cw.UseError, match=words):
        balls("none").simulate(0.3).gradient(of=of, by="ball1.mass")
