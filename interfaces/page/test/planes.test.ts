// Axes of planes, and what a gear does in numbers.
import assert from "node:assert/strict";
import { test } from "node:test";
import { elementRows, memberRows, sentence, type GearboxData } from "../src/gears";
import { quantity, tickWords } from "../src/format";
import { ends, ticks } from "../src/plane";

test("axes hold all values and are never empty", () => {
  assert.deepEqual(ends([[0, 10], [5]]), [-0.6, 10.6]);
  assert.deepEqual(ends([[3]]), [-0.18, 3.18]);
  assert.deepEqual(ends([[-3, -3 - 1e-12]]).map((end) => Number(end.toFixed(6))), [-3.18, 0.18]);
  assert.deepEqual(ends([[3, 3.001]]).map((end) => Number(end.toFixed(6))), [2.996999, 3.004001]);
  assert.deepEqual(ends([[0]]), [-1, 1]);
  assert.deepEqual(ends([]), [0, 1]);
});

test("each tick has a word of its own", () => {
  assert.deepEqual(tickWords([17.655, 17.66, 17.665]), ["17.655", "17.66", "17.665"]);
  assert.deepEqual(tickWords([-20000, 0, 20000]), ["−20000", "0", "20000"]);
  assert.deepEqual(tickWords([0]), ["0"]);
  assert.deepEqual(tickWords([]), []);
});

test("little energy is told in J", () => {
  assert.equal(quantity(19.68, "J"), "19.68 J");
  assert.equal(quantity(98560, "J"), "98.56 kJ");
  assert.equal(quantity(10, "Pa"), "0.0001 bar");
});

test("ticks are few and round", () => {
  assert.deepEqual(ticks(ends([[152.7]])), [0, 50, 100, 150]);
  assert.deepEqual(ticks([-0.6, 10.6]), [0, 2.5, 5, 7.5, 10]);
  assert.deepEqual(ticks([0, 1]), [0, 0.2, 0.4, 0.6, 0.8, 1].map((one) => ticks([0, 1]).find((other) => Math.abs(other - one) < 1e-12)));
  for (let high = 1; high < 10; high += 0.01) assert.ok(ticks([-high, high]).length >= 3 && ticks([-high, high]).length <= 6, `${high}`);
  assert.ok(ticks([1e-7, 9e-7]).length <= 6);
});

const BOX: GearboxData = {
  name: "two",
  title: "Two speeds",
  source: "",
  input: "ring",
  output: "carrier",
  members: ["ring", "carrier", "sun"],
  elements: [{ name: "B", kind: "brake" }, { name: "C", kind: "clutch" }],
  gears: [
    { name: "1", closed: ["B"], ratio: 1.5, published: 1.5, efficiency: 0.98, circulating: 0, housing: 0.5, speeds: { ring: 1, carrier: 2 / 3, sun: 0 }, slips: { C: -1 }, torques: { B: 0.5 }, pictures: {} },
  ],
};

test("speeds and torques are those of the input times what follows from the teeth", () => {
  const gear = BOX.gears[0]!;
  assert.deepEqual(memberRows(BOX, gear, 3000), [["ring", "3000"], ["carrier", "2000"], ["sun", "0"]]);
  assert.deepEqual(elementRows(BOX, gear, 3000, 200), [["B", "brake", "closed", "100", "–"], ["C", "clutch", "open", "–", "−3000"]]);
  assert.match(sentence(BOX, gear, 3000, 200), /turns at 2000 1\/min with 294 N m, 61\.58 kW, efficiency 98 %/);
});
