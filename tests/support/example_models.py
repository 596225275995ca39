"""The drivelines of the examples, from their files and their programs, as pages compute them."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from contextlib import contextmanager
from importlib import import_module
from typing import TYPE_CHECKING

import clutchwork as cw
from clutchwork.run.settings import merged
from support.project import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

EXAMPLES = ROOT / "examples"
Case = tuple[cw.System, float]


@contextmanager
def beside(folder: str) -> Iterator[None]:
    """The programs of an example can be imported."""
    sys.path.insert(0, str(EXAMPLES / folder))
    try:
        yield
    finally:
        sys.path.remove(str(EXAMPLES / folder))


def of_file(folder: str) -> Callable[[], Case]:
    """The model file of an example, to the end that it names."""

    def made() -> Case:
        system = cw.Driveline.load(EXAMPLES / folder / "model.toml").assemble()
        return system, merged(system.settings, {})[0]

    return made


def calibrated(name: str) -> Callable[[], Case]:
    """A shift that is calibrated."""

    def made() -> Case:
        with beside("calibrate_shift"):
            shift = getattr(import_module("calibrate_shift"), name)()
        return shift.system, shift.t_end

    return made


def cycle() -> Case:
    """The first minute of the car on its cycle."""
    with beside("car"):
        module = import_module("cycle")
        return module.whole_car(module._driven).assemble(), 60.0


def half() -> Case:
    """The whole car of the co-simulation."""
    with beside("cosimulation"):
        module = import_module("cosimulation")
        d = cw.Driveline("car")
        module.vehicle(d, module.drive(d))
        return d.assemble(), module.T_END


def eight_speed() -> Case:
    """The eight-speed car that starts in first gear, without its controller."""
    with beside("eight_speed"):
        return import_module("eight_speed_model").car(cw.Gearbox.load("zf-8hp70"), "1", throttle=0.3).assemble(), 5.0


def gearbox(folder: str) -> Callable[[], Case]:
    """The gearbox of a study."""

    def made() -> Case:
        with beside(folder):
            return import_module(folder).gearbox(), 4.0

    return made


def tuned() -> Case:
    """The car that learns to launch, under a clutch that closes."""
    with beside("tune_launch"):
        car = import_module("tune_launch").car().assemble()
    return car.changed({"actuator.command": cw.Table([(0.0, 0.0), (0.2, 2e5), (1.5, 6e5)])}), 3.0


MODELS: dict[str, Callable[[], Case]] = {
    **{name: of_file(name) for name in ("car_launch", "engine_clutch_vehicle", "launch", "six_speed")},
    "calibrate_shift": calibrated("six_speed"),
    "calibrate_shift_eight": calibrated("eight_speed"),
    "car": cycle,
    "cosimulation": half,
    "eight_speed": eight_speed,
    "million_shifts": gearbox("million_shifts"),
    "shift_sweep": gearbox("shift_sweep"),
    "tune_launch": tuned,
}
# folders without a driveline of their own that a page can compute
WITHOUT = {
    "fit": "measured points of a lining",
    "hill_starts": "controllers in Python act on the car of car_launch",
    "valve_body": "pages have no room for hydraulics",
    "shift_controller": "a controller in Python acts on the gearbox of six_speed",
}


def model(name: str) -> Case:
    """The System of an example, and the end of its run [s]."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        return MODELS[name]()
