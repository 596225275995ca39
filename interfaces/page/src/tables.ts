// Knots of a table as pieces of a signal in the bytes of a System: signals/table.py.
import type { Knot, Places, TableData } from "./data";

/** A piece: its start, value there, and slope. */
export type Piece = [number, number, number];

// between pieces that no run reaches [s]
const NEVER = 1e9;

export function pieces(knots: readonly Knot[]): Piece[] {
  const made: Piece[] = [];
  const first = knots[0]!;
  const last = knots[knots.length - 1]!;
  if (first[0] > 0) made.push([0, first[1], 0]);
  for (let i = 0; i + 1 < knots.length; i++) {
    const [t, y] = knots[i]!;
    const [tNext, yNext] = knots[i + 1]!;
    if (tNext > t) made.push([t, y, (yNext - y) / (tNext - t)]);
  }
  made.push([last[0], last[1], 0]);
  return made;
}

/** Value of a table at a time; the later one at a jump. */
export function valueAt(knots: readonly Knot[], time: number): number {
  let found = knots[0]![1];
  for (const [start, value, rise] of pieces(knots)) if (start <= time) found = value + (time - start) * rise;
  return found;
}

/** Write the pieces of a table into the bytes of a System; false where there is no room. */
export function written(bytes: DataView, places: Places, table: TableData, knots: readonly Knot[]): boolean {
  const made = pieces(knots);
  const [last, value] = made[made.length - 1]!;
  for (const input of table.inputs) {
    if (made.length > input.room) return false;
    // what is not needed begins long after every run
    const all = [...made, ...Array.from({ length: input.room - made.length }, (_, k): Piece => [last + NEVER * (k + 1), value, 0])];
    bytes.setFloat64(places.input_value + 8 * input.number, valueAt(knots, 0), true);
    all.forEach(([start, value, rise], i) => {
      const number = input.first + i;
      bytes.setFloat64(places.segment_time + 8 * number, start, true);
      const coefficients = places.segment_coef + 96 * number;
      bytes.setFloat64(coefficients, value, true);
      bytes.setFloat64(coefficients + 8, rise, true);
      for (let k = 2; k < 12; k++) bytes.setFloat64(coefficients + 8 * k, 0, true);
    });
  }
  return true;
}

/** Ends between which a knot may stand: its neighbours in time, its declaration in value. */
export function limits(table: TableData, knots: readonly Knot[], number: number, end: number): [Knot, Knot] {
  const before = knots[number - 1]?.[0] ?? Math.min(0, knots[0]![0]);
  const after = knots[number + 1]?.[0] ?? Math.max(end, knots[number]![0]);
  const values = table.points.map(([, y]) => y);
  const least = table.lower ?? (Math.min(...values) >= 0 ? 0 : -Infinity);
  return [
    [before, least],
    [after, table.upper ?? Infinity],
  ];
}

export function moved(table: TableData, knots: readonly Knot[], number: number, to: Knot, end: number): Knot[] {
  const [[t0, y0], [t1, y1]] = limits(table, knots, number, end);
  const made = knots.map(([t, y]): Knot => [t, y]);
  made[number] = [Math.min(Math.max(to[0], t0), t1), Math.min(Math.max(to[1], y0), y1)];
  return made;
}

/** One more knot on the table at a time; the same where there is no room. */
export function added(table: TableData, knots: readonly Knot[], time: number): Knot[] {
  const room = Math.min(...table.inputs.map((input) => input.room)) - 1;
  const made = knots.map(([t, y]): Knot => [t, y]);
  if (knots.length >= room) return made;
  const place = knots.findIndex(([t]) => t > time);
  made.splice(place < 0 ? knots.length : place, 0, [time, valueAt(knots, time)]);
  return made;
}

/** Without one knot; two stay. */
export function removed(knots: readonly Knot[], number: number): Knot[] {
  return knots.length > 2 ? knots.filter((_, i) => i !== number).map(([t, y]): Knot => [t, y]) : [...knots];
}
