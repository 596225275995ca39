"""A copy of the project that tests change: one for all of them, mended after each."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from support import project

# what is made in a copy, and its caches
MADE = {"gen", "__pycache__"}


def _state(folder: Path) -> dict[Path, tuple[int, int]]:
    """Time and size of every source of a copy."""
    files = (path for path in folder.rglob("*") if path.is_file() and not MADE & set(path.relative_to(folder).parts))
    return {path.relative_to(folder): (path.stat().st_mtime_ns, path.stat().st_size) for path in files}


def _mend(folder: Path, before: dict[Path, tuple[int, int]]) -> None:
    """Make the sources what they were."""
    after = _state(folder)
    for path in {path for path, _ in before.items() ^ after.items()}:
        (folder / path).unlink(missing_ok=True)
        # edits of the same second and size would be taken for each other
        for cache in (folder / path.parent / "__pycache__").glob(f"{path.stem}.*"):
            cache.unlink()
        if path in before:
            shutil.copy2(project.ROOT / path, folder / path)
    shutil.rmtree(folder / "gen", ignore_errors=True)


@pytest.fixture(scope="session")
def _shared(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[Path, tuple[int, int]]]:
    folder = project.copy(tmp_path_factory.mktemp("copy") / "project")
    return folder, _state(folder)


@pytest.fixture
def copy(_shared: tuple[Path, dict[Path, tuple[int, int]]]) -> Iterator[Path]:
    """The project without build results, as it is in the repository."""
    folder, before = _shared
    yield folder
    _mend(folder, before)
