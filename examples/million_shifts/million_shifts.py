"""A million gear shifts in a data set: python examples/million_shifts/million_shifts.py [FOLDER] [--on ray] ..."""

from __future__ import annotations

import argparse
import shutil
import time
from pathlib import Path
from typing import Any

import numpy as np

import clutchwork as cw

MODEL = Path(__file__).resolve().parents[1] / "six_speed" / "model.toml"
T_END = 4.0  # s
FULL = 2e6  # Pa
POINTS = 131072
ROUNDS = 3
LOCKS, HEAT, PEAK = cw.lock("F1"), "F1.heat", cw.peak("shaft.torque")
VARY = {
    # chosen: how long the pressure of the oncoming clutch rises, and that of the offgoing one falls
    "F1.pressure.duration": cw.uniform("0.5 s", "2.5 s"),
    "F2.pressure.duration": cw.uniform("0.1 s", "0.6 s"),
    # scatters: delay of the valve, lining at low and at high slip, what the gearbox drives
    "F1.pressure.start": cw.truncated_normal(2.05, 0.02, 2.0, 2.1),
    "F1.friction.slow": cw.truncated_normal(0.140, 0.005, 0.125, 0.155),
    "F1.friction.fast": cw.truncated_normal(0.065, 0.004, 0.053, 0.077),
    "load.torque": cw.triangular("3 kN m", "4 kN m", "5 kN m"),
}
RELEASE, RAMP = "F2.pressure.duration", "F1.pressure.duration"
# limits of a good shift, and how many keep both
QUERY = """
SELECT round("F2.pressure.duration", 1) AS release, round("F1.pressure.duration", 1) AS ramp,
       avg(("F1.heat" < 80e3 AND "peak(shaft.torque)" < 5e3)::INT) AS good
FROM study GROUP BY release, ramp ORDER BY good DESC LIMIT 5
"""
BANDS = """
SELECT round({bins} * "{name}") / {bins} AS value, quantile_cont("{output}", [0.05, 0.5, 0.95]) AS levels
FROM study GROUP BY value ORDER BY value
"""


def gearbox() -> cw.System:
    """The six-speed gearbox at rest in third gear; from 2 s on it shifts to fourth, by two ramps of pressure."""
    start = {
        "w1.speed": 0.0,
        "F1.pressure": cw.Ramp(height=FULL, duration=1.5, start=2.05),
        "F2.pressure": cw.Ramp(height=-FULL, duration=0.3, start=2.0, offset=FULL),
        "F4.pressure": FULL,
    }
    return cw.Driveline.load(MODEL).assemble().changed(start)


def study(folder: Path, points: int = POINTS, **how: Any) -> cw.Study:
    """Run what is missing: (values + 2) shifts for each point of a Sobol sequence, so that indices follow."""
    vary = cw.design(VARY, points, method="saltelli", seed=1)
    return cw.study(gearbox(), T_END, vary=vary, outputs=[LOCKS, HEAT, PEAK], folder=folder, **how)


def check(found: cw.Study) -> None:
    """What the example claims."""
    assert found.complete
    assert set(found.ends) == {"done"}
    heat, peak = (cw.sobol_indices(found, name) for name in (HEAT, PEAK.name))
    # while the offgoing clutch holds on, both work against each other: that makes the heat, and the ramp the torque
    assert heat.names[int(np.argmax(heat.total))] == RELEASE
    assert peak.names[int(np.argmax(peak.total))] == RAMP


def picture(found: cw.Study, path: Path) -> None:
    """Heat over the release, torque over the ramp, by queries; Sobol indices of both."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(2, 2, figsize=(11.0, 6.4), layout="constrained")
    panels = (
        (RELEASE, 50, "time of the release of F2, s", HEAT, "slip energy of F1, kJ"),
        (RAMP, 20, "time of the ramp of F1, s", PEAK.name, "peak torque of the shaft, kN m"),
    )
    for (above, below), (name, bins, label, output, title) in zip(axes.T, panels, strict=True):
        rows = found.query(BANDS.format(bins=bins, name=name, output=output)).fetchall()
        low, middle, high = 1e-3 * np.array([levels for _, levels in rows]).T
        values = [value for value, _ in rows]
        above.fill_between(values, low, high, alpha=0.3, label="nine of ten shifts")
        above.plot(values, middle, label="median")
        above.set_xlabel(label)
        above.set_ylabel(title)
        above.legend(loc="upper left" if output == HEAT else "upper right")
        indices = cw.sobol_indices(found, output)
        places = np.arange(len(indices.names))
        below.barh(places + 0.2, indices.total, 0.38, xerr=indices.total_interval, label="total")
        below.barh(places - 0.2, indices.first, 0.38, xerr=indices.first_interval, label="first order")
        below.set_yticks(places, indices.names)
        below.set_xlabel(f"share of the variance of {output}")
        below.legend(loc="upper right")
    figure.suptitle(f"{len(found)} shifts")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def measure(folder: Path, points: int) -> None:
    """How long Ray takes to begin; runs a second of threads and of its workers, the best of some rounds."""
    import ray

    begun = time.perf_counter()
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    _rate(folder, points // 10, "ray", 2)
    print(f"Ray begins in {time.perf_counter() - begun:.1f} s, with a tenth of the study")
    ways: dict[str, tuple[str | None, int]] = {
        "one thread": (None, 1),
        "two threads": (None, 2),
        "two workers of Ray": ("ray", 2),
    }
    best = dict.fromkeys(ways, 0.0)
    for name, (on, workers) in [*ways.items()] * ROUNDS:
        best[name] = max(best[name], _rate(folder, points, on, workers))
    for name, rate in best.items():
        print(f"{name}: {rate:.0f} shifts a second, efficiency {rate / best['one thread'] / ways[name][1]:.0%}")
    shutil.rmtree(folder)


def _rate(folder: Path, points: int, on: str | None, workers: int) -> float:
    """Shifts a second from the first chunk that was begun to the last that was written."""
    shutil.rmtree(folder, ignore_errors=True)
    found = study(folder, points, on=on, threads=workers)
    parts = found.parts.values()
    return len(found) / (max(part.begun + part.seconds for part in parts) - min(part.begun for part in parts))


def main() -> None:
    """Run or go on, tell, draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?", default=Path("out/million_shifts"))
    parser.add_argument("--points", type=int, default=POINTS, help="eight shifts for each (default: %(default)s)")
    parser.add_argument("--on", help="ray, dask or the address of a cluster; default: threads of this process")
    parser.add_argument("--threads", type=int, help="workers; default: as many as there are cores")
    parser.add_argument("--measure", action="store_true", help="only runs a second, on 1 and 2 workers")
    asked = parser.parse_args()
    if asked.measure:
        measure(asked.folder, asked.points)
        return
    there, begun = 0, time.perf_counter()
    if (asked.folder / "study.json").exists():
        there = len(cw.Study.load(asked.folder))
        print(f"goes on with {there} shifts that are there")
    found = study(asked.folder, asked.points, on=asked.on, threads=asked.threads, progress=True)
    taken = time.perf_counter() - begun
    print(f"{len(found) - there} shifts in {taken:.0f} s: {(len(found) - there) / taken:.0f} a second")
    print(found)
    for name in (HEAT, PEAK.name):
        print(cw.sobol_indices(found, name))
    print(found.query(QUERY))
    check(found)
    picture(found, asked.folder / "million_shifts.png")
    print(f"wrote {asked.folder / 'million_shifts.png'}")


if __name__ == "__main__":
    main()
