"""Break one rule of the physics on purpose, and report which test of a tier sees it: tools/broken_rules.toml.

Usage: PYTHON tools/break_rules.py --list
       PYTHON tools/break_rules.py [--tier first|last|all] [--likely] [NAME...]

Without names every rule is broken in turn, in a copy of the checkout in build/broken; the core is built there without
optimisation. A test that fails there counts where it passes in a sound copy. The exit status is the number of rules
that no test has seen. PYTHON has what the tests need, and cmake and ninja beside it.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RULES = ROOT / "tools/broken_rules.toml"
WORK = ROOT / "build/broken"
# where most of the physics is tested, what is cheap first; then everything
FOLDERS = (
    "physics",
    "registry",
    "linear",
    "stepping",
    "gearbox",
    "model",
    "properties",
    "shifts",
    "sweeps",
    "gradients",
)
# s after which a tree of tests that does not come to its end counts as a failure
LONGEST = 1200.0
ENDLESS, CRASHES = "does not come to its end", "crashes"
# tests of runs with derivatives
DERIVATIVES = ("gradients", "calibration", "fit")
FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+::.+?|\S+\.py)(?: - .*)?$", re.MULTILINE)
# the finder of an editable install would find the checkout in place of the copy
SITE = """import sys
sys.meta_path[:] = [one for one in sys.meta_path if "ScikitBuild" not in type(one).__name__]
"""


@dataclass(frozen=True)
class Rule:
    """A rule: its words, the code that makes it, and code that breaks it."""

    name: str
    words: str
    file: str
    text: str
    broken: str
    likely: tuple[str, ...] = ()

    def problems(self) -> Iterator[str]:
        """Why it cannot be broken."""
        count = (ROOT / self.file).read_text(encoding="utf-8").count(self.text)
        if count != 1:
            yield f"{self.name}: its text is {count} times in {self.file}"
        if self.text == self.broken:
            yield f"{self.name}: its text is not changed"
        for name in self.likely:
            if not (ROOT / "tests" / name).exists():
                yield f"{self.name}: there is no tests/{name}"


def rules() -> dict[str, Rule]:
    """All rules by name."""
    lines = tomllib.loads(RULES.read_text(encoding="utf-8"))["rule"]
    return {one["name"]: Rule(**one | {"likely": tuple(one.get("likely", ()))}) for one in lines}


@dataclass(frozen=True)
class Copy:
    """A copy of the checkout with a core of its own."""

    folder: Path
    # tests that fail without a broken rule
    unfit: list[str] = field(default_factory=list)

    def bring_up_to_date(self) -> None:
        """Copy what has changed, and what a build has generated beside the sources."""
        wanted = set(_listed())
        for name in wanted:
            here, there = ROOT / name, self.folder / name
            if not there.exists() or there.read_bytes() != here.read_bytes():
                there.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(here, there)
        for path in (self.folder / "tests").rglob("test_*.py"):
            if str(path.relative_to(self.folder)) not in wanted:
                path.unlink()
        (self.folder / "site").mkdir(exist_ok=True)
        (self.folder / "site/sitecustomize.py").write_text(SITE, encoding="utf-8")

    def build(self, *targets: str) -> bool:
        """Build targets of the core; whether that went well."""
        build = self.folder / "build"
        if not (build / "build.ninja").exists():
            self._run(*_configure(self.folder, build), check=True)
        done = self._run(_tool("cmake"), "--build", str(build), "--parallel", str(_jobs()), "--target", *targets)
        for module in build.glob("_*.so"):
            shutil.copy(module, self.folder / "src/clutchwork" / module.name)
        return done.returncode == 0

    def first_failure(self, tier: str, paths: Sequence[str]) -> str:
        """The first test of a tier that fails; empty where all pass."""
        command = [sys.executable, "-m", "pytest", "-x", "-q", "--tb=no", "-p", "no:cacheprovider", "--tier", tier]
        command += [f"--deselect={name}" for name in self.unfit]
        try:
            done = self._run(*command, *paths)
        except subprocess.TimeoutExpired:
            return f"{' '.join(paths)} {ENDLESS}"
        if found := FAILED.search(done.stdout):
            return found.group(1)
        if done.returncode < 0:
            return f"{' '.join(paths)} {CRASHES}"
        # 5: no test of these files is in this tier
        if done.returncode not in (0, 5):
            raise SystemExit(done.stdout)
        return ""

    def core_fails(self) -> bool:
        """Whether the tests of the core alone fail."""
        return not self.build("first_tier") or bool(
            self._run(_tool("ctest"), "--test-dir", str(self.folder / "build"), "-LE", "scalar").returncode
        )

    def _run(self, *command: str, check: bool = False) -> subprocess.CompletedProcess[str]:
        paths = os.pathsep.join(str(self.folder / name) for name in ("site", "src"))
        env = os.environ | {"PYTHONPATH": paths, "PYTHONDONTWRITEBYTECODE": "1"}
        return subprocess.run(  # noqa: S603 - our own tests
            command,
            cwd=self.folder,
            env=env,
            check=check,
            timeout=LONGEST,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )


def _listed() -> Iterator[str]:
    """Files of the checkout, and those that builds put beside the sources, except the modules."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
    done = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True)  # noqa: S603 - our own files
    for name in done.stdout.splitlines():
        if (ROOT / name).is_file():
            yield name
    for pattern in ("**/*.pyi", "page/static/*"):
        yield from (str(path.relative_to(ROOT)) for path in (ROOT / "src/clutchwork").glob(pattern) if path.is_file())


def _tool(name: str) -> str:
    return shutil.which(name, path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', '')}") or name


def _jobs() -> int:
    return int(os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", os.cpu_count() or 1))


def _configure(sources: Path, build: Path) -> list[str]:
    """A build that is as cheap as it can be: no optimisation, one size of the steps, this machine's width."""
    options = {
        "CMAKE_MAKE_PROGRAM": _tool("ninja"),
        "Python_EXECUTABLE": sys.executable,
        "CMAKE_CXX_FLAGS": "-DCLUTCHWORK_ONE_SIZE",
        "CLUTCHWORK_QUICK": "ON",
        "CLUTCHWORK_NATIVE": "ON",
        "CLUTCHWORK_TESTS": "ON",
    }
    where = [sys.executable, "-m", "nanobind", "--cmake_dir"]
    done = subprocess.run(where, check=True, stdout=subprocess.PIPE, text=True)  # noqa: S603 - our own environment
    options["nanobind_DIR"] = done.stdout.strip()
    defines = [f"-D{name}={value}" for name, value in options.items()]
    return [_tool("cmake"), "-S", str(sources), "-B", str(build), "-G", "Ninja", *defines]


def seen_by(rule: Rule, tier: str, broken: Copy, sound: Copy, only_likely: bool = False) -> str:
    """The test that sees a broken rule; empty where none does."""
    file = broken.folder / rule.file
    whole = file.read_text(encoding="utf-8")
    file.write_text(whole.replace(rule.text, rule.broken), encoding="utf-8")
    try:
        if not broken.build("_core"):
            raise SystemExit(f"{rule.name}: the core does not compile; break it in another way")
        found = _first_that_counts(tier, rule.likely if only_likely else (*rule.likely, *FOLDERS, ""), broken, sound)
        return found or ("the tests of the core alone" if not only_likely and broken.core_fails() else "")
    finally:
        file.write_text(whole, encoding="utf-8")


def _first_that_counts(tier: str, paths: Sequence[str], broken: Copy, sound: Copy) -> str:
    for path in paths:
        # they take as long to build as the core
        if not path or path.startswith(DERIVATIVES):
            broken.build("_derivatives")
        while found := broken.first_failure(tier, [f"tests/{path}".rstrip("/")]):
            if found.endswith((ENDLESS, CRASHES)) or not sound.first_failure("all", [found]):
                return found
            if "::" not in found:
                raise SystemExit(f"fails in the sound copy: {found}")
            broken.unfit.append(found)
    return ""


def main() -> int:
    """Break rules one by one; the number of those that were not seen."""
    known = rules()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="rules; all by default")
    parser.add_argument("--tier", choices=("first", "last", "all"), default="first")
    parser.add_argument("--likely", action="store_true", help="run no tests but those that a rule names: minutes")
    parser.add_argument("--list", action="store_true", help="names and words of all rules")
    asked = parser.parse_args()
    if asked.list:
        for rule in known.values():
            print(f"{rule.name:32} {rule.words} ({rule.file})")
        return 0
    if unknown := [name for name in asked.names if name not in known]:
        parser.error(f"no rule {', '.join(unknown)}; --list has all")
    broken, sound = Copy(WORK / "one_broken"), Copy(WORK / "sound")
    for copy in (broken, sound):
        copy.bring_up_to_date()
        if not copy.build("_core", "_derivatives"):
            raise SystemExit(f"the core does not build in {copy.folder}")
    missed = 0
    for name in asked.names or known:
        start = time.monotonic()
        found = seen_by(known[name], asked.tier, broken, sound, asked.likely)
        missed += not found
        print(f"{name:32} {found or 'NOT SEEN'}  ({time.monotonic() - start:.0f} s)", flush=True)
    return missed


if __name__ == "__main__":
    sys.exit(main())
