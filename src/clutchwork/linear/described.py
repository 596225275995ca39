"""What pictures and other packages need of a linear system."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

from numpy.typing import NDArray

if TYPE_CHECKING:
    from clutchwork.linear.modes import NaturalModes
    from clutchwork.linear.quantity import Quantity

Array = NDArray[Any]


class LinearSystem(Protocol):
    """A linear system, such as a Linear."""

    @property
    def matrices(self) -> tuple[Array, Array, Array, Array]:
        """A, B, C and D."""

    @property
    def model(self) -> str:
        """Name of the driveline."""

    @property
    def time(self) -> float:
        """Instant [s]."""

    @property
    def contacts(self) -> dict[str, str]:
        """How each contact is."""

    @property
    def state_quantities(self) -> Sequence[Quantity]:
        """States."""

    @property
    def input_quantities(self) -> Sequence[Quantity]:
        """Inputs."""

    @property
    def output_quantities(self) -> Sequence[Quantity]:
        """Outputs."""

    @property
    def eigenvalues(self) -> Array:
        """Eigenvalues [1/s]."""

    @property
    def modes(self) -> NaturalModes:
        """Natural modes."""

    @property
    def notes(self) -> Sequence[str]:
        """What was undecided."""
