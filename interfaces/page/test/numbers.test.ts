// Knots as pieces, forms of rows, states over time, sliders and words.
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Result } from "../src/core";
import type { ContactData, SliderData, TableData } from "../src/data";
import { number, quantity } from "../src/format";
import { evaluated, feltJerk, slope } from "../src/forms";
import { strokes } from "../src/measures";
import { position, told, valueAt } from "../src/sliders";
import { added, limits, moved, pieces, removed, valueAt as tableAt, written } from "../src/tables";

const TABLE: TableData = { name: "p", unit: "Pa", points: [[0, 0], [1, 2], [2, 2]], lower: null, upper: null, inputs: [{ number: 1, first: 2, room: 5 }] };

function result(times: number[], rows: number[][]): Result {
  const size = rows[0]!.length;
  return { times: Float64Array.from(times), rows: Float64Array.from(rows.flat()), count: times.length, size, events: [], status: 0, reached: times.at(-1)!, component: -1, steps: times.length };
}

test("a table is straight between its knots and constant outside", () => {
  assert.deepEqual(pieces([[0, 0], [1, 2], [2, 2]]), [[0, 0, 2], [1, 2, 0], [2, 2, 0]]);
  assert.deepEqual(pieces([[0.5, 1], [0.5, 3], [1, 3]]), [[0, 1, 0], [0.5, 3, 0], [1, 3, 0]]);
  assert.equal(tableAt([[0, 0], [1, 2]], 0.25), 0.5);
  assert.equal(tableAt([[0, 0], [1, 2]], 7), 2);
});

test("pieces are written where the signal has its room", () => {
  const bytes = new DataView(new ArrayBuffer(2000));
  const places = { input_value: 16, segment_time: 100, segment_coef: 300 };
  assert.ok(written(bytes, places, TABLE, TABLE.points));
  assert.equal(bytes.getFloat64(100 + 8 * 6, true), 2 + 2e9);
  assert.equal(bytes.getFloat64(100 + 8 * 3, true), 1);
  assert.equal(bytes.getFloat64(300 + 96 * 2 + 8, true), 2);
  assert.ok(!written(bytes, places, TABLE, [[0, 0], [1, 1], [2, 2], [3, 3], [4, 4], [5, 5]]));
});

test("a knot stays between its neighbours and within its bounds", () => {
  assert.deepEqual(limits(TABLE, TABLE.points, 1, 4), [[0, 0], [2, Infinity]]);
  assert.deepEqual(moved(TABLE, TABLE.points, 1, [9, -3], 4)[1], [2, 0]);
  assert.deepEqual(added(TABLE, TABLE.points, 0.5)[1], [0.5, 1]);
  assert.equal(added(TABLE, added(TABLE, TABLE.points, 0.5), 0.6).length, 4);
  assert.deepEqual(removed(TABLE.points, 1), [[0, 0], [2, 2]]);
  assert.equal(removed([[0, 0], [1, 1]], 0).length, 2);
});

test("forms of a row", () => {
  const run = result([0, 1], [[1, 2, 0], [3, 4, 1]]);
  const made = (form: Parameters<typeof evaluated>[0]): number[] => [...evaluated(form, run)];
  assert.deepEqual(made(["c", 1]), [2, 4]);
  assert.deepEqual(made(["a", 0, 2, 5]), [7, 11]);
  assert.deepEqual(made(["t", [0, 1], true]), [-3, -7]);
  assert.deepEqual(made(["l", [0, 1], [1, -1]]), [-1, -1]);
  assert.deepEqual(made(["s", ["l", [0], [1]], 2]), [0, 3]);
  assert.deepEqual(made(["p", ["c", 0], ["c", 1]]), [2, 12]);
  assert.deepEqual(made(["q", [["c", 0], ["c", 1]]]), [3, 7]);
  assert.deepEqual(made(["d", ["c", 0]]), [2, 2]);
});

test("a slope does not cross a jump", () => {
  const times = Float64Array.from([0, 1, 1, 2]);
  assert.deepEqual([...slope(Float64Array.from([0, 1, 5, 6]), times)], [1, 1, 1, 1]);
  assert.deepEqual([...slope(Float64Array.from([3]), Float64Array.from([0]))], [0]);
});

test("states of a contact over time", () => {
  const contact: ContactData = { name: "c", number: 0, mode: 0, torque: ["t", [1], false], slip: null, heat: null };
  const run = result([0, 1, 2, 2, 3, 4], [[1, 5], [1, 5], [1, 5], [0, 3], [0, 3], [2, 0]]);
  assert.deepEqual(strokes(contact, run).map(({ from, to, state }) => [from, to, state]), [[0, 2, "slipping"], [2, 4, "locked"]]);
});

test("a slider has its start exactly", () => {
  const slider: SliderData = { name: "g", names: ["g"], unit: "", doc: "", start: 0.1 + 0.2, starts: [0.1 + 0.2], values: [0.15, 0.6], places: [1], direct: true };
  assert.equal(valueAt(slider, position(slider, slider.start)), slider.start);
  assert.equal(valueAt(slider, 0), 0.15);
  assert.equal(valueAt(slider, 400), 0.6);
});

test("numbers with different starts keep their own until they are turned", () => {
  const slider: SliderData = { name: "*.g", names: ["a.g", "b.g"], unit: "Pa", doc: "", start: 3e5, starts: [2e5, 4e5], values: [1e5, 5e5], places: [1, 2], direct: true };
  assert.equal(told(slider, slider.start), "2 bar to 4 bar, each with its own");
  assert.equal(told(slider, 3.01e5), "3.01 bar");
});

test("numbers as people read them", () => {
  assert.equal(number(0.1 + 0.2), "0.3");
  assert.equal(number(-1234567), "−1.235e+6");
  assert.equal(quantity(250000, "Pa"), "2.5 bar");
  assert.equal(quantity(-12.5, "rad/s2"), "−12.5 rad/s²");
});

test("a jump of the acceleration is felt as its height over the window", () => {
  const times = Float64Array.from([0, 0.5, 0.5, 1]);
  const jump = feltJerk(Float64Array.from([1, 1, 4, 4]), times) ?? 0;
  assert.ok(jump <= 3 / 0.05 + 1e-6 && jump >= (3 / 0.05) * (1 - 1 / 32));
  // a steady jerk is what it is
  assert.ok(Math.abs((feltJerk(Float64Array.from([0, 1, 1, 2]), times) ?? 0) - 2) < 1e-6);
  assert.equal(feltJerk(Float64Array.from([0, 1]), Float64Array.from([0, 0.09])), null);
});
