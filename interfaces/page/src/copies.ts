// What a reader takes along: the model as TOML, a program in Python, the curves as CSV.
import type { Result } from "./core";
import type { Knot, PageData, Plain } from "./data";
import { evaluated } from "./forms";
import type { Session } from "./session";
import { toml } from "./toml";

/** The model file with the knots and numbers of now; null where the driveline has none. */
export function asToml(session: Session): string | null {
  const { data } = session;
  if (!data.model) return null;
  const model = structuredClone(data.model);
  const lost: string[] = [];
  changes(session).forEach(([name, value]) => {
    const paths = data.paths[name] ?? [];
    for (const path of paths) put(model, path, value);
    if (!paths.length) lost.push(`# a model file has no place for ${JSON.stringify(name)}, which is ${JSON.stringify(value)} here\n`);
  });
  return lost.join("") + toml(model);
}

/** Names of what a page changes, and what it is now. */
export function changes(session: Session): [string, Knot[] | number][] {
  const { data, knots, values } = session;
  const tables = data.tables.map((table, i): [string, Knot[]] => [table.name, knots[i]!]);
  const numbers = data.sliders.flatMap(({ names }, i) => (session.isTurned(i) ? names.map((name): [string, number] => [name, values[i]!]) : []));
  return [...tables, ...numbers];
}

function put(model: Plain, path: readonly (string | number)[], value: Plain): void {
  let inner = model as Record<string | number, Plain>;
  for (const step of path.slice(0, -1)) inner = (inner[step] ??= {}) as Record<string | number, Plain>;
  inner[path[path.length - 1]!] = value;
}

export function asPython(session: Session): string {
  const { data } = session;
  const lines = changes(session).map(([name, value]) => {
    const written = typeof value === "number" ? `${value}` : `cw.Table([${value.map(([t, y]) => `(${t}, ${y})`).join(", ")}])`;
    return `    ${JSON.stringify(name)}: ${written},`;
  });
  return [
    "import clutchwork as cw",
    "",
    'driveline = cw.Driveline.load("model.toml")',
    "system = driveline.assemble().changed({",
    ...lines,
    "})",
    `run = cw.simulate(system, ${data.tEnd})`,
    "print(run.events)",
    "",
  ].join("\n");
}

export function asCsv(data: PageData, run: Result): string {
  const names = [...data.tables.map((table) => table.name), ...data.panels.flatMap((panel) => panel.names)];
  const known = [...new Set(names)].filter((name) => name in data.signals);
  const columns = known.map((name) => evaluated(data.signals[name]!.form, run));
  const head = ["time [s]", ...known.map((name) => `${name} [${data.signals[name]!.unit}]`)];
  const lines = [head.map(quoted).join(",")];
  for (let i = 0; i < run.count; i++) lines.push([run.times[i]!, ...columns.map((column) => column[i]!)].join(","));
  return lines.join("\n") + "\n";
}

function quoted(word: string): string {
  // a spreadsheet takes a cell that begins so for a formula
  const plain = /^[=+\-@]/.test(word) ? `'${word}` : word;
  return /[",\n]/.test(plain) ? `"${plain.replaceAll('"', '""')}"` : plain;
}
