"""Lists and matrices of numbers: mistakes, units, and their place in the System."""

from __future__ import annotations

from typing import Any

import pytest

import clutchwork as cw

GOOD: dict[str, Any] = {
    "temperatures": [300.0, 400.0],
    "speeds": [0.0, 50.0, 100.0],
    "static": [0.4, 0.35],
    "kinetic": [[0.3, 0.28, 0.26], [0.25, 0.24, 0.23]],
    "temperature": 320.0,
}


def _brake(**changes: Any) -> cw.Driveline:
    d = cw.Driveline("mapped")
    a = d.shaft("a", inertia=1.0, speed=10.0)
    d.add(cw.Brake("b", shaft=a, friction=cw.FrictionMap(**(GOOD | changes)), gain=1.0, pressure=1.0))
    return d


def test_the_good_one_is_good() -> None:
    assert _brake().check() == []


MISTAKES = {
    "text": ({"static": "0.4"}, "friction.static", "must be a list of numbers"),
    "empty": ({"speeds": []}, "friction.speeds", "must be a list of numbers"),
    "no list": ({"speeds": 3.0}, "friction.speeds", "must be a list of numbers"),
    "not rising": ({"speeds": [0.0, 50.0, 40.0]}, "friction.speeds, number 3", "comes after 50 rad/s"),
    "twice": ({"temperatures": [300.0, 300.0]}, "friction.temperatures, number 2", "appears twice; sort the numbers"),
    "not finite": ({"static": [0.4, float("nan")]}, "friction.static, number 2", "must be finite"),
    "below its bound": ({"static": [0.4, 0.0]}, "friction.static, number 2", "must be > 0"),
    "ragged": ({"kinetic": [[0.3, 0.2, 0.1], [0.3, 0.2]]}, "friction.kinetic", "has rows of different lengths"),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_mistakes(case: str) -> None:
    changes, quantity, message = MISTAKES[case]
    (problem,) = _brake(**changes).check()
    assert problem.quantity == quantity
    assert message in str(problem)


def test_units_in_a_model_file() -> None:
    data = _brake().to_dict()
    data["element"][0]["friction"]["speeds"] = {"values": [0.0, 300.0, 600.0], "unit": "rpm"}
    speeds = cw.Driveline.from_dict(data).elements[0].friction.speeds
    assert speeds == pytest.approx([0.0, 31.4159265, 62.8318531])
    data["element"][0]["friction"]["speeds"] = {"values": [0.0, 1.0, 2.0], "unit": "Pa"}
    with pytest.raises(cw.ModelError, match="has a unit that does not fit"):
        cw.Driveline.from_dict(data)


def test_rows_stand_one_after_another() -> None:
    system = _brake().assemble()
    assert system.points[:, 0].tolist() == [
        300.0,
        400.0,
        0.0,
        50.0,
        100.0,
        0.4,
        0.35,
        0.3,
        0.28,
        0.26,
        0.25,
        0.24,
        0.23,
    ]
    first = system.contact_law_param[0]
    # after the two choices: (first point, number of points) of each list
    assert system.params[first + 2 : first + 10].tolist() == [0.0, 2.0, 2.0, 3.0, 5.0, 2.0, 7.0, 6.0]
    # the temperature of the law is an input of its own
    assert [system.inputs[system.input_refs[system.contact_law_input[0]]].name] == ["b.friction.temperature"]
