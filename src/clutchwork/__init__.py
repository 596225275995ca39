"""Drivelines with clutches that lock and break away exactly.

    import clutchwork as cw

    d = cw.Driveline("two discs")
    engine = d.shaft("engine", inertia=0.2, speed=100.0)
    load = d.shaft("load", inertia=0.8)
    lining = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=1.0, normal_force=100.0))
    run = d.simulate(2.0)

Elements, friction laws and signals are published from their folders: a new file there is a new name here. Type checkers
and editors read the same names in `__init__.pyi`, which the build writes.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

# importing the folders fills the registry
from clutchwork import elements, laws, signals  # noqa: F401
from clutchwork.base.errors import near
from clutchwork.declare import HeatFlow, Node, Rate, ThermalNode
from clutchwork.declare.calls import explain
from clutchwork.declare.core import core
from clutchwork.declare.docs import document
from clutchwork.declare.schema import REGISTRY
from clutchwork.face.names import NAMES, PACKAGES

__version__ = "0.1.0"

_DECLARED = {cls.__name__: cls for kinds in REGISTRY.values() for cls in kinds.values()}
for _made in _DECLARED.values():
    document(_made)
for _made in (*_DECLARED.values(), HeatFlow, Node, Rate, ThermalNode):
    explain(_made)
globals().update(_DECLARED)

__all__ = sorted([*NAMES, *PACKAGES, *_DECLARED])


def __getattr__(name: str) -> Any:
    if name in PACKAGES:
        return import_module(f"clutchwork.{name}")
    if name in NAMES:
        value = getattr(import_module(f"clutchwork.{NAMES[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"clutchwork has no {name!r}{near(name, __all__)}")


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


# a package whose core is missing or stale refuses to be imported
core()
