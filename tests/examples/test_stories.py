"""Three tasks of somebody who is new, as the guide tells them: their files, pictures and numbers hold."""

from __future__ import annotations

import base64
import copy
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from support.project import ROOT

GUIDE = ROOT / "docs" / "guide"


def programs(name: str) -> list[str]:
    """The Python blocks of a page."""
    text = (GUIDE / f"{name}.md").read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


@pytest.fixture
def clone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with the examples, as the root of a clone has them."""
    pytest.importorskip("matplotlib").use("agg")
    shutil.copytree(ROOT / "examples", tmp_path / "examples", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", list(sys.path))
    return tmp_path


def told(name: str) -> dict[str, Any]:
    """What the programs of a page define."""
    names: dict[str, Any] = {}
    exec(compile("\n".join(programs(name)), f"{name}.md", "exec"), names)
    return names


def test_the_first_launch_prints_what_its_page_shows(clone: Path) -> None:
    names, page = told("start"), (GUIDE / "start.md").read_text(encoding="utf-8")
    assert f"locks at {names['run'].events[-1].time:.3f} s" in page
    assert " ".join(str(names["soft"].hints).split()) in " ".join(page.split())
    (clutch,) = (item for item in names["d"].elements if item.name == "clutch")
    assert f"{clutch.gain:.3e} m3".replace("e-03", "e-3") in page
    for made in ("model.svg", "launch.png", "both.png"):
        assert (clone / made).stat().st_size > 5000


def test_a_thermal_launch_is_drawn_exported_and_varied(clone: Path) -> None:
    asammdf = pytest.importorskip("asammdf")
    pandas = pytest.importorskip("pandas")
    names = told("thermal-launch")
    run, found = names["run"], names["found"]
    for made in ("model.svg", "launch.png", "variants.png"):
        assert (clone / made).stat().st_size > 10_000
    assert run["half_shafts.torque"].max() > 1500.0

    frame = pandas.read_parquet(clone / "launch.parquet")
    assert frame["half_shafts.torque"].to_numpy().tobytes() == run["half_shafts.torque"].tobytes()
    assert frame.attrs["units"]["half_shafts.torque"] == "N m"
    with asammdf.MDF(clone / "launch.mf4") as mdf:
        signal = mdf.get("half_shafts.torque")
        assert signal.unit == "N m"
        grid = np.linspace(0.0, 4.0, 4001)
        assert signal.timestamps == pytest.approx(grid, abs=1e-12)
        # twice the same computation, at the same instants
        assert signal.samples == pytest.approx(run.at(grid)["half_shafts.torque"], rel=1e-9, abs=1e-6)

    assert len(found["lock"]) == 200
    assert found.finished.all()
    # a variant is the run of its own, bit for bit
    for number in (0, 87, 199):
        alone = found.run(number)
        assert alone.events.of("clutch")[-1].time == found["lock"][number]
    # heat over capacity: the lighter plates rise more, at every temperature
    rise = found["hottest"].reshape(10, 20) - names["warm"]
    assert (np.diff(rise, axis=0) < 0.0).all()
    # the lining grips best near 400 K
    assert abs(names["warm"][np.argmin(found["lock"].reshape(10, 20)[5])] - 400.0) <= 10.0


def test_a_closed_loop_shift_is_saved_in_the_middle(clone: Path) -> None:
    names = told("shift-controller")
    drive, sim, controller = names["drive"], names["gearbox"](), names["ShiftController"]()
    rows = [name for name in sim.names if not name.endswith(".state")]
    seen = []
    while sim.time < 4.0 - 1e-9:
        if abs(sim.time - 2.5) < 1e-9:
            state, then = sim.save(), copy.deepcopy(controller)
        drive(sim, controller, sim.time + 0.01)
        seen.append(sim[rows])
    assert controller.state == "done"
    assert sim["F1.state"] == "locked"
    sim.restore(state)
    rest = []
    while sim.time < 4.0 - 1e-9:
        drive(sim, then, sim.time + 0.01)
        rest.append(sim[rows])
    # every signal at every instant of the controller
    assert len(rest) == 150
    assert np.array(rest).tobytes() == np.array(seen[-150:]).tobytes()
    for made in ("model.svg", "shift.png"):
        assert (clone / made).stat().st_size > 10_000


def test_the_page_about_notebooks_runs_as_one() -> None:
    pytest.importorskip("ipykernel")
    nbformat = pytest.importorskip("nbformat")
    client = pytest.importorskip("nbclient").NotebookClient
    sources = programs("notebook")
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in sources])
    done = client(book, timeout=300, kernel_name="python3").execute()
    nbformat.validate(done)
    pictures = {}
    for source, cell in zip(sources, done.cells, strict=True):
        shown = [output.data["image/png"] for output in cell.outputs if "image/png" in output.get("data", {})]
        for content in shown:
            assert base64.b64decode(content).startswith(b"\x89PNG")
        pictures[source.strip().splitlines()[-1]] = len(shown)
    # law, signal, run, a plot of names, two variants beside each other
    assert sum(pictures.values()) == 5
    assert pictures['run.plot("*.speed", "c1.torque")'] == 1
    assert pictures["system"] == 0


def test_pages_of_stories_are_in_the_guide_in_their_order() -> None:
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8").partition("## All pages")[2]
    order = ["start", "build", "notebook", "first-minutes", "shift-controller", "fit", "thermal-launch", "wet-clutch"]
    places = [index.index(f"](guide/{name}.md)\n") for name in [*order, "sweeps", "learn", "export"]]
    assert places == sorted(places)


def test_every_example_is_listed_with_its_picture() -> None:
    page = (ROOT / "docs" / "examples.md").read_text(encoding="utf-8")
    found = sorted(path.name for path in (ROOT / "examples").iterdir() if (path / "README.md").exists())
    parts = page.split("\n## ")[1:]
    listed = [name for part in parts for name in re.findall(r"^\[`examples/(\w+)`\]", part, re.MULTILINE)]
    assert sorted(listed) == found
    assert all("\n![" in part for part in parts)


def test_a_pump_a_circuit_and_a_valve_body(clone: Path) -> None:
    """The page asserts its energies, the cold oil and what is learnt."""
    names = told("hydraulics")
    for made in ("circuit.svg", "circuit.png", "shift.png"):
        assert (clone / made).stat().st_size > 5000
    assert names["control"].records[-1].reached
