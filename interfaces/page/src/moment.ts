// The driveline at the time of the cursor: its schematic, and its gears as levers.
import type { App, Part } from "./app";
import type { LeverData } from "./data";
import { button, element, svg, whileSeen, write } from "./dom";
import { number, quantity, seconds } from "./format";

const NOTHING = 1e-9;
// size of a schematic, of that on paper
const LEAST = 1.2;
const MOST = 1.8;

/** The time that is shown: a slider, and a button that lets it go. */
export class Clock implements Part {
  readonly root: HTMLElement;
  private readonly input = element("input", { type: "range", min: "0", max: "1000", step: "1", "aria-label": "time" });
  private readonly output = element("output", {});
  private readonly play: HTMLButtonElement;
  private playing = 0;

  constructor(private readonly app: App) {
    this.play = button("Play", () => this.toggle());
    this.input.addEventListener("input", () => {
      const { tStart, tEnd } = app.data;
      app.look(tStart + ((tEnd - tStart) * Number(this.input.value)) / 1000);
    });
    this.root = element("div", { class: "clock" }, this.play, this.input, this.output);
    this.at(app.time);
  }

  at(time: number): void {
    const { tStart, tEnd } = this.app.data;
    this.input.value = `${Math.round((1000 * (time - tStart)) / (tEnd - tStart))}`;
    this.input.setAttribute("aria-valuetext", seconds(time));
    this.output.textContent = `t = ${seconds(time)}`;
  }

  end(): void {
    cancelAnimationFrame(this.playing);
    this.playing = 0;
    this.play.textContent = "Play";
  }

  private toggle(): void {
    if (this.playing) {
      this.end();
      return;
    }
    const { tStart, tEnd } = this.app.data;
    this.play.textContent = "Stop";
    let last = performance.now();
    if (this.app.time >= tEnd) this.app.look(tStart);
    const step = (now: number): void => {
      // the whole run in some eight seconds
      this.app.look(this.app.time + ((now - last) / 8000) * (tEnd - tStart));
      last = now;
      if (this.app.time >= tEnd) this.toggle();
      else this.playing = requestAnimationFrame(step);
    };
    this.playing = requestAnimationFrame(step);
  }
}

export class Schematic implements Part {
  readonly root: HTMLElement;
  readonly at: () => void;
  readonly update: () => void;
  private readonly texts: { place: SVGTextElement; column: number; unit: string }[] = [];
  private readonly symbols: { groups: SVGElement[]; mode: number; torque: number[] }[] = [];

  constructor(private readonly app: App) {
    const source = app.data.schematic!;
    const picture = document.importNode(new DOMParser().parseFromString(source.svg, "image/svg+xml").documentElement as unknown as SVGSVGElement, true);
    this.root = element("section", { class: "panel moment", "aria-label": "schematic at the time of the cursor" }, element("h2", {}, "The driveline at this time"), element("div", { class: "wide" }));
    this.root.lastElementChild!.append(picture);
    // its letters stay readable: what is wider than the page is moved sideways
    const width = picture.viewBox.baseVal.width;
    picture.style.minWidth = `${LEAST * width}px`;
    picture.style.maxWidth = `${MOST * width}px`;
    for (const place of picture.querySelectorAll<SVGTextElement>("text[data-signal]")) {
      const signal = app.data.signals[place.dataset["signal"] ?? ""];
      if (signal && (signal.form[0] === "c" || (signal.form[0] === "t" && signal.form[1].length === 1))) {
        const column = signal.form[0] === "c" ? signal.form[1] : signal.form[1][0]!;
        this.texts.push({ place, column, unit: signal.unit });
      }
    }
    for (const contact of app.data.contacts) {
      const symbol = [...picture.querySelectorAll<SVGElement>("g[data-name]")].find((one) => one.dataset["name"] === contact.name);
      const groups = [...(symbol?.querySelectorAll<SVGElement>("g[data-state]") ?? [])];
      const torque = contact.torque[0] === "t" ? contact.torque[1] : [];
      if (groups.length) this.symbols.push({ groups, mode: contact.mode, torque });
    }
    this.update = this.at = whileSeen(this.root, () => this.draw());
    this.at();
  }

  private draw(): void {
    const { run } = this.app;
    const start = this.app.row() * run.size;
    for (const { place, column, unit } of this.texts) {
      const value = run.rows[start + column]!;
      write(place, quantity(Math.abs(value) > NOTHING ? value : 0, unit));
    }
    for (const { groups, mode, torque } of this.symbols) {
      const now = run.rows[start + mode]!;
      const sum = torque.reduce((total, column) => total + run.rows[start + column]!, 0);
      const state = now === 0 ? "locked" : Math.abs(now) === 1 && Math.abs(sum) > NOTHING ? "slipping" : "open";
      for (const group of groups) {
        if (group.dataset["state"] === state) group.removeAttribute("display");
        else group.setAttribute("display", "none");
      }
    }
  }
}

const LEVER = { height: 150, width: 222, top: 24, left: 100, reach: 100 };

/** Each gear as a line through the speeds of its members: they stay on it, whatever they do. */
export class Levers implements Part {
  readonly root: HTMLElement;
  readonly at: () => void;
  readonly update: () => void;
  private readonly drawn: { line: SVGElement; dots: SVGElement[]; labels: SVGElement[]; lever: LeverData }[] = [];
  private readonly scale: number;

  constructor(private readonly app: App) {
    const pictures = element("div", { class: "levers" });
    this.root = element("section", { class: "panel moment", "aria-label": "lever diagrams at the time of the cursor" }, element("h2", {}, "Its gear sets as levers"), pictures);
    for (const lever of app.data.levers) pictures.append(this.picture(lever));
    this.scale = LEVER.reach / this.fastest();
    this.update = this.at = whileSeen(this.root, () => this.draw());
    this.at();
  }

  /** The largest speed of any member at the start of the page. */
  private fastest(): number {
    let most = 1e-9;
    const columns = new Set(this.app.data.levers.flatMap((lever) => lever.points.map((point) => point.column)).filter((column) => column >= 0));
    const { rows, count, size } = this.app.first;
    for (const column of columns) for (let i = 0; i < count; i++) most = Math.max(most, Math.abs(rows[i * size + column]!));
    return most;
  }

  private draw(): void {
    const { run } = this.app;
    const start = this.app.row() * run.size;
    for (const { line, dots, labels, lever } of this.drawn) {
      const speeds = lever.points.map(({ column }) => (column < 0 ? 0 : run.rows[start + column]!));
      const x = speeds.map((speed) => LEVER.left + Math.max(Math.min(this.scale * speed, 1.15 * LEVER.reach), -0.6 * LEVER.reach));
      const last = speeds.length - 1;
      line.setAttribute("x1", x[0]!.toFixed(1));
      line.setAttribute("x2", x[last]!.toFixed(1));
      speeds.forEach((speed, i) => {
        dots[i]!.setAttribute("cx", x[i]!.toFixed(1));
        // beside the line of rest, where the lever is not
        const back = speed < -NOTHING;
        labels[i]!.setAttribute("x", `${LEVER.left + (back ? 8 : -8)}`);
        labels[i]!.setAttribute("text-anchor", back ? "start" : "end");
        labels[i]!.textContent = `${leaf(lever.points[i]!.name)} ${number(Math.abs(speed) > NOTHING ? speed : 0, 3)}`;
      });
    }
  }

  private picture(lever: LeverData): SVGElement {
    const { height, width, top, left } = LEVER;
    const y = (place: number): number => top + (1 - place) * (height - top - 16);
    const made = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "lever", role: "img", "aria-label": `lever of ${lever.name}` });
    const zero = svg("line", { class: "zero", x1: `${left}`, x2: `${left}`, y1: `${top}`, y2: `${height - 16}` });
    const line = svg("line", { class: "now", y1: `${y(lever.points[0]!.place)}`, y2: `${y(lever.points.at(-1)!.place)}` });
    const dots = lever.points.map(({ place }) => svg("circle", { r: "4", cy: `${y(place)}` }));
    const labels = lever.points.map(({ place }) => svg("text", { y: `${y(place) + 4}` }));
    made.append(svg("text", { x: `${left}`, y: "13", class: "title", "text-anchor": "middle" }, leaf(lever.name)), zero, line, ...dots, ...labels);
    this.drawn.push({ line, dots, labels, lever });
    return made;
  }
}

/** A name without that of the gearbox that it is in. */
function leaf(name: string): string {
  return name.slice(name.lastIndexOf(".") + 1);
}
