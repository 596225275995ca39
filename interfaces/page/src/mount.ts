// The page from its data and its core.
import { App, type Part } from "./app";
import { Bars } from "./bars";
import { Chart } from "./chart";
import { Core } from "./core";
import type { PageData } from "./data";
import { element } from "./dom";
import { Editor } from "./editor";
import { Clock, Levers, Schematic } from "./moment";
import { Loop, Trade, trades } from "./planes";
import { Events, Results, Verdict } from "./report";
import { Session } from "./session";
import { Sliders } from "./sliders";
import { tools } from "./tools";

/** Fill an element with the page of a driveline; what is returned runs it. */
export async function mount(root: HTMLElement, data: PageData, wasm: BufferSource): Promise<App> {
  const app = new App(root, new Session(data, await Core.of(wasm)));
  const add = <P extends Part & { root: HTMLElement }>(part: P): HTMLElement => {
    app.add(part);
    return part.root;
  };
  const hand = element("div", { class: "hand" });
  const curves = element("div", { class: "curves" });
  const below = element("div", { class: "below" });
  const head = element("header", {}, element("h1", {}, data.name), add(new Verdict(app)), tools(app));
  root.replaceChildren(head, element("div", { class: "columns" }, hand, curves), below);
  for (const tables of byUnit(data)) hand.append(add(new Editor(app, tables)));
  if (data.contacts.length) hand.append(add(new Bars(app)));
  if (data.sliders.length) hand.append(add(new Sliders(app)));
  for (const loop of data.loops) curves.append(add(new Loop(app, loop)));
  for (const panel of data.panels) if (panel.names.length) curves.append(add(new Chart(app, panel)));
  if (trades(data) && data.tables.length + data.sliders.length) curves.append(add(new Trade(app)));
  below.append(add(new Results(app)), add(new Events(app)));
  const clock = add(new Clock(app));
  if (data.schematic) below.append(add(new Schematic(app)));
  if (data.levers.length) below.append(add(new Levers(app)));
  root.append(clock);
  // what shows a value would tell it at every picture; knots, sliders and the verdict tell theirs
  for (const output of root.querySelectorAll("output")) output.setAttribute("aria-live", "off");
  app.look(app.time);
  return app;
}

/** Tables of one unit are dragged in one plot. */
function byUnit(data: PageData): number[][] {
  const found = new Map<string, number[]>();
  data.tables.forEach(({ unit }, i) => found.set(unit, [...(found.get(unit) ?? []), i]));
  return [...found.values()];
}
