// A driveline that is changed and run again: knots and numbers go into the bytes of its System.
import { fromBase64 } from "./bytes";
import type { Core, Output, Result } from "./core";
import type { Knot, PageData, PairData } from "./data";
import { written } from "./tables";

export class Session {
  readonly knots: Knot[][];
  readonly values: number[];
  private readonly base: Uint8Array;
  private readonly words: (BigUint64Array | null)[];
  private readonly pairWords: BigUint64Array[];

  constructor(
    readonly data: PageData,
    private readonly core: Core,
  ) {
    if (core.schema !== data.schema) throw new Error("this page and its core are of different versions");
    this.base = fromBase64(data.system);
    this.knots = data.tables.map((table) => copied(table.points));
    this.values = data.sliders.map((slider) => slider.start);
    this.words = data.sliders.map(({ words }) => (words ? unpackedWords(words) : null));
    this.pairWords = data.pairs.map(({ words }) => unpackedWords(words));
  }

  reset(): void {
    this.data.tables.forEach((table, i) => (this.knots[i] = copied(table.points)));
    this.data.sliders.forEach((slider, i) => (this.values[i] = slider.start));
  }

  /** The bytes of the System as it is now. */
  bytes(): Uint8Array {
    const made = this.base.slice();
    const view = new DataView(made.buffer);
    this.data.sliders.forEach((_, i) => this.isTurned(i) && this.turn(view, i));
    this.data.pairs.forEach((pair, i) => pair.sliders.some((one) => this.isTurned(one)) && put(view, pair.places, this.pairWords[i]!, this.line(pair)));
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

  /** Why there is no driveline with these numbers; empty where there is one. */
  refusal(): string {
    return this.data.pairs.map((pair) => pair.refused[this.line(pair)] ?? "").find((why) => why) ?? "";
  }

  isTurned(i: number): boolean {
    return this.values[i] !== this.data.sliders[i]!.start;
  }

  private turn(view: DataView, i: number): void {
    const slider = this.data.sliders[i]!;
    if (slider.direct) {
      for (const place of slider.places) view.setFloat64(8 * place, this.values[i]!, true);
      return;
    }
    const words = this.words[i];
    if (words) put(view, slider.places, words, slider.values.indexOf(this.values[i]!));
  }

  /** The line of a pair; the start of a slider has one wherever it is. */
  private line({ sliders, values }: PairData): number {
    const [first, second] = sliders.map((slider, i) => values[i]!.indexOf(this.values[slider]!));
    return first! * values[1].length + second!;
  }
}

function put(view: DataView, places: readonly number[], words: BigUint64Array, line: number): void {
  if (line < 0) return;
  places.forEach((place, i) => view.setBigUint64(8 * place, words[line * places.length + i]!, true));
}

function unpackedWords(text: string): BigUint64Array {
  return new BigUint64Array(fromBase64(text).buffer);
}

export function copied(knots: readonly Knot[]): Knot[] {
  return knots.map(([t, y]) => [t, y]);
}
