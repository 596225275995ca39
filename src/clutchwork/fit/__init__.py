"""Parameters of friction laws and of whole drivelines, identified from measurements.

    import clutchwork as cw
    from clutchwork.fit import fit_csv

    start = cw.Stribeck(static=0.12, kinetic=0.1, speed=1.0)
    result = fit_csv("measured.csv", start, slip="slip", torque="torque", load="load")
    print(result)

Needs SciPy: pip install "clutchwork[fit]".
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from clutchwork.base import near

if TYPE_CHECKING:
    from clutchwork.fit.estimates import Parameter as Parameter
    from clutchwork.fit.estimates import UndeterminedError as UndeterminedError
    from clutchwork.fit.failure import FitError as FitError
    from clutchwork.fit.law import fit_csv as fit_csv
    from clutchwork.fit.law import fit_law as fit_law
    from clutchwork.fit.record import Record as Record
    from clutchwork.fit.records import fit_records as fit_records
    from clutchwork.fit.response import fit_response as fit_response
    from clutchwork.fit.response_result import ResponseFit as ResponseFit
    from clutchwork.fit.result import FitResult as FitResult

# names that are loaded when they are first used, with their module: the command line imports this package to ask less
_LAZY = {
    "FitError": "failure",
    "FitResult": "result",
    "Parameter": "estimates",
    "Record": "record",
    "ResponseFit": "response_result",
    "UndeterminedError": "estimates",
    "fit_csv": "law",
    "fit_law": "law",
    "fit_records": "records",
    "fit_response": "response",
}
__all__ = sorted(_LAZY)


if not TYPE_CHECKING:
    # to a type checker any name would do
    def __getattr__(name: str) -> Any:
        if name in _LAZY:
            return getattr(import_module(f"clutchwork.fit.{_LAZY[name]}"), name)
        raise AttributeError(f"clutchwork.fit has no {name!r}{near(name, __all__)}")


def __dir__() -> list[str]:
    return list(__all__)
