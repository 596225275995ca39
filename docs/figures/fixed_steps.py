"""How far off steps of 1 ms are: an upshift of every gearbox of the catalogue beside the exact run."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import numpy as np

import clutchwork as cw
from clutchwork.gearbox.gearbox import catalogue

STEP, END = 1e-3, 1.5  # s
TORQUE = 200.0  # N m, at a turbine of 0.2 kg m2 and 250 rad/s
FULL = 1e6  # Pa
FRICTION = ("clutch", "brake")


def upshift(box: cw.Gearbox) -> tuple[str, str, str, str] | None:
    """The first upshift in which one clutch or brake opens and one closes: gears and elements."""
    forward = sorted(
        (gear for gear, ratio in box.ratios.items() if ratio > 0.0),
        key=lambda gear: -box.ratios[gear],
    )
    friction = {one.name for one in box.elements if one.kind in FRICTION}
    for low, high in pairwise(forward):
        before, after = set(box.gears[low]), set(box.gears[high])
        off, on = before - after, after - before
        if len(off) == len(on) == 1 and off | on <= friction:
            return low, high, *off, *on
    return None


def driveline(box: cw.Gearbox, gear: str, off: str, on: str) -> cw.Driveline:
    """A turbine under torque, the box, and an inertia behind it."""
    d = cw.Driveline(box.name)
    turbine = d.shaft("turbine", inertia=0.2, speed=250.0)
    wheels = d.shaft("wheels", inertia=30.0)
    opens = cw.Ramp(height=-FULL, duration=0.07, start=0.5, offset=FULL)
    closes = cw.Ramp(height=0.6 * FULL, duration=0.3, start=0.45)
    shift = {off: {"pressure": opens}, on: {"pressure": closes}}
    how = {"gearbox": box, "gear": gear, "torque": TORQUE, "shift": shift}
    d.add(cw.Transmission("box", input=turbine, output=wheels, **how))
    d.add(cw.Torque("engine", shaft=turbine, torque=TORQUE))
    return d


def row(box: cw.Gearbox) -> str:
    """The line of a box."""
    found = upshift(box)
    if found is None:
        return f"{box.name:<18}no upshift of one element for another"
    low, high, off, on = found
    d, at = driveline(box, low, off, on), np.arange(0.0, END, STEP)
    exact = d.simulate(END, times=at)
    try:
        fixed = d.simulate(END, times=at, method="fixed", step=STEP)
    except cw.ClutchworkError as error:
        (one,) = re.findall(r"'(box\.\w+)'", str(error))
        return f"{box.name:<18}refused because of the dog clutch {one}"
    names = [f"{one.name}.speed" for one in d.assemble().nodes if one.name != "housing"]
    error = max(float(np.abs(fixed[name] - exact[name]).max()) for name in names)
    most = max(float(np.abs(exact[name]).max()) for name in names)
    return (
        f"{box.name:<18}{f'{low}-{high}':<8}{len(names):>6}{most:>10.0f}{error:>12.1e}"
    )


def write(folder: Path) -> list[Path]:
    """The table of all boxes."""
    folder.mkdir(parents=True, exist_ok=True)
    head = f"{'box':<18}{'shift':<8}{'shafts':>6}{'most':>10}{'error':>12}  speeds in rad/s\n"
    lines = [row(box) for _, box in sorted(catalogue().items())]
    (folder / "catalogue.txt").write_text(
        head + "\n".join(lines) + "\n", encoding="utf-8"
    )
    return [folder / "catalogue.txt"]
