// Bars of the states of contacts over time: full where locked, half and hatched where slipping, a line where open.
import type { App, Part } from "./app";
import type { Result } from "./core";
import type { ContactData } from "./data";
import { element, put, svg } from "./dom";
import { seconds } from "./format";
import { type State, strokes } from "./measures";
import { LEFT, RIGHT } from "./timeplot";

const ROW = 22;
const LETTER = 7;
const MOST = 400;
const HEIGHTS: Record<State, number> = { locked: 14, slipping: 8, open: 2 };

export class Bars implements Part {
  readonly root: HTMLElement;
  private readonly picture = svg("svg", { class: "bars", "aria-hidden": "true" });
  private readonly bars: SVGElement;
  private readonly cursor = svg("line", { class: "cursorline" });
  private readonly words = element("ul", { class: "unseen" });
  private readonly contacts: ContactData[];
  private width = 400;
  private readonly left: number;

  constructor(private readonly app: App) {
    this.contacts = app.data.contacts;
    this.bars = svg("g");
    const names = this.contacts.map(({ name }) => shortened(name));
    this.left = Math.max(LEFT, 14 + LETTER * Math.max(0, ...names.map((name) => name.length)));
    const labels = names.map((name, row) => svg("text", { x: `${this.left - 8}`, y: `${ROW * (row + 0.5) + 4}`, "text-anchor": "end" }, svg("title", {}, this.contacts[row]!.name), name));
    this.picture.append(...labels, this.bars, this.cursor);
    const keys = element("p", { class: "states" }, ...(["locked", "slipping", "open"] as const).flatMap((state) => [element("span", { class: `state ${state}` }), state, " "]));
    this.root = element("section", { class: "panel", "aria-label": "states of the contacts over time" }, element("h2", {}, "Locked, slipping, open"), keys, this.words);
    this.root.append(this.picture);
    new ResizeObserver(() => this.resize()).observe(this.root);
    this.update(app.run, true);
  }

  update(run: Result, settled: boolean): void {
    const told: HTMLElement[] = [];
    let used = 0;
    this.contacts.forEach((contact, row) => {
      const middle = ROW * row + ROW / 2;
      const found = strokes(contact, run);
      for (const { from, to, state } of found.slice(0, MOST)) {
        const high = HEIGHTS[state];
        const x = this.x(from);
        this.bar(used++, `bar ${state}`, x, Math.max(this.x(to) - x, 0.7), middle - high / 2, high);
      }
      if (settled) told.push(element("li", {}, `${contact.name}: ${found.slice(0, 20).map((one) => `${one.state} from ${seconds(one.from)} to ${seconds(one.to)}`).join(", ")}`));
    });
    if (run.status !== 0) {
      const x = this.x(run.reached);
      this.bar(used++, "beyondbar", x, Math.max(this.width - RIGHT - x, 0), 0, ROW * this.contacts.length);
    }
    while (this.bars.childElementCount > used) this.bars.lastElementChild!.remove();
    if (settled) this.words.replaceChildren(...told);
  }

  private bar(number: number, kind: string, x: number, wide: number, y: number, high: number): void {
    const place = this.bars.children[number] ?? this.bars.appendChild(svg("rect"));
    put(place, "class", kind);
    put(place, "x", x.toFixed(1));
    put(place, "width", wide.toFixed(1));
    put(place, "y", `${y}`);
    put(place, "height", `${high}`);
  }

  at(time: number): void {
    const x = `${this.x(time)}`;
    this.cursor.setAttribute("x1", x);
    this.cursor.setAttribute("x2", x);
    this.cursor.setAttribute("y1", "0");
    this.cursor.setAttribute("y2", `${ROW * this.contacts.length}`);
  }

  private x(time: number): number {
    const { tStart, tEnd } = this.app.data;
    return this.left + ((time - tStart) / (tEnd - tStart)) * (this.width - this.left - RIGHT);
  }

  private resize(): void {
    this.width = Math.max(this.root.clientWidth - 24, 150);
    this.picture.setAttribute("width", `${this.width}`);
    this.picture.setAttribute("height", `${ROW * this.contacts.length}`);
    this.update(this.app.run, true);
    this.at(this.app.time);
  }
}

function shortened(name: string): string {
  return name.length > 15 ? `…${name.slice(-14)}` : name;
}
