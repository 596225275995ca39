"""A notebook that is run: what its cells show."""

from __future__ import annotations

import base64
import struct
from typing import Any

import pytest

pytest.importorskip("ipykernel")
nbformat = pytest.importorskip("nbformat")
NotebookClient = pytest.importorskip("nbclient").NotebookClient

MODEL = """
import clutchwork as cw
d = cw.Driveline("two <b>discs</b>")
engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
law = cw.Coulomb(static=0.125, kinetic=0.1)
pressure = cw.Table([(0.0, 0.0), (0.2, 2e5)])
d.add(cw.Clutch("c <i>1</i>", base=engine, follower=load, friction=law, gain=5e-4, pressure=pressure))
d.add(cw.Torque("drag", shaft=load, torque=-1.0))
run = d.simulate(2.5)
loose = cw.Driveline("loose")
shafts = [loose.shaft(name, inertia=1.0) for name in ("engine", "idle")]
loose.add(cw.Torque("drive", shaft=shafts[0], torque=1.0))
None
"""
# a page with tables and one picture, and the picture for what knows no pages
PAGE = {"text/html", "picture", "image/png"}
# cell -> the kinds of output that a browser chooses from, and words that it must show
CELLS = {
    "run": (PAGE, ["two &lt;b&gt;discs", "residual of the energy balance"]),
    "run.plot()": ({"image/png"}, []),
    "run.plot('load.speed')": ({"image/png"}, []),
    "cw.compare({'a': run, 'b': run}, 'load.speed')": ({"image/png"}, []),
    "d.assemble()": ({"text/html"}, ["shafts and masses", "two &lt;b&gt;discs"]),
    "run.events": ({"text/html"}, ["time, s", "torque after, N m", "c &lt;i&gt;1", "slip zero"]),
    "run.energy": ({"text/html"}, ["kinetic energy, change", ">J<", "c &lt;i&gt;1"]),
    "law": (PAGE, ["Coulomb", "0.125", "coefficient at rest"]),
    "cw.LuGre(static=0.15, kinetic=0.1, speed=2.0, stiffness=1e3, damping=0.0)": (
        PAGE,
        ["LuGre", "1/rad or 1/m"],
    ),
    "pressure": (PAGE, ["Table", "points"]),
    "cw.Sampled(print, 0.1)": ({"text/html"}, ["Sampled", "0.1", "print"]),
    "cw.sweep(d, 1.0, vary={'load.inertia': [0.5, 0.6]}, outputs=['load.speed', cw.lock('c <i>1</i>')])": (
        {"text/html"},
        ["load.inertia", "load.speed, rad/s", "0.6", "done"],
    ),
    "cw.linearise(d)": (
        {"text/html"},
        ["Linear &#x27;two &lt;b&gt;discs&lt;/b&gt;&#x27; at 0 s", "rate of change", "time constant", "who moves"],
    ),
    "cw.linearise(d).modes": ({"text/html"}, ["time constant", "engine 1.00"]),
    "cw.Simulator(d)": ({"text/html"}, ["Simulator of", "engine.speed", "rad/s", "100"]),
    "loose.hints()": ({"text/html"}, ["what to do", "idle", "joined to nothing"]),
    "d.draw()": ({"image/svg+xml"}, []),
    "run.explore('load.speed')": ({"application/vnd.plotly.v1+json"}, []),
}


@pytest.fixture(scope="module")
def outputs() -> dict[str, list[Any]]:
    """What each cell shows, by its source."""
    sources = [MODEL, *CELLS, "d.simulate(2.5, progress=True)", "import matplotlib.pyplot as plt", "run.plot()"]
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in sources])
    done = NotebookClient(book, timeout=300, kernel_name="python3").execute()
    nbformat.validate(done)
    shown = {cell.source: list(cell.outputs) for cell in done.cells}
    # the same cell as before, but with pyplot there
    return shown | {"run.plot() again": list(done.cells[-1].outputs)}


def png(data: dict[str, Any]) -> tuple[int, int]:
    """Width and height of a picture [px]."""
    content = base64.b64decode(data["image/png"])
    assert content.startswith(b"\x89PNG")
    width, height = struct.unpack(">II", content[16:24])
    return width, height


@pytest.mark.parametrize("source", CELLS)
def test_what_a_cell_shows(outputs: dict[str, list[Any]], source: str) -> None:
    kinds, words = CELLS[source]
    (shown,) = outputs[source]
    assert shown.output_type in ("execute_result", "display_data")
    assert set(shown.data) - {"text/plain"} == kinds - {"picture"}
    html = str(shown.data.get("text/html", ""))
    assert [word for word in words if word not in html] == []
    assert "<b>discs" not in html
    assert "<i>1" not in html
    if "image/png" in kinds:
        width, height = png(shown.data)
        assert width > 900
        assert height > 200
    if "text/html" in kinds:
        # both in one page, and nothing of it twice
        assert "<table" in html
        assert html.count("data:image/png;base64,") == len(kinds & {"picture"})


def test_a_figure_is_shown_once_and_in_its_size(outputs: dict[str, list[Any]]) -> None:
    # whether pyplot is there or not
    for source in ("run.plot()", "run.plot() again"):
        (shown,) = outputs[source]
        width, _ = png(shown.data)
        assert width == pytest.approx(2 * shown.metadata["image/png"]["width"], abs=2)
    assert outputs["import matplotlib.pyplot as plt"] == []


def test_progress_shows_a_bar(outputs: dict[str, list[Any]]) -> None:
    shown = outputs["d.simulate(2.5, progress=True)"]
    texts = [output.get("text", "") for output in shown if output.output_type == "stream"]
    widgets = [output for output in shown if "application/vnd.jupyter.widget-view+json" in output.get("data", {})]
    assert widgets or any("2.5 of 2.5 s" in text for text in texts)
    assert not any("Warning" in text for text in texts)
    assert "data:image/png;base64," in shown[-1].data["text/html"]
