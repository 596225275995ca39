"""The reference page of the catalogue of gearboxes, from its files, and what chooses one of their live pages."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape

from clutchwork.base.plural import counted
from clutchwork.gearbox.gearbox import Gearbox, catalogue

INTRODUCTION = """# Gearboxes

Gearboxes that are known by name, `cw.Gearbox.load("zf-8hp70")`; `cw.catalogue()` has them all. Their ratios follow from
the teeth below; the largest deviation is that from the published ratios, of which many are rounded to three decimals.
Members whose wheels are one part share a name, such as `R2S3`: ring of the second set and sun of the third.

| name | gearbox | gears | elements | largest deviation |
|---|---|---|---|---|"""

# the box that is there before one is chosen
FIRST = "zf-8hp70"
LIVE = "../live/{}.html"
# a new frame each time, so that the browser does not go back through all that were chosen
CHOOSER = """<p><label for="gearbox">Gearbox:</label> <select id="gearbox">
{options}
</select></p>
<iframe class="live" id="gearbox-page" loading="lazy" src="{first}"
 title="A gearbox whose gears can be chosen"></iframe>
<script>
(() => {{
  const select = document.getElementById("gearbox");
  const show = () => {{
    const old = document.getElementById("gearbox-page");
    const frame = old.cloneNode();
    frame.src = select.value;
    old.replaceWith(frame);
  }};
  select.addEventListener("change", show);
  // a browser may remember what was chosen
  if (select.value !== "{first}") show();
}})();
</script>
<noscript><p>Without scripts the pages of all gearboxes are reached from their list in the reference.</p></noscript>
"""


def chooser() -> str:
    """HTML that shows the live page of the gearbox that is chosen."""
    options = "\n".join(map(_option, _sorted()))
    return CHOOSER.format(options=options, first=LIVE.format(FIRST))


def _option(box: Gearbox) -> str:
    selected = " selected" if box.name == FIRST else ""
    return f'<option value="{LIVE.format(box.name)}"{selected}>{escape(box.title)}</option>'


def _sorted() -> list[Gearbox]:
    return sorted(catalogue().values(), key=lambda box: box.title.lower())


def page() -> str:
    """The page."""
    boxes = _sorted()
    rows = [
        f"| [`{box.name}`](#{box.name}) | {box.title} | {len(box.gears)} | {len(box.elements)} | {_deviation(box)} |"
        for box in boxes
    ]
    return "\n".join([INTRODUCTION, *rows, *(line for box in boxes for line in _section(box)), ""])


def said(box: Gearbox) -> dict[str, float]:
    """Ratios by the teeth in the form in which they are published."""
    return {gear: 1.0 / ratio if box.ratio_form == "out/in" else ratio for gear, ratio in box.ratios.items()}


def _deviation(box: Gearbox) -> str:
    found = said(box)
    if not box.published:
        return ""
    return f"{max(abs(found[gear] - wanted) for gear, wanted in box.published.items()):.4f}"


def _section(box: Gearbox) -> Iterator[str]:
    form = "output over input" if box.ratio_form == "out/in" else "input over output"
    yield f"\n({box.name})=\n## {box.title}\n"
    live = f'<a href="{LIVE.format(box.name)}">choose a gear</a>'
    yield f"`{box.name}`, {counted(len(box.sets), 'gear sets')}; ratios {form}; {live}.\n"
    yield "| gear | closed | ratio by teeth | published |\n|---|---|---|---|"
    for row in (row for row in box.gears if row not in box.ratios):
        yield f"| {row} | {' '.join(box.closed_in(row))} | split | |"
    for gear, ratio in said(box).items():
        published = f"{box.published[gear]:g}" if gear in box.published else ""
        yield f"| {gear} | {' '.join(box.closed_in(gear))} | {ratio:.4f} | {published} |"
    yield "\n| set | type | members | teeth |\n|---|---|---|---|"
    for one in box.sets:
        members = ", ".join(f"{port.replace('_', ' ')} {member}" for port, member in one.members.items())
        sizes = ", ".join(f"{name.replace('_', ' ')} {size:g}" for name, size in (one.teeth or one.ratios).items())
        yield f"| {one.name} | {one.kind.replace('_', ' ')} | {members} | {sizes} |"
    joins = ", ".join(f"{element.name} {element.first} - {element.second}" for element in box.elements)
    if joins:
        yield f"\nElements: {joins}."
    if box.machines:
        yield f"\nMachines: {', '.join(f'{name} on {member}' for name, member in box.machines.items())}."
    yield f"\n{box.notes}\n\nSource: {box.source}"
