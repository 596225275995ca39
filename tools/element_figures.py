"""Pictures of the examples of the elements, in the look of runs; kept in build/ while nothing changes."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
from matplotlib.figure import Figure

import clutchwork
from clutchwork.declare.core import core as load_core
from clutchwork.declare.node import Domain
from clutchwork.declare.purposes import ELEMENT_ROLES, groups
from clutchwork.plot.panels import scale
from clutchwork.plot.style import COLOURS, EVENT_LINE, MILLIMETRE, RC
from element_programs import performed, program

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from clutchwork import Trajectory

ROOT = Path(__file__).resolve().parent.parent
KEPT = ROOT / "build" / "pictures"
WIDTH, PANEL = 130.0, 34.0  # mm
MOST_PANELS = 4
# what the other panels show already, or what says little over time
LEFT_OUT = {"angle", "position", "acceleration", "rate", "work", "power", "heat", "mode", "state", "slip", "speed"}


@dataclass(frozen=True)
class Example:
    """What a page shows of the run of its program."""

    picture: Path
    name: str  # of the element
    given: tuple[str, ...]  # fields that have a value
    signals: tuple[tuple[str, str], ...]  # those of the element, with units
    parts: tuple[tuple[str, str], ...]  # name and kind of all that it is made of, itself first


def example(cls: Any, source: str) -> Example:
    """Run the program of a page and draw its picture, unless nothing has changed since that was last done."""
    digest = hashlib.sha256((_package() + source).encode()).hexdigest()[:16]
    kept = KEPT / f"{cls.kind}-{digest}.json"
    if not kept.exists():
        KEPT.mkdir(parents=True, exist_ok=True)
        for old in KEPT.glob(f"{cls.kind}-*"):
            old.unlink()
        kept.write_text(json.dumps(_performed(cls, source, kept.with_suffix(".svg"))), encoding="utf-8")
    said = json.loads(kept.read_text(encoding="utf-8"))
    signals = tuple((name, unit) for name, unit in said["signals"])
    parts = tuple((name, kind) for name, kind in said["parts"])
    return Example(kept.with_suffix(".svg"), said["name"], tuple(said["given"]), signals, parts)


def draw_all() -> None:
    """Draw the pictures of all elements that are not kept, by all cores."""
    classes = [cls for kinds in groups(*ELEMENT_ROLES).values() for cls in kinds.values()]
    todo = [(cls, program(cls)) for cls in classes]
    with ProcessPoolExecutor(int(os.environ.get("JOBS") or os.cpu_count() or 1), get_context("spawn")) as pool:
        list(pool.map(example, *zip(*todo, strict=True), chunksize=4))


@cache
def _package() -> str:
    """Fingerprint of all that a picture may depend on: this file, the package and its core."""
    folder = Path(clutchwork.__file__).parent
    files = [Path(__file__), Path(load_core().__file__), *sorted(folder.rglob("*.py"))]
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def _performed(cls: Any, source: str, path: Path) -> dict[str, Any]:
    names = performed(source, cls.__name__)
    run = names["run"]
    element = next(element for element in names["d"].elements if type(element) is cls)
    draw(run, element, path)
    given = [item for item in vars(element) if getattr(element, item) is not None]
    own = [(name, unit) for name, unit in run.units.items() if name.startswith(f"{element.name}.")]
    return {"name": element.name, "given": given, "signals": own, "parts": list(_parts(element))}


def _parts(element: Any) -> Iterator[tuple[str, str]]:
    """Name and kind of an element and of all elements inside."""
    yield element.name, element.kind
    for part in element.parts():
        if isinstance(part, clutchwork.Element):
            yield from _parts(part)


def draw(run: Trajectory, element: Any, path: Path) -> None:
    """Speeds, what the element carries, what drives it and what it remembers, over time."""
    chosen = list(_panels(run, element))[:MOST_PANELS]
    with mpl.rc_context({**RC, "svg.hashsalt": "clutchwork"}):
        size = WIDTH * MILLIMETRE, (PANEL * len(chosen) + 8.0) * MILLIMETRE
        figure = Figure(figsize=size, layout="constrained")
        rows = figure.subplots(len(chosen), 1, sharex=True, squeeze=False)[:, 0]
        for axes, (label, names) in zip(rows, chosen, strict=True):
            _panel(axes, run, label, names)
        rows[-1].set_xlabel("time, s")
        rows[-1].set_xlim(run.time[0], run.time[-1])
        figure.align_ylabels()
        figure.savefig(path, metadata={"Date": None})


def _panel(axes: Axes, run: Trajectory, label: str, names: list[str]) -> None:
    factor, unit = scale(run, names)
    for number, name in enumerate(names):
        values = factor * run[name]
        look: dict[str, Any] = {"color": COLOURS[number % len(COLOURS)]}
        if name.endswith(".capacity"):
            # on the side on which the torque is
            torque = run[f"{name.removesuffix('capacity')}torque"]
            sign = -1.0 if -torque.min() > torque.max() else 1.0
            values = sign * values
            look = {"color": "#7F7F7F", "linestyle": (0, (4, 2))}
        axes.plot(run.time, values, label=name, **look)
    for event in run.events.changes():
        axes.axvline(event.time, **EVENT_LINE)
    axes.set_ylabel(label if unit == "1" else f"{label}, {unit}")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.margins(y=0.08)
    # as many labels beside each other as fit
    columns = max(1, min(3, 72 // (max(map(len, names)) + 6)))
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 0.98), ncols=columns, borderaxespad=0.0, handlelength=1.6)


def _panels(run: Trajectory, element: Any) -> Iterator[tuple[str, list[str]]]:
    """Label and signals of each panel."""
    for domain in Domain:
        members = [f"{node.name}.speed" for node in run.wiring.nodes if node.domain is domain]
        if members and any(abs(run[name]).max() > 0.0 for name in members):
            yield "speed", members[:6]
    temperatures = [f"{node.name}.temperature" for node in run.wiring.thermal if f"{node.name}.temperature" in run]
    own: dict[str, list[str]] = {}
    for name, unit in run.units.items():
        last = name.rpartition(".")[2]
        if name.startswith(f"{element.name}.") and last not in LEFT_OUT and name not in temperatures:
            own.setdefault(unit, []).append(name)
    for names in own.values():
        shown = [name for name in names if _worth_showing(run, name, names)]
        if shown:
            yield _label(shown[0]), shown[:6]
    if temperatures and ({"heat", "hot"} & set(vars(element)) or element.kind in ("thermal_plate", "disk_clutch")):
        yield "temperature", temperatures


def _worth_showing(run: Trajectory, name: str, group: list[str]) -> bool:
    """Not what is another signal again, nor what never differs from zero."""
    values = run[name]
    if values.dtype.kind != "f" or not abs(values).max() > 0.0:
        return False
    return not any((run[other] == values).all() for other in group[: group.index(name)])


def _label(name: str) -> str:
    last = name.rpartition(".")[2]
    return "torque" if last.startswith("torque") or last in ("capacity", "spring_torque") else last.replace("_", " ")
