// Numbers and units as people read them.

const SHOWN: Record<string, [number, string]> = { Pa: [1e-5, "bar"], J: [1e-3, "kJ"], W: [1e-3, "kW"] };
// of these, little is told in the unit of SI: 20 J, not 0.02 kJ
const SMALL = new Set(["J", "W"]);
const LITTLE = 0.1;
const WRITTEN: Record<string, string> = { "N m": "N m", "rad/s2": "rad/s²", "m/s2": "m/s²", "rad/s3": "rad/s³", "m/s3": "m/s³", degC: "°C", "kg m2": "kg m²", m3: "m³", m2: "m²" };

/** Factor from SI to the unit in which values up to the largest are shown, and how that is written. */
export function shownUnit(unit: string, largest = Infinity): [number, string] {
  const known = SHOWN[unit];
  const little = known && SMALL.has(unit) && Math.abs(largest) * known[0] < LITTLE;
  const [factor, word] = known && !little ? known : [1, unit];
  return [factor, word === "1" ? "" : (WRITTEN[word] ?? word)];
}

/** A number with so many digits, without a long tail of zeros. */
export function number(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0 || Math.abs(value) < 1e-12) return "0";
  const size = Math.abs(value);
  const text = size >= 1e6 || size < 1e-4 ? value.toExponential(digits - 1) : Number(value.toPrecision(digits)).toString();
  return text.replace("-", "\u2212");
}

/** A quantity of SI in the unit that is shown. */
export function quantity(value: number, unit: string, digits = 4): string {
  const [factor, word] = shownUnit(unit, value);
  return word ? `${number(value * factor, digits)} ${word}` : number(value * factor, digits);
}

/** Values at the ticks of an axis, with as many digits as tell one from the next. */
export function tickWords(ticks: readonly number[]): string[] {
  const largest = Math.max(...ticks.map(Math.abs));
  const step = Math.min(...ticks.slice(1).map((tick, i) => Math.abs(tick - ticks[i]!)));
  const digits = step > 0 && Number.isFinite(step) ? Math.ceil(Math.log10(largest / step)) + 2 : 4;
  return ticks.map((tick) => number(tick, Math.min(Math.max(digits, 4), 12)));
}

export function seconds(time: number): string {
  return `${time.toFixed(3)} s`;
}
