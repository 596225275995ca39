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
