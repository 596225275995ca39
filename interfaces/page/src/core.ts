// The core in WebAssembly: one run after another in one piece of memory.

const ALIGN = 16;
const ROWS_AT_ONCE = 4096;
const EVENTS_AT_ONCE = 256;
const ROWS_FULL = 1;
const EVENTS_FULL = 2;

interface Exports {
  memory: WebAssembly.Memory;
  __heap_base: WebAssembly.Global;
  _initialize?: () => void;
  cw_schema_hash: () => bigint;
  cw_size: (system: number, bytes: bigint) => bigint;
  cw_load: (system: number, bytes: bigint, memory: number, size: bigint) => number;
  cw_set_option: (run: number, name: number, value: number) => number;
  cw_advance: (run: number, end: number, times: number, rows: number, n: bigint, steps: number, filled: number) => number;
  cw_time: (run: number) => number;
  cw_row_size: (run: number) => bigint;
  cw_event_size: () => bigint;
  cw_take_events: (run: number, events: number, room: bigint) => bigint;
  cw_statistics: (run: number, counts: number) => void;
  cw_detail: (run: number, value: number) => bigint;
}

/** One change of a contact; fields as layout.EVENT. */
export type CoreEvent = Float64Array;

export interface Result {
  times: Float64Array;
  rows: Float64Array;
  count: number;
  size: number;
  events: CoreEvent[];
  status: number;
  reached: number;
  component: number;
  steps: number;
}

/** Where rows are wanted: so many per step of the solver, or at these instants. */
export type Output = { steps: number } | { times: number[] };

export class Core {
  private constructor(private readonly to: Exports) {
    this.base = aligned(Number(to.__heap_base.value));
    this.eventSize = Number(to.cw_event_size());
  }

  private readonly base: number;
  private readonly eventSize: number;

  static async of(wasm: BufferSource): Promise<Core> {
    const { instance } = await WebAssembly.instantiate(wasm, {});
    const to = instance.exports as unknown as Exports;
    to._initialize?.();
    return new Core(to);
  }

  get schema(): string {
    return this.to.cw_schema_hash().toString();
  }

  /** Run the bytes of a System from its start to an end [s]; null where they are refused. */
  run(system: Uint8Array, options: Record<string, number>, end: number, output: Output): Result | null {
    const { to } = this;
    let at = this.base;
    const place = (bytes: number): number => {
      const here = at;
      at = aligned(at + bytes);
      this.reserve(at);
      return here;
    };
    const model = place(system.length);
    new Uint8Array(to.memory.buffer).set(system, model);
    const size = to.cw_size(model, BigInt(system.length));
    if (size < 0n) return null;
    const run = to.cw_load(model, BigInt(system.length), place(Number(size)), size);
    if (!run) return null;
    const name = place(64);
    for (const [option, value] of Object.entries(options)) {
      const letters = new TextEncoder().encode(`${option}\0`);
      new Uint8Array(to.memory.buffer).set(letters, name);
      to.cw_set_option(run, name, value);
    }
    const width = Number(to.cw_row_size(run));
    const room = "times" in output ? Math.max(output.times.length, 1) : ROWS_AT_ONCE;
    const times = place(8 * room);
    const rows = place(8 * room * width);
    const events = place(8 * this.eventSize * EVENTS_AT_ONCE);
    const small = place(64);
    return this.advance(run, end, output, { times, rows, events, small, room, width });
  }

  private advance(run: number, end: number, output: Output, at: Buffers): Result {
    const { to } = this;
    const parts: { times: Float64Array; rows: Float64Array }[] = [];
    const events: CoreEvent[] = [];
    const grid = "times" in output ? output.times : null;
    let done = 0;
    let status: number;
    do {
      const left = grid ? grid.slice(done) : null;
      if (left) new Float64Array(to.memory.buffer, at.times, left.length).set(left);
      const room = left ? left.length : at.room;
      status = to.cw_advance(run, end, at.times, at.rows, BigInt(room), grid ? 0 : (output as { steps: number }).steps, at.small);
      const filled = Number(new BigInt64Array(to.memory.buffer, at.small, 1)[0]);
      parts.push({
        times: new Float64Array(to.memory.buffer, at.times, filled).slice(),
        rows: new Float64Array(to.memory.buffer, at.rows, filled * at.width).slice(),
      });
      done += filled;
      this.takeEvents(run, at.events, events);
    } while (status === ROWS_FULL || status === EVENTS_FULL);
    const component = Number(to.cw_detail(run, at.small));
    to.cw_statistics(run, at.small);
    const steps = Number(new BigInt64Array(to.memory.buffer, at.small, 1)[0]);
    const first = parts.length === 1 ? parts[0] : undefined;
    return {
      times: first?.times ?? joined(parts.map((part) => part.times)),
      rows: first?.rows ?? joined(parts.map((part) => part.rows)),
      count: done,
      size: at.width,
      events,
      status,
      reached: to.cw_time(run),
      component,
      steps,
    };
  }

  private takeEvents(run: number, place: number, events: CoreEvent[]): void {
    const { to, eventSize } = this;
    let taken: number;
    do {
      taken = Number(to.cw_take_events(run, place, BigInt(EVENTS_AT_ONCE)));
      for (let i = 0; i < taken; i++) {
        events.push(new Float64Array(to.memory.buffer, place + 8 * eventSize * i, eventSize).slice());
      }
    } while (taken === EVENTS_AT_ONCE);
  }

  private reserve(end: number): void {
    const { memory } = this.to;
    const lacking = end - memory.buffer.byteLength;
    if (lacking > 0) memory.grow(Math.ceil(lacking / 65536));
  }
}

interface Buffers {
  times: number;
  rows: number;
  events: number;
  small: number;
  room: number;
  width: number;
}

function aligned(at: number): number {
  return Math.ceil(at / ALIGN) * ALIGN;
}

function joined(parts: Float64Array[]): Float64Array {
  const made = new Float64Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    made.set(part, at);
    at += part.length;
  }
  return made;
}
