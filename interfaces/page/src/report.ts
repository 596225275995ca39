// Events with their times, and what the run comes to, beside the start.
import type { App, Part } from "./app";
import type { Result } from "./core";
import { element, Spoken, whileSeen, write } from "./dom";
import { number, quantity, seconds } from "./format";
import { brief, ending, eventTime, type Measure, measures, sentence, unlocked } from "./measures";

const MOST_EVENTS = 60;

export class Events implements Part {
  readonly root: HTMLElement;
  private readonly list = element("ol", { class: "events" });

  constructor(private readonly app: App) {
    this.root = element("section", { class: "panel", "aria-label": "events" }, element("h2", {}, "Events"), this.list);
    this.update(app.run, true);
  }

  update(run: Result, settled: boolean): void {
    if (!settled) return;
    const items = run.events.slice(0, MOST_EVENTS).map((event) => {
      const time = eventTime(event);
      const go = element("button", { type: "button", class: "time", title: "look at this time" }, seconds(time));
      go.addEventListener("click", () => this.app.look(time));
      return element("li", {}, go, ` ${sentence(this.app.data, event)}`);
    });
    if (run.events.length > MOST_EVENTS) items.push(element("li", {}, `and ${run.events.length - MOST_EVENTS} more`));
    if (!items.length) items.push(element("li", {}, "No contact changes its state."));
    this.list.replaceChildren(...items);
  }
}

export class Results implements Part {
  readonly root: HTMLElement;
  readonly update: () => void;
  private readonly body = element("tbody");
  private readonly first: Measure[];

  constructor(private readonly app: App) {
    this.first = measures(app.data, app.first);
    const head = element("thead", {}, element("tr", {}, ...["", "now", "at the start", "change"].map((word) => element("th", { scope: "col" }, word))));
    this.root = element("section", { class: "panel", "aria-label": "results" }, element("h2", {}, "Results"), element("div", { class: "wide" }, element("table", {}, head, this.body)));
    this.update = whileSeen(this.root, () => this.draw(app.run));
    this.update();
  }

  private draw(run: Result): void {
    const known = measures(this.app.data, run);
    const names = known.map((one) => one.name);
    this.root.hidden = !known.length && !this.first.length;
    const lost = this.first.filter((one) => !names.includes(one.name));
    [...known, ...lost.map((one) => ({ ...one, value: null }))].forEach((one, i) => {
      const before = this.first.find((other) => other.name === one.name)?.value ?? null;
      const change = one.value !== null && before ? `${signed((100 * (one.value - before)) / Math.abs(before))} %` : "";
      const row = this.body.rows[i] ?? line(this.body);
      row.className = one.value === null ? "missing" : "";
      const words = [one.name, one.value === null ? "never" : quantity(one.value, one.unit), before === null ? "never" : quantity(before, one.unit), change];
      words.forEach((word, k) => write(row.cells[k]!, word));
    });
    while (this.body.rows.length > known.length + lost.length) this.body.deleteRow(-1);
  }
}

function line(body: HTMLTableSectionElement): HTMLTableRowElement {
  const row = element("tr", {}, element("th", { scope: "row" }), element("td"), element("td"), element("td"));
  body.append(row);
  return row;
}

/** What is wrong with the run, said to everybody. */
export class Verdict implements Part {
  readonly root: HTMLElement;
  private readonly spoken = new Spoken("verdict");

  constructor(private readonly app: App) {
    this.root = this.spoken.root;
    this.update(app.run);
  }

  update(run: Result): void {
    const { data, first, session } = this.app;
    const why = session.refusal();
    const refused = why && `These numbers make no valid driveline: ${why}. The curves are unchanged.`;
    const open = unlocked(data, first, run);
    const never = open.length ? `${open.join(" and ")} never ${open.length > 1 ? "lock" : "locks"}.` : "";
    const wrong = [refused, ending(data, run), never].filter(Boolean).join(" ");
    const well = `${run.events.length === 1 ? "1 event" : `${run.events.length} events`}; runs to ${number(run.reached)} s.`;
    this.root.classList.toggle("bad", wrong !== "");
    // what any move changes, so that there is something to tell of each
    const amounts = why ? "" : brief(data, run);
    this.spoken.say([wrong || well, amounts && `${amounts}.`].filter(Boolean).join(" "));
  }
}

/** Per cent with two decimals, or three digits where it is more. */
function signed(value: number): string {
  const round = Math.round(100 * value) / 100;
  return `${round > 0 ? "+" : ""}${number(round, 3)}`;
}
