"""Sliders of several numbers, and sliders that go together: the page is Python, copies give every number."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import clutchwork as cw
from clutchwork.assembly.system import System
from clutchwork.model.changes import named, target, unit_of
from clutchwork.page import pairs
from clutchwork.page import sliders as page
from clutchwork.page.data import PageRequest, data_of
from support.project import ROOT

# over the largest that a signal becomes: as in test_parity
SAME = 1e-13
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
    return data_of(system, t_end, cw.Options(), PageRequest(sliders=sliders))


def same(system: cw.System, data: dict[str, Any], values: list[float], found: Any, names: list[str]) -> None:
    """The page has at its end what Python has with the same numbers."""
    turned = zip(data["sliders"], values, strict=True)
    changes = {name: value for one, value in turned if value != one["start"] for name in one["names"]}
    run = cw.simulate(system.changed(changes), data["tEnd"], times=times(data).tolist())
    for name in names:
        assert np.abs(np.array(found["signals"][name]) - run[name]).max() <= SAME * np.abs(run[name]).max(), name


def times(data: dict[str, Any]) -> NDArray[np.float64]:
    """When page and Python are compared."""
    return np.linspace(data["tStart"], data["tEnd"], 21)


def asked(data: dict[str, Any], values: list[float], names: list[str], **more: Any) -> dict[str, Any]:
    """A job of the engine."""
    turned = {str(number): value for number, value in enumerate(values)}
    return {"values": turned, "times": times(data).tolist(), "signals": names, **more}


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
    # the start of the inertia is one more, that of the ratio is outside of the ends
    assert (len(one), len(other)) == (18, 17)
    places = [[one[i], other[k]] for i, k in ((0, 0), (17, 3), (5, 16))] + [
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


def twisted() -> cw.System:
    """Two shafts with a spring without initial twist: its torque then is stiffness times twist."""
    d = cw.Driveline("twisted")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.Spring("s", base=a, follower=b, stiffness=100.0))
    return d.assemble()


def test_a_product_of_which_one_factor_is_zero_at_the_start_has_all_pairs(engine: Any) -> None:
    """Neither slider alone shows that the other one counts."""
    system = twisted()
    data, names = page_data(system, "s.initial_twist=0:0.1", "s.stiffness=50:200"), ["s.torque", "a.speed"]
    assert [pair["sliders"] for pair in data["pairs"]] == [[0, 1]]
    one, other = ([*slider["values"]] for slider in data["sliders"])
    places = [[one[i], other[k]] for i, k in ((-1, -1), (-1, 0), (5, 9), (0, 5))]
    for values, found in zip(places, engine(data, [asked(data, values, names) for values in places]), strict=True):
        same(system, data, values, found, names)


def test_what_two_make_together_may_not_be_what_a_third_makes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Words that only both of a pair change, and one that goes with neither: one would undo the other."""
    system = twisted()
    alone = pairs._pair

    def wider(*given: Any) -> pairs.Pair:
        made = alone(*given)
        places = np.append(made.places, page.sliders(system, ["a.inertia=1:2"], [], System.to_bytes)[0].places[:1])
        return replace(made, places=places)

    monkeypatch.setattr(pairs, "_pair", wider)
    with pytest.raises(cw.UseError, match=r"s\.initial_twist, s\.stiffness and a\.inertia depend on each other"):
        page_data(system, "s.initial_twist=0:0.1", "s.stiffness=50:200", "a.inertia=1:2")


@pytest.mark.parametrize("name", ["a=b", "a,b", "a:b", "a=1:2"])
def test_names_may_have_what_separates(name: str) -> None:
    d = cw.Driveline("named")
    for shaft in (name, "c"):
        d.shaft(shaft, inertia=1.0, speed=10.0)
    system, own = d.assemble(), f"{name}.inertia"
    asked = {own: (own,), f"{own}=1:2": (own,), f"{own}, c.inertia": (own, "c.inertia")}
    asked |= {f"c.inertia, {own}=1:2": ("c.inertia", own), f"{name}*tia=1:2": (own,), f"{name}.*tia": (own,)}
    for text, names in asked.items():
        (one,) = page_data(system, text)["sliders"]
        assert one["names"] == list(names), text
        assert (one["values"][0], one["values"][-1]) == ((1.0, 2.0) if text.endswith("=1:2") else (0.5, 2.0)), text
    with pytest.raises(cw.UseError, match=r"inertiaa.*did you mean"):
        page_data(system, "c.inertiaa=1:2")


def test_a_start_outside_of_the_ends_is_no_stop(engine: Any) -> None:
    """A pair keeps the ends that were asked for; one of it is turned from where the other one starts."""
    system = braked()
    data, names = page_data(system, "*.static=0.32:0.5", "*.kinetic=0.25:0.5"), ["a.speed", "b.speed"]
    assert [one["values"][0] for one in data["sliders"]] == [0.32, 0.25]
    assert [one["values"][-1] for one in data["sliders"]] == [0.5, 0.5]
    (pair,) = data["pairs"]
    assert [values[0] for values in pair["values"]] == [0.3, 0.2]
    starts = [one["start"] for one in data["sliders"]]
    places = [starts, [0.5, starts[1]], [starts[0], 0.25], [0.5, 0.25], [0.5, 0.5], [0.32, 0.25]]
    for values, found in zip(places, engine(data, [asked(data, values, names) for values in places]), strict=True):
        assert found["refusal"] == ""
        same(system, data, values, found, names)
    (wrong,) = engine(data, [asked(data, [starts[0], 0.5], names)])
    assert "below the kinetic coefficient 0.5" in wrong["refusal"]


def test_what_one_slider_is_refused_alone_binds_no_other() -> None:
    """A static coefficient below the kinetic one is none of the business of a gain."""
    data = page_data(braked(), "on_a.gain", "*.static=0.1:0.5", "*.kinetic=0.1:0.5")
    (pair,) = data["pairs"]
    assert pair["sliders"] == [1, 2]


def test_ends_that_cannot_be_reached_are_said() -> None:
    with pytest.raises(cw.UseError, match=r"on_a\.gain cannot reach -1 m3?: .*gain = -1\.0 .*must be > 0"):
        page_data(braked(), "on_a.gain=-1:1")
    for text in ("on_a.gain=1:", "on_a.gain=5 bar:6 bar"):
        with pytest.raises(cw.UseError, match=r"on_a\.gain: '.*' is not an end of its slider; give two numbers in"):
            page_data(braked(), text)


def test_a_constant_pressure_is_dragged_or_turned() -> None:
    d = cw.Driveline("constant")
    shaft = d.shaft("shaft", inertia=1.0, speed=10.0)
    d.add(cw.Brake("b", shaft=shaft, friction=LAW, gain=1e-4, pressure="2 bar"))
    system = d.assemble()
    data = page_data(system, "b.pressure=1 bar:5 bar")
    assert [one["name"] for one in data["tables"]] == []
    (slider,) = data["sliders"]
    assert (slider["unit"], slider["values"][0], slider["values"][-1]) == ("Pa", 1e5, 5e5)
    assert [one["name"] for one in page_data(system)["tables"]] == ["b.pressure"]


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
