"""Every gearbox of the catalogue against its published ratios, and against equations written apart from the package."""

from __future__ import annotations

from collections import Counter
from copy import deepcopy

import numpy as np
import pytest

import clutchwork as cw
from support.catalogue import DUAL, NAMES, SPLITS, Box, data

# those without a row in which two speeds are free; tests/gearbox/test_operating.py has the others
STEPPED = [name for name in NAMES if name not in SPLITS]
# gears whose ratio is published to two decimals only, or whose teeth are fitted to 0.4 %
COARSE = {
    "allison-1000": {"1", "2", "3", "5", "6", "R"},
    "chrysler-41te": {"4", "R"},
    "chrysler-45rfe": {"2", "5"},
    "chrysler-62te": {"6"},
    "gm-6t40": {"R"},
    "gm-6t70": {"R"},
    "vw-dq200": {"7"},
    "zf-8hp51": {"R"},
}


@pytest.mark.parametrize("name", STEPPED)
def test_published_ratios_follow_from_the_teeth(name: str) -> None:
    box = Box(data(name))
    missed = box.misses()
    assert missed
    for gear, miss in missed.items():
        assert miss <= box.allowed(gear) * (1 + 1e-9), gear
    assert {gear for gear, miss in missed.items() if miss > 0.001} <= COARSE.get(name, set())
    # a coarse tolerance says why
    assert box.content.get("tolerance", 0.001) == 0.001 or "olerance" in box.content["notes"]


@pytest.mark.parametrize("name", NAMES)
def test_a_file_says_where_it_comes_from(name: str) -> None:
    content = data(name)
    assert content["name"] == name
    assert content["title"]
    assert len(content["source"]) > 20
    words = content["notes"].lower()
    assert any(word in words for word in ("teeth", "ring over sun", "sun, planet and ring")), "how the teeth are known"
    assert set(content.get("published", ())) <= set(content["gears"])


@pytest.mark.parametrize("name", STEPPED)
def test_every_number_of_teeth_matters(name: str) -> None:
    """A wrong number is noticed: by the independent ratios, and by the package with the gear that it names."""
    content = data(name)
    for set_name, entry in content["sets"].items():
        for key in [key for key, value in entry.items() if not isinstance(value, str)]:
            if key == "teeth_planet":
                continue
            wrong = deepcopy(content)
            wrong["sets"][set_name][key] = entry[key] + 2 if key.startswith("teeth") else entry[key] * 1.05
            box = Box(wrong)
            assert any(miss > box.allowed(gear) for gear, miss in box.misses().items()), (set_name, key)
            with pytest.raises(cw.ModelError, match=r"published|mesh|teeth"):
                cw.Gearbox.from_dict(wrong)


@pytest.mark.parametrize("name", STEPPED)
def test_gears_are_gears_with_nothing_to_spare(name: str) -> None:
    box, ours = Box(data(name)), cw.Gearbox.load(name)
    for gear, closed in box.content["gears"].items():
        kind, dof, redundant, ratio = box.classified(closed)
        assert (kind, dof, redundant) == ("gear", 2 if name in DUAL else 1, 0), gear
        assert ours.ratios[gear] == pytest.approx(ratio, rel=1e-12)


@pytest.mark.parametrize("name", STEPPED)
def test_every_combination_of_closed_elements(name: str) -> None:
    box = Box(data(name))
    ours = {frozenset(one.closed): one for one in cw.Gearbox.load(name).combinations()}
    assert len(ours) == 2 ** len(box.elements)
    for closed in box.combinations():
        kind, dof, redundant, ratio = box.classified(closed)
        one = ours[frozenset(closed)]
        assert (one.kind, one.dof, one.redundant) == (kind, dof, redundant), closed
        if ratio is not None:
            assert float(one.ratio) == pytest.approx(ratio, rel=1e-9), closed


@pytest.mark.parametrize("name", [name for name in STEPPED if name not in DUAL])
def test_speeds_and_torques_of_every_gear(name: str) -> None:
    box, ours = Box(data(name)), cw.Gearbox.load(name)
    for gear, closed in box.content["gears"].items():
        free = box.motions(closed)[:, 0]
        speeds = dict(zip(box.members, free / free[0], strict=True))
        state = ours.state(gear)
        assert set(state.speeds) == set(speeds)
        for member, speed in speeds.items():
            assert state.speeds[member] == pytest.approx(speed, rel=1e-12, abs=1e-12), member
        for element, slip in state.slips.items():
            assert slip == pytest.approx(box.slip(element) @ (free / free[0]), rel=1e-12, abs=1e-12)
        torques, load = box.torques(gear)
        assert set(state.torques) == set(torques)
        for element, torque in torques.items():
            assert state.torques[element] == pytest.approx(torque, rel=1e-12, abs=1e-12), element
        # power in is power out
        assert 1.0 + state.load * speeds[box.members[1]] == pytest.approx(0.0, abs=1e-12)
        assert state.load == pytest.approx(load, rel=1e-12)
        # torques on all parts of each set and on the housing
        for ports in state.set_torques.values():
            if "first" not in ports:
                assert sum(ports.values()) == pytest.approx(0.0, abs=1e-12)
        for powers in state.set_powers.values():
            assert sum(powers.values()) == pytest.approx(0.0, abs=1e-12)
        assert state.housing == pytest.approx(1.0 + load, abs=1e-12)


@pytest.mark.parametrize("name", STEPPED)
def test_forward_ratios_fall_from_gear_to_gear(name: str) -> None:
    box = Box(data(name))
    found = np.array([box.ratio(gear) for gear in box.content["gears"] if not gear.startswith("R")])
    steps = found[1:] / found[:-1]
    assert (steps > 1).all() if box.content.get("ratio_form") == "out/in" else (steps < 1).all()
    ours = {(one.before, one.after): one.step for one in cw.Gearbox.load(name).swaps()}
    gears = [gear for gear in box.content["gears"] if not gear.startswith("R")]
    expected = steps if box.content.get("ratio_form") == "out/in" else 1 / steps
    for before, after, step in zip(gears, gears[1:], expected, strict=False):
        assert ours[before, after] == pytest.approx(step, rel=1e-12)


def test_figures_of_the_ten_speed_box() -> None:
    """Reference figures of another program, to the digits that it gives."""
    box = cw.Gearbox.load("ford-10r80")
    first = box.state("1")
    wanted = {"A": 2.507763975155, "B": 1.187888198758, "D": 0.0, "E": 1.0}
    assert first.torques == pytest.approx(wanted, abs=1e-12)
    assert first.speeds["X"] == pytest.approx(1.217872191011, abs=1e-12)
    assert box.state("10").speeds["out"] == pytest.approx(1 / 0.635714, abs=3e-6)
    kinds = {size: Counter() for size in range(7)}
    for one in box.combinations():
        kinds[len(one.closed)]["gear, idle members" if one.idle else one.kind] += 1
    assert kinds == {
        0: {"neutral": 1},
        1: {"neutral": 6},
        2: {"neutral": 15},
        3: {"neutral": 19, "gear, idle members": 1},
        4: {"gear": 13, "input held": 2},
        5: {"tie-up": 6},
        6: {"tie-up": 1},
    }


def test_figures_of_other_boxes() -> None:
    model_t = cw.Gearbox.load("ford-model-t")
    assert model_t.ratios == {"1": 2.75, "2": 1.0, "R": -4.0}
    assert model_t.state("R").torques == pytest.approx({"REV": -5.0}, abs=1e-12)
    fifth = cw.Gearbox.load("sa-sprinter7").state("5")
    assert fifth.speeds["Sb"] == pytest.approx(0.458937198068, abs=1e-12)
    assert fifth.torques["Bc"] == pytest.approx(-0.195804195804, abs=1e-12)


def test_the_catalogue_by_name() -> None:
    found = cw.catalogue()
    assert list(found) == NAMES
    assert len(NAMES) >= 49
    assert all(box.title and not box.check() for box in found.values())
    with pytest.raises(cw.ModelError, match=r"did you mean .zf-8hp7"):
        cw.Gearbox.load("zf-8hp7")
