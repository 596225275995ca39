"""Drivelines with clutches that lock and break away exactly.

    import clutchwork as cw

    d = cw.Driveline("two discs")
    engine = d.shaft("engine", inertia=0.2, speed=100.0)
    load = d.shaft("load", inertia=0.8)
    lining = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=1.0, normal_force=100.0))
    run = d.simulate(2.0)

Elements, friction laws and signals are published from their folders: a new file there is a new name here, imported when
it is first used. Type checkers and editors read the same names in `__init__.pyi`, which the build writes.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from clutchwork.base import near
from clutchwork.declare import HeatFlow, Node, Rate, SupplyPower, ThermalNode
from clutchwork.declare.calls import explain
from clutchwork.declare.core import core
from clutchwork.declare.docs import document
from clutchwork.declare.registry import REGISTRY, declared, with_each
from clutchwork.face import verbs as verbs
from clutchwork.face.names import NAMES, PACKAGES

__version__ = "0.1.0"

with_each(document)
with_each(explain)
for _made in (HeatFlow, Node, Rate, SupplyPower, ThermalNode):
    explain(_made)


def __getattr__(name: str) -> Any:
    if name == "__all__":
        known = [cls.__name__ for kinds in REGISTRY.values() for cls in kinds.values()]
        return globals().setdefault(name, sorted([*NAMES, *PACKAGES, *known]))
    if name in PACKAGES:
        return import_module(f"clutchwork.{name}")
    if name in NAMES:
        value = getattr(import_module(f"clutchwork.{NAMES[name]}"), name)
        globals()[name] = value
        return value
    found = None if name.startswith("_") else declared(name)
    if found is not None:
        return globals().setdefault(name, found)
    known = () if name.startswith("_") else __getattr__("__all__")
    # an object of its own keeps Python from naming a near one twice
    raise AttributeError(f"clutchwork has no {name!r}{near(name, known)}", name=name, obj=known)


def __dir__() -> list[str]:
    return [*__getattr__("__all__"), "__version__"]


# a package whose core is missing or stale refuses to be imported
core()
