"""What a start of the program imports: its time follows from these lists, and a module more is seen here."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
from collections.abc import Iterator

from support.project import ROOT

IMPORT = {
    *("base", "base.classes", "base.errors", "base.frozen", "base.quote", "base.plural"),
    *("declare", "declare.calls", "declare.core", "declare.docs", "declare.to_si", "declare.hooks", "declare.layout"),
    *("declare.node", "declare.pints", "declare.quantity", "declare.registry", "declare.schema"),
    *("declare.wording", "declare.unit_table", "declare.unit_words", "declare.units", "declare.expected_value"),
    *("base.verbs", "face", "face.names", "face.verbs", "_core"),
}
SIMULATE = {
    *("base.arrays", "base.memoize", "results", "results.events", "results.recorded"),
    *("run", "run.begin", "run.control", "run.exports", "run.jumps", "run.record", "run.settings", "run.simulation"),
    "run.trajectory",
}
# rooms with a command of their own
ROOMS = ("codegen", "diagrams", "fit", "fmu", "linear", "page", "rig", "schematic", "ssp", "sweeps")
HELP = IMPORT | {
    *("base.extras", "base.paths", "base.progress", "base.shell", "base.writing"),
    *("command", "command.check", "command.completion", "command.main", "command.models", "command.new"),
    *("command.plot", "command.progress", "command.reference", "command.run"),
    *(
        "codegen.precision",
        "declare.options",
        "declare.purposes",
        "declare.setting",
        "diagrams.kinds",
        "run",
        "run.flags",
        "sweeps.asking",
    ),
    *ROOMS,
    *(f"{room}.command" for room in ROOMS),
}
# what may import a module of the package by a name that is text
BY_NAME = {
    # public names, imported when they are first used
    *("__init__.py", "fit/__init__.py", "rig/__init__.py"),
    # every file of a folder
    *("declare/registry.py", "hints/registry.py", "rig/experiments/__init__.py"),
    # compiled ones, which may be missing
    "declare/core.py",
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


def test_an_import_inside_a_function_has_a_reason() -> None:
    """A start loads its module, it brings what may not be installed, or a comment above says why."""
    first = "d = cw.Driveline.load('examples/six_speed/model.toml'); d.simulate(0.1)"
    start = _own(_loaded(f"pass\nimport clutchwork as cw\n{first}")) | HELP
    wrong = list[str]()
    for own, text in _sources(r"(?m)^ +(from|import) "):
        if own.removesuffix(".py").replace("/", ".").removesuffix(".__init__") not in start:
            wrong += [f"{own}:{line}" for line in _inner_imports(text)]
    assert wrong == []


def test_no_module_is_named_by_a_text() -> None:
    """An arrow between rooms is an import, which the contracts see."""
    found = {
        own
        for own, text in _sources("import_module|__import__")
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith(("import_module", "__import__"))
        # names of other packages begin with these
        if not re.match(r"f?'(?!clutchwork|{)", ast.unparse(node.args[0]))
    }
    assert found - {"base/extras.py"} == BY_NAME


def _sources(pattern: str) -> Iterator[tuple[str, str]]:
    """Files of the package that have something, by their paths in it."""
    package = ROOT / "src" / "clutchwork"
    for path in sorted(package.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        if re.search(pattern, text):
            yield path.relative_to(package).as_posix(), text


def _inner_imports(text: str) -> list[int]:
    """Lines of imports inside functions, the first of those below each other, with no comment above."""
    lines = text.splitlines()
    tree = ast.parse(text)
    inner = {
        node.lineno - 1
        for function in ast.walk(tree)
        if isinstance(function, ast.FunctionDef)
        for node in ast.walk(function)
        if isinstance(node, ast.Import | ast.ImportFrom) and not _is_optional(node)
    }
    firsts = sorted(place for place in inner if place - 1 not in inner)
    return [place + 1 for place in firsts if not lines[place - 1].lstrip().startswith("#")]


def _is_optional(node: ast.Import | ast.ImportFrom) -> bool:
    names = [node.module or ""] if isinstance(node, ast.ImportFrom) else [one.name for one in node.names]
    return {name.partition(".")[0] for name in names} <= COSTLY
