"""Shifts of a gearbox: schedule, controller, what a shift was like, faults."""

from __future__ import annotations

from clutchwork.shifts.comfort import jerk, vibration_dose
from clutchwork.shifts.controller import Measured, ShiftController, ShiftRecord
from clutchwork.shifts.detect import InGear, Shift, gears_of, shifts_of
from clutchwork.shifts.drive import Sensed, drive
from clutchwork.shifts.exchange import Exchange, exchanges
from clutchwork.shifts.faults import Fault, FaultResult, FaultTable, fault_table, single_faults
from clutchwork.shifts.metrics import ShiftQuality, qualities
from clutchwork.shifts.plant import Plant, plant_of
from clutchwork.shifts.report import overview, picture, table
from clutchwork.shifts.schedule import ShiftSchedule
from clutchwork.shifts.settings import ShiftSettings

__all__ = [
    "Exchange",
    "Fault",
    "FaultResult",
    "FaultTable",
    "InGear",
    "Measured",
    "Plant",
    "Sensed",
    "Shift",
    "ShiftController",
    "ShiftQuality",
    "ShiftRecord",
    "ShiftSchedule",
    "ShiftSettings",
    "drive",
    "exchanges",
    "fault_table",
    "gears_of",
    "jerk",
    "overview",
    "picture",
    "plant_of",
    "qualities",
    "shifts_of",
    "single_faults",
    "table",
    "vibration_dose",
]
