// What a run comes to: states of contacts over time, events and results in words.
import type { CoreEvent, Result } from "./core";
import type { ContactData, PageData } from "./data";
import { quantity, seconds } from "./format";
import { evaluated, feltJerk } from "./forms";

export type State = "locked" | "slipping" | "open";

export interface Stroke {
  from: number;
  to: number;
  state: State;
}

export interface Measure {
  name: string;
  unit: string;
  value: number | null;
}

const [TIME, CONTACT, FROM, TO, CAUSE] = [0, 1, 2, 3, 4];
const NOTHING = 1e-9;
const PASSING = 7;

/** How a contact is over time. */
export function strokes(contact: ContactData, run: Result): Stroke[] {
  const torque = evaluated(contact.torque, run);
  const made: Stroke[] = [];
  for (let i = 0; i < run.count; i++) {
    const mode = run.rows[i * run.size + contact.mode]!;
    const state: State = mode === 0 ? "locked" : Math.abs(mode) === 1 && Math.abs(torque[i]!) > NOTHING ? "slipping" : "open";
    const last = made[made.length - 1];
    if (last) last.to = run.times[i]!;
    if (last?.state !== state) made.push({ from: run.times[i]!, to: run.times[i]!, state });
  }
  return made.filter((one) => one.to > one.from || made.length === 1);
}

export function eventTime(event: CoreEvent): number {
  return event[TIME]!;
}

/** An event in words. */
export function sentence(data: PageData, event: CoreEvent): string {
  const name = nameOf(data, event[CONTACT]!);
  if (event[CAUSE] === PASSING) return `${name}, open, turns the other way`;
  const [, cause] = data.causes[`${event[CAUSE]!}`] ?? ["", ""];
  const what = `${name} ${deed(event[FROM]!, event[TO]!)}`.trim();
  return cause ? `${what}: ${cause}` : what;
}

function deed(from: number, to: number): string {
  if (to === 0) return from === 0 ? "stays locked" : "locks";
  if (from === 0) return to === 2 ? "opens" : "breaks away";
  if (to === 2) return "opens";
  return from === 2 ? "closes" : "slips the other way";
}

function nameOf(data: PageData, number: number): string {
  return data.contacts.find((contact) => contact.number === number)?.name ?? "";
}

/** Heat of every contact, when it locks, and how the output feels. */
export function measures(data: PageData, run: Result): Measure[] {
  const made: Measure[] = [];
  let total = 0;
  for (const contact of data.contacts) {
    if (!contact.heat) continue;
    const heat = evaluated(contact.heat, run).at(-1) ?? 0;
    total += heat;
    if (Math.abs(heat) > 0.05) made.push({ name: `Heat of ${contact.name}`, unit: "J", value: heat });
  }
  if (made.length > 1) made.push({ name: "Heat of all contacts", unit: "J", value: total });
  for (const contact of data.contacts) {
    const locks = run.events.filter((event) => event[CONTACT] === contact.number && event[TO] === 0 && event[FROM] !== 0);
    const last = locks.at(-1);
    if (last) made.push({ name: `${contact.name} locks at`, unit: "s", value: last[TIME]! });
  }
  return [...made, ...felt(data, run)];
}

/** Heat and jerk of a run that reached its end, in a few words; empty where it has neither. */
export function brief(data: PageData, run: Result): string {
  if (run.status !== 0) return "";
  const known = measures(data, run);
  const heat = known.find((one) => one.name === "Heat of all contacts") ?? known.find((one) => one.name.startsWith("Heat of "));
  const jerk = known.find((one) => one.name.startsWith("Largest jerk"));
  return [heat, jerk].flatMap((one) => (one === undefined || one.value === null ? [] : [`${one.name} ${quantity(one.value, one.unit)}`])).join(", ");
}

function felt(data: PageData, run: Result): Measure[] {
  const acceleration = data.signals[`${data.output}.acceleration`];
  const jerk = data.signals[`${data.output}.jerk`];
  if (!acceleration) return [];
  const values = evaluated(acceleration.form, run);
  const most = values.reduce((most, one) => Math.max(most, Math.abs(one)), 0);
  const made: Measure[] = [{ name: `Largest acceleration of ${data.output}`, unit: acceleration.unit, value: most }];
  const jolt = jerk ? feltJerk(values, run.times) : null;
  if (jerk && jolt !== null) made.push({ name: `Largest jerk of ${data.output} over 0.05 s`, unit: jerk.unit, value: jolt });
  return made;
}

/** Why a run ended early, in words; empty where it reached its end. */
export function ending(data: PageData, run: Result): string {
  if (run.status === 0) return "";
  const [, reason, remedy] = data.statuses[run.status] ?? ["", "the run ended", ""];
  const where = data.components[run.component];
  const about = where ? ` at ${where}` : "";
  return `The run stops at ${seconds(run.reached)}${about}: ${reason}${remedy ? `; ${remedy}` : ""}.`;
}

/** Contacts that locked at the start of the page, and now do not. */
export function unlocked(data: PageData, first: Result, now: Result): string[] {
  const ever = (run: Result, contact: ContactData): boolean =>
    run.rows[contact.mode] === 0 || run.events.some((event) => event[CONTACT] === contact.number && event[TO] === 0);
  return data.contacts.filter((one) => ever(first, one) && !ever(now, one)).map((one) => one.name);
}
