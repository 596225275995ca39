"""What is wrong with a call is said, all at once, with what to do."""

from __future__ import annotations

import pytest

import clutchwork as cw
from support.engagement import discs, least_torque


def refused(**given):
    call = {"free": {"c1.gain": (3e-4, 9e-4)}, "minimise": "c1.heat", **given}
    with pytest.raises(cw.UseError) as caught:
        cw.calibrate(discs(), 5.0, **call)
    return "\n".join(caught.value.problems)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"free": {}}, "free is {}: give names with their bounds"),
        ({"free": {"c1.gian": (0, 1)}}, "c1.gian"),
        ({"free": {"c1.gain": (9e-4, 3e-4)}}, "free of 'c1.gain' is (0.0009, 0.0003): give (low, high) in m3"),
        ({"free": {"c1.gain": 5}}, "free of 'c1.gain' is 5: give (low, high)"),
        ({"free": {"c1.pressure.values[2:9]": (0, 1)}}, "they are counted from 1: c1.pressure.values[1:3]"),
        ({"free": {"c1.gain": (1e-4, 1e-3), "both": cw.together("c1.gian", factor=(0.9, 1.1))}}, "c1.gian"),
        ({"minimise": lambda run: 1.0}, "a function of the run has no derivative"),
        ({"minimise": {}}, "minimise: is empty"),
        ({"minimise": {"c1.heat": "much"}}, "the weight of c1.heat is 'much': give a number"),
        ({"minimise": cw.slope("c1.gain")}, "c1.gain"),
        ({"subject_to": "c1.heat"}, "subject_to is 'c1.heat': give a list of cw.limit"),
        ({"subject_to": ["c1.heat"]}, "'c1.heat' in subject_to is not a limit"),
        ({"subject_to": cw.limit("c1.heat")}, "limit of c1.heat: give lower=, upper= or both"),
        ({"subject_to": cw.limit("c1.heat", upper="3 bar")}, "limit of c1.heat is '3 bar': give finite numbers in J"),
        ({"subject_to": cw.limit("c1.heat", 5.0, 4.0)}, "limit of c1.heat is 5.0 and 4.0"),
        ({"solver": "ipopt"}, "solver is given, but SLSQP is the only solver: leave it out"),
        ({"robust": "best"}, "robust is 'best'"),
        ({"starts": 0}, "starts is 0: give a whole number of at least 1"),
        ({"tolerance": 2.0}, "tolerance is 2.0"),
        ({"file": 5}, "file: 5 is not a path"),
        ({"free": {"c1.gain": (6e-4, 9e-4)}}, "the model has 0.0005 m3, outside of 0.0006 to 0.0009 m3; give bounds"),
        ({"free": {"k": cw.together("c1.gain", factor=(1.1, 2.0))}}, "the model has factor 1, outside of 1.1 to 2;"),
        ({"free": {"k": cw.together(["c1.gain", "c1.gain"], factor=(0.5, 2.0))}}, "names c1.gain twice; give it once"),
        ({"scatter": {"c1.gain": (4e-4, 6e-4)}}, "c1.gain is free, and scatter sets it from 0.0004 to 0.0006 m3"),
        (
            {"scatter": {"load.inertia": (0.9, 1.1)}},
            "scatter of 'load.inertia': the model has 0.8 kg m2, outside of 0.9 to 1.1 kg m2; "
            "give bounds around it, or cw.together('load.inertia', factor=(0.9, 1.1))",
        ),
        ({"scatter": {"load.inertia": (1.2, 1.4)}}, "outside of 1.2 to 1.4 kg m2; give bounds around it"),
        ({"minimise": cw.jerk("load", 3.0)}, "two windows of 3 s take 6 s, there are 5 s of the run"),
        ({"minimise": cw.jerk("load", 0.1, (7.0, 9.0))}, "there are 0 s of the run"),
        ({"minimise": {cw.jerk("load"): 1.0, cw.slope("c1.pressure"): 1.0}}, "slope(c1.pressure) has 2; give a limit"),
        ({"minimise": {"c1.heat": 1.0, cw.squared_slope("c1.pressure"): -1.0}}, "is -1: give one > 0"),
        ({"minimise": cw.jerk("load"), "scatter": {"load.inertia": (0.7, 0.9)}}, "give robust='worst'"),
    ],
)
def test_each_mistake_is_named(given, said):
    assert said in refused(**given)


def test_all_mistakes_are_named_at_once():
    said = refused(free={"c1.gain": (2, 1)}, minimise=5, subject_to=[cw.limit("c1.heat")], tolerance=2.0, starts=-1)
    assert [word for word in ("c1.gain", "minimise", "subject_to", "tolerance", "starts") if word not in said] == []


def test_a_wrong_name_hides_no_wrong_output():
    said = refused(free={"c1.gian": (0, 1)}, minimise="c1.haet", subject_to=[cw.limit("c1.torqe", upper=1.0)])
    for word in ("'c1.gain'", "'c1.heat'", "'c1.torque'"):
        assert f"did you mean {word}?" in said
    both = refused(solver="ipopt", minimise={"c1.haet": 1.0, "c1.wrk": 1.0})
    for word in ("SLSQP is the only solver", "did you mean 'c1.heat'?", "did you mean 'c1.work'?"):
        assert word in both


def test_worst_without_scatter_is_refused():
    said = refused(robust="worst")
    assert "robust is 'worst', and nothing scatters: give scatter={" in said
    assert "or leave robust out" in said


def test_a_misspelt_argument_is_named():
    """Options are free names, which hid it."""
    with pytest.raises(cw.UseError) as caught:
        cw.calibrate(discs(), 5.0, free={"c1.gain": (3e-4, 9e-4)}, minimize="c1.heat", rtol=1e-6)
    assert caught.value.problems == ("unknown field 'minimize'; did you mean 'minimise'?",)


def test_bounds_that_the_model_refuses_are_named_before_the_search():
    with pytest.raises(cw.ModelError, match=r"c1.*gain.*must be > 0"):
        cw.calibrate(discs(), 5.0, free={"c1.gain": (-1.0, 1.0)}, minimise="c1.heat")


def test_outputs_that_are_not_there_are_named():
    with pytest.raises(cw.UseError, match=r"c1\.haet.*did you mean 'c1\.heat'"):
        cw.calibrate(discs(), 5.0, free={"c1.gain": (3e-4, 9e-4)}, minimise="c1.haet")


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, "give either factor=(low, high) or shift=(low, high)"),
        ({"factor": (0.9, 1.1), "shift": (0.0, 1.0)}, "give either"),
        ({"factor": (-1.0, 1.0)}, "factor is (-1.0, 1.0): both must be > 0"),
        ({"shift": (1.0, 0.0)}, "shift is (1.0, 0.0): give (low, high), the lower one first"),
    ],
)
def test_together_says_what_it_wants(given, said):
    with pytest.raises(cw.UseError) as caught:
        cw.together("c1.gain", **given)
    assert said in str(caught.value)


def test_a_start_without_the_event_is_told():
    short = discs()
    with pytest.raises(cw.CalibrationError, match=r"lock\(c1\).*no value|no start could be run"):
        cw.calibrate(
            short,
            0.5,
            free={"c1.gain": (3e-4, 9e-4)},
            minimise="c1.heat",
            subject_to=cw.limit(cw.lock("c1"), upper=0.4),
        )


def test_limits_that_cannot_be_held_are_told():
    found = least_torque(0.01)
    assert not found.solved
    assert "lock(c1) is" in found.message
    assert "outside of its bounds 0.01" in found.message
    with pytest.raises(cw.CalibrationError, match="outside of its bounds"):
        found.raise_for_status()


def test_verify_and_front_ask_for_what_they_need():
    found = least_torque(1.0)
    with pytest.raises(cw.UseError, match="nothing scatters"):
        found.verify()
    with pytest.raises(cw.UseError, match=r"no limit 'lock\(c2\)'"):
        found.front("lock(c2)", [1.0])
    with pytest.raises(cw.UseError, match="bounds are"):
        found.front("lock(c1)", ["soon"])
