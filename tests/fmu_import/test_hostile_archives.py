"""Archives that want out of their folder or fill the disk: each ends in one sentence. docs/guide/fmu-import.md"""

from __future__ import annotations

import stat
from collections.abc import Callable
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile, ZipInfo

import pytest

import clutchwork as cw
from clutchwork.fmu_import import archive
from support.c_fmus import DESCRIPTION_TWO

SOUND = DESCRIPTION_TWO.encode()
DOCTYPE = b'<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'


def entry(name: str, mode: int = 0, content: bytes = b"x") -> Callable[[ZipFile], None]:
    """Writes one entry, whatever its name."""

    def write(made: ZipFile) -> None:
        item = ZipInfo("x")
        # the constructor would turn the name
        item.filename = name
        item.external_attr = mode << 16
        made.writestr(item, content, ZIP_DEFLATED)

    return write


def twice(*names: str) -> Callable[[ZipFile], None]:
    """Writes several entries."""

    def write(made: ZipFile) -> None:
        for name in names:
            entry(name)(made)

    return write


def many(made: ZipFile) -> None:
    """More entries than any FMU has."""
    for number in range(archive.MOST_ENTRIES):
        made.writestr(ZipInfo(f"r/{number}"), b"")


# what an entry is, and the sentence
ENTRIES = {
    "absolute": (entry("/tmp/clutchwork-escaped"), "its entry '/tmp/clutchwork-escaped' has an absolute path"),
    "up": (entry("resources/../../escaped"), "its entry 'resources/../../escaped' leads out of its folder"),
    "backslash": (entry("..\\escaped"), "its entry '..\\\\escaped' has a backslash"),
    "drive": (entry("C:escaped"), "its entry 'C:escaped' has a colon, as a drive has"),
    "link": (entry("binaries", stat.S_IFLNK | 0o777, b"/"), "its entry 'binaries' is a link"),
    "device": (
        entry("resources/null", stat.S_IFCHR | 0o666),
        "its entry 'resources/null' is neither a file nor a folder",
    ),
    "twice": (twice("resources/a", "resources/A"), "is there twice"),
    "file and folder": (twice("resources/a", "resources/a/b"), "is there twice, as a file and as a folder"),
    "empty part": (entry("resources//a"), "has no name that all file systems take"),
    "NUL": (entry("resources/a\0b"), "has no name that all file systems take"),
    "many": (many, "it has 10002 entries, more than 10000"),
    "bomb": (entry("resources/a", 0, bytes(20_000_000)), "unpacks to more than 200 times its size"),
}


def made_of(path: Path, write: Callable[[ZipFile], None], description: bytes = SOUND) -> Path:
    """An FMU with a library that is none, and more entries."""
    with ZipFile(path, "w", ZIP_STORED) as made:
        made.writestr("modelDescription.xml", description)
        made.writestr("binaries/linux64/small.so", b"")
        write(made)
    return path


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize("case", ENTRIES)
def test_a_hostile_archive_ends_in_one_sentence(tmp_path: Path, case: str) -> None:
    write, words = ENTRIES[case]
    path, out = made_of(tmp_path / "a.fmu", write), tmp_path / "out"
    out.mkdir()
    with pytest.raises(cw.FMUError) as raised:
        archive.unpack(path, out)
    assert words in str(raised.value)
    # entries are looked at before the first is unpacked; what is too large is found on the way
    assert case == "bomb" or not list(out.iterdir())
    assert sorted(one.name for one in tmp_path.iterdir()) == ["a.fmu", "out", "temporary"]
    if case != "bomb":
        with pytest.raises(cw.FMUError, match=r"FMU 'a' .*a.fmu.: its entry|it has"):
            cw.FMU(path, 0.1, trust=True)


def test_heads_that_lie_do_not_let_a_bomb_pass(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A head says 10 bytes: no more are unpacked, and the checksum does not fit."""
    path = made_of(tmp_path / "a.fmu", entry("resources/a", 0, bytes(20_000_000)))
    data = path.read_bytes()
    path.write_bytes(data.replace((20_000_000).to_bytes(4, "little"), (10).to_bytes(4, "little")))
    (tmp_path / "out").mkdir()
    with pytest.raises(cw.FMUError, match=r"damaged"):
        archive.unpack(path, tmp_path / "out")
    # all bytes together, whatever each entry has
    monkeypatch.setattr(archive, "MOST_BYTES", 1000)
    (tmp_path / "more").mkdir()
    with pytest.raises(cw.FMUError, match=r"it unpacks to more than 1000 bytes"):
        archive.unpack(made_of(tmp_path / "b.fmu", lambda made: None), tmp_path / "more")


@pytest.mark.parametrize(
    ("description", "words"),
    [
        (SOUND.replace(b"?>\n", b"?>" + DOCTYPE, 1), "its description has a DOCTYPE, which no FMU needs"),
        (SOUND.replace(b'encoding="UTF-8"', b'encoding="none"'), "its description is not XML"),
        (SOUND[:200], "its description is not XML"),
        (
            SOUND.replace(b'"small" c', b'"../../small" c'),
            "its modelIdentifier is '../../small', which cannot be the name of a library",
        ),
        (SOUND.replace(b'"2.0"', b'"1.0"'), "it is of FMI '1.0'; what can be run is 2.0 and 3.0"),
        (SOUND.replace(b"CoSimulation", b"ModelExchange"), "it does not support co-simulation"),
        (SOUND.replace(b'"7"', b'"-7"'), "its variable 'steps' has no valueReference"),
        (SOUND.replace(b'"1e4"', b'"0"'), "its unit 'decibar' has a factor or an offset that is not a number"),
    ],
    ids=["DOCTYPE", "encoding", "cut", "identifier", "version", "kind", "reference", "unit"],
)
def test_a_description_that_is_none_ends_in_one_sentence(tmp_path: Path, description: bytes, words: str) -> None:
    path = made_of(tmp_path / "a.fmu", lambda made: None, description)
    with pytest.raises(cw.FMUError) as raised:
        cw.FMU(path, 0.1, trust=True)
    assert f"FMU 'a' ({path}): {words}" in str(raised.value)


def test_what_is_no_archive_or_has_no_description_or_library_is_told(tmp_path: Path) -> None:
    none, empty, bare = tmp_path / "none.fmu", tmp_path / "empty.fmu", tmp_path / "bare.fmu"
    none.write_bytes(b"PK")
    with ZipFile(empty, "w") as made:
        made.writestr("a", b"")
    with ZipFile(bare, "w") as made:
        made.writestr("modelDescription.xml", SOUND)
        made.writestr("binaries/vax/small.so", b"")
    for path, words in (
        (none, "damaged or not an archive"),
        (empty, "it has no modelDescription.xml, so it is not an FMU"),
        (bare, "for this machine; it has those of vax"),
        (tmp_path / "missing.fmu", "it cannot be read: No such file or directory"),
        (tmp_path, "it cannot be read: is not a regular file"),
    ):
        with pytest.raises(cw.FMUError, match=words):
            cw.FMU(path, 0.1, trust=True)


def test_folders_are_for_their_owner_alone(tmp_path: Path) -> None:
    from clutchwork.fmu_import.library import Assignment
    from clutchwork.fmu_import.process import Process

    path = made_of(tmp_path / "a.fmu", entry("resources/deep/a"))
    process = Process(path, Assignment("", "x", "2.0", "a", "", [], [], []), 60.0)
    folder, *_ = (tmp_path / "temporary").iterdir()
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert (folder / "fmu" / "resources" / "deep" / "a").read_bytes() == b"x"
    process.close()
