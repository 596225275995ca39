// What is copied: TOML, Python and CSV.
import assert from "node:assert/strict";
import { test } from "node:test";
import { toml } from "../src/toml";

test("plain data as TOML", () => {
  const written = toml({ format: 1, name: 'a "b"\n', simulation: { t_end: 4 }, element: [{ name: "c", friction: { type: "coulomb", static: 0.3 }, pressure: [[0, 1], [2, 3e-7]] }] });
  assert.equal(
    written,
    ['format = 1', 'name = "a \\"b\\"\\n"', "", "[simulation]", "t_end = 4", "", "[[element]]", 'name = "c"', 'friction = { type = "coulomb", static = 0.3 }', "pressure = [[0, 1], [2, 3e-7]]", ""].join("\n"),
  );
});

test("keys that are no words are quoted", () => {
  assert.equal(toml({ "a b": true }), '"a b" = true\n');
});
