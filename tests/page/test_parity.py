"""A page after dragging is Python with the same knots, and so is what it copies; any position ends with a status."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.layout import CAUSES, MODES, STATUS
from clutchwork.page.data import PageRequest, data_of
from clutchwork.page.html import as_json
from clutchwork.run.settings import merged
from support import example_models
from support.amount import amount
from support.project import ROOT

SIX_SPEED = "examples/six_speed/model.toml"
# of the scale of a signal: core and page have the same bits, but numpy may add the parts of a signal in another order
SAME = 1e-13
POINTS, PASSING = 401, 7


@cache
def model_of(name: str) -> tuple[cw.System, float]:
    """The System of an example, and the end of its run [s]."""
    return example_models.model(name)


def page_data(name: str, sliders: tuple[str, ...] | None = None) -> dict[str, Any]:
    """What a page of an example holds."""
    system, t_end = model_of(name)
    _, options = merged(system.settings, {"t_end": t_end})
    data: dict[str, Any] = json.loads(as_json(data_of(system, t_end, options, PageRequest(sliders=sliders))))
    return data


def python_run(name: str, data: dict[str, Any], job: dict[str, Any]) -> cw.Trajectory:
    """The same in Python."""
    system, t_end = model_of(name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        grid = np.linspace(data["tStart"], data["tEnd"], POINTS)
        most = int(data["options"]["max_steps"])
        return cw.simulate(system.changed(changes(data, job)), t_end, times=grid, max_steps=most)


def moved(data: dict[str, Any], random: np.random.Generator, size: float) -> dict[str, list[list[float]]]:
    """Random positions of all knots between their neighbours."""
    found = {}
    for number, table in enumerate(data["tables"]):
        knots = [list(knot) for knot in table["points"]]
        high = max(abs(y) for _, y in knots) or 1.0
        for i, (time, value) in enumerate(knots):
            low, most = (knots[i - 1][0] if i else 0.0), (knots[i + 1][0] if i + 1 < len(knots) else time)
            knots[i][0] = time + size * random.uniform(-0.4, 0.4) * min(time - low, most - time)
            knots[i][1] = float(np.clip(value + size * random.normal(0.0, 0.3) * high, 0.0, 2.0 * high))
        found[str(number)] = knots
    return found


def jobs(data: dict[str, Any], count: int, size: float, **more: Any) -> Iterator[dict[str, Any]]:
    """The start, then random positions of knots; far away also of sliders."""
    random = np.random.default_rng(15)
    yield {**more}
    for _ in range(count):
        turned = enumerate(data["sliders"]) if size > 1.0 else ()
        values = {str(i): float(random.choice(one["values"])) for i, one in turned}
        yield {"knots": moved(data, random, size), "values": values, **more}


def changes(data: dict[str, Any], job: dict[str, Any]) -> dict[str, Any]:
    """What `System.changed` is given for the same."""
    made: dict[str, Any] = {table["name"]: cw.Table(table["points"]) for table in data["tables"]}
    made |= {data["tables"][int(i)]["name"]: cw.Table(knots) for i, knots in job.get("knots", {}).items()}
    return made | {data["sliders"][int(i)]["name"]: value for i, value in job.get("values", {}).items()}


@pytest.mark.parametrize("size", [0.2, 1.5], ids=["dragged", "anywhere"])
@pytest.mark.parametrize("name", example_models.MODELS)
def test_a_page_is_python_with_the_same_knots(name: str, size: float, engine: Any) -> None:
    data = page_data(name)
    times = np.linspace(data["tStart"], data["tEnd"], POINTS)
    units = {name: one["unit"] for name, one in data["signals"].items() if not name.endswith(".jerk")}
    asked = list(jobs(data, 5, size, times=times.tolist(), signals=list(units)))
    for job, found in zip(asked, engine(data, asked), strict=True):
        run = python_run(name, data, job)
        assert (STATUS[found["status"]][0], found["count"]) == (run.status, len(run.time))
        # those of one instant have no order
        assert sorted(event[:5] for event in found["events"]) == sorted(codes(run, event) for event in run.events)
        assert max(difference(run, found["signals"], name, units) for name in units) <= SAME


def test_every_example_is_looked_at() -> None:
    folders = {path.name for path in (ROOT / "examples").iterdir() if path.is_dir() and any(path.glob("*.py"))}
    folders |= {path.parent.name for path in (ROOT / "examples").rglob("model.toml")}
    assert folders <= {*example_models.MODELS, *example_models.WITHOUT}


def difference(run: cw.Trajectory, signals: dict[str, Any], name: str, units: dict[str, str]) -> float:
    """How far a signal is from that of Python, over the largest of its unit."""
    scale = max(np.abs(run[other]).max() for other in units if units[other] == units[name])
    return float(np.abs(np.array(signals[name]) - run[name]).max() / (scale or 1.0))


def codes(run: cw.Trajectory, event: cw.Event) -> list[float]:
    """Time, contact, modes and cause of an event as the core writes them."""
    modes, causes = {word: n for n, word in MODES.items()}, {word: n for n, (word, _) in CAUSES.items()}
    names = [branch.name for branch in run.wiring.contacts]
    contact = names.index(event.element) if event.element else -1
    return [event.time, contact, modes[event.before], modes[event.after], causes[event.cause]]


@pytest.mark.random
def test_every_position_of_the_knots_ends_with_a_status(engine: Any) -> None:
    data = page_data("six_speed")
    random = np.random.default_rng(3)
    asked = [{"knots": moved(data, random, random.uniform(0.0, 2.5))} for _ in range(amount(100))]
    for found in engine(data, asked):
        assert 0 <= found["status"] < len(STATUS)
        assert found["status"] != [name for name, *_ in STATUS].index("bad_system")
        assert 0.0 < found["reached"] <= data["tEnd"]


def test_what_is_copied_is_what_is_shown(engine: Any, tmp_path: Any) -> None:
    data = page_data("six_speed", ("F1.gain", "w1.inertia"))
    *_, asked = jobs(data, 1, 0.5, copies=True, times=[3.9], signals=["w8.speed"])
    (found,) = engine(data, [asked])
    path = tmp_path / "model.toml"
    path.write_text(found["toml"], encoding="utf-8")
    written = cw.Driveline.load(path).simulate(times=[3.9])["w8.speed"][-1]
    known: dict[str, Any] = {}
    program = (
        found["python"]
        .replace('"model.toml"', repr(str(ROOT / SIX_SPEED)))
        .replace("print(run.events)", "run = cw.simulate(system, times=[3.9])")
    )
    exec(program, known)
    assert found["signals"]["w8.speed"][0] == pytest.approx(written, rel=SAME)
    assert known["run"]["w8.speed"][-1] == pytest.approx(written, rel=SAME)


def test_a_slider_with_stops_has_the_words_of_python(engine: Any) -> None:
    """An inertia goes into the mass matrix with others: its stops are those that Python computed."""
    data = page_data("six_speed", ("w1.inertia=10:40",))
    (slider,) = data["sliders"]
    assert not slider["direct"]
    # and the start
    assert len(slider["values"]) == 41 + 1
    times, names = np.linspace(0.0, 4.0, POINTS), ["w1.speed", "w8.acceleration"]
    asked = [{"values": {"0": value}, "times": times.tolist(), "signals": names} for value in slider["values"][::8]]
    for job, found in zip(asked, engine(data, asked), strict=True):
        run = python_run("six_speed", data, job)
        for name in names:
            scale = np.abs(run[name]).max()
            assert np.abs(np.array(found["signals"][name]) - run[name]).max() <= SAME * scale


def test_the_largest_jerk_is_that_of_calibration(engine: Any) -> None:
    """docs/theory/jerk.md (1), in which the jump of a lock-up counts."""
    (found,) = engine(page_data("six_speed"), [{"measures": 4}])
    (jerk,) = (one["value"] for one in found["measures"] if one["name"] == "Largest jerk of w8 over 0.05 s")
    window, end = 0.05, 4.0
    at = np.arange(window, end - window + 1e-9, window / 16)
    times = np.unique(np.concatenate([at - window, at, at + window]).round(12))
    system, _ = model_of("six_speed")
    speed = dict(zip(times, cw.simulate(system, end, times=times)["w8.speed"], strict=True))
    v = [[speed[key] for key in (at + shift).round(12)] for shift in (-window, 0.0, window)]
    wanted = np.max(np.abs(np.array(v[0]) - 2 * np.array(v[1]) + v[2])) / window**2
    # a page knows the acceleration four times a step, and takes it as straight between
    assert jerk == pytest.approx(wanted, rel=0.01)
