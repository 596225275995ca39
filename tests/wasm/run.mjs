// Runs of core.wasm for tests: `node run.mjs core.wasm STATUS`, where STATUS is that of events_full. Jobs come on
// standard input and results go to standard output as words of eight bytes that are doubles: tests/support/wasm.py
// says what they are.
import { readFileSync, writeSync } from "node:fs";

const [, , path, full] = process.argv;
const { instance } = await WebAssembly.instantiate(readFileSync(path), {});
const core = instance.exports;
core._initialize();
const eventsFull = Number(full);
const start = Math.ceil(core.__heap_base.value / 64) * 64;
let top = start;

/** A place for so many bytes behind everything that the module has itself. */
function place(bytes) {
  const at = top;
  top = Math.ceil((top + bytes) / 64) * 64;
  const missing = top - core.memory.buffer.byteLength;
  if (missing > 0) core.memory.grow(Math.ceil(missing / 65536));
  return at;
}

/** Bytes into the memory of the module; its place. */
function stored(bytes) {
  const at = place(bytes.length);
  new Uint8Array(core.memory.buffer).set(bytes, at);
  return at;
}

const raw = readFileSync(0);
const input = new Uint8Array(raw); // aligned
const words = new DataView(input.buffer);
let at = 0;
const next = () => words.getFloat64(8 * at++, true);
const take = (n) => input.subarray(8 * at, 8 * (at += n));

const results = [];
const put = (place_, n) => results.push(new Uint8Array(core.memory.buffer, place_, 8 * n).slice());
const tell = (...numbers) => results.push(new Uint8Array(Float64Array.from(numbers).buffer));

function stretch(run, events) {
  const signal = next();
  const pieces = next();
  const [starts, coefficients] = [stored(take(pieces)), stored(take(12 * pieces))];
  const set = signal < 0 ? -1 : core.cw_set_segments(run, BigInt(signal), starts, coefficients, BigInt(pieces));
  const end = next();
  const n = next();
  const times = stored(take(n));
  const [row, size] = [Number(core.cw_row_size(run)), Number(core.cw_event_size())];
  const rows = place(8 * n * row);
  const filled = place(8);
  let done = 0;
  let status = eventsFull;
  while (status === eventsFull) {
    status = core.cw_advance(run, end, times + 8 * done, rows + 8 * done * row, BigInt(n - done), 0, filled);
    done += Number(new DataView(core.memory.buffer).getBigInt64(filled, true));
    const pending = core.cw_pending_events(run);
    const found = place(8 * Number(pending) * size);
    core.cw_take_events(run, found, pending);
    events.push(new Uint8Array(core.memory.buffer, found, 8 * Number(pending) * size).slice());
  }
  tell(set, status, done);
  put(rows, done * row);
}

function job() {
  top = start;
  const system = take(next());
  const bytes = BigInt(system.length);
  const model = stored(system);
  const size = core.cw_size(model, bytes);
  const run = core.cw_load(model, bytes, place(Number(size)), size);
  for (const name of ["rtol", "atol", "method", "angles", "work"]) {
    core.cw_set_option(run, stored(new TextEncoder().encode(name + "\0")), next());
  }
  const events = [];
  for (let left = next(); left > 0; --left) stretch(run, events);
  tell(events.reduce((sum, one) => sum + one.length / 8, 0));
  results.push(...events);
}

while (8 * at < input.length) job();
results.unshift(new Uint8Array(BigInt64Array.of(core.cw_schema_hash()).buffer));
const output = Buffer.concat(results);
for (let sent = 0; sent < output.length; ) sent += writeSync(1, output, sent);
