// One signal over another one, such as a torque over a slip; and jerk over heat of all that was tried.
import type { App, Part } from "./app";
import type { Result } from "./core";
import type { LoopData, PageData } from "./data";
import { whileSeen } from "./dom";
import { number, shownUnit } from "./format";
import { evaluated } from "./forms";
import { measures } from "./measures";
import { Plane, type Line } from "./plane";

export class Loop implements Part {
  readonly root: HTMLElement;
  readonly update: () => void;
  private readonly plane: Plane;
  private readonly start: Line;

  constructor(
    private readonly app: App,
    private readonly loop: LoopData,
  ) {
    const { signals } = app.data;
    this.plane = new Plane(`${loop.y} over ${loop.x}`, named(loop.x, signals[loop.x]!.unit), named("", signals[loop.y]!.unit));
    this.root = this.plane.root;
    this.start = this.line(app.first, "loop was");
    this.update = whileSeen(this.root, () => this.draw(app.run));
    this.update();
  }

  private draw(run: Result): void {
    this.plane.draw(run === this.app.first ? [this.line(run, "loop")] : [this.start, this.line(run, "loop")]);
  }

  private line(run: Result, look: string): Line {
    return { xs: this.shown(this.loop.x, run), ys: this.shown(this.loop.y, run), look };
  }

  private shown(name: string, run: Result): Float64Array {
    const { form, unit } = this.app.data.signals[name]!;
    const factor = shownUnit(unit)[0];
    return evaluated(form, run).map((value) => value * factor);
  }
}

const MOST_TRIED = 400;

/** What an engineer trades: the largest jerk of the output over the heat of the contacts, a point for each run. */
export class Trade implements Part {
  readonly root: HTMLElement;
  private readonly plane: Plane;
  private readonly factor: number;
  private readonly heat: string;
  private readonly jerkFactor: number;
  private readonly jerk: string;
  private readonly drawn: () => void;
  private readonly xs: number[] = [];
  private readonly ys: number[] = [];

  constructor(private readonly app: App) {
    const unit = app.data.signals[`${app.data.output}.jerk`]!.unit;
    [this.factor, this.heat] = shownUnit("J", traded(app.data, app.first)?.[0]);
    [this.jerkFactor, this.jerk] = shownUnit(unit);
    this.plane = new Plane("Jerk over heat", `heat in ${this.heat}`, `: largest jerk in ${this.jerk}`);
    this.root = this.plane.root;
    this.drawn = whileSeen(this.root, () => this.draw());
    this.update(app.run);
  }

  update(run: Result): void {
    const found = traded(this.app.data, run);
    if (!found) return;
    const [x, y] = [found[0] * this.factor, found[1] * this.jerkFactor];
    if (this.xs.at(-1) !== x || this.ys.at(-1) !== y) {
      if (this.xs.length >= MOST_TRIED) [this.xs, this.ys].forEach((list) => list.splice(1, 1));
      this.xs.push(x);
      this.ys.push(y);
    }
    this.drawn();
  }

  private draw(): void {
    const now = { x: this.xs.at(-1)!, y: this.ys.at(-1)!, look: "spot" };
    const was = { x: this.xs[0]!, y: this.ys[0]!, look: "spot was" };
    this.plane.draw([{ xs: this.xs, ys: this.ys, look: "trail" }], [was, now]);
    this.root.setAttribute("aria-label", `heat ${number(now.x)} ${this.heat}, largest jerk ${number(now.y)} ${this.jerk}`);
  }
}

/** Whether there is something to trade. */
export function trades(data: PageData): boolean {
  return `${data.output}.jerk` in data.signals && data.contacts.some((contact) => contact.heat);
}

/** Heat [J] and largest jerk, in SI, of a run that reached its end. */
export function traded(data: PageData, run: Result): [number, number] | null {
  if (run.status !== 0) return null;
  const found = measures(data, run);
  const heats = found.filter((one) => one.name.startsWith("Heat of ") && one.name !== "Heat of all contacts");
  const jerk = found.find((one) => one.name.startsWith("Largest jerk"));
  if (!jerk || jerk.value === null) return null;
  return [heats.reduce((sum, one) => sum + (one.value ?? 0), 0), jerk.value];
}

function named(name: string, unit: string): string {
  const word = shownUnit(unit)[1];
  return word ? `${name} in ${word}` : name;
}
