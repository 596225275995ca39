// A picture of one quantity over another one: axes with few ticks, lines and points that are drawn anew each time.
import { element, svg } from "./dom";
import { tickWords } from "./format";

export interface Line {
  xs: ArrayLike<number>;
  ys: ArrayLike<number>;
  look: string; // class of the style
}

export interface Spot {
  x: number;
  y: number;
  look: string;
}

const NARROW = 1e-3;
// of one value, but for rounding
const SAME = 1e-9;
type Ends = [number, number];
const [WIDTH, HEIGHT, LEFT, RIGHT, BOTTOM, TOP] = [420, 240, 62, 20, 36, 8];

export class Plane {
  readonly root: HTMLElement;
  private readonly axes = svg("g", { class: "planeaxes" });
  private readonly drawn = svg("g");

  /** `over` and `up`: what the axes are, with their units; the latter goes on the title. */
  constructor(title: string, over: string, up: string) {
    const across = svg("text", { x: `${(LEFT + WIDTH - RIGHT) / 2}`, y: `${HEIGHT - 3}`, "text-anchor": "middle" }, over);
    const picture = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: "plane", role: "img", "aria-label": `${title}${up}, over ${over}` }, this.axes, this.drawn, across);
    this.root = element("figure", { class: "panel" }, element("h3", {}, title, element("span", { class: "unit" }, up)), picture);
  }

  draw(lines: readonly Line[], spots: readonly Spot[] = []): void {
    const x = ends([...lines.map((line) => line.xs), spots.map((spot) => spot.x)]);
    const y = ends([...lines.map((line) => line.ys), spots.map((spot) => spot.y)]);
    const across = (value: number): number => LEFT + ((value - x[0]) / (x[1] - x[0])) * (WIDTH - LEFT - RIGHT);
    const up = (value: number): number => HEIGHT - BOTTOM - ((value - y[0]) / (y[1] - y[0])) * (HEIGHT - BOTTOM - TOP);
    const [xTicks, yTicks] = [ticks(x), ticks(y)];
    const [xWords, yWords] = [tickWords(xTicks), tickWords(yTicks)];
    this.axes.replaceChildren(
      ...xTicks.flatMap((value, i) => [
        svg("line", { x1: fixed(across(value)), x2: fixed(across(value)), y1: `${TOP}`, y2: `${HEIGHT - BOTTOM}` }),
        svg("text", { x: fixed(across(value)), y: `${HEIGHT - BOTTOM + 14}`, "text-anchor": "middle" }, xWords[i]!),
      ]),
      ...yTicks.flatMap((value, i) => [
        svg("line", { x1: `${LEFT}`, x2: `${WIDTH - RIGHT}`, y1: fixed(up(value)), y2: fixed(up(value)) }),
        svg("text", { x: `${LEFT - 6}`, y: fixed(up(value) + 4), "text-anchor": "end" }, yWords[i]!),
      ]),
    );
    this.drawn.replaceChildren(
      ...lines.map((line) => svg("path", { class: line.look, d: path(line, across, up) })),
      ...spots.map((spot) => svg("circle", { class: spot.look, cx: fixed(across(spot.x)), cy: fixed(up(spot.y)), r: "4.5" })),
    );
  }
}

function path(line: Line, across: (value: number) => number, up: (value: number) => number): string {
  let made = "";
  for (let i = 0; i < line.xs.length; i++) made += `${i ? "L" : "M"}${fixed(across(line.xs[i]!))} ${fixed(up(line.ys[i]!))}`;
  return made;
}

function fixed(value: number): string {
  return value.toFixed(1);
}

/** Ends of an axis with some room; never empty, nor as narrow as the noise of what is shown; of one value from 0. */
export function ends(values: readonly ArrayLike<number>[]): Ends {
  let [low, high] = [Infinity, -Infinity];
  for (const some of values) {
    for (let i = 0; i < some.length; i++) {
      const value = some[i]!;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  if (!(low <= high)) return [0, 1];
  if (high - low <= SAME * Math.max(-low, high)) [low, high] = [Math.min(low, 0), Math.max(high, 0)];
  const room = Math.max(0.06 * (high - low), NARROW * Math.max(-low, high)) || 1;
  return [low - room, high + room];
}

/** Some five round numbers between the ends, two at least. */
export function ticks([low, high]: Ends): number[] {
  const rough = (high - low) / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].map((one) => one * power).find((one) => one >= rough) ?? 10 * power;
  const made: number[] = [];
  for (let k = Math.ceil(low / step); k * step <= high; k++) made.push(k * step + 0);
  return made;
}
