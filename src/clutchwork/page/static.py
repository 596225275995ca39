"""What is built for pages: the core as WebAssembly, the script and the style."""

from __future__ import annotations

from pathlib import Path

from clutchwork.base import ClutchworkError

FOLDER = Path(__file__).parent / "static"
CORE, SCRIPT, GEARBOX, WIDGET, STYLE = "core.wasm", "page.js", "gearbox.js", "widget.js", "page.css"


class PageError(ClutchworkError, ValueError):
    """Why there is no page."""


def missing() -> list[str]:
    """What was not built in a checkout of the sources; a wheel has all of it."""
    return [name for name in (CORE, SCRIPT, GEARBOX, WIDGET, STYLE) if not (FOLDER / name).is_file()]


def built(name: str) -> bytes:
    """The content of a built file; PageError says how to make what is missing."""
    lacking = missing()
    if lacking:
        raise PageError(f"a page needs {', '.join(lacking)}, which this checkout did not build: run make wasm page")
    return (FOLDER / name).read_bytes()
