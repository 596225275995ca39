"""Engine, clutch, vehicle against closed forms: python examples/engine_clutch_vehicle/engine_clutch_vehicle.py."""

from __future__ import annotations

import sys
from pathlib import Path

import clutchwork as cw

HERE = Path(__file__).resolve().parent


def check(run: cw.Trajectory) -> None:
    """Lock-up and heat of an engagement at constant torques, worked out by hand."""
    engine, drive, friction, slip = 0.2, 100.0, 180.0, 150.0
    # vehicle and road, reduced to the shaft of the gearbox
    reach = 0.3 / 14.0
    vehicle, road = 1300.0 * reach**2, 500.0 * reach
    slows = (friction - drive) / engine + (friction - road) / vehicle
    lock = next(event for event in run.events if event.after == "locked")
    # closed forms against a run with the default tolerance
    assert abs(lock.time - slip / slows) < 1e-6, lock.time
    assert abs(run["clutch.heat"][-1] - 0.5 * friction * slip**2 / slows) < 0.01
    together = (drive - road) / (engine + vehicle)
    assert abs(run["engine.acceleration"][-1] - together) < 1e-6


def main(folder: Path) -> None:
    """Run, tell, draw."""
    run = cw.Driveline.load(HERE / "model.toml").simulate()
    print(run.events)
    print(run.energy)
    run.plot(folder / "engine_clutch_vehicle.png")
    print(f"wrote {folder / 'engine_clutch_vehicle.png'}")
    check(run)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/engine_clutch_vehicle"))
