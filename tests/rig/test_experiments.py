"""Every experiment with several laws: a finite table, a picture, and results that can be looked up."""

from __future__ import annotations

import csv
from functools import cache
from math import isfinite
from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw
from clutchwork import rig

LAWS = ("coulomb", "stribeck", "lugre", "gms", "mykhalevych")
NAMES = tuple(rig.EXPERIMENTS)


@cache
def performed(name: str) -> rig.Result:
    """One experiment with the laws above."""
    return getattr(rig, name)(LAWS)


def test_every_experiment_has_its_function_and_says_what_it_is() -> None:
    for name, cls in rig.EXPERIMENTS.items():
        assert getattr(rig, name).__doc__ == cls.__doc__
        assert cls.title
        assert set(cls.usual) <= set(rig.PRESETS[cls.preset].laws)


@pytest.mark.parametrize("name", NAMES)
def test_the_table_is_finite_and_the_runs_complete(name: str) -> None:
    result = performed(name)
    assert result.complete
    assert list(result.laws) == list(LAWS)
    numbers = [cell for line in result.table.lines for cell in line if isinstance(cell, float)]
    assert len(numbers) >= len(LAWS)
    assert all(isfinite(number) for number in numbers)
    for label in LAWS:
        assert isinstance(result[label], cw.Trajectory)
        assert result[label].finished


@pytest.mark.parametrize("name", NAMES)
def test_picture_and_table_are_written(name: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    result = performed(name)
    picture, table = result.save(tmp_path)
    assert picture.read_bytes()[:4] == b"\x89PNG"
    with table.open(newline="", encoding="utf-8") as file:
        head, *lines = list(csv.reader(file))
    assert head == [column.head for column in result.table.columns]
    assert [float(line[-1]) for line in lines] == [line[-1] for line in result.table.lines]


@pytest.mark.parametrize("name", NAMES)
def test_pictures_have_units_and_every_law(name: str) -> None:
    pytest.importorskip("matplotlib")
    figure = performed(name).plot()
    drawn = [axes for axes in figure.axes if axes.axison]
    labelled = [axes.get_xlabel() for axes in drawn if axes.get_xlabel()]
    assert all(any(sign in text for sign in (",", "/", "number")) for text in labelled)
    assert any(axes.get_ylabel() for axes in drawn)
    told = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    told += [axes.get_title(loc="left") for axes in drawn]
    for label in LAWS:
        assert any(rig.title(label) in text for text in told)


@pytest.mark.parametrize("name", ["memory", "stall"])
def test_the_picture_grows_with_the_laws_that_have_panels_of_their_own(name: str) -> None:
    pytest.importorskip("matplotlib")
    few, many = getattr(rig, name)("stribeck"), getattr(rig, name)("all")
    assert many.plot().get_figheight() > 3.0 * few.plot().get_figheight()


def test_what_is_not_there_is_answered_with_what_is_near() -> None:
    result = performed("hysteresis")
    assert result["lugre", "sliding"].finished
    with pytest.raises(KeyError, match="did you mean 'lugre'"):
        result["lugr"]
    with pytest.raises(KeyError, match="did you mean 'sliding'"):
        result["lugre", "slidin"]
    with pytest.raises(KeyError, match="did you mean 'sliding peak'"):
        result.table["sliding peek"]
    with pytest.raises(KeyError, match="did you mean 'lugre'"):
        result.table.value("lugra", "sliding peak")


def test_a_law_over_the_temperature_is_refused_with_the_remedy() -> None:
    fades = cw.TemperatureTable(static=[(280.0, 0.35), (500.0, 0.28)], kinetic=[(280.0, 0.3), (500.0, 0.25)])
    with pytest.raises(ValueError, match=r"'lining' is a TemperatureTable over it: give .* FrictionTable"):
        rig.steady({"lining": fades})


def test_a_run_that_stops_early_leaves_a_note_and_no_numbers() -> None:
    result = rig.drift(["naive_sign", "stribeck"])
    assert result.table["note"][0].startswith("chatter at ")
    assert not isfinite(result.table.value("naive_sign", "creep"))
    assert isfinite(result.table.value("stribeck", "creep"))
    assert "naive_sign stopped at" in str(result)
    assert result.table.to_dict()[0]["creep [m]"] is None


def test_settings_change_the_experiment() -> None:
    slow = rig.lag("gms", fast=2.0)
    assert slow.table.columns[-1].head == "gap at 2 Hz [N]"
    with pytest.raises(ValueError, match="did you mean 'fast'"):
        rig.lag("gms", fats=2.0)


def test_shafts_take_the_place_of_masses() -> None:
    result = rig.hysteresis("stribeck", preset="clutch")
    assert result.table.columns[1].head == "elastic peak [N m]"
    assert result.table.value("stribeck", "elastic peak") == pytest.approx(300.0, rel=1e-6)
    assert np.max(np.abs(result["stribeck", "sliding"]["body.angle"])) == pytest.approx(20 * 2e-4, rel=1e-3)
    with pytest.raises(ValueError, match='use preset "clutch"'):
        rig.stall("stribeck", preset="first")
