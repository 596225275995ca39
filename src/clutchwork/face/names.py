"""The public names beside those of the declarations, and where they live: `clutchwork` and its type stub read it."""

from __future__ import annotations

# modules that are imported when the name is first used
NAMES = {
    "ClutchworkError": "base.errors",
    "Domain": "declare.node",
    "Driveline": "face.driveline",
    "Element": "declare.node",
    "EnergyBalance": "results.energy",
    "Event": "results.events",
    "Events": "results.events",
    "FaultWarning": "run.failure",
    "HeatFlow": "declare.node",
    "Interrupted": "run.failure",
    "Law": "declare.node",
    "ModelError": "base.errors",
    "ModelWarning": "base.errors",
    "Node": "declare.node",
    "OptionError": "base.errors",
    "Options": "declare.options",
    "Problem": "base.errors",
    "Rate": "declare.node",
    "Signal": "declare.node",
    "SimulationError": "results.trajectory",
    "StoppedEarly": "run.failure",
    "System": "assembly.system",
    "ThermalNode": "declare.node",
    "Trajectory": "results.trajectory",
    "UnknownName": "base.errors",
    "UseError": "base.errors",
    "export_c": "codegen",
    "Sweep": "sweeps.result",
    "SweepInterrupted": "sweeps.result",
    "at": "sweeps.outputs",
    "break_away": "sweeps.outputs",
    "draw": "face.draw",
    "integral": "sweeps.outputs",
    "lock": "sweeps.outputs",
    "maximum": "sweeps.outputs",
    "minimum": "sweeps.outputs",
    "peak": "sweeps.outputs",
    "simulate": "run.simulation",
    "sweep": "sweeps.sweep",
    "variants": "sweeps.variants",
}

PACKAGES = ("fit", "rig")
