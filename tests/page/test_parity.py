"""A page after dragging is Python with the same knots, and so is what it copies; any position ends with a status."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.layout import STATUS
from clutchwork.page.data import Wanted, data_of
from clutchwork.page.html import as_json
from clutchwork.run.settings import merged
from support.amount import amount
from support.project import ROOT

MODELS = sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "examples").rglob("model.toml"))
SIX_SPEED = "examples/six_speed/model.toml"
# tolerance of the solver, and what may be between page and Python: the core of a page has fewer exact forms and
# another mathematical library, so that steps differ within the tolerance
TIGHT, CLOSE = {"rtol": 1e-11, "atol": 1e-13}, 1e-9
USUAL, APART = {"rtol": 1e-6, "atol": 1e-8}, 3e-5
POINTS, PASSING = 401, 7


@cache
def system_of(path: str) -> cw.System:
    """The System of an example."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        return cw.Driveline.load(ROOT / path).assemble()


@cache
def text_of(path: str, sliders: tuple[str, ...] | None) -> bytes:
    """What a page of an example holds."""
    system = system_of(path)
    t_end, options = merged(system.settings, {})
    return as_json(data_of(system, t_end, options, Wanted(sliders=sliders)))


def page_data(path: str, tolerance: dict[str, float], sliders: tuple[str, ...] | None = None) -> dict[str, Any]:
    """What a page of an example holds, at a tolerance of the solver."""
    data: dict[str, Any] = json.loads(text_of(path, sliders))
    data["options"] |= tolerance
    return data


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
@pytest.mark.parametrize("allowed", [(TIGHT, CLOSE), (USUAL, APART)], ids=["tight", "usual"])
@pytest.mark.parametrize("model", MODELS, ids=[Path(model).parent.name for model in MODELS])
def test_a_page_is_python_with_the_same_knots(model: str, allowed: Any, size: float, engine: Any) -> None:
    tolerance, most = allowed
    system = system_of(model)
    data = page_data(model, tolerance)
    times = np.linspace(data["tStart"], data["tEnd"], POINTS)
    units = {name: one["unit"] for name, one in data["signals"].items() if not name.endswith(".jerk")}
    asked = list(jobs(data, 5, size, times=times.tolist(), signals=list(units)))
    for job, found in zip(asked, engine(data, asked), strict=True):
        run = cw.simulate(system.changed(changes(data, job)), times=times, **tolerance)
        assert (found["status"], found["count"]) == (0, POINTS)
        assert acts(event[1:5] for event in found["events"]) == acts(codes(run, event) for event in run.events)
        assert max(difference(run, found["signals"], name, units) for name in units) <= most


def difference(run: cw.Trajectory, signals: dict[str, Any], name: str, units: dict[str, str]) -> float:
    """How far a signal is from that of Python, over the largest of its unit."""
    scale = max(np.abs(run[other]).max() for other in units if units[other] == units[name])
    return float(np.abs(np.array(signals[name]) - run[name]).max() / (scale or 1.0))


def acts(events: Iterable[list[float]]) -> list[list[float]]:
    """Events without open contacts that turn over, several of which may do so at one instant, in any order."""
    return [event for event in events if event[3] != PASSING]


def codes(run: cw.Trajectory, event: cw.Event) -> list[float]:
    """Contact, modes and cause of an event as the core writes them."""
    from clutchwork.declare.layout import CAUSES, MODES

    modes, causes = {word: n for n, word in MODES.items()}, {word: n for n, (word, _) in CAUSES.items()}
    names = [branch.name for branch in run.wiring.contacts]
    contact = names.index(event.element) if event.element else -1
    return [contact, modes[event.before], modes[event.after], causes[event.cause]]


def test_every_position_of_the_knots_ends_with_a_status(engine: Any) -> None:
    data = page_data(SIX_SPEED, USUAL)
    random = np.random.default_rng(3)
    asked = [{"knots": moved(data, random, random.uniform(0.0, 2.5))} for _ in range(amount(100))]
    for found in engine(data, asked):
        assert 0 <= found["status"] < len(STATUS)
        assert found["status"] != [name for name, *_ in STATUS].index("bad_system")
        assert 0.0 < found["reached"] <= data["tEnd"]


def test_what_is_copied_is_what_is_shown(engine: Any, tmp_path: Any) -> None:
    data = page_data(SIX_SPEED, TIGHT, ("F1.gain", "w1.inertia"))
    *_, asked = jobs(data, 1, 0.5, copies=True, times=[3.9], signals=["w8.speed"])
    (found,) = engine(data, [asked])
    path = tmp_path / "model.toml"
    path.write_text(found["toml"], encoding="utf-8")
    (tmp_path / "copied.py").write_text(found["python"], encoding="utf-8")
    written = cw.Driveline.load(path).simulate(times=[3.9], **TIGHT)["w8.speed"][-1]
    known: dict[str, Any] = {}
    program = (
        found["python"]
        .replace('"model.toml"', repr(str(ROOT / SIX_SPEED)))
        .replace("print(run.events)", f"run = cw.simulate(system, times=[3.9], **{TIGHT})")
    )
    exec(program, known)
    assert found["signals"]["w8.speed"][0] == pytest.approx(written, rel=CLOSE)
    assert known["run"]["w8.speed"][-1] == pytest.approx(written, rel=CLOSE)


def test_a_slider_with_stops_has_the_words_of_python(engine: Any) -> None:
    """An inertia goes into the mass matrix with others: its stops are those that Python computed."""
    system = system_of(SIX_SPEED)
    data = page_data(SIX_SPEED, TIGHT, ("w1.inertia=10:40",))
    (slider,) = data["sliders"]
    assert not slider["direct"]
    asked = [{"values": {"0": value}, "times": [4.0], "signals": ["w1.speed"]} for value in slider["values"][::8]]
    for job, found in zip(asked, engine(data, asked), strict=True):
        run = cw.simulate(system.changed(changes(data, job)), times=[4.0], **TIGHT)
        assert found["signals"]["w1.speed"][0] == pytest.approx(run["w1.speed"][-1], rel=CLOSE)
