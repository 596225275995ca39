"""The linear system that `cw.linearise` gives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import UseError, columns, counted, html, quote
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.quantity import QuantityError, has_unit, in_si
from clutchwork.linear.handover import to_control, to_dict, to_scipy
from clutchwork.linear.picture import picture
from clutchwork.linear.quantity import Quantity, amount, per_second
from clutchwork.linear.system import LinearSystem

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.figure import Figure

Array = NDArray[Any]

MOST_SHOWN = 20


@explained_methods("lin")
class Linear(LinearSystem):
    """A linear system about one instant: d/dt x = rate + A x + B u, y = C x + D u.

    x, u and y are what states, inputs and outputs deviate from their values at the instant: `state`, `input`, `output`.
    `rate` is the rate of the states there; it is zero in steady motion.
    """

    @explained("frequency_response")
    def frequency_response(self, frequencies: Any) -> Array:
        """Response of every output to every input at frequencies [Hz, or with a unit].

        A complex array (frequencies, outputs, inputs), in units of the output per unit of the input. UseError where a
        frequency is that of an undamped mode, at which there is no finite response.
        """
        try:
            asked = np.atleast_1d(np.asarray(_in_hertz(frequencies), dtype=float))
        except QuantityError as error:
            raise UseError("frequency_response", [f"frequencies: {error}"]) from None
        except (TypeError, ValueError):
            asked = np.full(1, np.nan)
        if asked.ndim != 1 or not np.isfinite(asked).all():
            given = f"frequencies = {quote(frequencies)}: must be finite numbers in Hz"
            raise UseError("frequency_response", [given])
        made = np.empty((len(asked), *self.D.shape), dtype=complex)
        for place, frequency in enumerate(asked):
            matrix = 2j * np.pi * frequency * np.eye(len(self.A)) - self.A
            try:
                made[place] = self.C @ np.linalg.solve(matrix, self.B) + self.D
            except np.linalg.LinAlgError:
                fault = f"{frequency:g} Hz is the frequency of an undamped mode; ask beside it"
                raise UseError("frequency_response", [fault]) from None
        return made

    def to_control(self) -> Any:
        """The system for python-control, with names; dots in them become underscores, which that package asks for."""
        return to_control(self)

    def to_scipy(self) -> Any:
        """The system as a `scipy.signal.StateSpace`."""
        return to_scipy(self)

    @explained("plot")
    def plot(self, path: str | Path | None = None) -> Figure:
        """Picture of the eigenvalues and of the shapes of the modes; written to `path` when given. Needs matplotlib."""
        return picture(self, path)

    def to_dict(self) -> dict[str, Any]:
        """All of it as plain data, as `clutchwork linearise --json` prints it."""
        return to_dict(self)

    def __str__(self) -> str:
        sizes = (
            counted(len(part), name) for part, name in zip(self._parts, ("states", "inputs", "outputs"), strict=True)
        )
        head = f"{self.model} at {self.time:g} s: {', '.join(sizes)}"
        words = {"locked": [], "slipping forward": [], "slipping backward": [], "open": []}  # type: dict[str, list[str]]
        for name, how in self.contacts.items():
            words[f"slipping {how}" if how in ("forward", "backward") else how].append(name)
        contacts = [f"{how}: {', '.join(names)}" for how, names in words.items() if names]
        lines = [head, *(["; ".join(contacts)] if contacts else []), "", self._table(), "", str(self.modes)]
        return "\n".join([*lines, *(["", *self.notes] if self.notes else [])])

    def __repr__(self) -> str:
        sizes = (
            counted(len(part), name) for part, name in zip(self._parts, ("states", "inputs", "outputs"), strict=True)
        )
        return f"<Linear {quote(self.model)} at {self.time:g} s: {', '.join(sizes)}>"

    @property
    def _parts(self) -> Sequence[Sequence[Quantity]]:
        return self.state_quantities, self.input_quantities, self.output_quantities

    def _repr_html_(self) -> str:
        """States, inputs and outputs, modes and notes for a notebook."""
        head, *lines = self._lines()
        return html.page(
            html.heading(repr(self)[1:-1]),
            html.table(head, lines, right=(2, 3), most=len(lines)),
            self.modes._repr_html_(),
            *map(html.paragraph, self.notes),
        )

    def _table(self) -> str:
        return columns(self._lines(), right=(2, 3))

    def _lines(self) -> list[tuple[str, str, str, str]]:
        """Lines of the table of states, inputs and outputs, the head first."""
        lines = [("", "", "value", "rate of change")]
        for word, part in zip(("state", "input", "output"), self._parts, strict=True):
            for place, quantity in enumerate(part[:MOST_SHOWN]):
                rate = (
                    f"{quantity.rate:.4g} {per_second(quantity.unit)}"
                    if word == "state" and abs(quantity.rate) > 0.0
                    else ""
                )
                lines.append((word if place == 0 else "", quantity.name, amount(quantity.value, quantity.unit), rate))
            if len(part) > MOST_SHOWN:
                lines.append(("", f"and {len(part) - MOST_SHOWN} more", "", ""))
        return lines


def _in_hertz(frequencies: Any) -> Any:
    """Frequencies with units as numbers in Hz, all else as it is; QuantityError for a unit that does not fit."""
    if isinstance(frequencies, list | tuple):
        return [in_si(one, "Hz") for one in frequencies]
    return in_si(frequencies, "Hz") if has_unit(frequencies) else frequencies
