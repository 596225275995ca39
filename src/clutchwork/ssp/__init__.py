"""Packages of several FMUs and their connections, SSP 1.0, which other simulators run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from clutchwork.ssp.export import export_ssp as export_ssp


if not TYPE_CHECKING:
    # the command line imports this package to ask less
    def __getattr__(name: str) -> Any:
        if name == "export_ssp":
            # loaded where a package is written
            from clutchwork.ssp.export import export_ssp

            return export_ssp
        raise AttributeError(f"clutchwork.ssp has no {name!r}")
