"""Sliders of several numbers, and sliders that go together: the page is Python, copies give every number."""

from __future__ import annotations

from typing import Any

import pytest

import clutchwork as cw
from clutchwork.model.changes import named, target, unit_of
from clutchwork.page.data import Wanted, data_of
from support.project import ROOT

# tolerance of the solver, and what may be between page and Python: as in test_parity
TIGHT, CLOSE = {"rtol": 1e-11, "atol": 1e-13}, 1e-9
LAW = cw.Stribeck(static=0.3, kinetic=0.2, speed=2.0)


def braked(gains: tuple[float, float] = (1e-4, 1e-4), law: cw.Law = LAW) -> cw.System:
    """Two discs that are braked, with one spring between them."""
    d = cw.Driveline("braked")
    discs = [d.shaft(name, inertia=1.0, speed=10.0) for name in ("a", "b")]
    for disc, gain in zip(discs, gains, strict=True):
        pressure = cw.Table([(0.0, 0.0), (0.5, 2e5)])
        d.add(cw.Brake(f"on_{disc.name}", shaft=disc, friction=law, gain=gain, pressure=pressure))
    d.add(cw.Spring("spring", base=discs[0], follower=discs[1], stiffness=10.0))
    return d.assemble()


def page_data(system: cw.System, *sliders: str, t_end: float = 1.0) -> dict[str, Any]:
    """What a page with sliders holds."""
    data = data_of(system, t_end, cw.Options(), Wanted(sliders=sliders))
    data["options"] |= TIGHT
    return data


def same(system: cw.System, data: dict[str, Any], values: list[float], found: Any, names: list[str]) -> None:
    """The page has at its end what Python has with the same numbers."""
    turned = zip(data["sliders"], values, strict=True)
    changes = {name: value for one, value in turned if value != one["start"] for name in one["names"]}
    run = cw.simulate(system.changed(changes), data["tEnd"], times=[data["tEnd"]], **TIGHT)
    for name in names:
        assert found["signals"][name][0] == pytest.approx(run[name][-1], rel=CLOSE, abs=CLOSE)


def asked(data: dict[str, Any], values: list[float], names: list[str], **more: Any) -> dict[str, Any]:
    """A job of the engine."""
    turned = {str(number): value for number, value in enumerate(values)}
    return {"values": turned, "times": [data["tEnd"]], "signals": names, **more}


@pytest.mark.parametrize("slider", ["on_*.gain=5e-5:4e-4", "on_a.gain, on_b.gain=5e-5:4e-4"])
def test_one_slider_turns_several_numbers(slider: str, engine: Any) -> None:
    system = braked()
    data, names = page_data(system, slider), ["a.speed", "b.speed"]
    (one,) = data["sliders"]
    assert (one["names"], one["unit"], one["start"]) == (["on_a.gain", "on_b.gain"], "m3", 1e-4)
    places = [[value] for value in (5e-5, 1e-4, 1.2345e-4, 4e-4)]
    assert one["direct"]
    for values, found in zip(places, engine(data, [asked(data, values, names) for values in places]), strict=True):
        same(system, data, values, found, names)


def test_numbers_with_different_starts_keep_them_until_they_are_turned(engine: Any) -> None:
    system = braked(gains=(1e-4, 3e-4))
    data, names = page_data(system, "*.gain"), ["a.speed", "b.speed"]
    (one,) = data["sliders"]
    assert one["starts"] == [1e-4, 3e-4]
    assert (one["values"][0], one["values"][-1]) == (5e-5, 6e-4)
    places = [[one["start"]], [2.5e-4]]
    for values, found in zip(places, engine(data, [asked(data, values, names) for values in places]), strict=True):
        same(system, data, values, found, names)


def test_every_number_is_copied(engine: Any, tmp_path: Any) -> None:
    system = braked(gains=(1e-4, 3e-4))
    data, names = page_data(system, "*.gain", "*.inertia=0.5:2"), ["a.speed", "b.speed"]
    values = [2.5e-4, data["sliders"][1]["values"][-1]]
    (found,) = engine(data, [asked(data, values, names, copies=True)])
    path = tmp_path / "model.toml"
    path.write_text(found["toml"], encoding="utf-8")
    model = cw.Driveline.load(path)
    same(model.assemble(), data, [one["start"] for one in data["sliders"]], found, names)
    for name in ("on_a.gain", "on_b.gain", "a.inertia", "b.inertia"):
        assert f'"{name}": ' in found["python"]


def test_two_sliders_that_change_the_same_words_have_all_pairs(engine: Any) -> None:
    """Inertias of wheels on one shaft and the ratio of their gear go into one number of the driveline."""
    system = cw.Driveline.load(ROOT / "examples/six_speed/model.toml").assemble()
    data, names = page_data(system, "w1.inertia=10:40", "divider.ratio=1.2:1.6", t_end=4.0), ["w1.speed", "w8.speed"]
    (pair,) = data["pairs"]
    assert pair["refused"] == {}
    one, other = ([*slider["values"]] for slider in data["sliders"])
    assert len(one) == len(other) == 18
    places = [[one[i], other[k]] for i, k in ((0, 0), (17, 3), (5, 17))] + [
        [data["sliders"][0]["start"], other[9]],
        [one[9], data["sliders"][1]["start"]],
        [slider["start"] for slider in data["sliders"]],
    ]
    for values, found in zip(places, engine(data, [asked(data, values, names) for values in places]), strict=True):
        assert found["refusal"] == ""
        same(system, data, values, found, names)


def test_what_python_refuses_is_refused_on_the_page(engine: Any) -> None:
    """A static coefficient below the kinetic one: the two go together, and the page says why there is no run."""
    system = braked()
    data, names = page_data(system, "*.static=0.1:0.5", "*.kinetic=0.05:0.5"), ["a.speed"]
    places = [[s, k] for s in data["sliders"][0]["values"][::4] for k in data["sliders"][1]["values"][::4]]
    made = engine(data, [asked(data, values, names) for values in places])
    for (static, kinetic), found in zip(places, made, strict=True):
        assert bool(found["refusal"]) == (kinetic > static * (1 + 1e-12))
        if found["refusal"]:
            assert f"is {static:g}, below the kinetic coefficient {kinetic:g}" in found["refusal"]
        else:
            same(system, data, [static, kinetic], found, names)


def test_sliders_within_what_is_allowed_do_not_go_together() -> None:
    data = page_data(braked(), "*.static=0.25:0.5", "*.kinetic=0.05:0.25")
    assert data["pairs"] == []
    assert all(one["direct"] for one in data["sliders"])


def test_more_than_two_that_go_together_are_refused() -> None:
    system = cw.Driveline.load(ROOT / "examples/six_speed/model.toml").assemble()
    said = "w1.inertia, w3.inertia and divider.ratio depend on each other in this driveline, and a page has at most two"
    with pytest.raises(cw.UseError, match=said):
        page_data(system, "w1.inertia", "w3.inertia", "F1.gain", "divider.ratio")


def test_numbers_of_a_law_have_the_units_of_what_is_joined() -> None:
    law = cw.LuGre(static=0.15, kinetic=0.1, speed=0.2, stiffness=100.0, damping=0.01, viscous=0.1)
    d = cw.Driveline("both")
    mass, shaft = d.mass("mass", mass=1.0), d.shaft("shaft", inertia=1.0)
    for name, node in (("slides", mass), ("turns", shaft)):
        d.add(cw.Brake(name, shaft=node, friction=law, gain=1.0, normal_force=10.0))
    owners = named(d.assemble().source)
    units = {"speed": "m/s rad/s", "stiffness": "1/m 1/rad", "viscous": "s/m s/rad", "static": "1 1"}
    for word, both in units.items():
        found = [unit_of(target(owners, f"{name}.friction.{word}")) for name in ("slides", "turns")]
        assert found == both.split(), word
