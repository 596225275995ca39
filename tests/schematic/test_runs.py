"""A schematic of an instant shows the states and numbers of the run."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.schematic.look import HALO, STATE
from clutchwork.schematic.pen import Stroke
from support import random_drivelines, schematics

ROOT = Path(__file__).resolve().parents[2]


@cache
def model(name: str) -> tuple[cw.Driveline, cw.Trajectory]:
    if name.startswith("random"):
        d = random_drivelines.describe(int(name.split()[1])).driveline()
        return d, d.simulate(random_drivelines.T_END)
    d = cw.Driveline.load(ROOT / "examples" / name / "model.toml")
    return d, d.simulate()


def state(made: cw.Driveline, name: str) -> str:
    """The state that a symbol has the look of."""
    piece = next(piece for piece in made.sheet.pieces if piece.name == name and piece.what == "element")
    strokes = [mark for mark in piece.marks if isinstance(mark, Stroke)]
    found = [state for state, colour in HALO.items() if any(m.look.fill == colour for m in strokes)]
    if found:
        (one,) = found
        return one
    return "open" if any(m.look.colour == STATE["open"].colour for m in strokes) else ""


def wanted(run: cw.Trajectory, name: str, row: int) -> str:
    if run[f"{name}.state"][row] == "locked":
        return "locked"
    return "slipping" if run[f"{name}.torque"][row] != 0.0 and run[f"{name}.mode"][row] != 2 else "open"


@pytest.mark.parametrize("name", ["launch", "six_speed", "car_launch", *(f"random {seed}" for seed in range(4))])
def test_states_are_those_of_the_run(name: str) -> None:
    d, run = model(name)
    seen = set()
    for row in np.linspace(0, len(run) - 1, 6).astype(int):
        at = float(run.time[row])
        # an instant that stands there twice is shown as it is after the event
        last = int(np.flatnonzero(run.time == at)[-1])
        made = d.draw(run=run, at=at)
        for branch in run.wiring.contacts:
            if branch.name in {element.name for element in d.elements}:
                assert state(made, branch.name) == wanted(run, branch.name, last), (branch.name, at)
                seen.add(wanted(run, branch.name, last))
        assert schematics.overlaps(made.sheet) == []
    assert len(seen) >= 2


def test_numbers_are_those_of_the_run() -> None:
    d, run = model("launch")
    made = d.draw(run=run, at=0.4)
    exact = run.at([0.4])
    written = {p.name: [t.text.replace("\u2009", " ") for t in p.text] for p in made.sheet.pieces}
    assert f"{exact['engine.speed'][0]:.4g} rad/s" in written["engine"]
    assert f"{exact['clutch.torque'][0]:.4g} N m" in written["clutch"]
    assert f"slip {exact['clutch.slip'][0]:.4g} rad/s".replace("-", "−") in written["clutch"]
    assert "launch, t = 0.4 s" in made._repr_svg_()


def test_at_an_event_it_is_as_after_it() -> None:
    d, run = model("launch")
    event = next(event for event in run.events if event.after == "locked")
    assert state(d.draw(run=run, at=event.time), "clutch") == "locked"
    assert state(d.draw(run=run, at=event.time - 1e-4), "clutch") == "slipping"


def test_without_a_time_it_is_the_end() -> None:
    d, run = model("launch")
    assert d.draw(run=run).time == run.time[-1]


def test_a_time_may_have_a_unit() -> None:
    d, run = model("launch")
    assert d.draw(run=run, at="400 ms")._repr_svg_() == d.draw(run=run, at=0.4)._repr_svg_()
    with pytest.raises(cw.UseError, match="at is '3 m'"):
        d.draw(run=run, at="3 m")


def test_power_is_shown_when_asked() -> None:
    d, run = model("launch")
    plain, full = d.draw(run=run, at=0.4), d.draw(run=run, at=0.4, power=True)
    watts = [text for text in schematics.texts(full.sheet) if text.endswith("W")]
    assert len(watts) >= 3
    assert not [text for text in schematics.texts(plain.sheet) if text.endswith("W")]


def test_a_legend_stands_below_pictures_of_runs_alone() -> None:
    d, run = model("launch")
    words = [f">{state}<" for state in ("locked", "slipping", "open")]
    assert all(word in d.draw(run=run, at=0.4)._repr_svg_() for word in words)
    assert not any(word in d.draw()._repr_svg_() for word in words)


def test_a_dog_clutch_and_a_synchroniser_are_locked_while_they_mesh() -> None:
    d = schematics.manual()
    d.simulation = {"t_end": 1.0}
    run = d.simulate()
    made = d.draw(run=run, at=1.0)
    # that of gears 1 and 2 is shifted, the other one stays in neutral
    for name, is_locked in (("sleeve 1/2", True), ("sleeve 3/4", False)):
        assert bool(run[f"{name}.forward_dog.sleeve"][-1] > 0.5) is is_locked
        piece = next(piece for piece in made.sheet.pieces if piece.name == name)
        assert (STATE["locked"].colour in {mark.look.colour for mark in piece.marks}) is is_locked


def test_a_run_that_stopped_early_is_shown_where_it_got_to() -> None:
    d, _ = model("launch")
    with pytest.warns(cw.StoppedEarly):
        run = d.simulate(3.0, max_steps=5)
    assert not run.finished
    made = d.draw(run=run)
    assert made.time == run.time[-1]


def test_what_holds_a_driveline_can_be_drawn() -> None:
    d, run = model("launch")
    svg = d.draw()._repr_svg_()
    assert cw.draw(d)._repr_svg_() == svg
    assert cw.draw(d.assemble())._repr_svg_() == svg
    assert cw.draw(run, at=0.4)._repr_svg_() == d.draw(run=run, at=0.4)._repr_svg_()


def test_what_does_not_fit_is_said_at_once(tmp_path: Path) -> None:
    d, run = model("launch")
    with pytest.raises(cw.UseError, match=r"the run goes from 0 to 3 s") as error:
        d.draw("picture.jpg", run=run, at=7.0)
    assert "picture.jpg" in str(error.value)
    with pytest.raises(cw.UseError, match="there is no run"):
        d.draw(at=1.0)
    with pytest.raises(cw.UseError, match="run=") as error:
        d.draw(run, at=1.0)
    with pytest.raises(cw.UseError, match="another driveline"):
        schematics.manual().draw(run=run)
    with pytest.raises(cw.UseError, match="at least 20 mm"):
        d.draw(width=-1.0)
    with pytest.raises(cw.UseError, match="holds no driveline"):
        cw.draw(3)
    with pytest.raises(cw.UseError, match="give one time"):
        d.draw(run=run, at=[0.1, 0.2])
    with pytest.raises(cw.UseError, match="unknown field 'value'"):
        d.draw(value=False)
    with pytest.raises(cw.UseError, match=r"\.svg, \.png or \.pdf"):
        d.draw().save(tmp_path / "picture")
