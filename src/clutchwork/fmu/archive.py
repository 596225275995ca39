"""Archives of FMUs: the same content gives the same bytes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.etree.ElementTree import fromstring
from zipfile import ZIP_DEFLATED, BadZipFile, ZipFile, ZipInfo

from clutchwork.base import UseError
from clutchwork.base.writing import replaced

# no archive has an earlier one
DATE = (1980, 1, 1, 0, 0, 0)
BINARIES = "binaries/"


def write(path: Path, entries: Mapping[str, bytes]) -> Path:
    """Write an archive with its entries in order of their names, the description first."""
    first = "modelDescription.xml"
    order = sorted(entries, key=lambda name: (name != first, name))
    with replaced(path) as new, ZipFile(new, "w") as archive:
        for name in order:
            item = ZipInfo(name, DATE)
            item.compress_type = ZIP_DEFLATED
            # a plain file that its owner may change and all may read; a library can be run
            item.external_attr = (0o100755 if name.startswith(BINARIES) else 0o100644) << 16
            item.create_system = 3
            archive.writestr(item, entries[name])
    return path


def read(path: Path) -> dict[str, bytes]:
    """The entries of an archive."""
    try:
        with ZipFile(path) as archive:
            return {name: archive.read(name) for name in archive.namelist()}
    except BadZipFile:
        raise UseError("clutchwork fmu merge", [f"{path} is not an FMU: it is not an archive"]) from None


def summary(path: Path) -> str:
    """Version, inputs and numbers of outputs and parameters of an FMU, in words."""
    root = fromstring(read(path)["modelDescription.xml"])  # noqa: S314 - written by us just now
    found = [(one.get("causality"), one.get("name", "")) for one in root.iter() if one.get("causality")]
    inputs = [name for role, name in found if role == "input" and not name.startswith("der(")]
    counts = [sum(role == wanted for role, _ in found) for wanted in ("output", "parameter")]
    names = ", ".join(inputs) or "none"
    return f"FMI {root.get('fmiVersion')}, inputs: {names}; {counts[0]} outputs, {counts[1]} parameters"


def merge(paths: Sequence[Path], out: Path) -> Path:
    """One FMU with the libraries of several that are otherwise the same; UseError where they are not."""
    whole = dict[str, bytes]()
    for path in paths:
        entries = read(path)
        for name, content in entries.items():
            if name in whole and whole[name] != content and not name.endswith(".png"):
                raise UseError("clutchwork fmu merge", [f"{path} and {paths[0]} differ in {name}: export both again"])
        if whole and not entries.keys() - whole.keys():
            raise UseError("clutchwork fmu merge", [f"{path} has no library that {paths[0]} does not have"])
        missing = [name for name in whole if name not in entries and not name.startswith(BINARIES)]
        if missing:
            raise UseError("clutchwork fmu merge", [f"{path} has no {missing[0]}: these are FMUs of two models"])
        whole = {**entries, **whole}
    return write(out, whole)
