"""Draw the picture at the top of the documentation from the program below it: make picture."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("agg")
import matplotlib.pyplot as plt

PAGE = Path(__file__).resolve().parents[1] / "index.md"


def simulated() -> Any:
    """The run of that program, which is executed without its last line, the plot."""
    source = re.search(
        r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL
    )
    assert source is not None
    names: dict[str, Any] = {}
    exec(source[1].rsplit("run.plot", 1)[0], names)
    return names["run"]


def draw(run: Any, path: Path) -> None:
    """Speeds and torques over time, the locked phase shaded."""
    lock = run.events.changes()[-1]
    colours = {
        "engine": "#1f5fa8",
        "load": "#2b8a5f",
        "torque": "#b3401f",
        "capacity": "#8a8f94",
    }
    plt.rcParams.update(
        {"font.size": 9, "axes.spines.top": False, "axes.spines.right": False}
    )
    figure, (speeds, torques) = plt.subplots(
        1, 2, figsize=(9.0, 2.9), layout="constrained"
    )
    for name in ("engine", "load"):
        speeds.plot(run.time, run[f"{name}.speed"], color=colours[name], label=name)
    torques.plot(
        run.time,
        run["c1.capacity"],
        color=colours["capacity"],
        ls="--",
        label="static capacity",
    )
    torques.plot(
        run.time,
        run["c1.torque"],
        color=colours["torque"],
        label="torque of the clutch",
    )
    for axes, title, unit in ((speeds, "speed", "rad/s"), (torques, "torque", "N m")):
        axes.axvspan(lock.time, run.time[-1], color="#e6ecf2", lw=0)
        axes.set(
            xlabel="time [s]", ylabel=f"{title} [{unit}]", xlim=(0.0, run.time[-1])
        )
        axes.legend(
            frameon=False, loc="upper right" if axes is speeds else (0.12, 0.25)
        )
    speeds.annotate(
        f"locks at {lock.time:.6f} s",
        (lock.time, 20.0),
        (1.0, 1.0),
        arrowprops={"arrowstyle": "-", "lw": 0.7},
    )
    torques.text(
        0.84, 0.45, "locked", transform=torques.transAxes, ha="center", color="#5b6b7c"
    )
    # no date and no version in the file: the same picture gives the same bytes
    figure.savefig(path, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    draw(simulated(), Path(sys.argv[1]))
