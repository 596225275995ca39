"""Install a release as its users will, and run the first program of the README with it.

Usage: PYTHON try_release.py WHEEL, a wheel for this machine. A package index on this machine serves it and what it
needs, so that the line of README.md runs as it stands, in a new environment.
"""

from __future__ import annotations

import html
import os
import re
import subprocess
import sys
import tempfile
import threading
import venv
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LINE = re.compile(r"^    pip (install \S+)$", re.MULTILINE)


class Quiet(SimpleHTTPRequestHandler):
    """Serves a folder, and prints no line for each request."""

    def log_message(self, *_: object) -> None:
        """Nothing."""


def install_line(readme: str) -> list[str]:
    """What README.md gives to pip."""
    found = LINE.search(readme)
    if not found:
        raise SystemExit("README.md: no line `pip install`")
    return found[1].replace('"', "").split()


def index(folder: Path, served: Path) -> None:
    """Lay files out as a simple index: PEP 503."""
    for path in sorted(folder.iterdir()):
        project = re.sub(r"[-_.]+", "-", path.name.partition("-")[0]).lower()
        (served / project).mkdir(parents=True, exist_ok=True)
        (served / project / path.name).hardlink_to(path)
    for place in served.iterdir():
        links = [f'<a href="{html.escape(path.name)}">{html.escape(path.name)}</a>' for path in place.iterdir()]
        (place / "index.html").write_text("<!doctype html>\n" + "\n".join(links), "utf-8")


def called(*command: str | Path, **settings: str) -> None:
    """Run a program to its end; its error is ours."""
    print("+", *command, flush=True)
    done = subprocess.run(command, env=os.environ | settings, check=False)  # noqa: S603 - our own programs
    if done.returncode:
        raise SystemExit(f"{command[0]} ended with {done.returncode}")


def main(wheel: Path) -> None:
    """Ends with an error where something fails or is missing."""
    line = install_line((ROOT / "README.md").read_text("utf-8"))
    with tempfile.TemporaryDirectory() as name:
        work = Path(name).resolve()
        venv.create(work / "venv", with_pip=True, symlinks=os.name != "nt")
        python = work / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python"
        pip = (python, "-m", "pip", "--disable-pip-version-check", "--quiet")
        extras = line[-1].removeprefix("clutchwork")
        called(*pip, "download", "--only-binary", ":all:", "--dest", work / "files", f"{wheel}{extras}")
        index(work / "files", work / "simple")
        with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(work / "simple"))) as server:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            address = f"http://127.0.0.1:{server.server_address[1]}/"
            # this index alone: no settings of the machine
            called(*pip, *line, PIP_CONFIG_FILE=os.devnull, PIP_INDEX_URL=address, PIP_NO_CACHE_DIR="1")
            server.shutdown()
        called(python, ROOT / "tools" / "try_installed.py")
    print(f"{wheel.name}: `pip {' '.join(line)}` and the programs of a new user work")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
