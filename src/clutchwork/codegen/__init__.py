"""C and C++ of a model: a folder that builds and runs without Python."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from clutchwork.codegen.folder import export_c as export_c


if not TYPE_CHECKING:
    # the command line imports this package to ask less
    def __getattr__(name: str) -> Any:
        if name == "export_c":
            from clutchwork.codegen.folder import export_c

            return export_c
        raise AttributeError(f"clutchwork.codegen has no {name!r}")
