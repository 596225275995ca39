"""The data of a linear system: its matrices, what they are about, and its modes."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

from numpy.typing import NDArray

from clutchwork.base import dataclass
from clutchwork.declare.layout import MODES
from clutchwork.linear.modes import NaturalModes, eigenvalues, natural_modes
from clutchwork.linear.quantity import Quantity

Array = NDArray[Any]


@dataclass(frozen=True, eq=False, repr=False)
class LinearSystem:
    """What pictures and other packages read of a linear system; a `Linear` is what users hold."""

    model: str
    time: float  # s
    A: Array
    B: Array
    C: Array
    D: Array
    state_quantities: tuple[Quantity, ...]
    input_quantities: tuple[Quantity, ...]
    output_quantities: tuple[Quantity, ...]
    modes_of_contacts: Mapping[str, int]  # a number of layout.MODES
    notes: tuple[str, ...]  # what was undecided, and which side was taken
    shafts: tuple[str, ...]
    shaft_speeds: Array  # speeds of all shafts over the states

    @property
    def matrices(self) -> tuple[Array, Array, Array, Array]:
        """A, B, C and D."""
        return self.A, self.B, self.C, self.D

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states, in the order of A."""
        return tuple(quantity.name for quantity in self.state_quantities)

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the inputs, in the order of the columns of B."""
        return tuple(quantity.name for quantity in self.input_quantities)

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the outputs, in the order of the rows of C."""
        return tuple(quantity.name for quantity in self.output_quantities)

    @property
    def units(self) -> dict[str, str]:
        """Unit of every state, input and output."""
        every = (*self.input_quantities, *self.output_quantities, *self.state_quantities)
        return {quantity.name: quantity.unit for quantity in every}

    @property
    def state(self) -> dict[str, float]:
        """Values of the states at the instant."""
        return {quantity.name: quantity.value for quantity in self.state_quantities}

    @property
    def rate(self) -> dict[str, float]:
        """Rates of the states at the instant, in the unit of each per second."""
        return {quantity.name: quantity.rate for quantity in self.state_quantities}

    @property
    def input(self) -> dict[str, float]:
        """Values of the inputs at the instant."""
        return {quantity.name: quantity.value for quantity in self.input_quantities}

    @property
    def output(self) -> dict[str, float]:
        """Values of the outputs at the instant."""
        return {quantity.name: quantity.value for quantity in self.output_quantities}

    @property
    def contacts(self) -> dict[str, str]:
        """How each contact is: locked, forward, backward or open."""
        return {name: MODES[mode] for name, mode in self.modes_of_contacts.items()}

    @cached_property
    def eigenvalues(self) -> Array:
        """Eigenvalues of A [1/s], slowest first."""
        return eigenvalues(self.A)

    @cached_property
    def modes(self) -> NaturalModes:
        """Natural modes: frequency, damping, time constant and shape of each; `print` shows a table."""
        return natural_modes(self.A, self.shafts, self.shaft_speeds, self.state_quantities)
