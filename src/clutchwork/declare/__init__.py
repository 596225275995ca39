"""Declarations of components: fields, units, nodes, roles. The layout of the core and the options of a run.

A declaration imports what it needs from here; the modules inside import each other.
"""

from typing import TYPE_CHECKING, Any

from clutchwork.declare.node import GAIN_OF_FORCE as GAIN_OF_FORCE
from clutchwork.declare.node import GAIN_OF_PRESSURE as GAIN_OF_PRESSURE
from clutchwork.declare.node import HOUSING as HOUSING
from clutchwork.declare.node import Component as Component
from clutchwork.declare.node import Entry as Entry
from clutchwork.declare.node import Found as Found
from clutchwork.declare.node import HeatFlow as HeatFlow
from clutchwork.declare.node import HeatPath as HeatPath
from clutchwork.declare.node import Law as Law
from clutchwork.declare.node import Node as Node
from clutchwork.declare.node import Part as Part
from clutchwork.declare.node import Passive as Passive
from clutchwork.declare.node import Points as Points
from clutchwork.declare.node import Rate as Rate
from clutchwork.declare.node import Sampling as Sampling
from clutchwork.declare.node import Segment as Segment
from clutchwork.declare.node import ShiftTable as ShiftTable
from clutchwork.declare.node import Signal as Signal
from clutchwork.declare.node import SignalLike as SignalLike
from clutchwork.declare.node import StateSum as StateSum
from clutchwork.declare.node import SupplyPower as SupplyPower
from clutchwork.declare.node import TabledComposite as TabledComposite
from clutchwork.declare.node import ThermalNode as ThermalNode
from clutchwork.declare.node import Work as Work
from clutchwork.declare.schema import Role as Role
from clutchwork.declare.schema import State as State
from clutchwork.declare.schema import Way as Way
from clutchwork.declare.schema import choice as choice
from clutchwork.declare.schema import component as component
from clutchwork.declare.schema import curve as curve
from clutchwork.declare.schema import data as data
from clutchwork.declare.schema import elements as elements
from clutchwork.declare.schema import family as family
from clutchwork.declare.schema import flag as flag
from clutchwork.declare.schema import formula as formula
from clutchwork.declare.schema import function as function
from clutchwork.declare.schema import law as law
from clutchwork.declare.schema import named as named
from clutchwork.declare.schema import numbers as numbers
from clutchwork.declare.schema import option as option
from clutchwork.declare.schema import param as param
from clutchwork.declare.schema import port as port
from clutchwork.declare.schema import signal as signal
from clutchwork.declare.schema import text as text
from clutchwork.declare.wording import say as say

if TYPE_CHECKING:
    from clutchwork.declare.rational import exact as exact
else:

    def __getattr__(name: str) -> Any:
        # fractions are loaded where a model is made
        if name == "exact":
            from clutchwork.declare.rational import exact

            return exact
        raise AttributeError(f"clutchwork.declare has no {name!r}")
