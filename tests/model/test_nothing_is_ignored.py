"""What is given and has no effect is refused, and so is what stands for a value that nobody gave."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import specs
from support import samples
from support.amount import seeds


def mistakes(cls: Any, **given: Any) -> str:
    """What is said of a sample of a class with other values."""
    data = samples.driveline(cls).to_dict()
    data["element"] = [one | given if one["name"] == "x" else one for one in data["element"]]
    data["element"] = [{key: value for key, value in one.items() if value is not None} for one in data["element"]]
    try:
        cw.Driveline.from_dict(data).assemble()
    except cw.ModelError as error:
        return str(error)
    return ""


@pytest.mark.parametrize(
    ("cls", "given", "words"),
    [
        (cw.BeltDrive, {"tensioned": "tight"}, "tensioned needs a tensioner; give `tensioner` in place of `preload`"),
        (cw.BeltDrive, {"tensioned": "slack"}, "tensioned needs a tensioner"),
        (cw.FlexibleShaft, {"modes": 3, "segments": 8}, "segments is 8 beside 3 modes; give one of the two"),
        (cw.DiskClutch, {"area": None, "pressure": 1e5}, "area is missing beside a pressure"),
        (cw.DiskClutch, {"area": None, "pressure": None, "normal_force": 9.0, "wear_rate": 1e-12}, "beside wear_rate"),
        (cw.PrescribedSpeed, {"speed": "a"}, "speed follows another part, and a motion is given over time"),
        (cw.RatioActuator, {"command": "a"}, "initial_ratio is missing, and the command says none at the start"),
    ],
)
def test_each_is_refused(cls: Any, given: dict[str, Any], words: str) -> None:
    assert words in mistakes(cls, **given)


@pytest.mark.parametrize(
    ("cls", "given"),
    [
        (cw.BeltDrive, {"preload": None, "tensioner": 300.0, "tensioned": "tight"}),
        (cw.FlexibleShaft, {"modes": 3}),
        (cw.FlexibleShaft, {"segments": 3}),
        (cw.DiskClutch, {"area": None, "pressure": None, "normal_force": 9.0}),
    ],
)
def test_each_has_a_way_that_is_right(cls: Any, given: dict[str, Any]) -> None:
    assert mistakes(cls, **given) == ""


@pytest.mark.parametrize("cls", samples.declared(*samples.ELEMENT_ROLES), ids=lambda cls: cls.kind)
def test_one_shaft_at_two_ports_is_refused(cls: Any) -> None:
    """But at members of a planetary gear, which it locks."""
    ports = [(item.name, spec.domain) for item, spec in specs(cls, "port")]
    if any(name == "carrier" for name, _ in ports):
        pytest.skip("a planetary gear")
    given = next(one for one in samples.driveline(cls).to_dict()["element"] if one["name"] == "x")
    for (first, domain), (second, other) in combinations(ports, 2):
        if domain == other:
            node = given.get(first, given.get(second))
            assert "are both attached to" in mistakes(cls, **{first: node, second: node}), (first, second)


@pytest.mark.random
@pytest.mark.parametrize("seed", seeds(60))
def test_a_converter_table_is_refused_where_it_gives_power(seed: int) -> None:
    """Also between its points: the most of ratio times m, from a fine grid."""
    rng = np.random.default_rng([seed, 8])
    ratios = np.array([0.0, *np.sort(rng.uniform(0.05, 0.95, int(rng.integers(0, 4)))), 1.0])
    # most of them below 1 over the ratio at each point
    multiples = np.minimum(np.sort(rng.uniform(0.2, 4.0, len(ratios)))[::-1], 1.0 / np.maximum(ratios, 1e-3))
    fine = np.linspace(0.0, 1.0, 20_001)
    most = float(np.max(fine * np.interp(fine, ratios, multiples)))
    said = mistakes(
        cw.TorqueConverter,
        speed_ratio=ratios.tolist(),
        torque_ratio=multiples.tolist(),
        capacity=[*[2e-3] * (len(ratios) - 1), 0.0],
    )
    assert ("it would give power" in said) == (most > 1.0 + 1e-7), (most, said)
