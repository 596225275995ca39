"""Pictures of pages to look at: of the documentation, of an example, and of two widgets, in every browser that is here.

Usage: PYTHON tools/page_pictures.py [FOLDER], in a checkout with `make wasm page`. Each page is opened as wide as a
desktop and as a phone, light and dark, and a knot is dragged: FOLDER/PAGE-BROWSER-WIDTH-SCHEME.png, else in out/pages.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from base64 import b64encode
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import clutchwork as cw
import law_pages
from clutchwork.page.static import WIDGET, built

ROOT = Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "docs" / "figures"))
# makes the pages of the documentation
live: Any = import_module("live")

BROWSERS = ("chromium", "firefox-esr", "firefox")
# as anywidget calls it, in a light notebook and in a dark one
NOTEBOOK = """<!DOCTYPE html><meta charset="utf-8"><title>two widgets</title><style>
body {{ margin: 0; display: flex; flex-wrap: wrap }} div {{ flex: 1 1 380px; min-width: 0 }}
</style><main><div class="panel" hidden></div></main>
<div data-jp-theme-light="true"></div><div data-jp-theme-light="false" style="background: #111"></div>
<script type="module">
const {{ default: widget }} = await import("data:text/javascript;base64,{script}");
const traits = {traits};
traits.core = new DataView(Uint8Array.from(atob(traits.core), (letter) => letter.charCodeAt(0)).buffer);
const model = {{ get: (name) => traits[name], set() {{}}, save_changes() {{}}, on() {{}}, off() {{}} }};
for (const el of document.querySelectorAll("[data-jp-theme-light]")) widget.render({{ model, el }});
</script>
"""


def pages(folder: Path) -> Iterator[Path]:
    """All pages that are looked at."""
    for name, page in live.PAGES.items():
        page(folder / f"{name}.html")
        yield folder / f"{name}.html"
    law_pages.write("gms", folder / "law.html")
    yield folder / "law.html"
    yield cw.Gearbox.load("zf-8hp70").page(folder / "gearbox.html")
    run = cw.Driveline.load(ROOT / "examples" / "six_speed" / "model.toml").simulate()
    yield run.page(folder / "six_speed.html")
    widget = folder / "widget.html"
    widget.write_text(notebook(run.widget(drag=["F1.pressure", "F2.pressure"])), encoding="utf-8")
    yield widget


def notebook(widget: Any) -> str:
    """A page with two views of a widget."""
    traits = {name: getattr(widget, name) for name in ("page", "css", "knots", "values")}
    core = b64encode(widget.core).decode()
    # in a script, where `</` could end it
    words = json.dumps({**traits, "core": core}).replace("</", "<\\/")
    return NOTEBOOK.format(script=b64encode(built(WIDGET)).decode(), traits=words)


def main() -> None:
    """Ends with an error where a page said something in its console."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "out" / "pages")
    folder.mkdir(parents=True, exist_ok=True)
    made = list(pages(folder))
    program = [str(ROOT / "tests" / "page" / "pictures.mjs"), str(ROOT / "interfaces" / "page")]
    said: dict[str, list[str]] = {}
    for browser in dict.fromkeys(filter(None, map(shutil.which, BROWSERS))):
        command = ["node", *program, browser, str(folder), *map(str, made)]
        done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)  # noqa: S603 - our own program
        said |= json.loads(done.stdout)
    print(f"{len(list(folder.glob('*.png')))} pictures in {folder}")
    if said:
        raise SystemExit("\n".join(f"{name}: {words}" for name, words in said.items()))


if __name__ == "__main__":
    main()
