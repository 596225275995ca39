// One panel of curves: uPlot, with the curves of the start behind them, the cursor, and what was not reached greyed.
import type uPlot from "uplot";
import type { App, Part } from "./app";
import type { Result } from "./core";
import type { PanelData } from "./data";
import { element, whileSeen, write } from "./dom";
import { number, shownUnit } from "./format";
import { evaluated } from "./forms";
import { ends } from "./plane";
import { TimePlot } from "./timeplot";

export class Chart implements Part {
  readonly root: HTMLElement;
  readonly update: () => void;
  private readonly over: TimePlot;
  private readonly beyond = element("div", { class: "beyond", hidden: true });
  private readonly values: HTMLElement[] = [];
  private readonly shown: boolean[];
  private readonly start: Float64Array[];
  private factor = 1;
  private range: [number, number] = [0, 1];
  private now: Float64Array[] = [];
  private readonly ghosts = element("canvas");
  private ghostKey = "";

  constructor(
    private readonly app: App,
    private readonly panel: PanelData,
  ) {
    this.shown = panel.names.map(() => true);
    const [, most] = ends(this.curves(app.first).map((curve) => curve.map(Math.abs)));
    const [factor, word] = shownUnit(panel.unit, most);
    this.factor = factor;
    this.start = this.curves(app.first);
    const place = element("div", { class: "plot" });
    const title = element("h3", {}, panel.title, element("span", { class: "unit" }, word ? ` in ${word}` : ""));
    this.root = element("figure", { class: "panel", "aria-label": `${panel.title}: ${panel.names.join(", ")}` }, title, this.legend(), place);
    this.over = new TimePlot(app, place, {
      height: 190,
      above: 8,
      series: panel.names.map((name, i): uPlot.Series => ({ label: name, stroke: () => app.palette.curve(i), width: 1.6, pxAlign: 0, points: { show: false } })),
      range: () => this.range,
      draw: (plot) => this.ghost(plot),
      resized: () => this.bound(),
    });
    const { over } = this.over.plot;
    over.append(this.beyond);
    over.addEventListener("pointermove", (event) => this.over.look(event));
    over.addEventListener("pointerdown", (event) => this.over.look(event));
    this.update = whileSeen(place, () => this.draw(app.run));
    this.update();
  }

  private draw(run: Result): void {
    const { plot } = this.over;
    this.now = this.curves(run);
    this.range = this.fitting();
    plot.setData([run.times, ...this.now] as uPlot.AlignedData);
    this.bound();
    this.at(this.app.time);
  }

  /** Grey from where the run ended early. */
  private bound(): void {
    const { run } = this.app;
    this.beyond.hidden = run.status === 0;
    if (run.status !== 0) this.beyond.style.left = `${this.over.plot.valToPos(run.reached, "x")}px`;
  }

  at(time: number): void {
    this.over.at(time);
    const row = this.app.row();
    const known = time <= this.app.run.reached;
    this.values.forEach((value, i) => write(value, number(known ? (this.now[i]?.[row] ?? NaN) : NaN)));
  }

  recolour(): void {
    this.over.plot.redraw(false);
  }

  private curves(run: Result): Float64Array[] {
    return this.panel.names.map((name) => {
      const made = evaluated(this.app.data.signals[name]!.form, run);
      if (this.factor !== 1) for (let i = 0; i < made.length; i++) made[i]! *= this.factor;
      return made;
    });
  }

  private legend(): HTMLElement {
    const list = element("ul", { class: "legend" });
    this.panel.names.forEach((name, i) => {
      const value = element("output", { class: "value" });
      this.values.push(value);
      const key = element("button", { type: "button", "aria-pressed": "true", class: `key c${i % 8}`, title: `show or hide ${name}` }, element("span", { class: "swatch" }), name);
      key.addEventListener("click", () => {
        this.shown[i] = !this.shown[i];
        key.setAttribute("aria-pressed", `${this.shown[i]}`);
        this.over.plot.setSeries(i + 1, { show: this.shown[i]! });
      });
      list.append(element("li", {}, key, value));
    });
    return list;
  }

  /** The curves of the start: painted once for an axis, for dashes cost more than all else. */
  private ghost(plot: uPlot): void {
    if (this.app.run === this.app.first) return;
    const { left, top, width, height } = plot.bbox;
    if (width < 1 || height < 1) return;
    const key = [...this.range, width, height, ...this.shown, this.app.palette.colour("ground")].join();
    if (key !== this.ghostKey) {
      this.ghostKey = key;
      this.ghosts.width = width;
      this.ghosts.height = height;
      this.paintGhost(plot, this.ghosts.getContext("2d")!);
    }
    plot.ctx.drawImage(this.ghosts, left, top);
  }

  private paintGhost(plot: uPlot, ctx: CanvasRenderingContext2D): void {
    const { times } = this.app.first;
    const { left, top } = plot.bbox;
    const [x0, y0] = [plot.valToPos(0, "x", true), plot.valToPos(0, "y", true)];
    const [xScale, yScale] = [plot.valToPos(1, "x", true) - x0, plot.valToPos(1, "y", true) - y0];
    ctx.globalAlpha = 0.4;
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
    this.start.forEach((values, i) => {
      if (!this.shown[i]) return;
      ctx.strokeStyle = this.app.palette.curve(i);
      ctx.beginPath();
      for (let k = 0; k < values.length; k++) ctx.lineTo(x0 - left + xScale * times[k]!, y0 - top + yScale * values[k]!);
      ctx.stroke();
    });
  }

  /** Ends of the axis: they stay while the curves fit well, so that dragging does not shake them. */
  private fitting(): [number, number] {
    let low = Infinity;
    let high = -Infinity;
    for (const curve of [...this.start, ...this.now]) {
      for (const value of curve) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    if (!(low <= high)) return [0, 1];
    const room = 0.06 * (high - low) || 0.1 * Math.abs(high) || 1;
    const [before, after] = this.range;
    const fits = before <= low && high <= after && after - before < 2.5 * (high - low);
    return fits ? this.range : [low - room, high + room];
  }
}
