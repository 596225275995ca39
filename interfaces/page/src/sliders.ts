// Numbers that are turned, each with its ends, its unit and what it is.
import type { App, Part } from "./app";
import type { SliderData } from "./data";
import { element } from "./dom";
import { quantity } from "./format";
import { nearest } from "./state";

const STEPS = 400;

export class Sliders implements Part {
  readonly root: HTMLElement;
  private readonly inputs: HTMLInputElement[] = [];
  private readonly outputs: HTMLOutputElement[] = [];

  constructor(private readonly app: App) {
    this.root = element("section", { class: "panel turn", "aria-label": "parameters" }, element("h2", {}, "Turn these"));
    app.data.sliders.forEach((slider, i) => this.root.append(this.line(slider, i)));
    this.update();
  }

  update(): void {
    this.app.data.sliders.forEach((slider, i) => {
      const value = this.app.session.values[i]!;
      const text = told(slider, value);
      this.inputs[i]!.value = `${position(slider, value)}`;
      this.inputs[i]!.setAttribute("aria-valuetext", text);
      this.outputs[i]!.textContent = text;
    });
  }

  private line(slider: SliderData, i: number): HTMLElement {
    const most = slider.direct ? STEPS : slider.values.length - 1;
    const input = element("input", { type: "range", min: "0", max: `${most}`, step: "1", id: `slider-${i}` });
    const output = element("output", { for: `slider-${i}` });
    input.addEventListener("input", () => {
      this.app.session.values[i] = valueAt(slider, Number(input.value));
      this.app.changed();
    });
    input.addEventListener("dblclick", () => {
      this.app.session.values[i] = slider.start;
      this.app.changed();
    });
    this.inputs[i] = input;
    this.outputs[i] = output;
    const ends = element("span", { class: "ends" }, ...[slider.values[0]!, slider.values.at(-1)!].map((end) => element("span", {}, quantity(end, slider.unit))));
    return element("div", { class: "slider" }, element("label", { for: `slider-${i}`, title: title(slider) }, slider.name), output, input, ends);
  }
}

/** A value in words; numbers with different starts have their own until they are turned. */
export function told({ start, starts, unit }: SliderData, value: number): string {
  return starts.length > 1 && value === start ? `${quantity(starts[0]!, unit)} to ${quantity(starts.at(-1)!, unit)}, each with its own` : quantity(value, unit);
}

function title({ doc, names, starts }: SliderData): string {
  if (names.length === 1) return doc;
  return `${doc}; of ${names.join(", ")}${starts.length > 1 ? ", which start from different values; once moved, all take this one" : ""}`;
}

/** The value at a place of a slider; the start stands exactly where it is nearest. */
export function valueAt(slider: SliderData, place: number): number {
  if (!slider.direct) return slider.values[place] ?? slider.start;
  if (place === position(slider, slider.start)) return slider.start;
  const low = slider.values[0]!;
  return low + ((slider.values.at(-1)! - low) * place) / STEPS;
}

export function position(slider: SliderData, value: number): number {
  if (!slider.direct) return slider.values.indexOf(nearest(slider.values, value));
  const low = slider.values[0]!;
  return Math.round((STEPS * (value - low)) / (slider.values.at(-1)! - low));
}
