// What a reader has changed, by name: knots of tables and values of sliders, to and from other programs.
import type { Knot } from "./data";
import { copied, type Session } from "./session";

export interface State {
  knots: Record<string, Knot[]>;
  values: Record<string, number>;
}

export function stateOf(session: Session): State {
  const { tables, sliders } = session.data;
  return {
    knots: Object.fromEntries(tables.map((table, i) => [table.name, copied(session.knots[i]!)])),
    values: Object.fromEntries(sliders.map((slider, i) => [slider.name, session.values[i]!])),
  };
}

/** Take what is given; what is not stays. Whether anything changed. */
export function take(session: Session, given: Partial<State>): boolean {
  const before = JSON.stringify(stateOf(session));
  const { tables, sliders } = session.data;
  tables.forEach(({ name }, i) => {
    const knots = given.knots?.[name];
    if (knots?.length) session.knots[i] = copied(knots);
  });
  sliders.forEach((slider, i) => {
    const value = given.values?.[slider.name];
    if (value !== undefined) session.values[i] = slider.direct || value === slider.start ? value : nearest(slider.values, value);
  });
  return JSON.stringify(stateOf(session)) !== before;
}

/** The stop that is nearest, the lower one of two. */
export function nearest(stops: readonly number[], value: number): number {
  return stops.reduce((best, one) => (Math.abs(one - value) < Math.abs(best - value) ? one : best));
}
