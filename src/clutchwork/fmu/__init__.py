"""FMUs of drivelines: archives that other simulators run, with the compiled core inside."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from clutchwork.fmu.export import export_fmu as export_fmu


if not TYPE_CHECKING:
    # the command line imports this package to ask less
    def __getattr__(name: str) -> Any:
        if name == "export_fmu":
            from clutchwork.fmu.export import export_fmu

            return export_fmu
        raise AttributeError(f"clutchwork.fmu has no {name!r}")
