// Bars of the states of contacts over time: full where locked, half and hatched where slipping, a line where open.
import type { App, Part } from "./app";
import type { Result } from "./core";
import type { ContactData } from "./data";
import { element, svg } from "./dom";
import { seconds } from "./format";
import { type State, strokes } from "./measures";

const ROW = 22;
const LEFT = 58;
const RIGHT = 8;
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

  constructor(private readonly app: App) {
    this.contacts = app.data.contacts;
    this.bars = svg("g");
    this.picture.append(this.bars, this.cursor);
    const keys = element("p", { class: "states" }, ...(["locked", "slipping", "open"] as const).flatMap((state) => [element("span", { class: `state ${state}` }), state, " "]));
    this.root = element("section", { class: "panel", "aria-label": "states of the contacts over time" }, element("h2", {}, "Locked, slipping, open"), keys, this.words);
    this.root.append(this.picture);
    new ResizeObserver(() => this.resize()).observe(this.root);
    this.update(app.run, true);
  }

  update(run: Result, settled: boolean): void {
    const made: SVGElement[] = [];
    const told: HTMLElement[] = [];
    this.contacts.forEach((contact, row) => {
      const middle = ROW * row + ROW / 2;
      made.push(svg("text", { x: `${LEFT - 8}`, y: `${middle + 4}`, "text-anchor": "end" }, shortened(contact.name)));
      const found = strokes(contact, run);
      for (const { from, to, state } of found.slice(0, MOST)) {
        const high = HEIGHTS[state];
        const x = this.x(from);
        made.push(svg("rect", { class: `bar ${state}`, x: x.toFixed(1), width: Math.max(this.x(to) - x, 0.7).toFixed(1), y: `${middle - high / 2}`, height: `${high}` }));
      }
      if (settled) told.push(element("li", {}, `${contact.name}: ${found.slice(0, 20).map((one) => `${one.state} from ${seconds(one.from)} to ${seconds(one.to)}`).join(", ")}`));
    });
    if (run.status !== 0) {
      const x = this.x(run.reached);
      made.push(svg("rect", { class: "beyondbar", x: `${x}`, width: `${Math.max(this.width - RIGHT - x, 0)}`, y: "0", height: `${ROW * this.contacts.length}` }));
    }
    this.bars.replaceChildren(...made);
    if (settled) this.words.replaceChildren(...told);
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
    return LEFT + ((time - tStart) / (tEnd - tStart)) * (this.width - LEFT - RIGHT);
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
  return name.length > 8 ? `…${name.slice(-7)}` : name;
}
