// A driveline that is changed and run again: knots and numbers go into the bytes of its System.
import { fromBase64 } from "./bytes";
import type { Core, Output, Result } from "./core";
import type { Knot, PageData, SliderData } from "./data";
import { written } from "./tables";

export class Session {
  readonly knots: Knot[][];
  readonly values: number[];
  private readonly base: Uint8Array;
  private readonly words: (BigUint64Array | null)[];

  constructor(
    readonly data: PageData,
    private readonly core: Core,
  ) {
    if (core.schema !== data.schema) throw new Error("this page and its core are of different versions");
    this.base = fromBase64(data.system);
    this.knots = data.tables.map((table) => copied(table.points));
    this.values = data.sliders.map((slider) => slider.start);
    this.words = data.sliders.map(({ words }) => (words ? new BigUint64Array(fromBase64(words).buffer) : null));
  }

  reset(): void {
    this.data.tables.forEach((table, i) => (this.knots[i] = copied(table.points)));
    this.data.sliders.forEach((slider, i) => (this.values[i] = slider.start));
  }

  /** The bytes of the System as it is now. */
  bytes(): Uint8Array {
    const made = this.base.slice();
    const view = new DataView(made.buffer);
    this.data.sliders.forEach((slider, i) => {
      if (this.values[i] !== slider.start) this.turn(view, slider, this.words[i] ?? null, this.values[i]!);
    });
    this.data.tables.forEach((table, i) => {
      if (!written(view, this.data.places, table, this.knots[i]!)) throw new Error(`${table.name} has too many knots`);
    });
    return made;
  }

  run(output: Output): Result {
    const made = this.core.run(this.bytes(), this.data.options, this.data.tEnd, output);
    if (!made) throw new Error("the core refuses this driveline");
    return made;
  }

  private turn(view: DataView, slider: SliderData, words: BigUint64Array | null, value: number): void {
    if (slider.direct) {
      for (const place of slider.places) view.setFloat64(8 * place, value, true);
      return;
    }
    const line = slider.values.indexOf(value);
    if (line < 0 || !words) return;
    slider.places.forEach((place, i) => view.setBigUint64(8 * place, words[line * slider.places.length + i]!, true));
  }
}

export function copied(knots: readonly Knot[]): Knot[] {
  return knots.map(([t, y]) => [t, y]);
}
