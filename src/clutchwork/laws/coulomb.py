"""Constant coefficients of friction."""

from __future__ import annotations

from clutchwork.declare import Law, Role, component, param


@component(Role.LAW)
class Coulomb(Law):
    """One coefficient while it slips, another at rest.

    Use it where the change with slip does not matter or is not known.
    """

    static: float = param("1", "coefficient at rest", at_least=0.0, example=0.12)
    kinetic: float = param("1", "coefficient while it slips, at most the static one", at_least=0.0, example=0.1)

    def sliding(self) -> float:
        return self.kinetic
