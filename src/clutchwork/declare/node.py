"""What components attach to, and the bases of elements, laws and signals."""

from __future__ import annotations

from dataclasses import field, fields
from enum import Enum, Flag, auto
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Protocol, TypeAlias, cast

from clutchwork.base import UnknownName, dataclass, listed, near, quote
from clutchwork.base.classes import PLAIN
from clutchwork.declare import to_si

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from fractions import Fraction

    from clutchwork.declare.schema import Role, State, Way

# what is wrong, as (quantity, what is so, remedy)
Found: TypeAlias = "list[tuple[str, str, str]]"


class PintQuantity(Protocol):
    """A quantity of pint."""

    @property
    def magnitude(self) -> Any:
        """Its number in its unit."""

    def to_root_units(self) -> Any:
        """The same in the base units of its registry."""


class Domain(Enum):
    """Kind of motion of a node."""

    ROTATION = "rotation"
    TRANSLATION = "translation"


@dataclass(frozen=True, repr=False)
class Node:
    """A shaft, a mass or the housing, as returned by `Driveline.shaft`, `.mass` and `.housing`.

    Parameters:
        name (text, required): its path in results and messages
        domain (choice: Domain.ROTATION, Domain.TRANSLATION; default Domain.ROTATION): a shaft, or a mass on a line
        inertia (number [kg m2 or kg] >= 0, default 0): inertia of a shaft, mass of a mass
        speed (number [rad/s or m/s], default none): at the start; none: follows from the others, else 0
        angle (number [rad or m], default none): at the start; none: 0, of a mass where its crank holds it
        fixed (flag, default false): whether it is the housing
    """

    name: str
    domain: Domain = Domain.ROTATION
    inertia: float = 0.0
    speed: float | None = None
    angle: float | None = None
    fixed: bool = False

    def _accept(self) -> None:
        """Converts values with units to SI."""
        values = vars(self)
        for name, unit in zip(PLACES, NODE_UNITS[self.domain], strict=True):
            values[name] = to_si.TargetUnit(unit).number(values[name])

    def __repr__(self) -> str:
        from clutchwork.declare.reprs import node

        return node(self)

    def __reduce__(self) -> str | tuple[Any, ...]:
        # there is one housing, copies included
        if self is HOUSING:
            return "HOUSING"
        return Node, (self.name, self.domain, self.inertia, self.speed, self.angle, self.fixed)


PLACES = ("inertia", "speed", "angle")
NODE_UNITS = {Domain.ROTATION: ("kg m2", "rad/s", "rad"), Domain.TRANSLATION: ("kg", "m/s", "m")}
HOUSING = Node("housing", fixed=True)


@dataclass(frozen=True, repr=False)
class ThermalNode:
    """A thermal mass, or an ambient of given temperature, as returned by `Driveline.thermal` and `.ambient`.

    Parameters:
        name (text, required): its path in results and messages
        capacity (number [J/K] > 0, default none): none: an ambient, whose temperature does not depend on its heat
        temperature (signal [K], default 300): of a mass at the start, of an ambient over time
        limit (number [K] > 0, default none): highest temperature that it stands; hints compare with it
    """

    name: str
    capacity: float | None = None
    temperature: SignalLike = 300.0
    limit: float | None = None

    def _accept(self) -> None:
        """Values with units are put into SI."""
        values = vars(self)
        values["capacity"] = to_si.TargetUnit("J/K").number(values["capacity"])
        values["temperature"] = to_si.driving(to_si.TargetUnit("K").number(values["temperature"]), "K")
        values["limit"] = to_si.TargetUnit("K").number(values["limit"])

    def __repr__(self) -> str:
        from clutchwork.declare.reprs import thermal_node

        return thermal_node(self)


PLAIN |= {Node, ThermalNode, Domain}


class Work(Flag):
    """Where the work of an element goes; STORE is combined with another by `|`."""

    SOURCE = auto()  # it comes from outside of the driveline, or goes there: drives and loads
    STORE = auto()  # the element stores it and gives it back, as much as `stored` says
    LOSS = auto()  # it becomes heat


class Passive(NamedTuple):
    """Torque `-(stiffness twist + damping rate)` on the follower, in N m/rad and N m s/rad, or N/m and N s/m."""

    stiffness: float
    damping: float


class HeatPath(NamedTuple):
    """The thermal node that takes the heat of an element, and its share of that heat."""

    node: ThermalNode
    share: float


class Entry(NamedTuple):
    """An element that a table of a composite describes.

    `cls` is None where there is no such kind, `made` where it does not fit its place; a value of it that must be given
    and is not, is MISSING.
    """

    quantity: str  # "shift.A"
    kind: str
    cls: Any
    made: Any  # the element
    unknown: tuple[str, ...] = ()  # keys that it does not have
    fault: tuple[str, str] = ("", "")  # why it does not fit its place, and the remedy


class StateSum(NamedTuple):
    """A signal of an element that is a weighted sum of states: its last word, unit, weights of states, and offset.

    States are named within the element, "force", or "segment_1.spring_torque" of a part.
    """

    name: str
    unit: str
    weights: Mapping[str, float]
    offset: float = 0.0


class ShiftTable(NamedTuple):
    """The gears of a gearbox; names are those in results."""

    name: str  # "gearbox"
    input: str  # shaft, "gearbox.in"
    output: str
    elements: tuple[str, ...]  # "gearbox.A"
    freewheels: tuple[str, ...]
    gears: Mapping[str, tuple[str, ...]]  # gear -> closed elements
    ratios: Mapping[str, float | None]  # gear -> speed of the input over that of the output, None in neutral
    waiting: tuple[str, ...] = ()  # synchronisers, which may be in beside a gear: they wait behind an open clutch


class DeclarationType(type):
    """Metaclass of declarations: dir() and help() leave out the hooks that only the engine calls."""

    # help() asks a class for its docstring by way of its own class, whose docstring would hide that of the declaration
    __doc__ = vars(type)["__doc__"]

    def __dir__(cls) -> list[str]:
        found = {name: value for base in reversed(cls.__mro__) for name, value in vars(base).items()}
        shown = [name for name, value in found.items() if isinstance(value, property | cached_property)]
        made_of_parts = found.get("parts", Component.parts) is not Component.parts
        return [name for name in [*shown, *(["part"] if made_of_parts else [])] if name[0] != "_"]


class Declared(metaclass=DeclarationType):
    """Base of elements, laws and signals."""

    def _accept(self) -> None:
        """Values with units are put into SI."""
        to_si.accept(self)

    def __repr__(self) -> str:
        from clutchwork.declare.reprs import called

        return called(self)

    def __dir__(self) -> list[str]:
        known: Any = self
        return [*(item.name for item in fields(known) if item.repr), *dir(type(self))]


@dataclass(frozen=True, repr=False)
class Element(Declared):
    """An element as its users see it; its name is its path in results and errors.

    Parameters:
        name (text, required): its path in results and messages
    """

    name: str

    def __repr__(self) -> str:
        from clutchwork.declare.reprs import element

        return element(self)


@dataclass(frozen=True, repr=False)
class Component(Element):
    """An element as its authors see it: what it is to the engine, by class variables and methods.

    Two fields have a meaning of their own wherever an element has them: `friction`, the law of a contact, and `locked`,
    whether it starts so.
    """

    # set by @component
    kind: ClassVar[str]
    role: ClassVar[Role]
    states: ClassVar[tuple[State, ...]] = ()
    ways: ClassVar[tuple[Way, ...]] = ()
    hooks: ClassVar[tuple[str, ...]] = ()

    one_way: ClassVar[bool] = False  # a freewheel, which locks by itself
    # of a contact: why it has lost its load where a run finds so, and the remedy
    lifts: ClassVar[tuple[str, str] | None] = None
    work: ClassVar[Work] = Work.SOURCE  # of a torque element; the work of a contact is always heat
    supply: ClassVar[str] = ""  # of a source with the hook `heat`: what it draws work and heat from, such as "electric"
    # meaning of its signals by their last word, where that is not the usual one
    reports: ClassVar[Mapping[str, str]] = {}
    elastic: ClassVar[bool] = False  # joins its ends as a shaft does: counts as rigid in ratios of speeds
    open: ClassVar[bool] = False  # a composite whose parts are seen one by one in tables and pictures of energy
    gathers: ClassVar[bool] = False  # of a process: an input before all others has the sum of what is drawn into it
    jumps: ClassVar[bool] = False  # a torque element whose torque jumps: its shafts need inertia, as at a contact
    bends: ClassVar[bool] = False  # a torque element or a process whose equations change where its state passes zero

    # what an element has unless it declares a field of that name
    friction = cast("Law | None", None)
    locked = False

    def problems(self) -> Found:
        """Mistakes beyond the bounds of single values, as (quantity, what is wrong, remedy)."""
        return []

    def law_problems(self) -> Found:
        """What it cannot do with its friction law, as `problems`; called once both are valid."""
        return []

    def parts(self) -> Iterable[Part]:
        """Its parts, named `{self.name}.{part}`; empty: it is one piece.

        One part may have the name of the component itself and stands for it in events and results. Parts refer to
        each other by name, so `HeatFlow(self)` is that of this part. A shaft or mass among them starts at the speed
        that its springs in here give it, unless it has one of its own.
        """
        return ()

    def directions(self) -> Mapping[str, Mapping[str, float | Fraction]]:
        """Rate of each way of an element with `ways`, as way -> port -> coefficient of the speed at that port.

        A float is taken as the decimal fraction that prints it.
        """
        return {}

    def notes(self) -> Sequence[str]:
        """Derived quantities worth knowing, such as natural frequencies; `check` shows them."""
        return ()

    def entries(self) -> Iterable[Entry]:
        """The elements that its tables of elements describe, valid or not."""
        return ()

    def held(self) -> Mapping[str, Part]:
        """Parts whose values are changed as if they were elements of the driveline, by name within it."""
        return {}

    def part(self, name: str) -> Element | ThermalNode | Node:
        """A part by its name within this component; UnknownName, which is a KeyError, when there is none."""
        try:
            named = {str(part.name).removeprefix(f"{self.name}."): part for part in self.parts()}
        except (AttributeError, TypeError):
            raise UnknownName(
                f"{self.name} has values that make no parts; `check` of its driveline names them"
            ) from None
        if name not in named:
            raise UnknownName(f"{self.name} has no part {quote(name)}{near(name, named, f'parts: {listed(named)}')}")
        return named[name]

    def start_ratio(self) -> float:
        """Of a transmission: its ratio at the start."""
        return 1.0

    def sums(self) -> tuple[str, ...]:
        """Names of parts, within it, whose torque, power, work and heat count as those of its own name."""
        return ()

    def own_states(self) -> tuple[State, ...]:
        """The states in use, by its parameters; the hook `count` says how many."""
        return self.states

    def initial_states(self) -> tuple[float, ...]:
        """Its states in use at the start, each in its unit."""
        return ()

    def states_at(self, speed: Callable[[Node], float]) -> tuple[float, ...]:  # noqa: ARG002, it may not ask
        """The same by what the speed of each shaft is at the start, given or not."""
        return self.initial_states()

    def takes_off(self) -> tuple[str, str]:
        """The input below which it does nothing, and the number that says where; "" for none."""
        return "", ""

    def begins_with(self) -> str:
        """Of a process: the input whose value its first state has at the start, "" where that is given."""
        return ""

    def state_scales(self) -> tuple[float, ...]:
        """Of a process: the scale of each of its states in the solver, 1 by default.

        The tolerances of a run are absolute too, so a state should not be small against 1.
        """
        return ()

    def state_sums(self) -> tuple[StateSum, ...]:
        """Further signals that follow from its states, or from those of its parts."""
        return ()

    def start_positions(self) -> tuple[tuple[Node, float], ...]:
        """Masses that it holds at a position of its own, with that at the start [m]."""
        return ()

    def passive(self) -> Passive | None:
        """Stiffness and damping of an element whose whole torque they are; None: it has another torque.

        With a stiffness its first state is the torque of that spring, stiffness times twist. The damping of such
        elements determines the speed of a shaft without inertia, and springs alone keep their balance there, in
        series. An element that is none never carries such a shaft.
        """
        return None

    def stored(self, states: Sequence[float], torque: float) -> float:  # noqa: ARG002, most need the states alone
        """Energy [J] that it stores, by its states and its torque; where it is `passive` that of its spring."""
        passive = self.passive()
        return 0.5 * states[0] * states[0] / passive.stiffness if passive and passive.stiffness else 0.0

    def heat_path(self) -> HeatPath | None:
        """Where its heat goes; None: to no node of the model."""
        return None

    def drives(self) -> bool | None:
        """Whether an element at one shaft drives or loads it; None: neither. Schematics show drives on the left."""
        return None

    def fault_warning(self) -> str:
        """Warning when a fault of it is triggered, such as "cannot transmit"; empty: none."""
        return ""


@dataclass(frozen=True, repr=False)
class TabledComposite(Component):
    """A composite with fields that are tables of elements, such as a gearbox with its shift elements.

    Its `entries` are what these tables describe, and it holds them, so that they are changed by their names within it.
    """

    @classmethod
    def entry_kinds(cls, values: Mapping[str, Any]) -> Mapping[str, str]:
        """Default kind of each element that its tables may describe, "shift.A" -> "clutch".

        Parameters: values, of its fields, some of which may be missing.
        """
        raise NotImplementedError

    def with_held(self, name: str, values: Mapping[str, Any]) -> Component:
        """Itself with other values of the fields of a part that it holds."""
        raise NotImplementedError

    def content(self, name: str) -> Mapping[str, Any]:
        """The content of a field of the sort "data", as a file holds it."""
        raise NotImplementedError

    def shift_table(self) -> ShiftTable | None:
        """Of a gearbox: its gears by the contacts that are closed in them."""
        return None

    def grips(self) -> Iterable[tuple[str, Node, Node]]:
        """Parts that are closed at the start, each with the two shafts that then turn together."""
        return ()


@dataclass(frozen=True, repr=False)
class Law(Declared):
    """A friction law; it has no name of its own.

    A law that sticks is set-valued: it locks exactly. One that does not is compliant: its torque is a function of
    slip and of its own states, and it never locks. Some fields have a meaning of their own wherever a law has them:
    `static` and `kinetic`, the coefficients at rest and while it slips, numbers or tables; `band`, the slip [rad/s] up
    to which it sticks, which widens the tolerance of its contact; `extrapolation`, what tables do beyond their ends.
    """

    # set by @component
    kind: ClassVar[str]
    role: ClassVar[Role]
    states: ClassVar[tuple[State, ...]] = ()

    sticks: ClassVar[bool] = True
    takes_numbers: ClassVar[bool] = False  # a call may have numbers of any name

    # what a law has unless it declares a field of that name
    static = cast("Coefficients | None", None)
    kinetic = cast("Coefficients | None", None)
    band = 0.0
    extrapolation = "nearest"

    @property
    def bends(self) -> bool:
        """Whether its torque has a kink or a jump at a slip that is not an event."""
        return False

    @property
    def steep(self) -> str:
        """Why its rates have no derivatives at some states; nothing where they have."""
        return ""

    def problems(self) -> Found:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        return []

    def slip_problems(self, unit: str) -> Found:  # noqa: ARG002, most say nothing of units
        """What does not fit a contact whose slip has a unit, rad/s or m/s."""
        return []

    def own_states(self) -> tuple[State, ...]:
        """The states in use, the first ones of `states`."""
        return self.states

    def advice(self) -> Found:
        """Allowed but rarely intended properties, as (quantity, what is unusual, remedy): warnings."""
        return []

    def slip_advice(self, unit: str) -> Found:  # noqa: ARG002, most say nothing of the slip
        """Such properties over the slip, in rad/s or m/s."""
        return []

    def sliding(self) -> float | None:
        """Kinetic coefficient at vanishing slip; None: the compiled core evaluates it, or `problems` covers it."""
        return None

    @classmethod
    def declared_by(cls, given: Mapping[str, Any]) -> type:  # noqa: ARG003, most have one declaration
        """The declaration whose fields a call has; another one where a law may have numbers of any name."""
        return cls

    def reads(self, name: str) -> bool:  # noqa: ARG002, most read all
        """Whether it reads an input, such as its temperature."""
        return True

    def code(self, field: str) -> Sequence[tuple[float, float, float]]:
        """The code words of an expression for the core."""
        raise NotImplementedError

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        from clutchwork.base.rich import bundle
        from clutchwork.base.verbs import do

        return bundle(self, *do("law.show", self))


class Segment(NamedTuple):
    """One piece of a signal.

    With s = t - start its value is c0 + c1 s + c2 s^2 + c3 s^3 + amplitude exp(-decay s) sin(omega s + phase), and a
    second wave of the same form.
    """

    start: float
    c0: float = 0.0
    c1: float = 0.0
    c2: float = 0.0
    c3: float = 0.0
    amplitude: float = 0.0
    omega: float = 0.0
    phase: float = 0.0
    decay: float = 0.0
    amplitude_2: float = 0.0
    omega_2: float = 0.0
    phase_2: float = 0.0
    decay_2: float = 0.0

    @property
    def waves(self) -> tuple[tuple[float, float, float, float], ...]:
        """Amplitude, omega, phase and decay of each wave that is there."""
        return tuple(wave for wave in (self[5:9], self[9:13]) if wave[0] != 0.0)


class Sampling(NamedTuple):
    """A Python function of time and readings that sets a signal once every period [s]."""

    period: float
    function: Callable[[float, Mapping[str, float]], float]


@dataclass(frozen=True, repr=False)
class Signal(Declared):
    """A value over time in the unit of the quantity that it drives."""

    # set by @component
    kind: ClassVar[str]
    role: ClassVar[Role]

    # whether it has values with units, whose meaning depends on what it drives
    has_units: bool = field(default=False, init=False, repr=False, compare=False)

    def problems(self) -> Found:
        """What the bounds of single values cannot say, as (quantity, what is wrong, remedy)."""
        return []

    def segments(self) -> tuple[Segment, ...]:
        """Pieces in order of their start.

        The first one starts at or before t = 0; where the pieces repeat it may start later, and until then the
        signal rests at the value with which the last one starts.
        """
        raise NotImplementedError

    def unit_problems(self, units: tuple[str, ...]) -> Found:  # noqa: ARG002, most need none
        """Units of values that do not fit the driven quantity, as `problems`."""
        return []

    def repeats(self) -> float:
        """Period [s] with which the pieces repeat from the start of the first one; 0: never."""
        return 0.0

    def sampling(self) -> Sampling | None:
        """The controller that sets it in a run; None: its pieces define it."""
        return None

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        from clutchwork.base.rich import bundle
        from clutchwork.base.verbs import do

        return bundle(self, *do("signal.show", self))


@dataclass(frozen=True)
class Rate:
    """Rate of an element, or slip of a contact, as an input of a flow or process [rad/s].

    Parameters:
        of (element, required): whose rate it is
    """

    of: Element


@dataclass(frozen=True)
class HeatFlow:
    """Heat that an element or a contact makes, as an input of a flow or process [W].

    Parameters:
        of (element, required): whose heat it is
    """

    of: Element


@dataclass(frozen=True)
class SupplyPower:
    """Power that an electric motor draws from its supply, work and losses, as an input of a process [W].

    Use it as a load of a `cw.Battery`; it is negative where the motor charges.

    Parameters:
        of (element, required): the motor whose power it is
    """

    of: Element


# what reads a direction rather than a signal or a state
DIRECT = (Rate, HeatFlow, SupplyPower)

# what a composite is made of
Part: TypeAlias = "Component | Node | ThermalNode"
# what an input accepts
SignalLike: TypeAlias = (
    "float | Signal | ThermalNode | Element | tuple[Element, str] | Node | Rate | HeatFlow | SupplyPower"
)
# (x, y) pairs of a curve
Points: TypeAlias = "Sequence[tuple[float, float]]"
# what may be given for a number, and for pairs of them
Number: TypeAlias = "float | str | PintQuantity"
PointsWithUnits: TypeAlias = "Sequence[tuple[Number, Number]]"
# coefficients of friction: one, a table, or rows of one
Coefficients: TypeAlias = "float | Points | Sequence[float] | Sequence[Sequence[float]]"
# units of the gain of a contact, on shafts and on masses: torque or force per pressure, per force, per share
GAIN_OF_PRESSURE = ("m3", "m2")
GAIN_OF_FORCE = ("m", "1", "N m", "N")


def is_reference(value: object) -> bool:
    """Whether an input is given by another component or node."""
    if isinstance(value, tuple):
        return len(value) == 2 and isinstance(value[0], Component) and isinstance(value[1], str)
    return isinstance(value, (ThermalNode, Component, Node, *DIRECT))
