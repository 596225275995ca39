"""What notebooks show, without one: pages of tables, curves of laws and signals, and plain text where that is all."""

from __future__ import annotations

import base64
import itertools
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.base import html
from clutchwork.command import report
from clutchwork.declare.schema import REGISTRY, Role, specs
from clutchwork.driveline.laws import curves
from clutchwork.plot.signals import curve
from clutchwork.results.ratios import phases
from clutchwork.signals.bases.waveform import value
from support import samples

from .conftest import LINING, two_discs


class Texts(HTMLParser):
    """Texts and tags of a page, all of which are closed."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.texts, self.open, self.tags = list[str](), list[str](), list[str]()
        self.feed(page)
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        self.tags.append(tag)
        if tag != "img":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


def shown(thing: Any) -> Texts:
    if hasattr(type(thing), "_repr_mimebundle_"):
        return Texts(thing._repr_mimebundle_()["text/html"])
    return Texts(thing._repr_html_())


def picture(bundle: dict[str, Any]) -> bytes:
    """The picture of a bundle, once in its page and once by itself."""
    assert set(bundle) == {"text/plain", "text/html", "image/png"}
    _, found = bundle["text/html"].split("data:image/png;base64,")
    content = base64.b64decode(found.partition('"')[0])
    assert content == bundle["image/png"]
    return content


@pytest.mark.parametrize("name", ["<script>", "a & b", '"quoted"', "$x$", "größe", "_a"])
def test_names_are_shown_as_they_are(name: str) -> None:
    d = two_discs(name)
    system = d.assemble()
    run = cw.simulate(system, 2.5)
    for thing in (run.events, run.energy):
        page = shown(thing)
        assert any(name in text for text in page.texts)
        assert "script" not in page.tags
    swept = cw.sweep(system, 0.1, vary={f"{name}.gain": [1e-4, 2e-4]}, outputs=[f"{name}.torque"])
    assert f"{name}.gain, m3" in shown(swept).texts
    assert f"{name}.torque, N m" in shown(swept).texts
    assert name in "".join(shown(run).texts)
    assert "mathjax_ignore" in html.table(("a",), [(name,)])


def test_a_table_has_all_cells_or_counts_the_rest() -> None:
    page = Texts(html.table(("a", "b"), [(i, -i) for i in range(100)], right={1}, most=10))
    assert page.texts == ["a", "b", *(str(sign * i) for i in range(10) for sign in (1, -1)), "... and 90 more"]
    assert page.tags.count("tr") == 12


def test_tables_hold_what_is_printed(six_speed: cw.Trajectory) -> None:
    for thing in (six_speed.events, six_speed.energy):
        cells = set(shown(thing).texts)
        # the head of columns is worded with units
        for line in str(thing).splitlines()[1:]:
            assert set(re.split(r" {2,}", line.strip())) <= {cell.strip() for cell in cells}
    assert shown(six_speed.events[:0]).texts == ["no events"]


def test_a_system_shows_counts_ratios_and_warnings(six_speed: cw.Trajectory) -> None:
    texts = shown(six_speed.system).texts
    counts = dict(itertools.pairwise(texts))
    assert counts["shafts and masses"] == "8"
    assert counts["contacts"] == "6"
    assert "w1/w8" in texts
    bare = cw.System.from_bytes(six_speed.system.to_bytes())
    assert shown(bare).texts[0] == "system"


def test_a_sweep_shows_its_first_lines() -> None:
    vary = {"c1.gain": np.linspace(1e-4, 5e-4, 30)}
    swept = cw.sweep(two_discs().assemble(), 1.0, vary=vary, outputs=["load.speed", cw.at("c1.torque", [0.5, 1.0])])
    page = shown(swept)
    assert page.tags.count("tr") == 13
    assert page.texts[-1] == "... and 18 more variants"
    assert f"{swept['load.speed'][3]:.6g}" in page.texts


@pytest.mark.parametrize("kind", REGISTRY[Role.LAW])
def test_every_law_shows_its_curve_and_parameters(kind: str) -> None:
    law = samples.law(REGISTRY[Role.LAW][kind])
    bundle = law._repr_mimebundle_()
    assert picture(bundle).startswith(b"\x89PNG")
    assert bundle["text/plain"] == repr(law)
    texts = Texts(bundle["text/html"]).texts
    assert [item.name for item, _ in specs(type(law)) if item.name not in texts] == []


# of laws with states: what their theory says, at the same slips
STEADY = ("lugre", "elastoplastic", "gms", "leuven")


@pytest.mark.parametrize("kind", STEADY)
def test_the_curve_of_a_law_with_states_is_its_stribeck_curve(kind: str) -> None:
    law: Any = samples.law(REGISTRY[Role.LAW][kind])
    ((slips, found, static),) = curves(law).values()
    expected = law.kinetic + (law.static - law.kinetic) * np.exp(-((slips / law.speed) ** 2)) + law.viscous * slips
    # what counts as settled
    np.testing.assert_allclose(found, expected, rtol=2e-3)
    assert static is None


def test_curves_of_laws_that_stick() -> None:
    ((slips, found, static),) = curves(cw.Stribeck(static=0.2, kinetic=0.1, speed=3.0)).values()
    np.testing.assert_allclose(found, 0.1 + 0.1 * np.exp(-((slips / 3.0) ** 2)), rtol=1e-12)
    assert static == 0.2
    assert slips[-1] == 15.0
    table = cw.CoefficientTable(static=0.13, kinetic=[(0.0, 0.12), (20.0, 0.1)])
    ((slips, found, _),) = curves(table).values()
    np.testing.assert_allclose(found, np.interp(slips, [0.0, 20.0], [0.12, 0.1]), rtol=1e-12)
    warm: Any = samples.law(cw.FrictionMap)
    assert list(curves(warm)) == [f"{warm.temperature:g} K"]


@pytest.mark.parametrize("kind", [kind for kind in REGISTRY[Role.SIGNAL] if kind not in ("column", "sampled")])
def test_the_curve_of_a_signal_is_its_values(kind: str) -> None:
    made = {"pulse": cw.Pulse(height=2.0, period=0.5, width=0.2, start=0.3, offset=1.0)}
    signal = made.get(kind) or samples.law(REGISTRY[Role.SIGNAL][kind])
    found = curve(signal)
    assert found is not None
    time, values = found
    assert time[0] == 0.0
    assert np.all(np.diff(time) >= 0.0)
    # between its points, where it does not jump
    middle = 0.5 * (time[1:] + time[:-1])
    wide = np.diff(time) > 1e-9
    between = 0.5 * (values[1:] + values[:-1])[wide]
    exact = np.array([value(signal, t) for t in middle[wide].tolist()])
    # a wave bends between two of 400 points by less than a thousandth of its height
    np.testing.assert_allclose(between, exact, atol=1e-3 * float(np.max(np.abs(values))))
    assert picture(signal._repr_mimebundle_()).startswith(b"\x89PNG")


def test_signals_of_files_and_of_functions(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("time,p [bar]\n0.5,1\n1,2\n1,3\n")
    column = cw.Column(str(tmp_path / "p.csv"), "p")
    found = curve(column)
    assert found is not None
    assert found[0].tolist() == pytest.approx([0.0, 0.5, 1.0, 1.0, 1.05])
    assert found[1].tolist() == pytest.approx([1e5, 1e5, 2e5, 3e5, 3e5])
    assert picture(column._repr_mimebundle_()).startswith(b"\x89PNG")
    for bad in (cw.Column("missing.csv", "p"), cw.Sampled(print, 0.1), cw.Pulse(height=1.0, period=0.1, width=0.2)):
        bundle = bad._repr_mimebundle_()
        assert "image/png" not in "".join([*bundle, bundle["text/html"]])
        assert bundle["text/plain"] == repr(bad)
    assert "missing.csv" in cw.Column("missing.csv", "p")._repr_mimebundle_()["text/html"]


@pytest.mark.parametrize(
    "law",
    [
        cw.Coulomb(static="a", kinetic=0.1),  # type: ignore[arg-type]
        cw.Stribeck(static=0.1, kinetic=0.2, speed=1.0),
        cw.CoefficientTable(static=0.1, kinetic=[]),
        cw.Coulomb(static=float("nan"), kinetic=0.1),
    ],
    ids=repr,
)
def test_a_law_that_is_wrong_is_shown_as_it_is(law: Any) -> None:
    assert law._repr_mimebundle_()["text/plain"] == repr(law)


def test_a_run_of_nothing_is_shown_as_words(discs: cw.Trajectory) -> None:
    import dataclasses

    empty = dataclasses.replace(discs, time=discs.time[:0], rows=discs.rows[:0])
    assert set(empty._repr_mimebundle_()) == {"text/plain", "text/html"}


def test_plain_words_stay(discs: cw.Trajectory) -> None:
    assert repr(discs).startswith("<Trajectory done, 0 to 2.5 s")
    assert repr(discs.system).startswith("<System 'two discs, c1'")
    assert repr(LINING) == "Coulomb(static=0.125, kinetic=0.1)"


WITHOUT = """
import sys
sys.modules["matplotlib"] = None
import clutchwork as cw
d = cw.Driveline()
a, b = d.shaft("a", inertia=1.0, speed=1.0), d.shaft("b", inertia=1.0)
law = cw.Coulomb(static=0.1, kinetic=0.1)
d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1.0, pressure=1.0))
run = d.simulate(1.0)
for thing in (run, law, cw.Ramp(height=1.0, duration=1.0), run.system):
    bundle = thing._repr_mimebundle_()
    assert set(bundle) == {"text/plain", "text/html"}, set(bundle)
    assert "<table" in bundle["text/html"]
try:
    run.plot("a.speed")
except ImportError as error:
    print(error)
sys.modules["plotly"] = sys.modules["plotly.graph_objects"] = None
try:
    run.explore("a.speed")
except ImportError as error:
    print(error)
sys.modules["tqdm"] = sys.modules["tqdm.auto"] = None
try:
    d.simulate(1.0, progress=True)
except ImportError as error:
    print(error)
"""


def test_without_packages_there_are_words() -> None:
    done = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True, check=False)
    assert done.stdout.splitlines() == [
        'a picture needs matplotlib: pip install "clutchwork[draw]"',
        'explore needs plotly: pip install "clutchwork[interactive]"',
        'progress=True needs tqdm: pip install "clutchwork[notebook]"',
    ], done.stderr


def test_a_ratio_of_springs_is_not_called_one_of_gears() -> None:
    """Two shafts on a spring have one speed where the spring does not twist; no gear is there that could say so."""
    d = cw.Driveline("torsion")
    a, b = d.shaft("engine", inertia=1.0, speed=5.0), d.shaft("vehicle", inertia=1.0)
    d.add(cw.Torque("drive", shaft=a, torque=1.0))
    d.add(cw.SpringDamper("half_shaft", base=a, follower=b, stiffness=100.0, damping=1.0))
    d.add(cw.Torque("road", shaft=b, torque=-1.0))
    run = d.simulate(0.1)
    text = report.run_text(run, phases(run, ("engine", "vehicle")), ("engine", "vehicle"))
    assert "engine/vehicle with rigid springs" in text
    assert "by gears" not in text
    assert "engine/vehicle with rigid springs" in report.model_text(run.system, ("engine", "vehicle"))
    assert "engine/vehicle with rigid springs" in " ".join(shown(run.system).texts)
    d.add(cw.Gear("gear", input=a, output=d.shaft("third"), ratio=2.0))
    geared = d.simulate(0.1)
    assert "engine/third by gears" in report.run_text(geared, phases(geared, ("engine", "third")), ("engine", "third"))
