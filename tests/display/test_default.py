"""The picture in which nothing is named: what a run has, readable for any size."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support import random_drivelines

from .conftest import NAMES, chain, example


def titles(figure: Any) -> list[str]:
    return [axes.get_title(loc="left")[4:] for axes in figure.axes]


def looks(legend: Any) -> set[tuple[str, str]]:
    """Colours and dashes of a legend."""
    return {(line.get_color(), str(line._unscaled_dash_pattern)) for line in legend.get_lines()}


def covered(figure: Any) -> list[Any]:
    """Panels whose legend lies over them, or over the panel below."""
    figure.draw_without_rendering()
    boxes = [axes.get_window_extent() for axes in figure.axes]
    found = []
    for number, axes in enumerate(figure.axes):
        legend = axes.get_legend()
        if legend is not None:
            box = legend.get_window_extent()
            # a few dots of the frame
            below = number + 1 < len(boxes) and box.y0 < boxes[number + 1].y1 - 3.0
            if box.x0 < boxes[number].x1 - 1.0 or below or box.x1 > figure.bbox.x1 + 1.0:
                found.append(axes.get_title(loc="left"))
    return found


@pytest.mark.parametrize("name", NAMES)
def test_the_pictures_of_the_examples(name: str) -> None:
    run = example(name)
    figure = run.plot()
    words = titles(figure)
    assert any("speeds of all" in word for word in words)
    warm = [node.name for node in run.wiring.thermal]
    assert any("temperatures" in word for word in words) == bool(warm)
    if warm:
        (axes,) = (axes for axes, word in zip(figure.axes, words, strict=True) if "temperatures" in word)
        assert axes.get_ylabel() == "temperature, K"
        assert [line.get_label() for line in axes.get_lines()][: len(warm)] == warm
        for line, node in zip(axes.get_lines(), warm, strict=False):
            assert np.array_equal(line.get_ydata(), run[f"{node}.temperature"])
    assert covered(figure) == []


@pytest.mark.parametrize("seed", range(4))
def test_pictures_of_random_drivelines(seed: int) -> None:
    run = random_drivelines.describe(seed).driveline().simulate(random_drivelines.T_END)
    figure = run.plot()
    curves = {line.get_label(): line for line in figure.axes[0].get_lines()}
    for node in run.wiring.nodes:
        assert np.array_equal(curves[node.name].get_ydata(), run[f"{node.name}.speed"])
    assert covered(figure) == []


def test_a_chain_of_thirty_clutches_is_readable() -> None:
    run = chain(30)
    figure = run.plot()
    assert titles(figure)[0] == "speeds of the first 24 of 31 shafts"
    assert titles(figure)[-1] == "states of 24 of 30 clutches and brakes"
    assert covered(figure) == []
    for axes in figure.axes:
        legend = axes.get_legend()
        assert legend is None or len(looks(legend)) == len(legend.get_lines())
    named = run.plot("*.speed")
    assert len(looks(named.axes[0].get_legend())) == 31
    assert covered(named) == []


def test_the_zoom_of_many_shafts_shows_those_that_meet() -> None:
    run = chain(30)
    for event in run.events.changes():
        axes = run.plot(lockup=event).axes[1]
        number = int(event.element.split()[1])
        met = {f"shaft {number - 1}", f"shaft {number}"}
        assert met <= {str(line.get_label()) for line in axes.get_lines()}
        if number > 27:
            break


def test_zoom_and_events_of_the_whole(six_speed: cw.Trajectory) -> None:
    figure = six_speed.plot(zoom=(2.0, 3.0), events="F1")
    whole = [axes for axes in figure.axes if axes.get_title(loc="left")[4:] != "zoom at lock-up"]
    assert {axes.get_xlim() for axes in whole} == {(2.0, 3.0)}
    speed = figure.axes[0].get_lines()[0]
    assert len(speed.get_xdata()) > 1600
    np.testing.assert_allclose(speed.get_ydata(), six_speed.at(speed.get_xdata())["w1.speed"], rtol=1e-12)
