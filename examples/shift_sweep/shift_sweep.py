"""10 000 gear shifts, pressure ramp x lining x temperature: python examples/shift_sweep/shift_sweep.py [FOLDER]."""

from __future__ import annotations

import math
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import clutchwork as cw

MODEL = Path(__file__).resolve().parents[1] / "six_speed" / "model.toml"
T_END = 4.0  # s
TEMPERATURES = (300.0, 400.0, 500.0)  # K
FADE = (1.0, 0.95, 0.8)  # share of the cold coefficients at each of them
SPEEDS = (0.0, 6.0, 14.0, 28.0, 60.0, 250.0)  # rad/s
LOCKS, HEAT, PEAK = cw.lock("F1"), "F1.heat", cw.peak("shaft.torque")


def ramp(duration: float) -> cw.Table:
    """The pressure of the oncoming clutch: it fills, then rises over a duration [s], then closes."""
    full = 2.2 + duration
    return cw.Table([(0.0, 0.0), (2.0, 0.0), (2.2, 0.25e6), (full, 0.6e6), (full + 0.2, 2e6)])


def kinetic(lining: float) -> list[list[float]]:
    """Coefficients of a lining while it slips, a row over the slip for each temperature; 1.0 is that of the model."""
    cold = [lining * (0.065 + 0.075 * math.exp(-speed / 12.6)) for speed in SPEEDS]
    return [[fade * value for value in cold] for fade in FADE]


def gearbox() -> cw.System:
    """The six-speed gearbox at rest in third gear, with a lining of F1 that fades; from 2 s on it shifts to fourth."""
    lining = cw.FrictionMap(
        temperatures=TEMPERATURES,
        speeds=SPEEDS,
        static=[0.16 * fade for fade in FADE],
        kinetic=kinetic(1.0),
        temperature=350.0,
    )
    start = {
        "w1.speed": 0.0,
        "F1.friction": lining,
        "F1.pressure": ramp(0.8),
        "F2.pressure": cw.Table([(0.0, 2e6), (2.0, 2e6), (2.3, 0.0)]),
        "F4.pressure": 2e6,
    }
    return cw.Driveline.load(MODEL).assemble().changed(start)


def shifts(ramps: int = 25, linings: int = 20, temperatures: int = 20, **how: Any) -> cw.Sweep:
    """A grid of shifts: duration of the ramp [s], lining as a factor on its coefficients, temperature of it [K]."""
    durations, factors = np.linspace(0.3, 1.5, ramps), np.linspace(0.8, 1.1, linings)
    vary = {
        "F1.pressure": {f"{duration:.3f}": ramp(duration) for duration in durations},
        "F1.friction.kinetic": {f"{factor:.4f}": kinetic(factor) for factor in factors},
        "F1.friction.temperature": np.linspace(300.0, 500.0, temperatures),
    }
    return cw.sweep(gearbox(), T_END, vary=vary, outputs=[LOCKS, HEAT, PEAK], **how)


def picture(found: cw.Sweep, path: Path) -> None:
    """Lock-up, slip energy and peak torque over ramp and lining, at the coldest and the hottest temperature."""
    import matplotlib.pyplot as plt
    from matplotlib.ticker import MaxNLocator

    durations, factors, temperatures = (axis.astype(float) for axis in found.coords.values())
    panels = (
        (LOCKS.name, 1.0, 2.0, "slip time, s"),
        (HEAT, 1e-3, 0.0, "slip energy, kJ"),
        (PEAK.name, 1e-3, 0.0, "peak torque of the shaft, kN m"),
    )
    figure, axes = plt.subplots(2, 3, figsize=(11.0, 6.4), layout="constrained", sharex=True, sharey=True)
    for line, place in zip(axes, (0, -1), strict=True):
        for axis, (name, scale, offset, title) in zip(line, panels, strict=True):
            values = scale * (found[name] - offset)
            levels = MaxNLocator(10).tick_values(np.nanmin(values), np.nanmax(values))
            shown = axis.contourf(durations, factors, values[:, :, place].T, levels, cmap="viridis")
            if place == 0:
                axis.set_title(title, fontsize=10)
            if place == -1:
                axis.set_xlabel("duration of the pressure ramp, s")
            figure.colorbar(shown, ax=axis, shrink=0.9, format="%.3g")
        line[0].set_ylabel(f"lining at {temperatures[place]:.0f} K\nfactor on the coefficients")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def check(found: cw.Sweep) -> None:
    """What the example claims."""
    assert found.finished.all()
    locks, heat, peak = found[LOCKS.name], found[HEAT], found[PEAK.name]
    # every shift is over; a softer ramp slips longer and makes more heat, and a hot lining slips longer
    assert np.all((locks > 2.2) & (locks < T_END))
    assert np.all(np.diff(heat, axis=0) > 0.0)
    assert np.all(locks[-1, :, -1] > locks[-1, :, 0])
    assert peak.min() > 1e3


def main(folder: Path) -> None:
    """Run, tell, draw."""
    started = time.perf_counter()
    found = shifts()
    taken = time.perf_counter() - started
    print(f"{found}: {len(found) / taken:.0f} shifts a second")
    check(found)
    folder.mkdir(parents=True, exist_ok=True)
    picture(found, folder / "shift_sweep.png")
    found.to_csv(folder / "shift_sweep.csv")
    print(f"wrote {folder / 'shift_sweep.png'} and {folder / 'shift_sweep.csv'}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/shift_sweep"))
