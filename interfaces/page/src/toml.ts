// Plain data as TOML.
import type { Plain } from "./data";

type Table = { [key: string]: Plain };

export function toml(table: Table): string {
  return `${lines(table, []).join("\n")}\n`;
}

function lines(table: Table, path: string[]): string[] {
  const made: string[] = [];
  const own = Object.entries(table).filter(([, value]) => value !== null);
  for (const [key, value] of own) if (!isTable(value) && !isTables(value)) made.push(`${word(key)} = ${inline(value)}`);
  for (const [key, value] of own) {
    const inner = [...path, key];
    if (isTables(value)) for (const one of value) made.push("", `[[${name(inner)}]]`, ...entries(one));
    else if (isTable(value)) made.push("", `[${name(inner)}]`, ...lines(value, inner));
  }
  return made;
}

/** Tables inside of an entry of a list stand in one line. */
function entries(table: Table): string[] {
  return Object.entries(table)
    .filter(([, value]) => value !== null)
    .map(([key, value]) => `${word(key)} = ${inline(value)}`);
}

function inline(value: Plain): string {
  if (typeof value === "string") return quoted(value);
  if (typeof value === "number") return number(value);
  if (typeof value === "boolean") return `${value}`;
  if (Array.isArray(value)) return `[${value.map(inline).join(", ")}]`;
  return `{ ${entries(value as Table).join(", ")} }`;
}

function number(value: number): string {
  return Number.isFinite(value) ? `${value}` : value > 0 ? "inf" : value < 0 ? "-inf" : "nan";
}

function quoted(text: string): string {
  // JSON and TOML escape alike, but for what TOML wants escaped besides
  return JSON.stringify(text).replace(/\u007f/g, "\\u007f");
}

function word(key: string): string {
  return /^[A-Za-z0-9_-]+$/.test(key) ? key : quoted(key);
}

function name(path: string[]): string {
  return path.map(word).join(".");
}

function isTable(value: Plain): value is Table {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function isTables(value: Plain): value is Table[] {
  return Array.isArray(value) && value.length > 0 && value.every(isTable);
}
