"""Draw the pictures of the car."""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

import matplotlib as mpl

mpl.use("agg")
EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
sys.path[:0] = [str(EXAMPLES / name) for name in ("car_launch", "hill_starts", "car")]

import car_launch  # noqa: E402
import hill_starts  # noqa: E402
import whole_car  # noqa: E402


def write(folder: Path) -> list[Path]:
    """Perform the launch, the hill starts and the drive of the whole car, and write their pictures."""
    whole_car.pictures(*whole_car.drive(), folder)
    paths = [folder / "car_launch.png", folder / "hill_starts.png"]
    car_launch.picture(car_launch.launch(), paths[0])
    driver = hill_starts.Driver()
    with warnings.catch_warnings():
        # the clutch gets too hot, which is the point of it
        warnings.simplefilter("ignore", hill_starts.ClutchTooHotWarning)
        run = hill_starts.starts(driver)
    hill_starts.picture(run, driver, paths[1])
    return [*paths, folder / "sankey_launch.svg"]
