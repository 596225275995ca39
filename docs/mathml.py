"""Sphinx extension: formulas become MathML when the pages are built, so that they need neither network nor script."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import ziamath
from docutils import nodes
from fontTools import subset
from math_core import LatexError, LatexToMathML
from sphinx.errors import ExtensionError
from sphinx.util.math import get_node_equation_number

# STIX Two Math, of which pages need Latin, Greek and mathematical signs
FONT = Path(ziamath.__file__).parent / "fonts" / "STIXTwoMath-Regular.ttf"
RANGES = (
    (0x20, 0x17F),
    (0x370, 0x3FF),
    (0x2000, 0x23FF),
    (0x2500, 0x2AFF),
    (0x1D400, 0x1D7FF),
)
_CONVERTER = LatexToMathML()


def converted(latex: str, *, display: bool) -> str:
    """MathML of a formula; an error that names it where it is not understood."""
    try:
        return str(_CONVERTER.convert_with_local_state(latex, displaystyle=display))
    except LatexError as error:
        raise ExtensionError(
            f"formula that math-core does not know: {latex}: {error}"
        ) from error


def visit_inline(writer: Any, node: nodes.math) -> None:
    """Write a formula within a line."""
    writer.body.append(
        writer.starttag(node, "span", "", CLASS="math")
        + converted(node.astext(), display=False)
    )
    writer.body.append("</span>")
    raise nodes.SkipNode


def visit_block(writer: Any, node: nodes.math_block) -> None:
    """Write a formula on a line of its own, with its number and a link to it."""
    writer.body.append(writer.starttag(node, "div", CLASS="math"))
    if node["number"]:
        writer.body.append(
            f'<span class="eqno">({get_node_equation_number(writer, node)})'
        )
        writer.add_permalink_ref(node, "Link to this equation")
        writer.body.append("</span>")
    writer.body.append(converted(node.astext(), display=True) + "</div>\n")
    raise nodes.SkipNode


def write_font(folder: Path) -> None:
    """Write what the pages need of the font."""
    target = folder / "math.woff"
    if target.exists():
        return
    folder.mkdir(parents=True, exist_ok=True)
    options = subset.Options(flavor="woff", layout_features=["*"], notdef_outline=True)
    font = subset.load_font(str(FONT), options)
    subsetter = subset.Subsetter(options)
    subsetter.populate(
        unicodes=[code for first, last in RANGES for code in range(first, last + 1)]
    )
    subsetter.subset(font)
    subset.save_font(font, str(target), options)


def setup(app: Any) -> dict[str, Any]:
    """Register the renderer and write the font."""
    write_font(Path(app.confdir) / "reference" / "static")
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
