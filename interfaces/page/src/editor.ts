// The plot whose knots are dragged: by mouse, finger, or the arrow keys.
import type uPlot from "uplot";
import type { App, Part } from "./app";
import type { Knot, TableData } from "./data";
import { element, put } from "./dom";
import { number, shownUnit } from "./format";
import { added, moved, removed } from "./tables";
import { TimePlot } from "./timeplot";

const FINE = 0.2;

export class Editor implements Part {
  readonly root: HTMLElement;
  private readonly over: TimePlot;
  private readonly handles: HTMLElement[][] = [];
  private readonly factor: number;
  private readonly word: string;
  private range: [number, number];
  private held = false;

  /** For tables of one unit, by their numbers in the session. */
  constructor(
    private readonly app: App,
    private readonly tables: number[],
  ) {
    const unit = this.table(tables[0]!).unit;
    [this.factor, this.word] = shownUnit(unit);
    this.range = this.fitting();
    const place = element("div", { class: "plot editor" });
    const names = tables.map((i) => this.table(i).name);
    const keys = element("ul", { class: "legend" }, ...names.map((name, k) => element("li", {}, element("span", { class: `key c${k % 8}` }, element("span", { class: "swatch" }), name))));
    const help = element("p", { class: "help" }, "Drag a knot, or select one with Tab and move it with the arrow keys (Shift: fine steps). Double click: adds a knot. Delete: removes it.");
    const title = element("h2", {}, names.length > 1 ? "Drag these" : "Drag this", element("span", { class: "unit" }, this.word ? ` in ${this.word}` : ""));
    this.root = element("section", { class: "panel drag", "aria-label": `knots of ${names.join(", ")}` }, title, keys, place, help);
    this.over = new TimePlot(app, place, {
      height: 230,
      above: 10,
      series: [{ show: false }],
      range: () => this.range,
      draw: (plot) => this.draw(plot),
      resized: () => this.place(),
    });
    this.plot.setData([[0, 1], [0, 1]]);
    this.plot.over.addEventListener("dblclick", (event) => this.insert(event));
    this.plot.over.addEventListener("pointermove", (event) => {
      if (!event.buttons) this.over.look(event);
    });
    this.place();
  }

  private get plot(): uPlot {
    return this.over.plot;
  }

  update(): void {
    this.place();
  }

  at(time: number): void {
    this.over.at(time);
  }

  recolour(): void {
    this.plot.redraw(false);
  }

  private table(number: number): TableData {
    return this.app.data.tables[number]!;
  }

  private knots(number: number): Knot[] {
    return this.app.session.knots[number]!;
  }

  /** Tables as straight lines, those of the start behind them. */
  private draw(plot: uPlot): void {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    this.tables.forEach((table, k) => {
      ctx.strokeStyle = this.app.palette.curve(k);
      const kinds: [Knot[], number, number[]][] = [
        [this.table(table).points, 0.4, [4 * devicePixelRatio, 3 * devicePixelRatio]],
        [this.knots(table), 1, []],
      ];
      for (const [knots, alpha, dash] of kinds) {
        ctx.globalAlpha = alpha;
        ctx.lineWidth = (dash.length ? 1 : 2) * devicePixelRatio;
        ctx.setLineDash(dash);
        ctx.beginPath();
        ctx.moveTo(bbox.left, plot.valToPos(knots[0]![1] * this.factor, "y", true));
        for (const [t, y] of knots) ctx.lineTo(plot.valToPos(t, "x", true), plot.valToPos(y * this.factor, "y", true));
        ctx.lineTo(bbox.left + bbox.width, plot.valToPos(knots.at(-1)![1] * this.factor, "y", true));
        ctx.stroke();
      }
    });
    ctx.restore();
  }

  /** Put the handles onto the knots. */
  private place(): void {
    this.range = this.fitting();
    this.plot.setData(this.plot.data);
    this.tables.forEach((table, k) => {
      const knots = this.knots(table);
      const row = (this.handles[k] ??= []);
      while (row.length > knots.length) row.pop()!.remove();
      while (row.length < knots.length) row.push(this.handle(table, k, row.length));
      knots.forEach(([t, y], i) => {
        const handle = row[i]!;
        const place = `translate(${this.plot.valToPos(t, "x")}px, ${this.plot.valToPos(y * this.factor, "y")}px)`;
        if (handle.style.transform !== place) handle.style.transform = place;
        handle.hidden = t < this.app.data.tStart || t > this.app.data.tEnd;
        put(handle, "aria-valuemin", `${this.range[0]}`);
        put(handle, "aria-valuemax", `${this.range[1]}`);
        put(handle, "aria-valuenow", `${y * this.factor}`);
        put(handle, "aria-valuetext", `${number(t)} s, ${number(y * this.factor)} ${this.word}`);
      });
    });
    this.at(this.app.time);
  }

  private handle(table: number, k: number, i: number): HTMLElement {
    const label = `${this.table(table).name}, knot ${i + 1}`;
    const made = element("div", { class: `knot c${k % 8}`, role: "slider", tabindex: "0", "aria-label": label, "aria-orientation": "vertical" });
    made.addEventListener("pointerdown", (event) => this.grab(event, made));
    made.addEventListener("keydown", (event) => this.key(event, table, i));
    made.addEventListener("focus", () => this.app.look(this.knots(table)[i]?.[0] ?? this.app.time));
    this.plot.over.append(made);
    return made;
  }

  /** The knot whose middle is nearest to a pointer: where they are close, their handles overlap. */
  private nearest(event: PointerEvent, hit: HTMLElement): [HTMLElement, number, number] {
    const away = (handle: HTMLElement): number => {
      const { left, right, top, bottom } = handle.getBoundingClientRect();
      // of two in one place the one that is seen
      return Math.hypot((left + right) / 2 - event.clientX, (top + bottom) / 2 - event.clientY) - (handle === hit ? 1 : 0);
    };
    const all = this.handles.flatMap((row, k) => row.map((handle, i): [HTMLElement, number, number] => [handle, this.tables[k]!, i]));
    return all.filter(([handle]) => !handle.hidden).reduce((best, one) => (away(one[0]) < away(best[0]) ? one : best));
  }

  private grab(event: PointerEvent, hit: HTMLElement): void {
    if (event.button !== 0) return;
    event.preventDefault();
    const [handle, table, i] = this.nearest(event, hit);
    // a hand that takes it beside its middle does not move it yet
    const [t, y] = this.knots(table)[i]!;
    const [tHand, yHand] = this.over.under(event);
    const off: Knot = [t - tHand, y * this.factor - yHand];
    handle.focus({ preventScroll: true });
    handle.setPointerCapture(event.pointerId);
    handle.classList.add("held");
    this.held = true;
    const drag = (to: PointerEvent): void => {
      const [time, value] = this.over.under(to);
      this.move(table, i, [time + off[0], Math.min(value + off[1], this.range[1]) / this.factor]);
    };
    const drop = (): void => {
      handle.classList.remove("held");
      this.held = false;
      handle.removeEventListener("pointermove", drag);
      this.place();
    };
    handle.addEventListener("pointermove", drag);
    handle.addEventListener("pointerup", drop, { once: true });
    handle.addEventListener("pointercancel", drop, { once: true });
  }

  private key(event: KeyboardEvent, table: number, i: number): void {
    const ways: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1], PageUp: [0, 10], PageDown: [0, -10] };
    const [t, y] = this.knots(table)[i]!;
    const way = ways[event.key];
    if (event.key === "Delete" || event.key === "Backspace") this.set(table, removed(this.knots(table), i));
    else if (event.key === "Insert") this.set(table, added(this.table(table), this.knots(table), t + 0.5 * ((this.knots(table)[i + 1]?.[0] ?? t) - t)));
    else if (way) {
      const step = event.shiftKey ? FINE : 1;
      const span = this.app.data.tEnd - this.app.data.tStart;
      const high = (this.range[1] - this.range[0]) / this.factor;
      this.move(table, i, [t + way[0] * step * span * 0.005, y + way[1] * step * high * 0.01]);
    } else return;
    event.preventDefault();
  }

  private insert(event: MouseEvent): void {
    const [time, value] = this.over.under(event);
    const height = value / this.factor;
    const away = (table: number): number => {
      const with_ = added(this.table(table), this.knots(table), time);
      return Math.abs((with_.find(([t]) => t === time)?.[1] ?? Infinity) - height);
    };
    const table = this.tables.reduce((best, one) => (away(one) < away(best) ? one : best));
    this.set(table, added(this.table(table), this.knots(table), time));
  }

  private move(table: number, i: number, to: Knot): void {
    const { tStart, tEnd } = this.app.data;
    const inside: Knot = [Math.min(Math.max(to[0], tStart), tEnd), to[1]];
    this.set(table, moved(this.table(table), this.knots(table), i, inside, tEnd));
  }

  private set(table: number, knots: Knot[]): void {
    this.app.session.knots[table] = knots;
    this.app.changed();
  }

  /** Ends of the axis; they stay while a knot is held, or it would run away from the hand. */
  private fitting(): [number, number] {
    if (this.held) return this.range;
    const all = this.tables.flatMap((table) => [...this.table(table).points, ...this.knots(table)]).map(([, y]) => y * this.factor);
    const low = Math.min(0, ...all);
    const high = Math.max(...all, low + 1e-9);
    const room = 0.15 * (high - low) || 1;
    const [before, after] = this.range ?? [0, 0];
    return low >= before && high <= after && after - before < 2.5 * (high - low) && high < after - 0.02 * room ? this.range : [low - 0.25 * room, high + room];
  }
}
