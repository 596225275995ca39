"""Pictures: what is drawn, and that matplotlib stays out until one is wanted."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import clutchwork as cw

pytest.importorskip("matplotlib")

SIX_SPEED = Path(__file__).resolve().parents[2] / "examples" / "six_speed" / "model.toml"


@pytest.fixture(scope="module")
def run() -> cw.Trajectory:
    return cw.Driveline.load(SIX_SPEED).simulate(4.0)


def test_the_panels_of_a_gear_shift(run: cw.Trajectory, tmp_path: Path) -> None:
    figure = run.plot(tmp_path / "shift.svg")
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert [title[0] for title in titles] == ["a", "b", "c", "d", "e"]
    assert "pressures" in titles[2]
    assert figure.axes[2].get_ylabel() == "pressure, MPa"
    assert len(figure.axes[0].get_legend().get_texts()) == 8
    assert (tmp_path / "shift.svg").stat().st_size > 10_000


def test_legends_cover_no_curve(run: cw.Trajectory) -> None:
    figure = run.plot()
    figure.draw_without_rendering()
    for axes in figure.axes:
        legend = axes.get_legend()
        if legend is not None:
            assert legend.get_window_extent().x0 >= axes.get_window_extent().x1


def test_what_happens_is_said_above_each_line_where_there_is_room() -> None:
    d = cw.Driveline("third to fourth")
    turbine, wheels = d.shaft("turbine", inertia=0.2, speed="2400 rpm"), d.shaft("wheels", inertia=30.0)
    opens = cw.Ramp(height=-1e6, duration=0.07, start=0.5, offset=1e6)
    closes = cw.Ramp(height=5e5, duration=0.4, start=0.5)
    shift = {"C": {"pressure": opens}, "D": {"pressure": closes}}
    d.add(cw.Transmission("box", input=turbine, output=wheels, gearbox="zf-8hp70", gear="3", shift=shift))
    d.add(cw.Torque("engine", shaft=turbine, torque=200.0))
    figure = d.simulate(1.5).plot("turbine.speed", "box.C.torque", "box.D.torque")
    figure.draw_without_rendering()
    words = figure.axes[0].texts
    assert [word.get_text() for word in words] == ["box.C breaks away", "box.D locks"]
    first, second = (word.get_window_extent() for word in words)
    assert first.x1 < second.x0


def test_signals_of_a_run_without_events() -> None:
    d = cw.Driveline("nothing happens")
    d.shaft("a", inertia=1.0, speed=3.0)
    assert not d.simulate(1.0).plot("a.speed").axes[0].texts


def test_the_zoom_shows_the_chosen_lock_up(run: cw.Trajectory) -> None:
    first = next(event for event in run.events if event.after == "locked")
    axes = run.plot(lockup=first).axes[1]
    left, right = axes.get_xlim()
    assert left < first.time < right
    assert axes.texts[0].get_text() == f"{first.element} locks at {first.time:.4f} s"


def test_a_model_without_contacts_and_one_that_moves_along_a_line() -> None:
    d = cw.Driveline()
    block, wall = d.mass("block", mass=1.0, speed=1.0), d.housing
    d.add(cw.Spring("spring", base=wall, follower=block, stiffness=10.0))
    figure = d.simulate(1.0).plot()
    assert len(figure.axes) == 1
    assert figure.axes[0].get_ylabel() == "speed, m/s"


def test_each_panel_has_one_unit() -> None:
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("b", inertia=0.2)
    block, lining = d.mass("block", mass=2.0, speed=30.0), cw.Coulomb(static=0.3, kinetic=0.3)
    d.add(cw.DiskClutch("c", base=a, follower=b, friction=lining, radius=0.1, area=1e-3, pressure=1e6))
    d.add(cw.BandBrake("band", shaft=b, friction=lining, radius=0.1, wrap=4.0, force=10.0))
    d.add(cw.Brake("slide", shaft=block, friction=lining, gain=1.0, normal_force=20.0))
    labels = [axes.get_ylabel() for axes in d.simulate(0.1).plot().axes]
    pressed = ["pressure, MPa", "actuating force, N"]
    assert labels[3:7] == [*pressed, "torque on follower, N m", "force on follower, N"]


def test_spans_of_locked_phases() -> None:
    from clutchwork.plot.panels import spans

    time = np.array([0.0, 1.0, 2.0, 2.0, 3.0, 4.0])
    assert spans(time, np.array([False, True, True, False, False, True])) == [(1.0, 1.0), (4.0, 0.0)]
    assert spans(time, np.ones(6, dtype=bool)) == [(0.0, 4.0)]
    assert spans(time, np.zeros(6, dtype=bool)) == []


def test_matplotlib_is_imported_when_a_picture_is_drawn() -> None:
    code = "import sys, clutchwork.run.trajectory, clutchwork.plot; assert 'matplotlib' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_letter_of_the_frame_stays_in_its_panel(run: cw.Trajectory) -> None:
    """Also where the lock-up is at the end of the run, so that the frame ends at the edge."""
    lock = next(event for event in run.events if event.after == "locked")
    for end in (float(run.time[-1]), lock.time + 1e-3):
        figure = cw.simulate(run.system, end).plot()
        figure.canvas.draw()
        letters = [text for axes in figure.axes[:1] for text in axes.texts if text.get_text() in ("b", "c")]
        assert letters
        for text in letters:
            assert text.get_window_extent().x1 <= figure.axes[0].get_window_extent().x1


def test_only_a_single_instant_is_dotted() -> None:
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    lining = cw.Coulomb(static=0.125, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=5e-4, pressure=2e5))
    run = d.simulate(2.5)
    # its lines at the lock-up are upright
    assert {line.get_marker() for axes in run.plot().axes for line in axes.get_lines()} == {"None"}
    assert "o" in {line.get_marker() for line in run.at(1.0).plot().axes[0].get_lines()}
