"""Draw what a forge shows where the site has a page that computes: the run or the gearbox that it begins with."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl

mpl.use("agg")

import live

import clutchwork as cw
from clutchwork.plot.figure import figure_of
from clutchwork.plot.style import COLOURS

PLOTTED: dict[str, tuple[str | list[str], ...]] = {
    "shift": (
        ["F1.pressure", "F2.pressure"],
        ["w1.speed", "w8.speed"],
        ["F1.torque", "F2.torque"],
    ),
    "stick_slip": ("drive.speed", "block.speed", "contact.torque"),
    "calibrated": (
        ["gearbox.C.pressure", "gearbox.E.pressure"],
        ["gearbox.C.slip"],
        ["gearbox.C.torque", "gearbox.E.torque"],
    ),
}


def write(folder: Path) -> list[Path]:
    """Draw the first run of each page, a loop, and a gear of the box that is chosen first."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, signals in PLOTTED.items():
        run = getattr(live, f"{name}_run")()
        run.plot(*signals, path=folder / f"{name}.png")
    loop(live.hysteresis_run(), folder / "hysteresis.png")
    cw.diagram("zf-8hp70", gear="1", path=folder / "chooser.svg")
    names = [f"{name}.png" for name in (*PLOTTED, "hysteresis")]
    return [folder / name for name in (*names, "chooser.svg")]


def loop(run: cw.Trajectory, path: Path) -> None:
    """Torque over angle."""
    with figure_of(80.0) as figure:
        axes = figure.subplots()
        axes.plot(1e3 * run["plate.angle"], run["contact.torque"], color=COLOURS[0])
        axes.set_xlabel("angle of the plate, mrad")
        axes.set_ylabel("torque of the contact, N m")
        figure.savefig(path)
