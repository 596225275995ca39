"""Which laws are compared, and with which parameters."""

from __future__ import annotations

import warnings
from dataclasses import replace

import pytest

import clutchwork as cw
from clutchwork import rig
from clutchwork.declare.schema import REGISTRY, Role, inputs
from clutchwork.rig.experiment import chosen

FIRST = rig.PRESETS["first"]


@pytest.mark.parametrize("preset", rig.PRESETS.values(), ids=lambda preset: preset.name)
def test_presets_know_every_law(preset: rig.Preset) -> None:
    over_more = {kind for kind, cls in REGISTRY[Role.LAW].items() if any(inputs(cls))}
    assert set(preset.laws) == set(REGISTRY[Role.LAW]) - over_more
    for kind in preset.laws:
        assert preset.law(kind).kind == kind


def test_names_are_matched_without_case_and_underscores() -> None:
    found = chosen(["LuGre", "elasto-plastic", "REGULARISED STRIBECK", "gms"], FIRST, ())
    assert list(found) == ["lugre", "elastoplastic", "regularised_stribeck", "gms"]


def test_a_misspelt_name_is_answered_with_a_near_one() -> None:
    with pytest.raises(ValueError, match=r"unknown friction law 'mykhalewych'; did you mean 'mykhalevych'\?"):
        rig.drift("mykhalewych")
    with pytest.raises(ValueError, match="did you mean 'second'"):
        rig.drift("lugre", preset="secondd")
    with pytest.raises(TypeError, match="is not a friction law"):
        rig.drift([3.0])
    with pytest.raises(ValueError, match="no friction law is given"):
        rig.drift([])


def test_laws_by_instance_by_label_and_twice() -> None:
    own = cw.Coulomb(static=0.12, kinetic=0.1)
    assert list(chosen([own, "coulomb", own], FIRST, ())) == ["coulomb", "coulomb 2", "coulomb 3"]
    assert list(chosen({"lining": own, "paper": "stribeck"}, FIRST, ())) == ["lining", "paper"]
    assert chosen(own, FIRST, ()) == {"coulomb": own}
    assert "naive_sign" not in chosen("all", FIRST, ())
    assert len(chosen("all", FIRST, ())) == len(FIRST.laws) - 1


def test_a_lining_is_loaded_so_that_it_holds_as_much_as_the_preset() -> None:
    lining = cw.Coulomb(static=0.12, kinetic=0.084)
    both = rig.drift({"lining": lining, "preset": "coulomb"})
    assert both.table.value("lining", "after the push") == pytest.approx(
        both.table.value("preset", "after the push"), rel=1e-6
    )
    # laws without a static coefficient are compared by the kinetic one
    tanh = rig.Bench("t", cw.Tanh(kinetic=0.07, speed=1e-3), FIRST)
    assert tanh.load == pytest.approx(10.0)


def test_presets_do_not_warn_and_laws_of_ones_own_do() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rig.lag("lugre", preset="first")
    own = replace(FIRST.law("lugre"), damping=300.0)
    with pytest.warns(cw.ModelWarning, match="damping"):
        rig.lag(own, preset="first")


def test_a_preset_may_be_changed() -> None:
    stiff = replace(FIRST, name="stiff", stiffness=1e5)
    result = rig.hysteresis("dahl", preset=stiff)
    assert result["dahl", "elastic"]["body.position"].max() == pytest.approx(0.5e-5, rel=1e-3)
