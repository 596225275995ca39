"""The reference pages: everything that is declared has its place, with every field."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from clutchwork.declare.schema import REGISTRY, Role, specs
from support import samples


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory, root: Path) -> str:
    """All pages, one after the other."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(root / "tools"))
        import element_figures
        import gen_docs

        # what the examples report is asked for, not their pictures, which `make docs` draws
        patch.setattr(element_figures, "KEPT", tmp_path_factory.mktemp("pictures"))
        patch.setattr(element_figures, "draw", lambda run, element, path: None)
        written = gen_docs.write(tmp_path_factory.mktemp("reference"))
    return "\n".join(path.read_text(encoding="utf-8") for path in written)


@pytest.mark.parametrize("cls", samples.declared(*Role), ids=lambda cls: cls.__name__)
def test_has_its_place_and_a_line_for_every_field(cls: type, pages: str) -> None:
    kind: str = cls.kind  # type: ignore[attr-defined]
    head = rf"^\({kind}\)=\n#+ {cls.__name__}\n"
    found = re.split(head, pages, maxsplit=1, flags=re.MULTILINE)
    assert len(found) == 2, f"no reference page shows {kind}"
    own = re.split(r"^\(\w+\)=\n#+ ", found[1], maxsplit=1, flags=re.MULTILINE)[0]
    assert f'`type = "{kind}"`' in own
    missing = [item.name for item, spec in specs(cls) if not re.search(rf"^\| `{item.name}` \|", own, re.MULTILINE)]
    assert missing == []


@pytest.mark.parametrize("kind", REGISTRY[Role.LAW])
def test_the_overview_of_laws_leads_to_every_page(kind: str, pages: str) -> None:
    assert f"](laws/{kind}.md)" in pages
