// Signals from rows, as results/forms.py evaluates them: terms are added in their order.
import type { Form } from "./data";
import type { Result } from "./core";

const LOCKED = 0;

export function evaluated(form: Form, run: Result): Float64Array {
  const { rows, count, size } = run;
  const made = new Float64Array(count);
  switch (form[0]) {
    case "c":
      for (let i = 0, at = form[1]; i < count; i++, at += size) made[i] = rows[at]!;
      return made;
    case "a":
      for (let i = 0, at = form[1]; i < count; i++, at += size) made[i] = form[3] + form[2] * rows[at]!;
      return made;
    case "t":
      for (const column of form[1]) for (let i = 0, at = column; i < count; i++, at += size) made[i]! += rows[at]!;
      if (form[2]) for (let i = 0; i < count; i++) made[i] = -made[i]!;
      return made;
    case "l":
      form[1].forEach((column, term) => {
        const factor = form[2][term]!;
        for (let i = 0, at = column; i < count; i++, at += size) made[i]! += factor * rows[at]!;
      });
      return made;
    case "s": {
      const rate = evaluated(form[1], run);
      for (let i = 0, at = form[2]; i < count; i++, at += size) if (rows[at] === LOCKED) rate[i] = 0;
      return rate;
    }
    case "p":
      return product(evaluated(form[1], run), evaluated(form[2], run));
    case "q":
      for (const part of form[1]) evaluated(part, run).forEach((power, i) => (made[i]! += power));
      return made;
    case "d":
      return slope(evaluated(form[1], run), run.times);
  }
}

function product(one: Float64Array, other: Float64Array): Float64Array {
  for (let i = 0; i < one.length; i++) one[i]! *= other[i]!;
  return one;
}

/** Difference quotients between rows; none across a jump, where the one beside it stands. */
export function slope(values: Float64Array, times: Float64Array): Float64Array {
  const made = new Float64Array(values.length);
  const least = 1e-9 * Math.max(Math.abs(times.at(-1) ?? 0), 1e-9);
  let known = 0;
  for (let i = 1; i < values.length; i++) {
    const step = times[i]! - times[i - 1]!;
    if (step > least) {
      made[i] = (values[i]! - values[i - 1]!) / step;
      // the right limit at a jump, and the first row, have the slope of what follows
      for (let k = known; k < i; k++) made[k] = made[i]!;
      known = i + 1;
    } else {
      known = Math.max(known, i);
    }
  }
  return made;
}

/** The largest jerk that a person feels: the change of the mean accelerations before and behind an instant over a window, in
 * which a jump counts; null for a run of less than two windows. docs/theory/jerk.md (1) */
export function feltJerk(acceleration: Float64Array, times: Float64Array, window = 0.05): number | null {
  const n = times.length;
  const [first, last] = [times[0] ?? 0, times[n - 1] ?? 0];
  if (last - first < 2 * window) return null;
  const sums = new Float64Array(n);
  for (let i = 1; i < n; i++) sums[i] = sums[i - 1]! + 0.5 * (acceleration[i]! + acceleration[i - 1]!) * (times[i]! - times[i - 1]!);
  const speedAt = (): ((t: number) => number) => {
    let i = 0;
    return (t) => {
      while (i < n - 2 && times[i + 1]! < t) i++;
      const [h, s] = [times[i + 1]! - times[i]!, t - times[i]!];
      const rise = h > 0 ? (acceleration[i + 1]! - acceleration[i]!) / h : 0;
      return sums[i]! + s * (acceleration[i]! + 0.5 * s * rise);
    };
  };
  const [before, here, after] = [speedAt(), speedAt(), speedAt()];
  let most = 0;
  const instants = Math.floor((16 * (last - first - 2 * window)) / window + 1e-9);
  for (let k = 0; k <= instants; k++) {
    const t = first + window + (k * window) / 16;
    most = Math.max(most, Math.abs(after(t + window) - 2 * here(t) + before(t - window)) / (window * window));
  }
  return most;
}
