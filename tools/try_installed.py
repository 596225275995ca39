"""Run the first program of the README, the demo, a gradient, a new model and its page with the installed package.

Usage: PYTHON try_installed.py, where PYTHON has `clutchwork[draw]`, not editable. All run in an empty folder,
with a PATH that holds no compiler, and see no checkout.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import sysconfig
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parent.parent
FIRST = re.compile(r"<!-- the first program -->\n```python\n(.*?)```", re.DOTALL)
WHERE = "import clutchwork; print(clutchwork.__file__)"
CATALOGUE = "import clutchwork as cw; print(len(cw.catalogue()), cw.Gearbox.load('zf-8hp70').ratios)"
# what pages and widgets are made of, which node bundles and only wheels have
STATIC = """
from clutchwork.page import static
import clutchwork as cw
for name in (static.CORE, static.SCRIPT, static.GEARBOX, static.WIDGET, static.STYLE):
    print(name, len(static.built(name)))
print(cw.Gearbox.load("zf-8hp70").page("gearbox.html"))
"""
# derivatives are a module of their own, and a schematic takes what [draw] brings
DERIVATIVES = """
import clutchwork as cw
d = cw.Driveline("two discs")
engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8, speed=0.0)
lining = cw.Coulomb(static=0.1, kinetic=0.1)
d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=5e-4, pressure=2e5))
d.draw("schematic.svg")
print(d.simulate(2.0).gradient(of=cw.lock("c1"), by=["c1.gain"]))
"""
WRITTEN = (
    "schematic.svg",
    "shift.html",
    "gearbox.html",
    "shift.png",
    "out/demo/shift.png",
    "out/demo/trajectory.csv",
    "out/demo/events.csv",
)


def first_program(readme: str) -> str:
    """The program at the top of the README."""
    found = FIRST.search(readme)
    if not found:
        raise SystemExit("README.md: no first program")
    return found[1]


def environment() -> dict[str, str]:
    """Without compilers and without what could lead Python elsewhere."""
    kept = {name: text for name, text in os.environ.items() if not name.upper().startswith("PYTHON")}
    paths = [sysconfig.get_path("scripts")]
    if sys.platform == "win32":
        paths.append(str(Path(os.environ["SYSTEMROOT"], "System32")))
    return {**kept, "PATH": os.pathsep.join(paths), "MPLBACKEND": "agg"}


def run(folder: Path, *command: str) -> str:
    """Run a program in a folder; what it printed."""
    print("+", *command, flush=True)
    done = subprocess.run(  # noqa: S603 - our own programs
        command, cwd=folder, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    print(done.stdout, flush=True)
    if done.returncode:
        raise SystemExit(f"{command[0]} ended with {done.returncode}")
    return done.stdout


def main() -> None:
    """Ends with an error where something fails or is missing."""
    with TemporaryDirectory() as name:
        folder = Path(name).resolve()
        package = Path(run(folder, sys.executable, "-c", WHERE).strip())
        if (ROOT / "src") in package.parents:
            raise SystemExit(f"{package} is the checkout: install a wheel")
        (folder / "first.py").write_text(first_program((ROOT / "README.md").read_text("utf-8")), encoding="utf-8")
        run(folder, sys.executable, "first.py")
        run(folder, sys.executable, "-c", CATALOGUE)
        run(folder, sys.executable, "-c", DERIVATIVES)
        command = str(Path(sysconfig.get_path("scripts"), "clutchwork"))
        run(folder, command, "demo")
        run(folder, command, "new")
        run(folder, command, "run", "model.toml")
        run(folder, command, "page", "model.toml", "--out", "shift.html")
        run(folder, sys.executable, "-c", STATIC)
        missing = [file for file in WRITTEN if not (folder / file).is_file()]
        if missing:
            raise SystemExit(f"not written: {', '.join(missing)}")


if __name__ == "__main__":
    main()
