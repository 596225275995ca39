// What a gear does in numbers: per speed 1 and torque 1 in the data, with those of the input in the tables.
import { element } from "./dom";
import { number } from "./format";

export interface GearData {
  name: string;
  closed: string[];
  ratio: number;
  published: number | null;
  efficiency: number;
  circulating: number;
  housing: number;
  speeds: Record<string, number>;
  slips: Record<string, number>;
  torques: Record<string, number | null>;
  pictures: Record<string, string>;
}

export interface GearboxData {
  name: string;
  title: string;
  source: string;
  input: string;
  output: string;
  members: string[];
  elements: { name: string; kind: string }[];
  gears: GearData[];
}

type Row = [string, ...string[]];
const KILOWATTS = Math.PI / 30e3; // of 1/min and N m

/** Speed, torque and power of the output, in words. */
export function sentence(data: GearboxData, gear: GearData, speed: number, torque: number): string {
  const turns = (gear.speeds[data.output] ?? 0) * speed;
  const carried = gear.ratio * gear.efficiency * torque;
  const losses = gear.efficiency < 1 ? `, efficiency ${number(100 * gear.efficiency)} %` : "";
  const published = gear.published === null ? "" : ` (published ${number(gear.published)})`;
  const circle = gear.circulating > 1e-9 ? ` ${number(100 * gear.circulating, 3)} % of the power circulates.` : "";
  return `Ratio ${number(gear.ratio)}${published}: the output turns at ${number(turns)} 1/min with ${number(carried)} N m, ${number(Math.abs(turns * carried) * KILOWATTS)} kW${losses}.${circle}`;
}

/** Rows of the elements: closed ones hold a torque, open ones slip. */
export function elementRows(data: GearboxData, gear: GearData, speed: number, torque: number): Row[] {
  return data.elements.map(({ name, kind }): Row => {
    if (!gear.closed.includes(name)) return [name, kind, "open", "–", number((gear.slips[name] ?? 0) * speed)];
    const held = gear.torques[name];
    return [name, kind, "closed", held === null || held === undefined ? "shared" : number(held * torque), "–"];
  });
}

export function memberRows(data: GearboxData, gear: GearData, speed: number): Row[] {
  return data.members.filter((name) => name in gear.speeds).map((name): Row => [name, number((gear.speeds[name] ?? 0) * speed)]);
}

export function gearTables(data: GearboxData, gear: GearData, speed: number, torque: number): HTMLElement[] {
  return [
    table("Shift elements", ["element", "kind", "state", "torque, N m", "slip, 1/min"], elementRows(data, gear, speed, torque)),
    table("Members", ["member", "speed, 1/min"], memberRows(data, gear, speed)),
  ];
}

function table(title: string, head: string[], rows: Row[]): HTMLElement {
  const cells = (row: Row): HTMLElement[] => row.map((text, place) => element(place ? "td" : "th", place ? {} : { scope: "row" }, text));
  const made = element(
    "table",
    {},
    element("thead", {}, element("tr", {}, ...head.map((text) => element("th", { scope: "col" }, text)))),
    element("tbody", {}, ...rows.map((row) => element("tr", {}, ...cells(row)))),
  );
  return element("section", { class: "panel wide" }, element("h2", {}, title), made);
}
