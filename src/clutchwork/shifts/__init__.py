"""Shifts of a gearbox: schedule, controller, measures of shift quality, faults."""

from __future__ import annotations

from typing import Any

from clutchwork.base import near
from clutchwork.shifts.actuators import ElementActuator, Learnt
from clutchwork.shifts.comfort import jerk, vibration_dose
from clutchwork.shifts.controller import ShiftController
from clutchwork.shifts.detect import Shift, shifts_of
from clutchwork.shifts.diagnosis import diagnose
from clutchwork.shifts.drive import Sensed, drive
from clutchwork.shifts.exchange import Exchange, exchanges
from clutchwork.shifts.fault_results import Fault, FaultResult, FaultTable
from clutchwork.shifts.faults import fault_table, single_faults
from clutchwork.shifts.fill_test import fill_test
from clutchwork.shifts.gears import InGear, gears_of
from clutchwork.shifts.handover import Handover
from clutchwork.shifts.hybrid import HybridController, HybridSettings
from clutchwork.shifts.metrics import ShiftQuality, qualities
from clutchwork.shifts.plant import Plant, plant_of
from clutchwork.shifts.record import Finding, Measured, ShiftRecord
from clutchwork.shifts.report import overview, picture, table
from clutchwork.shifts.settings import ShiftSettings
from clutchwork.shifts.shift_map import Inhibit, ShiftMap
from clutchwork.shifts.survey import Survey, Surveyed, neighbours, survey
from clutchwork.shifts.torque_sources import EngineSource, TorqueSource

__all__ = [
    "ElementActuator",
    "EngineSource",
    "Exchange",
    "Fault",
    "FaultResult",
    "FaultTable",
    "Finding",
    "Handover",
    "HybridController",
    "HybridSettings",
    "InGear",
    "Inhibit",
    "Learnt",
    "Measured",
    "Plant",
    "Sensed",
    "Shift",
    "ShiftController",
    "ShiftMap",
    "ShiftQuality",
    "ShiftRecord",
    "ShiftSettings",
    "Survey",
    "Surveyed",
    "TorqueSource",
    "diagnose",
    "drive",
    "exchanges",
    "fault_table",
    "fill_test",
    "gears_of",
    "jerk",
    "neighbours",
    "overview",
    "picture",
    "plant_of",
    "qualities",
    "shifts_of",
    "single_faults",
    "survey",
    "table",
    "vibration_dose",
]

# names of clones before 0.1.0, and what took their place
MOVED = {
    "DualClutch": "ShiftController, which shifts dual-clutch gearboxes too",
    "DualClutchSettings": "ShiftSettings",
    "DualClutchShift": "ShiftRecord",
    "ShiftSchedule": "ShiftMap.two_lines",
    "drive_dual_clutch": "drive, with sources",
}


def __getattr__(name: str) -> Any:
    if name in MOVED:
        raise AttributeError(f"cw.shifts.{name} is gone: use cw.shifts.{MOVED[name]}")
    raise AttributeError(f"clutchwork.shifts has no {name!r}{near(name, __all__)}")
