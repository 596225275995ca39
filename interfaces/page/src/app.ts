// What all parts of the page share: the session, its present run, the one at the start, and the time that is shown.
import type { Result } from "./core";
import type { PageData } from "./data";
import type { Session } from "./session";
import { Palette } from "./theme";

/** A part of the page; each is told what changed. */
export interface Part {
  /** There is a new run; while something is dragged, `settled` is false. */
  update?(run: Result, settled: boolean): void;
  /** Another time is looked at. */
  at?(time: number): void;
  /** Colours changed. */
  recolour?(): void;
  /** The page is taken away. */
  end?(): void;
}

// rows that a run should have: enough for a curve; while something is dragged half as many, for they are drawn each time
const ROWS = 800;
const ROWS_DRAGGED = 400;
const QUIET = 160;

export class App {
  run: Result;
  readonly first: Result;
  time: number;
  /** Times of the work from the move to the curves [ms], for benchmarks. */
  readonly work: number[] = [];
  private readonly parts: Part[] = [];
  private readonly steps: number;
  private readonly stepsDragged: number;
  private waiting = 0;
  private ended = false;
  private settling: ReturnType<typeof setTimeout> | undefined;

  readonly palette: Palette;

  /** For what is in an element, whose style has its colours. */
  constructor(
    readonly root: HTMLElement,
    readonly session: Session,
  ) {
    this.palette = new Palette(root);
    const bare = session.run({ steps: 1 });
    const perStep = (rows: number): number => Math.min(Math.max(Math.ceil(rows / Math.max(bare.steps, 1)), 1), 8);
    this.steps = perStep(ROWS);
    this.stepsDragged = perStep(ROWS_DRAGGED);
    this.first = this.run = session.run({ steps: this.steps });
    this.time = (session.data.tStart + session.data.tEnd) / 2;
  }

  get data(): PageData {
    return this.session.data;
  }

  add(part: Part): void {
    this.parts.push(part);
  }

  /** Something moved: run and draw before the next picture, once for all that moved until then. */
  changed(): void {
    if (this.waiting || this.ended) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = 0;
      this.compute(false);
      clearTimeout(this.settling);
      this.settling = setTimeout(() => this.settle(), QUIET);
    });
  }

  /** Run and draw at once. */
  compute(settled: boolean): void {
    const begin = performance.now();
    this.renew(settled);
    this.tell(settled);
    this.work.push(performance.now() - begin);
    if (this.work.length > 5000) this.work.shift();
  }

  private settle(): void {
    this.renew(true);
    this.tell(true);
  }

  /** Run what there is now; where these numbers make no driveline, the last run stays. */
  private renew(settled: boolean): void {
    if (!this.session.refusal()) this.run = this.session.run({ steps: settled ? this.steps : this.stepsDragged });
  }

  look(time: number): void {
    this.time = Math.min(Math.max(time, this.data.tStart), this.data.tEnd);
    for (const part of this.parts) part.at?.(this.time);
  }

  /** The style has other colours now. */
  recolour(): void {
    this.palette.forget();
    for (const part of this.parts) part.recolour?.();
  }

  /** The page is taken away: nothing runs any more. */
  end(): void {
    this.ended = true;
    cancelAnimationFrame(this.waiting);
    clearTimeout(this.settling);
    for (const part of this.parts) part.end?.();
  }

  /** Row of the present run at the time that is shown: the last one that is not later. */
  row(): number {
    const { times, count } = this.run;
    let low = 0;
    let high = count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle]! <= this.time) low = middle + 1;
      else high = middle;
    }
    return Math.max(low - 1, 0);
  }

  private tell(settled: boolean): void {
    for (const part of this.parts) part.update?.(this.run, settled);
  }
}
