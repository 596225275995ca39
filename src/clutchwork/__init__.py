"""Drivelines with clutches that lock and break away exactly.

    import clutchwork as cw

    d = cw.Driveline("two discs")
    engine = d.shaft("engine", inertia=0.2, speed=100.0)
    load = d.shaft("load", inertia=0.8)
    lining = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("c1", base=load, follower=engine, friction=lining, gain=1.0, normal_force=100.0))
    run = d.simulate(2.0)

Elements, friction laws and signals are published from their folders: a new file there is a new name here.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from clutchwork import elements as elements
from clutchwork import laws as laws
from clutchwork import signals as signals
from clutchwork.base.errors import ClutchworkError as ClutchworkError
from clutchwork.base.errors import ModelError as ModelError
from clutchwork.base.errors import ModelWarning as ModelWarning
from clutchwork.base.errors import OptionError as OptionError
from clutchwork.base.errors import Problem as Problem
from clutchwork.base.errors import UnknownName as UnknownName
from clutchwork.base.errors import UseError as UseError
from clutchwork.base.errors import near
from clutchwork.declare.calls import explain
from clutchwork.declare.core import core
from clutchwork.declare.docs import document
from clutchwork.declare.node import Domain as Domain
from clutchwork.declare.node import HeatFlow as HeatFlow
from clutchwork.declare.node import Law as Law
from clutchwork.declare.node import Node as Node
from clutchwork.declare.node import Rate as Rate
from clutchwork.declare.node import Signal as Signal
from clutchwork.declare.node import ThermalNode as ThermalNode
from clutchwork.declare.schema import REGISTRY
from clutchwork.face.driveline import Driveline as Driveline

if TYPE_CHECKING:
    # what type checkers and editors shall know by name; at run time the registry decides
    from clutchwork import fit as fit
    from clutchwork import rig as rig
    from clutchwork.assembly.system import System as System
    from clutchwork.codegen import export_c as export_c
    from clutchwork.declare.options import Options as Options
    from clutchwork.elements.band_brake import BandBrake as BandBrake
    from clutchwork.elements.bearing_friction import BearingFriction as BearingFriction
    from clutchwork.elements.brake import Brake as Brake
    from clutchwork.elements.centrifugal_clutch import CentrifugalClutch as CentrifugalClutch
    from clutchwork.elements.clutch import Clutch as Clutch
    from clutchwork.elements.conduction import Conduction as Conduction
    from clutchwork.elements.cone_clutch import ConeClutch as ConeClutch
    from clutchwork.elements.convection import Convection as Convection
    from clutchwork.elements.damper import Damper as Damper
    from clutchwork.elements.diaphragm_spring import DiaphragmSpring as DiaphragmSpring
    from clutchwork.elements.disk_brake import DiskBrake as DiskBrake
    from clutchwork.elements.disk_clutch import DiskClutch as DiskClutch
    from clutchwork.elements.dog_clutch import DogClutch as DogClutch
    from clutchwork.elements.double_planetary import DoublePlanetary as DoublePlanetary
    from clutchwork.elements.double_shoe_brake import DoubleShoeBrake as DoubleShoeBrake
    from clutchwork.elements.flyweights import Flyweights as Flyweights
    from clutchwork.elements.fundamental_clutch import FundamentalClutch as FundamentalClutch
    from clutchwork.elements.gear import Gear as Gear
    from clutchwork.elements.linear_torque import LinearTorque as LinearTorque
    from clutchwork.elements.oil_flow import OilFlow as OilFlow
    from clutchwork.elements.one_way_clutch import OneWayClutch as OneWayClutch
    from clutchwork.elements.planetary import Planetary as Planetary
    from clutchwork.elements.plate_contact import PlateContact as PlateContact
    from clutchwork.elements.prescribed_speed import PrescribedSpeed as PrescribedSpeed
    from clutchwork.elements.pressure_actuator import PressureActuator as PressureActuator
    from clutchwork.elements.quadratic_torque import QuadraticTorque as QuadraticTorque
    from clutchwork.elements.resisting_torque import ResistingTorque as ResistingTorque
    from clutchwork.elements.rolling_wheel import RollingWheel as RollingWheel
    from clutchwork.elements.speed_torque import SpeedTorque as SpeedTorque
    from clutchwork.elements.sprag_clutch import SpragClutch as SpragClutch
    from clutchwork.elements.spring import Spring as Spring
    from clutchwork.elements.spring_damper import SpringDamper as SpringDamper
    from clutchwork.elements.synchroniser import Synchroniser as Synchroniser
    from clutchwork.elements.thermal_plate import ThermalPlate as ThermalPlate
    from clutchwork.elements.torque import Torque as Torque
    from clutchwork.elements.torque_limiter import TorqueLimiter as TorqueLimiter
    from clutchwork.elements.wear import Wear as Wear
    from clutchwork.elements.wet_drag import WetDrag as WetDrag
    from clutchwork.laws.coefficient_table import CoefficientTable as CoefficientTable
    from clutchwork.laws.coulomb import Coulomb as Coulomb
    from clutchwork.laws.dahl import Dahl as Dahl
    from clutchwork.laws.elastoplastic import ElastoPlastic as ElastoPlastic
    from clutchwork.laws.exponential import Exponential as Exponential
    from clutchwork.laws.friction_map import FrictionMap as FrictionMap
    from clutchwork.laws.friction_table import FrictionTable as FrictionTable
    from clutchwork.laws.gms import GMS as GMS
    from clutchwork.laws.karnopp import Karnopp as Karnopp
    from clutchwork.laws.leuven import Leuven as Leuven
    from clutchwork.laws.lugre import LuGre as LuGre
    from clutchwork.laws.mykhalevych import Mykhalevych as Mykhalevych
    from clutchwork.laws.naive_sign import NaiveSign as NaiveSign
    from clutchwork.laws.regularised_stribeck import RegularisedStribeck as RegularisedStribeck
    from clutchwork.laws.stribeck import Stribeck as Stribeck
    from clutchwork.laws.tanh import Tanh as Tanh
    from clutchwork.laws.temperature_table import TemperatureTable as TemperatureTable
    from clutchwork.results.energy import EnergyBalance as EnergyBalance
    from clutchwork.results.events import Event as Event
    from clutchwork.results.events import Events as Events
    from clutchwork.results.trajectory import SimulationError as SimulationError
    from clutchwork.results.trajectory import Trajectory as Trajectory
    from clutchwork.run.failure import FaultWarning as FaultWarning
    from clutchwork.run.failure import Interrupted as Interrupted
    from clutchwork.run.failure import StoppedEarly as StoppedEarly
    from clutchwork.run.simulation import simulate as simulate
    from clutchwork.signals.column import Column as Column
    from clutchwork.signals.constant import Constant as Constant
    from clutchwork.signals.pulse import Pulse as Pulse
    from clutchwork.signals.ramp import Ramp as Ramp
    from clutchwork.signals.sampled import Sampled as Sampled
    from clutchwork.signals.sine import Sine as Sine
    from clutchwork.signals.step import Step as Step
    from clutchwork.signals.table import Table as Table

__version__ = "0.1.0"

# names that are loaded when they are first used, with their module
_LAZY = {
    "EnergyBalance": "results.energy",
    "Event": "results.events",
    "Events": "results.events",
    "FaultWarning": "run.failure",
    "Interrupted": "run.failure",
    "Options": "declare.options",
    "SimulationError": "results.trajectory",
    "StoppedEarly": "run.failure",
    "System": "assembly.system",
    "Trajectory": "results.trajectory",
    "export_c": "codegen",
    "simulate": "run.simulation",
}

# packages that are imported when they are first used
_PACKAGES = ("fit", "rig")

_DECLARED = {cls.__name__: cls for kinds in REGISTRY.values() for cls in kinds.values()}
globals().update(_DECLARED)
for _made in _DECLARED.values():
    document(_made)
for _made in (*_DECLARED.values(), Driveline, HeatFlow, Node, Rate, ThermalNode):
    explain(_made)

_FIXED = (
    "ClutchworkError",
    "Domain",
    "Driveline",
    "HeatFlow",
    "Law",
    "ModelError",
    "ModelWarning",
    "Node",
    "OptionError",
    "Problem",
    "Rate",
    "Signal",
    "ThermalNode",
    "UnknownName",
    "UseError",
)
__all__ = sorted([*_FIXED, *_LAZY, *_DECLARED])


def __getattr__(name: str) -> Any:
    if name in _LAZY:
        value = getattr(import_module(f"clutchwork.{_LAZY[name]}"), name)
        globals()[name] = value
        return value
    if name in _PACKAGES:
        return import_module(f"clutchwork.{name}")
    raise AttributeError(f"clutchwork has no {name!r}{near(name, __all__)}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


# a package whose core is missing or stale refuses to be imported
core()
