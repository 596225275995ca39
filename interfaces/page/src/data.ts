// What Python writes into a page: src/clutchwork/page/data.py.

/** How a signal follows from a row: results/forms.py; "d" is the slope over time of another one. */
export type Form =
  | ["c", number]
  | ["a", number, number, number]
  | ["t", number[], boolean]
  | ["l", number[], number[]]
  | ["s", Form, number]
  | ["p", Form, Form]
  | ["q", Form[]]
  | ["d", Form];

/** A knot: time [s] and value. */
export type Knot = [number, number];

export interface TableData {
  name: string;
  unit: string;
  points: Knot[];
  lower: number | null;
  upper: number | null;
  inputs: { number: number; first: number; room: number }[];
}

export interface SliderData {
  name: string;
  names: string[]; // numbers that it turns together
  unit: string;
  doc: string;
  start: number;
  starts: number[]; // where these stand until it is turned; one where all are the same
  values: number[];
  places: number[];
  direct: boolean;
  words?: string;
}

/** Two sliders that go together: words of all pairs of their values, and why some of these have no driveline. */
export interface PairData {
  sliders: [number, number];
  values: [number[], number[]]; // stops and start of each
  places: number[];
  words: string;
  refused: Record<string, string>;
}

export interface ContactData {
  name: string;
  number: number;
  mode: number;
  torque: Form;
  slip: Form | null;
  heat: Form | null;
}

export interface LeverData {
  name: string;
  points: { name: string; column: number; place: number }[];
}

export interface PanelData {
  title: string;
  unit: string;
  names: string[];
}

/** One signal over another. */
export interface LoopData {
  y: string;
  x: string;
}

export type Places = Record<"input_value" | "segment_time" | "segment_coef", number>;

export type Plain = string | number | boolean | null | Plain[] | { [key: string]: Plain };

export interface PageData {
  format: number;
  name: string;
  schema: string;
  system: string;
  rowSize: number;
  tStart: number;
  tEnd: number;
  options: Record<string, number>;
  places: Places;
  tables: TableData[];
  sliders: SliderData[];
  pairs: PairData[];
  signals: Record<string, { unit: string; form: Form }>;
  panels: PanelData[];
  loops: LoopData[];
  contacts: ContactData[];
  components: string[];
  output: string;
  schematic: { svg: string; signals: string[] } | null;
  levers: LeverData[];
  modes: Record<string, string>;
  causes: Record<string, [string, string]>;
  statuses: [string, string, string][];
  model: { [key: string]: Plain } | null;
  paths: Record<string, (string | number)[][]>;
}
