"""What a start of the program imports: its time follows from these lists, and a module more is seen here."""

from __future__ import annotations

import json
import subprocess
import sys

from support.project import ROOT

IMPORT = {
    *("base", "base.classes", "base.errors", "base.frozen", "base.quote", "base.plural"),
    *("declare", "declare.calls", "declare.core", "declare.docs", "declare.to_si", "declare.hooks", "declare.layout"),
    *("declare.node", "declare.pints", "declare.quantity", "declare.registry", "declare.schema"),
    *("declare.wording", "declare.unit_table", "declare.unit_words", "declare.units", "declare.expected_value"),
    *("base.verbs", "face", "face.names", "face.verbs", "_core"),
}
SIMULATE = {
    *("base.memoize", "results", "results.events", "results.recorded"),
    *("run", "run.begin", "run.control", "run.exports", "run.jumps", "run.record", "run.settings", "run.simulation"),
    "run.trajectory",
}
# rooms with a command of their own
ROOMS = ("codegen", "diagrams", "fit", "linear", "page", "rig", "schematic", "sweeps")
HELP = IMPORT | {
    *("base.extras", "base.paths", "base.progress", "base.shell", "base.writing"),
    *("command", "command.check", "command.completion", "command.main", "command.models", "command.new"),
    *("command.plot", "command.progress", "command.reference", "command.run"),
    *("declare.options", "declare.purposes", "declare.setting", "diagrams.kinds", "run", "run.flags", "sweeps.asking"),
    *ROOMS,
    *(f"{room}.command" for room in ROOMS),
}
# slow to load, and of no use before something is run, read or written
COSTLY = {
    *("numpy", "csv", "hashlib", "importlib.metadata", "importlib.resources", "tomllib", "zipfile", "email.message"),
    *("matplotlib", "pandas", "scipy", "xarray", "tqdm"),
}


def _loaded(code: str) -> set[str]:
    """Modules that a program loads behind its first line."""
    before, _, rest = code.partition("\n")
    program = (
        f"import sys, json\n{before}\nbefore = set(sys.modules)\n{rest}\n"
        "print()\nprint(json.dumps(sorted(set(sys.modules) - before)))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT)
    return set(json.loads(done.stdout.splitlines()[-1]))


def _own(loaded: set[str]) -> set[str]:
    return {name.removeprefix("clutchwork.") for name in loaded if name.startswith("clutchwork.")}


def test_a_plain_import() -> None:
    loaded = _loaded("pass\nimport clutchwork")
    assert _own(loaded) == IMPORT
    assert loaded & COSTLY == set()


def test_the_first_run_of_a_process() -> None:
    loaded = _loaded(
        "import clutchwork as cw; system = cw.Driveline.load('examples/six_speed/model.toml').assemble()\n"
        "cw.simulate(system, 4.0)"
    )
    assert _own(loaded) | SIMULATE == SIMULATE
    # no module of the standard library or of others
    assert [name for name in loaded if not name.startswith("clutchwork.")] == []


def test_help() -> None:
    loaded = _loaded("pass\nfrom clutchwork.command.main import main\nmain([])")
    assert _own(loaded) == HELP
    assert loaded & COSTLY == set()
