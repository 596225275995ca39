"""The car of model.toml with other parts, and an engine that keeps its idle speed."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

import clutchwork as cw

MODEL = Path(__file__).resolve().parent / "model.toml"
RATIO = 3.6 * 3.9
RADIUS = 0.3

# torque of combustion at full throttle over speed, rad/s and N m; less the drag: 120 to 160 N m
FULL = ((0.0, 60.0, 100.0, 200.0, 400.0, 500.0, 600.0, 650.0), (90.0, 125.0, 140.0, 162.0, 183.0, 178.0, 160.0, 0.0))

Readings = Mapping[str, float]


@dataclass
class Engine:
    """Torque of combustion: what the throttle asks for, or what keeps the idle speed, whichever is more.

    Parameters: throttle, a function of time [s] and readings that gives 0 to 1; idle [rad/s]; the gains of the idle
    controller, share of full throttle per rad/s and per rad.
    """

    throttle: Callable[[float, Readings], float]
    idle: float = 83.8
    proportional: float = 0.02
    integral: float = 0.05
    period: float = 0.01
    _sum: float = field(default=0.0, init=False)

    def torque(self, time: float, readings: Readings) -> float:
        """One step of the controller [N m]; the integral stops where the throttle or its limits rule."""
        speed = readings["engine.speed"]
        if time == 0.0:
            self._sum = -readings["engine_drag.torque"] / self._full(speed)
        lacking = self.idle - speed
        share = self._sum + self.proportional * lacking
        wanted = self.throttle(time, readings)
        if 0.0 < share < 1.0 and share >= wanted:
            self._sum += self.integral * self.period * lacking
        return min(max(share, wanted, 0.0), 1.0) * self._full(speed)

    def signal(self) -> cw.Sampled:
        """The torque as a signal of a model."""
        return cw.Sampled(self.torque, self.period)

    @staticmethod
    def _full(speed: float) -> float:
        return float(np.interp(speed, *FULL))


def car(controllers: Mapping[str, Mapping[str, cw.Signal]], **changes: Mapping[str, object]) -> cw.Driveline:
    """The car of the model file with other values and with controllers, which no file can hold.

    Parameters: controllers, `{"combustion": {"torque": signal}}`; changes, `slope={"torque": -300.0}`, where the name
    is that of a shaft, a thermal node or an element.
    """
    data = tomllib.loads(MODEL.read_text(encoding="utf-8"))
    for part in (*data["shaft"], *data["thermal"], *data["ambient"], *data["element"]):
        part.update(changes.get(part["name"], {}))
    read = cw.Driveline.from_dict(data)
    made = cw.Driveline(read.name)
    for node in read.nodes:
        made.add_node(node)
    for thermal in read.thermal_nodes:
        made.add_thermal(thermal)
    anew = {element.name: replace(element, **controllers.get(element.name, {})) for element in read.elements}
    # what presses the clutch is the spring that was made anew, not the one of the file
    anew["clutch"] = replace(anew["clutch"], **{"normal_force": anew["spring"], **controllers.get("clutch", {})})
    for element in anew.values():
        made.add(element)
    return made
