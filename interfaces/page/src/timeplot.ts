// A plot over the time of the run: uPlot with its axes, the line at the time that is shown, and the width of its place.
import uPlot from "uplot";
import type { App } from "./app";
import { element } from "./dom";
import { tickWords } from "./format";

export interface Look {
  height: number;
  /** Room above the curves [px]. */
  above: number;
  series: uPlot.Series[];
  /** Ends of the axis of values. */
  range: () => [number, number];
  /** Draws below the curves. */
  draw: (plot: uPlot) => void;
  /** The place has another width. */
  resized?: () => void;
}

const NARROWEST = 120;
/** Room beside the curves [px], of bars below them too. */
export const LEFT = 64;
export const RIGHT = 14;

export class TimePlot {
  readonly plot: uPlot;
  private readonly cursor = element("div", { class: "cursor" });

  constructor(
    private readonly app: App,
    place: HTMLElement,
    look: Look,
  ) {
    const empty = [[], ...look.series.map(() => [])] as unknown as uPlot.AlignedData;
    this.plot = new uPlot(this.options(look), empty, place);
    this.plot.over.append(this.cursor);
    new ResizeObserver(() => {
      const width = Math.max(place.clientWidth, NARROWEST);
      if (width !== this.plot.width) this.plot.setSize({ width, height: look.height });
      this.at(app.time);
      look.resized?.();
    }).observe(place);
  }

  /** Another time is shown. */
  at(time: number): void {
    this.cursor.style.transform = `translateX(${this.plot.valToPos(time, "x")}px)`;
  }

  /** Look at the time below a pointer. */
  look(event: PointerEvent): void {
    this.app.look(this.under(event)[0]);
  }

  /** Time and value below a pointer. */
  under(event: MouseEvent): [number, number] {
    const box = this.plot.over.getBoundingClientRect();
    return [this.plot.posToVal(event.clientX - box.left, "x"), this.plot.posToVal(event.clientY - box.top, "y")];
  }

  private options({ height, above, series, range, draw }: Look): uPlot.Options {
    const { palette, data } = this.app;
    const axis: uPlot.Axis = { stroke: () => palette.colour("text"), grid: { stroke: () => palette.colour("grid"), width: 1 }, ticks: { show: false }, font: "12px system-ui, sans-serif" };
    const values = (_: uPlot, ticks: number[]): string[] => tickWords(ticks);
    // the last one has the unit
    const times = (_: uPlot, ticks: number[]): string[] => tickWords(ticks).map((word, i) => (i === ticks.length - 1 ? `${word} s` : word));
    return {
      width: 400,
      height,
      legend: { show: false },
      cursor: { show: false },
      padding: [above, RIGHT, 0, 0],
      scales: { x: { time: false, range: () => [data.tStart, data.tEnd] }, y: { range } },
      axes: [
        { ...axis, size: 26, values: times },
        { ...axis, size: LEFT, gap: 10, values },
      ],
      series: [{}, ...series],
      hooks: { drawAxes: [draw] },
    };
  }
}
